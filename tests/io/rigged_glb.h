#pragma once

#include "tests/io/glb_file.h"

namespace pliant::test {

/// A strip of 100 x 200 mm in the plane z = 0: rows of two vertices at y = 0, 100 and 200 mm, in the frame of
/// its mesh, with the morph target "bulge" (the last row by 20 mm along z). Nodes: 0 "strip", the mesh, whose
/// own shift plays no part because of its skin; 1 "root", shifted by 1 m in x; 2 "bone", its child 100 mm up.
/// The first row is carried by the root, the last by the bone, that in the middle by both alike. The
/// animation "wave" turns the bone by 90 degrees about z from 1 s to 3 s.
struct RiggedGlb : GlbFile {
  RiggedGlb() {
    const auto positions =
        vectors({0, 0, 0, 0.1f, 0, 0, 0, 0.1f, 0, 0.1f, 0.1f, 0, 0, 0.2f, 0, 0.1f, 0.2f, 0});
    const auto corners = indices(std::vector<std::uint8_t>{0, 1, 3, 0, 3, 2, 2, 3, 5, 2, 5, 4}, kByte);
    const auto bulge = vectors({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.02f, 0, 0, 0.02f});
    const auto joints = accessor(view(std::vector<std::uint8_t>{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0,
                                                                0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}),
                                 kByte, "VEC4", 6);
    const auto weights = accessor(view(std::vector<float>{1,    0,    0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0,
                                                          0.5f, 0.5f, 0, 0, 0, 1, 0, 0, 0,    1,    0, 0}),
                                  kFloat, "VEC4", 6);
    const auto inverse_bind =
        accessor(view(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,     0, 1,
                                         1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -0.1f, 0, 1}),
                 kFloat, "MAT4", 2);
    json["meshes"].push_back(
        {{"primitives",
          {{{"attributes", {{"POSITION", positions}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}},
            {"indices", corners},
            {"targets", {{{"POSITION", bulge}}}}}}},
         {"extras", {{"targetNames", {"bulge"}}}}});
    json["nodes"] = {{{"name", "strip"}, {"mesh", 0}, {"skin", 0}, {"translation", {0, 0, 5}}},
                     {{"name", "root"}, {"translation", {1, 0, 0}}, {"children", {2}}},
                     {{"name", "bone"}, {"translation", {0, 0.1f, 0}}}};
    json["scenes"][0]["nodes"] = {0, 1};
    json["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", inverse_bind}}};
    json["animations"] = {
        {{"name", "wave"}, {"samplers", nlohmann::json::array()}, {"channels", nlohmann::json::array()}}};
    const float half = 0.70710678f;
    animate(2, "rotation", scalars({1, 3}),
            accessor(view(std::vector<float>{0, 0, 0, 1, 0, 0, half, half}), kFloat, "VEC4", 2));
  }

  std::size_t scalars(const std::vector<float>& numbers) {
    return accessor(view(numbers), kFloat, "SCALAR", numbers.size());
  }

  /// Adds a channel to the animation, with a sampler of its own.
  void animate(std::size_t node, const char* path, std::size_t input, std::size_t output,
               const char* interpolation = "LINEAR") {
    nlohmann::json& animation = json["animations"][0];
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
    animation["samplers"].push_back({{"input", input}, {"output", output}, {"interpolation", interpolation}});
  }

  nlohmann::json& primitive() { return json["meshes"][0]["primitives"][0]; }
};

}  // namespace pliant::test
