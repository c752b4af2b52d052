#pragma once

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pliant::test {

/// A binary glTF file in the making. Data goes in as views and accessors; `json` may be changed at will.
struct GlbFile {
  static constexpr int kByte = 5121;
  static constexpr int kShort = 5123;
  static constexpr int kInt = 5125;
  static constexpr int kFloat = 5126;

  nlohmann::json json = {{"asset", {{"version", "2.0"}}},         {"scene", 0},
                         {"scenes", {{{"nodes", {0}}}}},          {"nodes", {{{"mesh", 0}}}},
                         {"meshes", nlohmann::json::array()},     {"accessors", nlohmann::json::array()},
                         {"bufferViews", nlohmann::json::array()}};
  std::vector<std::uint8_t> binary;

  /// Appends values as they are; gives the index of their buffer view.
  template <class Number>
  std::size_t view(const std::vector<Number>& values) {
    const std::size_t start = binary.size();
    binary.resize(start + values.size() * sizeof(Number));
    std::memcpy(binary.data() + start, values.data(), values.size() * sizeof(Number));
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", start}, {"byteLength", values.size() * sizeof(Number)}});
    binary.resize((binary.size() + 3) / 4 * 4);
    return json["bufferViews"].size() - 1;
  }

  std::size_t accessor(std::size_t view, int component_type, const std::string& type, std::size_t count) {
    json["accessors"].push_back(
        {{"bufferView", view}, {"componentType", component_type}, {"type", type}, {"count", count}});
    return json["accessors"].size() - 1;
  }

  std::size_t vectors(const std::vector<float>& numbers) {
    return accessor(view(numbers), kFloat, "VEC3", numbers.size() / 3);
  }

  template <class Number>
  std::size_t indices(const std::vector<Number>& numbers, int component_type) {
    return accessor(view(numbers), component_type, "SCALAR", numbers.size());
  }

  std::vector<std::uint8_t> bytes() const {
    nlohmann::json whole = json;
    if (!whole.contains("buffers")) whole["buffers"] = {{{"byteLength", binary.size()}}};
    std::string text = whole.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::vector<std::uint8_t> file;
    const auto add_word = [&file](std::uint32_t word) {
      for (int b = 0; b < 4; ++b) file.push_back(static_cast<std::uint8_t>(word >> (8 * b)));
    };
    add_word(0x46546C67);
    add_word(2);
    add_word(static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + binary.size()));
    add_word(static_cast<std::uint32_t>(text.size()));
    add_word(0x4E4F534A);
    file.insert(file.end(), text.begin(), text.end());
    add_word(static_cast<std::uint32_t>(binary.size()));
    add_word(0x004E4942);
    file.insert(file.end(), binary.begin(), binary.end());
    return file;
  }
};

/// A square of 200 mm in the plane z = 0 with the morph targets "bulge" (corner 3 by 10 mm along z, sparse)
/// and "slide" (all by 20 mm along x).
inline GlbFile square_glb() {
  GlbFile glb;
  const auto positions = glb.vectors({-0.1f, -0.1f, 0, 0.1f, -0.1f, 0, 0.1f, 0.1f, 0, -0.1f, 0.1f, 0});
  const auto indices = glb.indices(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, GlbFile::kShort);
  const auto places = glb.view(std::vector<std::uint8_t>{3});
  const auto values = glb.view(std::vector<float>{0, 0, 0.01f});
  glb.json["accessors"].push_back({{"componentType", GlbFile::kFloat},
                                   {"type", "VEC3"},
                                   {"count", 4},
                                   {"sparse",
                                    {{"count", 1},
                                     {"indices", {{"bufferView", places}, {"componentType", GlbFile::kByte}}},
                                     {"values", {{"bufferView", values}}}}}});
  const auto bulge = glb.json["accessors"].size() - 1;
  const auto slide = glb.vectors({0.02f, 0, 0, 0.02f, 0, 0, 0.02f, 0, 0, 0.02f, 0, 0});
  glb.json["meshes"].push_back({{"primitives",
                                 {{{"attributes", {{"POSITION", positions}}},
                                   {"indices", indices},
                                   {"targets", {{{"POSITION", bulge}}, {{"POSITION", slide}}}}}}},
                                {"extras", {{"targetNames", {"bulge", "slide"}}}}});
  return glb;
}

}  // namespace pliant::test
