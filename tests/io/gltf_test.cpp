#include "framework/io/gltf.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <random>

#include "tests/io/glb_file.h"
#include "tests/io/test_files.h"

namespace pliant {
namespace {

using nlohmann::json;
using test::data_error_of;
using test::GlbFile;
using test::square_glb;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Gltf : public test::TestFiles {
 protected:
  Mesh read(const std::vector<std::uint8_t>& bytes) const { return read_gltf(write("mesh.glb", bytes)); }
  Mesh read(const GlbFile& glb) const { return read(glb.bytes()); }

  std::string error_of(const std::vector<std::uint8_t>& bytes) const {
    const auto path = write("mesh.glb", bytes);
    const auto error = data_error_of([&] { read_gltf(path); });
    EXPECT_THAT(error, HasSubstr(path));
    return error;
  }
  /// A new file every time: to replace the last one can mean to wait for the disk.
  std::string write_damaged(const std::vector<std::uint8_t>& bytes) const {
    std::filesystem::remove(file("damaged.glb"));
    return write("damaged.glb", bytes);
  }

  /// Of the square after a change of its JSON.
  std::string error_after(const std::function<void(json&)>& change) const {
    GlbFile glb = square_glb();
    change(glb.json);
    return error_of(glb.bytes());
  }
};

/// What must hold of every mesh that is read, however strange its file.
void check_sound(const Mesh& mesh) {
  ASSERT_FALSE(mesh.triangles.empty());
  const auto finite = [](const Eigen::Vector3f& vector) { return vector.allFinite(); };
  ASSERT_TRUE(std::all_of(mesh.vertices.begin(), mesh.vertices.end(), finite));
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    ASSERT_GE(triangle.minCoeff(), 0);
    ASSERT_LT(triangle.maxCoeff(), static_cast<int>(mesh.vertices.size()));
  }
  for (const MorphTarget& target : mesh.targets) {
    ASSERT_EQ(target.displacements.size(), mesh.vertices.size());
    ASSERT_TRUE(std::all_of(target.displacements.begin(), target.displacements.end(), finite));
  }
}

/// Reads the file if it can be read; anything but a sound mesh or a DataError is a failure.
void read_mesh_or_refuse(const std::string& path) {
  try {
    check_sound(read_gltf(path));
  } catch (const DataError& error) {
    const std::string message = error.what();
    ASSERT_THAT(message, HasSubstr(path));
    ASSERT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST_F(Gltf, MetresBecomeMillimetres) {
  const Mesh mesh = read(square_glb());
  ASSERT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.vertices[1], Eigen::Vector3f(100, -100, 0));
  EXPECT_THAT(mesh.triangles, ElementsAre(Eigen::Vector3i(0, 1, 2), Eigen::Vector3i(0, 2, 3)));
}

TEST_F(Gltf, MorphTargetsHaveTheirNamesAndMayBeSparse) {
  const Mesh mesh = read(square_glb());
  ASSERT_THAT(mesh.target_names(), ElementsAre("bulge", "slide"));
  EXPECT_EQ(mesh.targets[0].displacements[2], Eigen::Vector3f::Zero());
  EXPECT_EQ(mesh.targets[0].displacements[3], Eigen::Vector3f(0, 0, 10));
  EXPECT_EQ(mesh.targets[1].displacements[0], Eigen::Vector3f(20, 0, 0));
}

TEST_F(Gltf, TargetsWithoutNamesAreNumbered) {
  GlbFile glb = square_glb();
  glb.json["meshes"][0].erase("extras");
  EXPECT_THAT(read(glb).target_names(), ElementsAre("target0", "target1"));
}

TEST_F(Gltf, SparseElementsReplaceThoseOfTheirView) {
  GlbFile glb = square_glb();
  const auto dense = glb.view(std::vector<float>{1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0});
  glb.json["accessors"][2]["bufferView"] = dense;
  const auto moved = read(glb).targets[0].displacements;
  EXPECT_EQ(moved[2], Eigen::Vector3f(3000, 0, 0));
  EXPECT_EQ(moved[3], Eigen::Vector3f(0, 0, 10));
}

TEST_F(Gltf, ATargetWithoutPositionsMovesNothing) {
  GlbFile glb = square_glb();
  glb.json["meshes"][0]["primitives"][0]["targets"][1] = {{"NORMAL", 3}};
  const Mesh mesh = read(glb);
  for (const auto& displacement : mesh.targets[1].displacements) {
    EXPECT_EQ(displacement, Eigen::Vector3f::Zero());
  }
}

TEST_F(Gltf, IndicesOfAnyWidth) {
  const Mesh expected = read(square_glb());
  GlbFile glb = square_glb();
  auto& indices = glb.json["meshes"][0]["primitives"][0]["indices"];
  indices = glb.indices(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3}, GlbFile::kByte);
  EXPECT_EQ(read(glb).triangles, expected.triangles);
  indices = glb.indices(std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}, GlbFile::kInt);
  EXPECT_EQ(read(glb).triangles, expected.triangles);
}

TEST_F(Gltf, WithoutIndicesEveryThreeVerticesAreATriangle) {
  GlbFile glb;
  const auto positions = glb.vectors({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1});
  glb.json["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", positions}}}}}}});
  EXPECT_THAT(read(glb).triangles, ElementsAre(Eigen::Vector3i(0, 1, 2), Eigen::Vector3i(3, 4, 5)));
}

TEST_F(Gltf, InterleavedAttributesAreFollowed) {
  GlbFile glb;
  // Positions 12 bytes apart in elements of 20.
  const auto view = glb.view(std::vector<float>{7, 0, 0, 0, 9, 9, 1, 0, 0, 9, 9, 0, 1, 0, 9});
  const auto positions = glb.accessor(view, GlbFile::kFloat, "VEC3", 3);
  glb.json["bufferViews"][view]["byteStride"] = 20;
  glb.json["accessors"][positions]["byteOffset"] = 4;
  glb.json["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", positions}}}}}}});
  // The third element ends with the last byte of the view but one float.
  const Mesh mesh = read(glb);
  EXPECT_THAT(mesh.vertices, ElementsAre(Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(1000, 0, 0),
                                         Eigen::Vector3f(0, 1000, 0)));
}

TEST_F(Gltf, NodesPlaceTheirMeshesOneInAnother) {
  GlbFile glb = square_glb();
  glb.json["nodes"] = {{{"translation", {0, 0, 1}}, {"children", {1}}},
                       {{"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}},  // a quarter turn about z
                        {"scale", {2, 1, 1}},
                        {"mesh", 0}}};
  const Mesh mesh = read(glb);
  EXPECT_TRUE(mesh.vertices[1].isApprox(Eigen::Vector3f(100, 200, 1000), 1e-6f))
      << mesh.vertices[1].transpose();
  EXPECT_LT((mesh.targets[1].displacements[0] - Eigen::Vector3f(0, 40, 0)).norm(), 1e-4);
}

TEST_F(Gltf, AMatrixIsByColumnsAndAMirrorKeepsTheOutside) {
  GlbFile glb = square_glb();
  glb.json["nodes"][0]["matrix"] = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.5, 0, 0, 1};
  const Mesh mesh = read(glb);
  EXPECT_TRUE(mesh.vertices[1].isApprox(Eigen::Vector3f(400, -100, 0), 1e-6f));
  EXPECT_EQ(mesh.triangles[0], Eigen::Vector3i(0, 2, 1));
}

TEST_F(Gltf, PrimitivesAndMeshesAreMergedAndTargetsJoinedByName) {
  GlbFile glb = square_glb();
  const auto positions = glb.vectors({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const auto moved = glb.vectors({0, 0, 1, 0, 0, 2, 0, 0, 3});
  glb.json["meshes"].push_back(
      {{"primitives",
        {{{"attributes", {{"POSITION", positions}}}, {"targets", {{{"POSITION", moved}}}}},
         {{"attributes", {{"POSITION", positions}}}, {"targets", {{{"POSITION", moved}}}}}}},
       {"extras", {{"targetNames", {"slide"}}}}});
  glb.json["nodes"] = {{{"mesh", 1}}, {{"mesh", 0}}};
  glb.json["scenes"][0]["nodes"] = {1, 0};
  const Mesh mesh = read(glb);
  check_sound(mesh);
  EXPECT_EQ(mesh.vertices.size(), 10u);
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_THAT(mesh.target_names(), ::testing::UnorderedElementsAre("bulge", "slide"));
}

TEST_F(Gltf, OnlyTheDefaultSceneIsRead) {
  GlbFile glb = square_glb();
  glb.json["nodes"].push_back({{"mesh", 0}});
  glb.json["scenes"].push_back({{"nodes", {0, 1}}});
  EXPECT_EQ(read(glb).vertices.size(), 4u);
  glb.json["scene"] = 1;
  EXPECT_EQ(read(glb).vertices.size(), 8u);
}

TEST_F(Gltf, WithoutAnySceneEveryNodeIsShownOnce) {
  GlbFile glb = square_glb();
  glb.json.erase("scenes");
  glb.json.erase("scene");
  EXPECT_EQ(read(glb).vertices, read(square_glb()).vertices);
  glb.json["nodes"] = {{{"mesh", 0}}, {{"translation", {0, 0, 1}}, {"children", {0}}}, {{"mesh", 0}}};
  const Mesh mesh = read(glb);
  ASSERT_EQ(mesh.vertices.size(), 8u);
  EXPECT_EQ(mesh.vertices[0].z() + mesh.vertices[4].z(), 1000) << "one of both is moved by its parent";
}

TEST_F(Gltf, StripsAndFansAreTriangles) {
  GlbFile glb = square_glb();
  const auto corners = glb.indices(std::vector<std::uint8_t>{0, 1, 3, 2, 0}, GlbFile::kByte);
  json& primitive = glb.json["meshes"][0]["primitives"][0];
  primitive["indices"] = corners;
  primitive["mode"] = 5;
  EXPECT_THAT(read(glb).triangles,
              ElementsAre(Eigen::Vector3i(0, 1, 3), Eigen::Vector3i(1, 2, 3), Eigen::Vector3i(3, 2, 0)));
  primitive["mode"] = 6;
  EXPECT_THAT(read(glb).triangles,
              ElementsAre(Eigen::Vector3i(0, 1, 3), Eigen::Vector3i(0, 3, 2), Eigen::Vector3i(0, 2, 0)));
}

TEST_F(Gltf, PointsAndLinesArePassedOver) {
  for (int mode = 0; mode < 4; ++mode) {
    GlbFile glb = square_glb();
    json& primitives = glb.json["meshes"][0]["primitives"];
    const json triangles = primitives[0];
    const json other = {{"attributes", {{"POSITION", 0}}}, {"mode", mode}};
    primitives = json::array({other, triangles});
    EXPECT_EQ(read(glb).vertices, read(square_glb()).vertices) << mode;
    primitives = json::array({other});
    EXPECT_THAT(error_of(glb.bytes()), HasSubstr("shows no triangle"));
  }
}

TEST_F(Gltf, OtherUnitsThanMetresMayBeNamed) {
  const auto path = write("mesh.glb", square_glb().bytes());
  EXPECT_EQ(read_gltf(path, 10).vertices[1], Eigen::Vector3f(1, -1, 0));
  EXPECT_FLOAT_EQ(read_gltf(path, 10).targets[1].displacements[0].x(), 0.2F);
}

TEST_F(Gltf, OtherFilesAreErrors) {
  EXPECT_THAT(error_of({}), HasSubstr("truncated"));
  EXPECT_THAT(error_of({'s', 'o', 'l', 'i', 'd', ' ', 'x', ' ', ' ', ' ', ' ', ' '}),
              HasSubstr("not a glTF file"));
  auto bytes = square_glb().bytes();
  bytes[4] = 1;
  EXPECT_THAT(error_of(bytes), HasSubstr("glTF version 1"));
  bytes = square_glb().bytes();
  bytes.push_back(0);
  EXPECT_THAT(error_of(bytes), HasSubstr("too long"));
  bytes = square_glb().bytes();
  bytes[16] = 'B';
  EXPECT_THAT(error_of(bytes), HasSubstr("first chunk is not JSON"));
  bytes = square_glb().bytes();
  bytes[20] = '[';
  EXPECT_THAT(error_of(bytes), HasSubstr("JSON is damaged"));
  EXPECT_THAT(data_error_of([&] { read_gltf(file("none.glb")); }), HasSubstr("none.glb"));
}

TEST_F(Gltf, WhatIsNotSupportedIsNamed) {
  EXPECT_THAT(error_after([](json& file) { file["extensionsRequired"] = {"KHR_draco_mesh_compression"}; }),
              HasSubstr("needs the extension \"KHR_draco_mesh_compression\""));
  EXPECT_THAT(error_after([](json& file) { file["meshes"][0]["primitives"][0]["mode"] = 7; }),
              HasSubstr("mode 7"));
}

TEST_F(Gltf, WhatIsOutOfBoundsIsNamed) {
  EXPECT_THAT(error_after([](json& file) {
                file["buffers"] = {{{"byteLength", 9999}}};
              }),
              HasSubstr("a buffer of 9999 bytes"));
  EXPECT_THAT(error_after([](json& file) { file["bufferViews"][0]["byteLength"] = 9999; }),
              HasSubstr("buffer view 0 reaches out"));
  EXPECT_THAT(error_after([](json& file) {
                file["bufferViews"][0]["byteOffset"] = std::numeric_limits<std::uint64_t>::max();
              }),
              HasSubstr("buffer view 0 reaches out"));
  EXPECT_THAT(error_after([](json& file) { file["bufferViews"][0]["byteStride"] = 4; }),
              HasSubstr("stride of 4 bytes"));
  EXPECT_THAT(error_after([](json& file) { file["accessors"][0]["count"] = 5; }),
              HasSubstr("reaches out of buffer view 0"));
  EXPECT_THAT(error_after([](json& file) { file["accessors"][0]["byteOffset"] = 4; }),
              HasSubstr("reaches out of buffer view 0"));
  EXPECT_THAT(error_after([](json& file) {
                file["accessors"][2]["count"] = std::numeric_limits<std::uint64_t>::max();
              }),
              HasSubstr("accessor 2 has 18446744073709551615 elements"));
  EXPECT_THAT(error_after([](json& file) {
                file["accessors"][0]["count"] = std::numeric_limits<std::uint64_t>::max();
              }),
              HasSubstr("more than the file has bytes"));
  EXPECT_THAT(error_after([](json& file) { file["accessors"][2]["sparse"]["count"] = 5; }),
              HasSubstr("replaces 5 of 4"));
  EXPECT_THAT(error_after([](json& file) { file["nodes"][0]["mesh"] = 1; }),
              HasSubstr("element 1 of 'meshes'"));
  EXPECT_THAT(error_after([](json& file) { file["scenes"][0]["nodes"] = {3}; }),
              HasSubstr("element 3 of 'nodes'"));
  GlbFile glb = square_glb();
  glb.json["meshes"][0]["primitives"][0]["indices"] =
      glb.indices(std::vector<std::uint8_t>{0, 1, 4}, GlbFile::kByte);
  EXPECT_THAT(error_of(glb.bytes()), HasSubstr("vertex 4 of 4"));
  glb = square_glb();
  glb.json["accessors"][2]["sparse"]["indices"]["bufferView"] = glb.view(std::vector<std::uint8_t>{4});
  EXPECT_THAT(error_of(glb.bytes()), HasSubstr("replaces element 4 of 4"));
}

TEST_F(Gltf, WhatMakesNoSenseIsNamed) {
  EXPECT_THAT(error_after([](json& file) { file["accessors"][0]["componentType"] = GlbFile::kShort; }),
              HasSubstr("accessor 0 holds \"VEC3\" of component type 5123, expected VEC3 of floats"));
  EXPECT_THAT(error_after([](json& file) { file["accessors"][1]["componentType"] = GlbFile::kFloat; }),
              HasSubstr("accessor 1 does not hold unsigned integers"));
  EXPECT_THAT(error_after([](json& file) { file["accessors"][0].erase("count"); }),
              HasSubstr("'count' is missing"));
  EXPECT_THAT(error_after([](json& file) { file["accessors"][1]["count"] = 5; }), HasSubstr("5 corners"));
  EXPECT_THAT(error_after([](json& file) { file["accessors"][3]["count"] = 3; }),
              HasSubstr("morph target moves 3 vertices of 4"));
  EXPECT_THAT(error_after([](json& file) { file["meshes"][0]["extras"]["targetNames"] = {"one"}; }),
              HasSubstr("1 names for 2 morph targets"));
  EXPECT_THAT(error_after([](json& file) {
                file["meshes"][0]["extras"]["targetNames"] = {"a", "a"};
              }),
              HasSubstr("two morph targets are named \"a\""));
  EXPECT_THAT(error_after([](json& file) {
                file["scenes"][0]["nodes"] = {0, 0};
              }),
              HasSubstr("node 0 has two parents"));
  EXPECT_THAT(error_after([](json& file) { file["nodes"][0]["children"] = {0}; }),
              HasSubstr("node 0 is below itself"));
  EXPECT_THAT(error_after([](json& file) {
                file["nodes"] = {{{"mesh", 0}, {"children", {1}}}, {{"children", {2}}}, {{"children", {0}}}};
              }),
              HasSubstr("node 0 is below itself: its nodes form a cycle"));
  EXPECT_THAT(error_after([](json& file) {
                file.erase("scenes");
                file["nodes"] = {{{"mesh", 0}, {"children", {1}}}, {{"children", {0}}}};
              }),
              HasSubstr("its nodes form cycles"));
  EXPECT_THAT(error_after([](json& file) {
                file["nodes"][0]["rotation"] = {0, 0, 0, 0};
              }),
              HasSubstr("unit quaternion"));
  EXPECT_THAT(error_after([](json& file) {
                file["nodes"][0]["scale"] = {1, 2};
              }),
              HasSubstr("'scale' has 2 numbers"));
  EXPECT_THAT(error_after([](json& file) {
                file["nodes"][0]["scale"] = {1e200, 1e200, 1e200};
              }),
              HasSubstr("to infinity"));
  EXPECT_THAT(error_after([](json& file) {
                file["nodes"][0]["matrix"] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
              }),
              HasSubstr("not affine"));
  EXPECT_THAT(error_after([](json& file) { file["scenes"][0]["nodes"] = json::array(); }),
              HasSubstr("shows no triangle"));
  EXPECT_THAT(error_after([](json& file) { file["scene"] = 1; }), HasSubstr("element 1 of 'scenes'"));
  EXPECT_THAT(error_after([](json& file) {
                file.erase("scenes");
                file["nodes"][0]["children"] = {9};
              }),
              HasSubstr("element 9 of 'nodes'"));
  GlbFile glb = square_glb();
  glb.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
      glb.vectors({0, 0, 0, 1, 0, 0, 0, 1, std::nanf(""), 0, 1, 0});
  EXPECT_THAT(error_of(glb.bytes()), HasSubstr("element 2 of accessor 4 is not finite"));
}

TEST_F(Gltf, EveryTruncationIsAnError) {
  const auto whole = write("whole.glb", square_glb().bytes());
  const std::size_t size = read_file(whole).size();
  for (std::size_t length = 0; length < size; ++length) {
    const auto path = cut(whole, length);
    EXPECT_THAT(data_error_of([&] { read_gltf(path); }), HasSubstr("truncated")) << length;
    std::filesystem::remove(path);
  }
}

TEST_F(Gltf, DamagedBytesNeverDoHarm) {
  const auto whole = square_glb().bytes();
  std::mt19937 generator(1);
  for (int trial = 0; trial < 4000; ++trial) {
    auto bytes = whole;
    const std::size_t changes = 1 + generator() % 4;
    for (std::size_t i = 0; i < changes; ++i) {
      bytes[generator() % bytes.size()] = static_cast<std::uint8_t>(generator());
    }
    ASSERT_NO_FATAL_FAILURE(read_mesh_or_refuse(write_damaged(bytes))) << "trial " << trial;
  }
}

TEST_F(Gltf, StrangeValuesAnywhereInItsJsonNeverDoHarm) {
  const GlbFile whole = square_glb();
  const std::vector<json> strange = {nullptr,
                                     true,
                                     -1,
                                     0,
                                     3,
                                     255,
                                     0xFFFFFFFFu,
                                     std::numeric_limits<std::uint64_t>::max(),
                                     0x7FFFFFFFFFFFFFFF,
                                     0.5,
                                     1e308,
                                     "text",
                                     json::array(),
                                     json::array({0, 0, 0}),
                                     json::object()};
  const json flat = whole.json.flatten();
  ASSERT_GT(flat.size(), 40u);
  for (const auto& [pointer, value] : flat.items()) {
    // The value itself and everything that it is a part of.
    for (json::json_pointer place(pointer); !place.empty(); place = place.parent_pointer()) {
      for (const json& replacement : strange) {
        GlbFile damaged = whole;
        damaged.json[place] = replacement;
        ASSERT_NO_FATAL_FAILURE(read_mesh_or_refuse(write_damaged(damaged.bytes())))
            << place << " = " << replacement;
      }
    }
  }
}

TEST_F(Gltf, AChainOfNodesMayBeLong) {
  GlbFile glb = square_glb();
  constexpr int kNodes = 50000;
  json nodes = json::array();
  for (int i = 0; i + 1 < kNodes; ++i) nodes.push_back({{"children", {i + 1}}});
  nodes.push_back({{"mesh", 0}});
  glb.json["nodes"] = nodes;
  EXPECT_EQ(read(glb).vertices[1], Eigen::Vector3f(100, -100, 0));
}

TEST_F(Gltf, DataNamedTooOftenIsRefusedBeforeItFillsTheMemory) {
  constexpr std::size_t kVertices = 3000;
  GlbFile glb;
  const auto positions = glb.vectors(std::vector<float>(3 * kVertices, 0.5f));
  const auto mesh_with = [&](std::size_t targets) {
    const json target = {{"POSITION", positions}};
    return json{
        {"primitives",
         {{{"attributes", {{"POSITION", positions}}}, {"targets", std::vector<json>(targets, target)}}}}};
  };
  glb.json["meshes"] = json::array({mesh_with(7000)});
  EXPECT_THAT(error_of(glb.bytes()), HasSubstr("3000 vertices with 7000 morph targets"));
  // Each of two could be held, but not both together.
  glb.json["meshes"] = json::array({mesh_with(3500), mesh_with(0)});
  glb.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 1}}};
  glb.json["scenes"][0]["nodes"] = {0, 1};
  EXPECT_THAT(error_of(glb.bytes()), HasSubstr("6000 vertices with 3500 morph targets"));
}

TEST_F(Gltf, TheRealHead) {
  const std::string path = test::real_data("ict_face/ict_face.glb");
  if (path.empty()) GTEST_SKIP() << "ict_face/ict_face.glb is not below PLIANT_DATA";
  const Mesh mesh = read_gltf(path);
  check_sound(mesh);
  EXPECT_EQ(mesh.vertices.size(), 24591u);
  EXPECT_EQ(mesh.triangles.size(), 48836u);
  ASSERT_EQ(mesh.targets.size(), 23u);
  const auto peak = [&](const std::string& name) {
    float longest = 0;
    for (const MorphTarget& target : mesh.targets) {
      if (target.name != name) continue;
      for (const auto& displacement : target.displacements) longest = std::max(longest, displacement.norm());
    }
    return longest;
  };
  EXPECT_NEAR(peak("mouthSmile_L"), 15.8, 0.05);
  EXPECT_NEAR(peak("cheekPuff_L"), 14.1, 0.05);
  EXPECT_NEAR(peak("mouthPucker"), 12.4, 0.05);
  EXPECT_NEAR(peak("browDown_L"), 6.5, 0.05);
}

}  // namespace
}  // namespace pliant
