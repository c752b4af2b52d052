#include "framework/io/ply_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>

#include "framework/core/error.h"
#include "framework/io/ply_header.h"

namespace pliant {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// The numbers behind a header, one after the other.
class PlyData {
 public:
  virtual ~PlyData() = default;
  /// Goes to the next entry of an element, whose name and number are for messages.
  virtual void begin(const PlyElement& element, std::uint64_t number) = 0;
  virtual double next(PlyType type) = 0;
  /// Nothing of the entry may be left.
  virtual void end() {}
  /// Nothing at all may be left.
  virtual void finish() = 0;
  [[noreturn]] virtual void fail(const std::string& what) const = 0;
};

/// An entry a line.
class AsciiData : public PlyData {
 public:
  explicit AsciiData(TextLines& lines) : lines_(lines) {}

  void begin(const PlyElement& element, std::uint64_t number) override {
    const int last = line_.number;
    if (!go_to_line())
      lines_.fail(last + 1,
                  fmt::format("the file ends before {} {} of {}", element.name, number, element.count));
    word_ = 0;
  }
  double next(PlyType type) override {
    const double value = lines_.real(line_, word_++);
    if (is_integer(type) && value != std::floor(value)) fail(fmt::format("{} is not a whole number", value));
    return value;
  }
  void end() override {
    if (word_ < line_.words.size()) fail(fmt::format("{} numbers too many", line_.words.size() - word_));
  }
  void finish() override {
    if (go_to_line()) fail("a line behind the last element");
  }
  [[noreturn]] void fail(const std::string& what) const override { lines_.fail(line_.number, what); }

 private:
  bool go_to_line() {
    while (auto line = lines_.next()) {
      line_ = *std::move(line);
      if (!line_.empty()) return true;
    }
    return false;
  }

  TextLines& lines_;
  TextLines::Line line_;
  std::size_t word_ = 0;
};

class BinaryData : public PlyData {
 public:
  BinaryData(const Bytes& bytes, std::size_t begin, bool is_big_endian, std::string path)
      : bytes_(bytes), position_(begin), is_big_endian_(is_big_endian), path_(std::move(path)) {}

  void begin(const PlyElement& element, std::uint64_t number) override {
    element_ = &element;
    number_ = number;
  }
  double next(PlyType type) override {
    switch (type) {
      case PlyType::int8:
        return number<std::int8_t>();
      case PlyType::uint8:
        return number<std::uint8_t>();
      case PlyType::int16:
        return number<std::int16_t>();
      case PlyType::uint16:
        return number<std::uint16_t>();
      case PlyType::int32:
        return number<std::int32_t>();
      case PlyType::uint32:
        return number<std::uint32_t>();
      case PlyType::float32:
        return number<float>();
      case PlyType::float64:
        break;
    }
    return number<double>();
  }
  void finish() override {
    if (position_ < bytes_.size())
      throw DataError(
          fmt::format("{}: too long: {} bytes behind the last element", path_, bytes_.size() - position_));
  }
  [[noreturn]] void fail(const std::string& what) const override {
    throw DataError(fmt::format("{}: {} {}: {}", path_, element_->name, number_, what));
  }

 private:
  template <class Number>
  Number number() {
    std::array<std::uint8_t, sizeof(Number)> bytes{};
    if (bytes_.size() - position_ < bytes.size()) fail(fmt::format("truncated: {} bytes", bytes_.size()));
    std::memcpy(bytes.data(), bytes_.data() + position_, bytes.size());
    position_ += bytes.size();
    const bool is_foreign = is_big_endian_ != (std::endian::native == std::endian::big);
    if (is_foreign) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<Number>(bytes);
  }

  const Bytes& bytes_;
  std::size_t position_;
  bool is_big_endian_;
  std::string path_;
  const PlyElement* element_ = nullptr;
  std::uint64_t number_ = 0;
};

/// Where the three properties of such names are; none unless all are there and none is a list.
std::optional<std::array<std::size_t, 3>> places(const PlyElement& element,
                                                 const std::array<const char*, 3>& names) {
  std::array<std::size_t, 3> places{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto place = element.find(names[i]);
    if (!place || element.properties[*place].count_type) return std::nullopt;
    places[i] = *place;
  }
  return places;
}

class PlyReader {
 public:
  PlyReader(const PlyHeader& header, PlyData& data, std::string path, double unit)
      : header_(header), data_(data), path_(std::move(path)), unit_(unit) {}

  SurfaceMesh read() {
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex")
        read_vertices(element);
      else if (element.name == "face")
        read_faces(element);
      else
        for (std::uint64_t i = 0; i < element.count; ++i) read_entry(element, i);
    }
    data_.finish();
    return std::move(mesh_);
  }

 private:
  void read_vertices(const PlyElement& element) {
    const auto position = places(element, {"x", "y", "z"});
    if (!position) throw DataError(path_ + ": the element vertex has no x, y and z");
    const auto color = places(element, {"red", "green", "blue"});
    for (std::uint64_t i = 0; i < element.count; ++i) {
      read_entry(element, i);
      const Eigen::Vector3d vertex(values_[(*position)[0]], values_[(*position)[1]], values_[(*position)[2]]);
      mesh_.vertices.emplace_back((unit_ * vertex).cast<float>());
      if (!mesh_.vertices.back().allFinite()) data_.fail("a vertex that is not finite");
      if (color) mesh_.colors.push_back(color_of(element, *color));
    }
  }

  Rgb color_of(const PlyElement& element, const std::array<std::size_t, 3>& at) const {
    std::array<std::uint8_t, 3> color{};
    for (std::size_t i = 0; i < 3; ++i) {
      const double value = values_[at[i]] * (is_integer(element.properties[at[i]].type) ? 1 : 255);
      if (!(value >= 0 && value <= 255))
        data_.fail("a colour that is not from 0 to 255, or from 0 to 1 as a float");
      color[i] = static_cast<std::uint8_t>(std::lround(value));
    }
    return {color[0], color[1], color[2]};
  }

  void read_faces(const PlyElement& element) {
    auto corners = element.find("vertex_indices");
    if (!corners) corners = element.find("vertex_index");
    if (!corners || !element.properties[*corners].count_type ||
        !is_integer(element.properties[*corners].type))
      throw DataError(path_ + ": the element face has no list vertex_indices of integers");
    for (std::uint64_t i = 0; i < element.count; ++i) {
      read_entry(element, i, *corners);
      if (list_.size() < 3) data_.fail(fmt::format("a face of {} corners, expected 3 or more", list_.size()));
      add_polygon(list_, mesh_.triangles);
    }
  }

  /// Leaves the numbers of an entry in `values_`, in place of a list 0; the list `kept` in `list_`.
  void read_entry(const PlyElement& element, std::uint64_t number,
                  std::optional<std::size_t> kept = std::nullopt) {
    data_.begin(element, number);
    values_.assign(element.properties.size(), 0);
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (property.count_type)
        read_list(property, kept == p);
      else
        values_[p] = data_.next(property.type);
    }
    data_.end();
  }

  void read_list(const PlyProperty& property, bool is_kept) {
    const double length = data_.next(*property.count_type);
    if (length < 0) data_.fail(fmt::format("a list of {} entries", length));
    if (is_kept) list_.clear();
    for (double i = 0; i < length; ++i) {
      const double value = data_.next(property.type);
      if (is_kept) list_.push_back(vertex_of(value));
    }
  }

  int vertex_of(double value) const {
    const std::uint64_t count = vertex_count();
    if (!(value >= 0 && value < static_cast<double>(count)))
      data_.fail(fmt::format("a face names vertex {}, but there are {}", value, count));
    return static_cast<int>(value);
  }

  /// Faces may come before the vertices.
  std::uint64_t vertex_count() const {
    for (const PlyElement& element : header_.elements)
      if (element.name == "vertex") return std::min<std::uint64_t>(element.count, 0x7FFFFFFF);
    return 0;
  }

  const PlyHeader& header_;
  PlyData& data_;
  std::string path_;
  double unit_;
  std::vector<double> values_;
  std::vector<int> list_;
  SurfaceMesh mesh_;
};

}  // namespace

bool is_ply(const Bytes& bytes) {
  return bytes.size() >= 4 && std::memcmp(bytes.data(), "ply", 3) == 0 &&
         (bytes[3] == '\n' || bytes[3] == '\r');
}

SurfaceMesh read_ply(const Bytes& bytes, const std::string& path, double unit) {
  TextLines lines({bytes.begin(), bytes.end()}, path);
  const PlyHeader header = read_ply_header(lines);
  std::unique_ptr<PlyData> data;
  if (header.format == PlyHeader::Format::ascii)
    data = std::make_unique<AsciiData>(lines);
  else
    data = std::make_unique<BinaryData>(bytes, lines.position(),
                                        header.format == PlyHeader::Format::big_endian, path);
  return PlyReader(header, *data, path, unit).read();
}

}  // namespace pliant
