#include "framework/io/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace pliant {
namespace {

using Line = TextLines::Line;

constexpr std::array<std::pair<std::string_view, PlyType>, 16> types{{{"char", PlyType::int8},
                                                                      {"uchar", PlyType::uint8},
                                                                      {"short", PlyType::int16},
                                                                      {"ushort", PlyType::uint16},
                                                                      {"int", PlyType::int32},
                                                                      {"uint", PlyType::uint32},
                                                                      {"float", PlyType::float32},
                                                                      {"double", PlyType::float64},
                                                                      {"int8", PlyType::int8},
                                                                      {"uint8", PlyType::uint8},
                                                                      {"int16", PlyType::int16},
                                                                      {"uint16", PlyType::uint16},
                                                                      {"int32", PlyType::int32},
                                                                      {"uint32", PlyType::uint32},
                                                                      {"float32", PlyType::float32},
                                                                      {"float64", PlyType::float64}}};

class HeaderReader {
 public:
  explicit HeaderReader(TextLines& lines) : lines_(lines) {}

  PlyHeader read() {
    const Line magic = line();
    if (magic.words != std::vector<std::string_view>{"ply"}) lines_.fail(magic.number, "expected 'ply'");
    read_format(line());
    for (Line next = line(); !is(next, "end_header"); next = line()) {
      if (is(next, "element"))
        add_element(next);
      else if (is(next, "property"))
        add_property(next);
      else if (!next.empty() && !is(next, "comment") && !is(next, "obj_info"))
        lines_.fail(next.number, "expected an element, a property, a comment or end_header");
    }
    for (const PlyElement& element : header_.elements)
      if (element.properties.empty())
        lines_.fail(last_, fmt::format("element {} has no property", element.name));
    return std::move(header_);
  }

 private:
  static bool is(const Line& line, std::string_view keyword) {
    return !line.empty() && line.words[0] == keyword;
  }

  Line line() {
    const auto line = lines_.next();
    if (!line) lines_.fail(last_ + 1, "the header ends without end_header");
    last_ = line->number;
    return *line;
  }

  void read_format(const Line& line) {
    using Format = PlyHeader::Format;
    constexpr std::array<std::pair<std::string_view, Format>, 3> formats{
        {{"ascii", Format::ascii},
         {"binary_little_endian", Format::little_endian},
         {"binary_big_endian", Format::big_endian}}};
    const bool is_format = is(line, "format") && line.words.size() == 3 && line.words[2] == "1.0";
    const auto* found = std::find_if(formats.begin(), formats.end(), [&](const auto& format) {
      return is_format && format.first == line.words[1];
    });
    if (found == formats.end())
      lines_.fail(line.number, "expected 'format ascii 1.0', binary_little_endian or binary_big_endian");
    header_.format = found->second;
  }

  void add_element(const Line& line) {
    if (line.words.size() != 3) lines_.fail(line.number, "expected 'element NAME COUNT'");
    const long long count = lines_.integer(line, 2);
    if (count < 0) lines_.fail(line.number, fmt::format("{} elements", count));
    PlyElement element{std::string(line.words[1]), static_cast<std::uint64_t>(count), {}};
    for (const PlyElement& other : header_.elements)
      if (other.name == element.name) lines_.fail(line.number, "an element of a name that another has");
    header_.elements.push_back(std::move(element));
  }

  void add_property(const Line& line) {
    if (header_.elements.empty()) lines_.fail(line.number, "a property before any element");
    const bool is_list = line.words.size() > 1 && line.words[1] == "list";
    if (line.words.size() != (is_list ? 5U : 3U))
      lines_.fail(line.number, "expected 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
    PlyProperty property{std::string(line.words.back()), type(line, is_list ? 3 : 1)};
    if (is_list) property.count_type = type(line, 2);
    if (is_list && !is_integer(*property.count_type))
      lines_.fail(line.number, "a list whose length is no integer");
    PlyElement& element = header_.elements.back();
    if (element.find(property.name)) lines_.fail(line.number, "a property of a name that another has");
    element.properties.push_back(std::move(property));
  }

  PlyType type(const Line& line, std::size_t word) const {
    const auto* found = std::find_if(types.begin(), types.end(),
                                     [&](const auto& type) { return type.first == line.words[word]; });
    if (found == types.end())
      lines_.fail(line.number,
                  "a type that PLY does not have; expected char, uchar, short, ushort, int, uint, float "
                  "or double");
    return found->second;
  }

  TextLines& lines_;
  PlyHeader header_;
  int last_ = 0;
};

}  // namespace

std::size_t size_of(PlyType type) {
  constexpr std::array<std::size_t, 8> sizes{1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

bool is_integer(PlyType type) { return type != PlyType::float32 && type != PlyType::float64; }

std::optional<std::size_t> PlyElement::find(const std::string& property) const {
  for (std::size_t i = 0; i < properties.size(); ++i)
    if (properties[i].name == property) return i;
  return std::nullopt;
}

PlyHeader read_ply_header(TextLines& lines) { return HeaderReader(lines).read(); }

}  // namespace pliant
