#include "framework/io/obj_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include "framework/core/error.h"
#include "framework/io/text_lines.h"

namespace pliant {
namespace {

using Line = TextLines::Line;

/// What there is in such files besides vertices and polygons.
constexpr std::array<std::string_view, 14> passed_over{"vt", "vn", "vp",     "g",  "s",   "o",      "usemtl",
                                                       "l",  "p",  "mtllib", "mg", "lod", "usemap", "maplib"};

class ObjReader {
 public:
  ObjReader(std::string text, const std::string& path, double unit)
      : lines_(std::move(text), path), path_(path), unit_(unit) {}

  SurfaceMesh read() {
    while (const auto line = lines_.next()) {
      if (line->empty()) continue;
      const std::string_view kind = line->words[0];
      if (kind == "v")
        add_vertex(*line);
      else if (kind == "f")
        add_face(*line);
      else if (std::find(passed_over.begin(), passed_over.end(), kind) == passed_over.end())
        lines_.fail(line->number,
                    "a line that is no vertex, no face and nothing else that a surface of polygons has");
    }
    if (!mesh_.colors.empty() && mesh_.colors.size() != mesh_.vertices.size())
      throw DataError(fmt::format("{}: {} of {} vertices have colours; expected all or none", path_,
                                  mesh_.colors.size(), mesh_.vertices.size()));
    return std::move(mesh_);
  }

 private:
  void add_vertex(const Line& line) {
    const std::size_t numbers = line.words.size() - 1;
    if (numbers != 3 && numbers != 4 && numbers != 6)
      lines_.fail(line.number, fmt::format("a vertex of {} numbers, expected x y z", numbers));
    const Eigen::Vector3d vertex(lines_.real(line, 1), lines_.real(line, 2), lines_.real(line, 3));
    if (numbers == 4 && lines_.real(line, 4) != 1)
      lines_.fail(line.number, "a vertex with a weight that is not 1");
    mesh_.vertices.emplace_back((unit_ * vertex).cast<float>());
    if (!mesh_.vertices.back().allFinite()) lines_.fail(line.number, "a vertex that is too far away");
    if (numbers == 6) mesh_.colors.push_back({color(line, 4), color(line, 5), color(line, 6)});
  }

  std::uint8_t color(const Line& line, std::size_t word) const {
    const double value = lines_.real(line, word);
    if (value < 0 || value > 1)
      lines_.fail(line.number, fmt::format("a colour of {}, expected 0 to 1", value));
    return static_cast<std::uint8_t>(std::lround(255 * value));
  }

  void add_face(const Line& line) {
    if (line.words.size() < 4)
      lines_.fail(line.number,
                  fmt::format("a face of {} corners, expected 3 or more", line.words.size() - 1));
    std::vector<int> corners;
    for (std::size_t word = 1; word < line.words.size(); ++word) corners.push_back(corner(line, word));
    add_polygon(corners, mesh_.triangles);
  }

  /// Of "7/1/2" the 7; what is behind it is held to be a number, too.
  int corner(const Line& line, std::size_t word) const {
    const std::string_view text = line.words[word];
    const auto wrong = [&] {
      lines_.fail(line.number, "a corner of a face that is not written as v, v/vt, v//vn or v/vt/vn");
    };
    std::array<long long, 3> numbers{};
    const char* at = text.data();
    const char* end = at + text.size();
    std::size_t part = 0;
    for (;; ++part, ++at) {
      if (part == numbers.size()) wrong();
      const bool is_left_out = part == 1 && at != end && *at == '/';
      if (!is_left_out) {
        const auto [stop, error] = std::from_chars(at, end, numbers[part]);
        if (error != std::errc()) wrong();
        at = stop;
      }
      if (at == end) break;
      if (*at != '/') wrong();
    }
    const auto count = static_cast<long long>(mesh_.vertices.size());
    const long long vertex = numbers[0] < 0 ? count + numbers[0] : numbers[0] - 1;
    if (vertex < 0 || vertex >= count)
      lines_.fail(line.number,
                  fmt::format("a face names vertex {}, but {} are before it", numbers[0], count));
    return static_cast<int>(vertex);
  }

  TextLines lines_;
  std::string path_;
  double unit_;
  SurfaceMesh mesh_;
};

}  // namespace

SurfaceMesh read_obj(const std::vector<std::uint8_t>& bytes, const std::string& path, double unit) {
  return ObjReader({bytes.begin(), bytes.end()}, path, unit).read();
}

}  // namespace pliant
