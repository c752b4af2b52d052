#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include "framework/io/gltf.h"
#include "tests/io/rigged_glb.h"
#include "tests/io/test_files.h"

namespace pliant {
namespace {

using nlohmann::json;
using test::data_error_of;
using test::GlbFile;
using test::RiggedGlb;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class GltfSceneFile : public test::TestFiles {
 protected:
  GltfScene read(const GlbFile& glb, bool chain_joints = false) const {
    return read_gltf_scene(write("scene.glb", glb.bytes()), {1000, chain_joints});
  }

  std::string error_of(const GlbFile& glb) const {
    const std::string path = write("scene.glb", glb.bytes());
    std::string error = data_error_of([&] { read_gltf_scene(path); });
    EXPECT_THAT(error, HasSubstr(path));
    return error;
  }

  /// Of the rigged strip after a change.
  std::string error_after(const std::function<void(RiggedGlb&)>& change) const {
    RiggedGlb glb;
    change(glb);
    return error_of(glb);
  }
};

std::vector<std::string> joint_names(const Mesh& mesh) {
  std::vector<std::string> names;
  for (const Joint& joint : mesh.joints) names.push_back(joint.name);
  return names;
}

int joint_named(const Mesh& mesh, const std::string& name) {
  const auto names = joint_names(mesh);
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

void expect_point(const Eigen::Vector3d& point, double x, double y, double z) {
  EXPECT_LT((point - Eigen::Vector3d(x, y, z)).norm(), 1e-3) << point.transpose();
}

TEST_F(GltfSceneFile, JointsCarryTheirSkinAndTheMeshNodePlaysNoPart) {
  const GltfScene scene = read(RiggedGlb());
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_THAT(joint_names(scene.mesh), ::testing::UnorderedElementsAre("strip", "root", "bone"));
  const auto at_rest = scene.mesh.deform(scene.mesh.rest());
  expect_point(at_rest[1], 1100, 0, 0);
  expect_point(at_rest[3], 1100, 100, 0);
  expect_point(at_rest[5], 1100, 200, 0);
}

TEST_F(GltfSceneFile, AJointTurnsWhatItCarries) {
  const Mesh mesh = read(RiggedGlb()).mesh;
  MeshPose pose = mesh.rest();
  pose.joints[static_cast<std::size_t>(joint_named(mesh, "bone"))].rotate(
      Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()));
  pose.weights[0] = 0.5;
  const auto bent = mesh.deform(pose);
  expect_point(bent[0], 1000, 0, 0);
  expect_point(bent[4], 900, 100, 10);
  expect_point(bent[3], 1050, 150, 0);  // between (1100, 100) and (1000, 200)
}

TEST_F(GltfSceneFile, WithoutJointsItIsWhatTheFileShowsAtRest) {
  RiggedGlb glb;
  glb.json["nodes"][1]["scale"] = {2, 2, 2};
  const GltfScene scene = read(glb);
  const Mesh mesh = read_gltf(file("scene.glb"));
  EXPECT_THAT(mesh.joints, IsEmpty());
  EXPECT_THAT(mesh.skin, IsEmpty());
  EXPECT_EQ(mesh.triangles, scene.mesh.triangles);
  MeshPose pose = scene.mesh.rest();
  pose.weights[0] = 0.7;
  const auto expected = scene.mesh.deform(pose);
  const auto deformed = mesh.deform(pose.weights);
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_LT((deformed[i] - expected[i]).norm(), 1e-3);
  EXPECT_NEAR(deformed[5].z(), 28, 1e-3) << "the target grows with the joint";
}

TEST_F(GltfSceneFile, WeightsMayBeNormalisedIntegersAndJointsShorts) {
  RiggedGlb glb;
  const auto expected = read(glb).mesh;
  const auto weights = glb.accessor(
      glb.view(std::vector<std::uint16_t>{65535, 0,     0, 0, 65535, 0,     0, 0, 32768, 32768, 0, 0,
                                          32768, 32768, 0, 0, 0,     65535, 0, 0, 0,     65535, 0, 0}),
      GlbFile::kShort, "VEC4", 6);
  glb.json["accessors"][weights]["normalized"] = true;
  const auto joints = glb.accessor(glb.view(std::vector<std::uint16_t>{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0,
                                                                       0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}),
                                   GlbFile::kShort, "VEC4", 6);
  glb.primitive()["attributes"]["WEIGHTS_0"] = weights;
  glb.primitive()["attributes"]["JOINTS_0"] = joints;
  const Mesh mesh = read(glb).mesh;
  for (std::size_t i = 0; i < mesh.skin.size(); ++i) {
    EXPECT_EQ(mesh.skin[i].joints, expected.skin[i].joints);
    EXPECT_LT((mesh.skin[i].weights - expected.skin[i].weights).norm(), 1e-6);
  }
}

TEST_F(GltfSceneFile, OfMoreThanFourWeightsTheLargestStay) {
  RiggedGlb glb;
  std::vector<std::uint8_t> joints;
  std::vector<float> first;
  std::vector<float> second;
  for (int i = 0; i < 6; ++i) {
    joints.insert(joints.end(), {0, 1, 2, 3});
    first.insert(first.end(), {0.05F, 0.2F, 0.1F, 0.15F});
    second.insert(second.end(), {0, 0.5F, 0, 0});
  }
  for (const char* name : {"a", "b"}) glb.json["nodes"].push_back({{"name", name}});
  glb.json["scenes"][0]["nodes"] = {0, 1, 3, 4};
  glb.json["skins"][0] = {{"joints", {1, 2, 3, 4}}};
  json& attributes = glb.primitive()["attributes"];
  attributes["JOINTS_0"] = glb.accessor(glb.view(joints), GlbFile::kByte, "VEC4", 6);
  attributes["JOINTS_1"] = attributes["JOINTS_0"];
  attributes["WEIGHTS_0"] = glb.accessor(glb.view(first), GlbFile::kFloat, "VEC4", 6);
  attributes["WEIGHTS_1"] = glb.accessor(glb.view(second), GlbFile::kFloat, "VEC4", 6);
  const Mesh mesh = read(glb).mesh;
  const Eigen::Vector4f expected = Eigen::Vector4f(0.5F, 0.2F, 0.15F, 0.1F) / 0.95F;
  EXPECT_LT((mesh.skin[0].weights - expected).norm(), 1e-6) << mesh.skin[0].weights.transpose();
  const int a = joint_named(mesh, "a");
  EXPECT_EQ(mesh.skin[0].joints,
            Eigen::Vector4i(joint_named(mesh, "bone"), joint_named(mesh, "bone"), joint_named(mesh, "b"), a));
}

TEST_F(GltfSceneFile, AMeshWithoutSkinHangsOnItsNode) {
  RiggedGlb glb;
  glb.json["meshes"].push_back(
      {{"primitives", {{{"attributes", {{"POSITION", glb.vectors({0, 0, 0, 0.01F, 0, 0, 0, 0.01F, 0})}}}}}}});
  glb.json["nodes"][2]["mesh"] = 1;
  const Mesh mesh = read(glb).mesh;
  ASSERT_EQ(mesh.vertices.size(), 9U);
  ASSERT_EQ(mesh.skin.size(), 9U);
  const auto at_rest = mesh.deform(mesh.rest());
  Eigen::Vector3d lowest = at_rest[0];
  for (std::size_t i = 0; i < 9; ++i) {
    if (mesh.vertices[i].norm() == 0 && mesh.skin[i].weights[0] == 1 && at_rest[i].y() > 50)
      lowest = at_rest[i];
  }
  expect_point(lowest, 1000, 100, 0);
  // The bone's own mesh and its skin need different frames: the node has two joints that move together.
  EXPECT_EQ(mesh.joints.size(), 4U);
  EXPECT_EQ(mesh.joints[3].rest.matrix(), Eigen::Matrix4d::Identity());
  EXPECT_EQ(mesh.joints[3].parent, joint_named(mesh, "bone"));
}

TEST_F(GltfSceneFile, AMirroringJointKeepsTheOutside) {
  RiggedGlb glb;
  const auto expected = read(glb).mesh.triangles;
  glb.json["nodes"][1]["scale"] = {-1, 1, 1};
  const auto mirrored = read(glb).mesh.triangles;
  EXPECT_EQ(mirrored[0], Eigen::Vector3i(expected[0][0], expected[0][2], expected[0][1]));
}

TEST_F(GltfSceneFile, AnAnimationMovesJoints) {
  const GltfScene scene = read(RiggedGlb());
  ASSERT_EQ(scene.animations.size(), 1U);
  const Animation& wave = scene.animations[0];
  EXPECT_EQ(wave.name, "wave");
  EXPECT_EQ(wave.duration, 3);
  expect_point(scene.mesh.deform(wave.pose(scene.mesh, 0))[5], 1100, 200, 0);
  expect_point(scene.mesh.deform(wave.pose(scene.mesh, 3))[5], 900, 200, 0);
  const double half = std::sqrt(0.5) * 100;
  expect_point(scene.mesh.deform(wave.pose(scene.mesh, 2))[4], 1000 - half, 100 + half, 0);
}

TEST_F(GltfSceneFile, AnAnimationMayShiftScaleAndMorph) {
  RiggedGlb glb;
  const auto times = glb.scalars({0, 1});
  glb.animate(1, "translation", times, glb.vectors({1, 0, 0, 2, 0, 0}), "STEP");
  glb.animate(2, "scale", times, glb.vectors({1, 1, 1, 1, 3, 1}));
  glb.animate(0, "weights", times, glb.scalars({0, 0, 1, 0, 1, 0}), "CUBICSPLINE");
  const GltfScene scene = read(glb);
  const Animation& animation = scene.animations[0];
  expect_point(scene.mesh.deform(animation.pose(scene.mesh, 0.5))[4], 1000, 100 + 200, 20 * 0.625);
  expect_point(scene.mesh.deform(animation.pose(scene.mesh, 1))[4], 2000, 100 + 300, 20);
}

TEST_F(GltfSceneFile, AnAnimatedNodeWithoutSkinIsAJoint) {
  GlbFile glb = test::square_glb();
  glb.json["nodes"][0]["rotation"] = {0, 0, std::sqrt(0.5), std::sqrt(0.5)};
  glb.json["nodes"][0]["scale"] = {2, 2, 2};
  const auto still = read_gltf(write("still.glb", glb.bytes()));
  const auto times = glb.accessor(glb.view(std::vector<float>{0.5F}), GlbFile::kFloat, "SCALAR", 1);
  glb.json["animations"] = {
      {{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
       {"samplers", {{{"input", times}, {"output", glb.vectors({0, 0, 1})}}}}}};
  const GltfScene scene = read(glb);
  ASSERT_THAT(joint_names(scene.mesh), ElementsAre("node0"));
  EXPECT_EQ(scene.animations[0].name, "animation0");
  const auto at_rest = scene.mesh.deform(scene.mesh.rest());
  const auto moved = scene.mesh.deform(scene.animations[0].pose(scene.mesh, 9));
  for (std::size_t i = 0; i < at_rest.size(); ++i) {
    EXPECT_LT((at_rest[i] - still.vertices[i].cast<double>()).norm(), 1e-4);
    EXPECT_LT((moved[i] - at_rest[i] - Eigen::Vector3d(0, 0, 1000)).norm(), 1e-4);
  }
  EXPECT_EQ(read_gltf(file("scene.glb")).vertices, still.vertices);
}

TEST_F(GltfSceneFile, RotationsMayBeNormalisedIntegers) {
  RiggedGlb glb;
  const auto shorts =
      glb.accessor(glb.view(std::vector<std::int16_t>{0, 0, 0, 32767, 0, 0, 23170, 23170}), 5122, "VEC4", 2);
  glb.json["accessors"][shorts]["normalized"] = true;
  glb.json["animations"][0]["samplers"][0]["output"] = shorts;
  const GltfScene scene = read(glb);
  expect_point(scene.mesh.deform(scene.animations[0].pose(scene.mesh, 3))[5], 900, 200, 0);
}

TEST_F(GltfSceneFile, QuantisedPositionsAreReadWhereTheFileNeedsThem) {
  GlbFile glb;
  const auto view = glb.view(std::vector<std::int16_t>{0, 0, 0, 0, 100, 0, 0, 0, 0, 100, 0, 0});
  const auto positions = glb.accessor(view, 5122, "VEC3", 3);
  glb.json["bufferViews"][view]["byteStride"] = 8;
  glb.json["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", positions}}}}}}});
  EXPECT_THAT(error_of(glb), HasSubstr("expected VEC3 of floats"));
  glb.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  EXPECT_EQ(read(glb).mesh.vertices[2], Eigen::Vector3f(0, 100000, 0));
}

TEST_F(GltfSceneFile, JointsNamedAlikeCanBeToldApart) {
  RiggedGlb glb;
  glb.json["nodes"][2]["name"] = "root";
  EXPECT_THAT(joint_names(read(glb).mesh), ElementsAre("root", "root#2", "strip"));
}

/// A strip whose bones `NAME_1`, `NAME_2`, `NAME_3` are all children of one node.
RiggedGlb flat_rig() {
  RiggedGlb glb;
  glb.json.erase("animations");
  glb.json["nodes"][1]["name"] = "armature";
  glb.json["nodes"][1]["children"] = {4, 3, 2};
  glb.json["nodes"][2]["name"] = "bone_1";
  glb.json["nodes"].push_back({{"name", "bone_2"}, {"translation", {0, 0.15F, 0}}});
  glb.json["nodes"].push_back({{"name", "bone_3"}, {"translation", {0, 0.2F, 0}}});
  return glb;
}

TEST_F(GltfSceneFile, ChainsAreBuiltOfNamesWhenThatIsAskedFor) {
  const Mesh flat = read(flat_rig()).mesh;
  const GltfScene chained = read(flat_rig(), true);
  EXPECT_THAT(chained.warnings, IsEmpty());
  const auto parent_of = [](const Mesh& mesh, const char* name) {
    const int parent = mesh.joints[static_cast<std::size_t>(joint_named(mesh, name))].parent;
    return mesh.joints[static_cast<std::size_t>(parent)].name;
  };
  EXPECT_EQ(parent_of(flat, "bone_3"), "armature");
  EXPECT_EQ(parent_of(chained.mesh, "bone_3"), "bone_2");
  EXPECT_EQ(parent_of(chained.mesh, "bone_2"), "bone_1");
  EXPECT_EQ(parent_of(chained.mesh, "bone_1"), "armature");
  const auto at_rest = flat.deform(flat.rest());
  const auto still = chained.mesh.deform(chained.mesh.rest());
  for (std::size_t i = 0; i < at_rest.size(); ++i) EXPECT_LT((still[i] - at_rest[i]).norm(), 1e-4);
}

TEST_F(GltfSceneFile, ChainsThatCouldBeBuiltOrCouldNotAreMentioned) {
  RiggedGlb glb = flat_rig();
  glb.json["nodes"].push_back({{"name", "bone_4"}});
  glb.json["nodes"][1]["children"] = {4, 3, 2, 5};
  EXPECT_THAT(read(glb).warnings, ElementsAre(HasSubstr("the names of 3 of its 6 nodes make chains")));
  EXPECT_THAT(read(RiggedGlb(), true).warnings, ElementsAre(HasSubstr("chain_joints does nothing")));
}

TEST_F(GltfSceneFile, JointsThatAnAnimationMovesKeepTheirParent) {
  RiggedGlb glb;
  glb.json["nodes"][1]["children"] = {2, 3};
  glb.json["nodes"][2]["name"] = "bone_2";
  glb.json["nodes"].push_back({{"name", "bone_1"}});
  EXPECT_THAT(read(glb, true).warnings, ElementsAre(HasSubstr("chain_joints does nothing")));
}

TEST_F(GltfSceneFile, WhatIsWrongWithASkinIsNamed) {
  EXPECT_THAT(error_after([](RiggedGlb& glb) { glb.json["nodes"][0]["skin"] = 1; }),
              HasSubstr("element 1 of 'skins'"));
  EXPECT_THAT(error_after([](RiggedGlb& glb) { glb.json["skins"][0]["joints"] = json::array(); }),
              HasSubstr("skin 0 has no joints"));
  EXPECT_THAT(error_after([](RiggedGlb& glb) {
                glb.json["skins"][0]["joints"] = {1, 9};
              }),
              HasSubstr("element 9 of 'nodes'"));
  EXPECT_THAT(error_after([](RiggedGlb& glb) { glb.json["nodes"][1].erase("children"); }),
              HasSubstr("joint 1 of skin 0 is node 2, which the scene does not have"));
  EXPECT_THAT(error_after([](RiggedGlb& glb) { glb.json["skins"][0]["joints"] = {1}; }),
              HasSubstr("names joint 1, but its skin has 1"));
  EXPECT_THAT(error_after([](RiggedGlb& glb) {
                glb.json["skins"][0]["joints"] = {1, 2, 0};
              }),
              HasSubstr("skin 0 has 2 inverse bind matrices for 3 joints"));
  EXPECT_THAT(error_after([](RiggedGlb& glb) { glb.primitive()["attributes"].erase("JOINTS_0"); }),
              HasSubstr("'JOINTS_0' is missing"));
  EXPECT_THAT(error_after([](RiggedGlb& glb) { glb.primitive()["attributes"].erase("WEIGHTS_0"); }),
              HasSubstr("'WEIGHTS_0' is missing"));
  EXPECT_THAT(error_after([](RiggedGlb& glb) {
                glb.json["accessors"][glb.primitive()["attributes"]["JOINTS_0"].get<std::size_t>()]["count"] =
                    5;
              }),
              HasSubstr("5 joints and 6 weights of a skin for 6 vertices"));
}

TEST_F(GltfSceneFile, WeightsThatAreNoneAreNamed) {
  const auto with_weights = [](RiggedGlb& glb, const std::vector<float>& of_vertex_4) {
    std::vector<float> weights(24, 0.25F);
    std::copy(of_vertex_4.begin(), of_vertex_4.end(), weights.begin() + 16);
    glb.primitive()["attributes"]["WEIGHTS_0"] = glb.accessor(glb.view(weights), GlbFile::kFloat, "VEC4", 6);
  };
  EXPECT_THAT(error_after([&](RiggedGlb& glb) {
                with_weights(glb, {0, 0, 0, 0});
              }),
              HasSubstr("the weights of skinned vertex 4 are all zero"));
  EXPECT_THAT(error_after([&](RiggedGlb& glb) {
                with_weights(glb, {1, -0.5F, 0, 0});
              }),
              HasSubstr("a weight of skinned vertex 4 is negative"));
  EXPECT_THAT(error_after([&](RiggedGlb& glb) {
                with_weights(glb, {std::nanf(""), 1, 0, 0});
              }),
              HasSubstr("is not finite"));
}

TEST_F(GltfSceneFile, MatricesThatAreNoneAreNamed) {
  const auto error_with = [&](const std::vector<float>& second) {
    return error_after([&](RiggedGlb& glb) {
      std::vector<float> matrices{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
      matrices.insert(matrices.end(), second.begin(), second.end());
      glb.json["skins"][0]["inverseBindMatrices"] =
          glb.accessor(glb.view(matrices), GlbFile::kFloat, "MAT4", 2);
    });
  };
  EXPECT_THAT(error_with({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}),
              HasSubstr("inverse bind matrix 1 of skin 0 cannot be inverted"));
  EXPECT_THAT(error_with({1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}), HasSubstr("is not affine"));
  EXPECT_THAT(error_with({1, 0, 0, 0, 0, INFINITY, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}),
              HasSubstr("is not finite"));
  EXPECT_THAT(error_after([](RiggedGlb& glb) {
                glb.json["nodes"][1]["scale"] = {1e200, 1e200, 1e200};
                glb.json["nodes"][2]["scale"] = {1e200, 1e200, 1e200};
              }),
              HasSubstr("to infinity"));
}

TEST_F(GltfSceneFile, WhatIsWrongWithAnAnimationIsNamed) {
  const auto with_sampler = [&](const char* key, const std::vector<float>& numbers, const char* type,
                                const char* interpolation = "LINEAR") {
    return error_after([&](RiggedGlb& glb) {
      const std::size_t width = std::string(type) == "VEC4" ? 4 : 1;
      json& sampler = glb.json["animations"][0]["samplers"][0];
      sampler[key] = glb.accessor(glb.view(numbers), GlbFile::kFloat, type, numbers.size() / width);
      sampler["interpolation"] = interpolation;
    });
  };
  EXPECT_THAT(with_sampler("input", {1, 1}, "SCALAR"), HasSubstr("do not increase: 1 s after 1 s"));
  EXPECT_THAT(with_sampler("input", {-1, 1}, "SCALAR"), HasSubstr("a key at -1 s"));
  EXPECT_THAT(with_sampler("input", {1, 2, 3}, "SCALAR"),
              HasSubstr("8 numbers of rotation for 3 keys, expected 12"));
  EXPECT_THAT(with_sampler("input", {1, 3}, "SCALAR", "CUBICSPLINE"), HasSubstr("expected 24"));
  EXPECT_THAT(with_sampler("input", {1, 3}, "SCALAR", "SMOOTH"), HasSubstr("interpolated by \"SMOOTH\""));
  EXPECT_THAT(with_sampler("output", {0, 0, 0, 1, 0, 0, 0, 0}, "VEC4"), HasSubstr("key 1 of an animation"));
  EXPECT_THAT(with_sampler("output", {0, 1}, "SCALAR"), HasSubstr("expected VEC4 of floats or normalised"));
  const auto with_channel = [&](const char* key, const json& value) {
    return error_after([&](RiggedGlb& glb) {
      json& channel = glb.json["animations"][0]["channels"][0];
      (channel.contains(key) ? channel : channel["target"])[key] = value;
    });
  };
  EXPECT_THAT(with_channel("sampler", 7), HasSubstr("sampler 7 of 1"));
  EXPECT_THAT(with_channel("node", 7), HasSubstr("element 7 of 'nodes'"));
  EXPECT_THAT(with_channel("path", "colour"), HasSubstr("an animation changes \"colour\""));
  EXPECT_THAT(with_channel("path", "weights"), HasSubstr("weights of node 2, which has no morph targets"));
  EXPECT_THAT(error_after([](RiggedGlb& glb) {
                glb.json["nodes"][2] = {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}};
              }),
              HasSubstr("an animation moves node 2, which has a matrix"));
}

TEST_F(GltfSceneFile, KeysNamedTooOftenAreRefusedBeforeTheyFillTheMemory) {
  RiggedGlb glb;
  constexpr std::size_t kKeys = 50000;
  std::vector<float> times(kKeys);
  for (std::size_t i = 0; i < kKeys; ++i) times[i] = static_cast<float>(i);
  const auto input = glb.scalars(times);
  const auto output = glb.vectors(std::vector<float>(3 * kKeys, 1));
  for (int i = 0; i < 110; ++i) glb.animate(1, "scale", input, output);
  EXPECT_THAT(error_of(glb), HasSubstr("more keys than can be held"));
}

/// Reads the file if it can be read; anything but a mesh that can be posed or a DataError is a failure.
void read_scene_or_refuse(const std::string& path) {
  try {
    for (const bool chain_joints : {false, true}) {
      const GltfScene scene = read_gltf_scene(path, {1000, chain_joints});
      scene.mesh.deform(scene.mesh.rest());
      for (const Animation& animation : scene.animations) scene.mesh.deform(animation.pose(scene.mesh, 1.5));
    }
    read_gltf(path);
  } catch (const DataError& error) {
    const std::string message = error.what();
    ASSERT_THAT(message, HasSubstr(path));
    ASSERT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST_F(GltfSceneFile, DamagedBytesNeverDoHarm) {
  const auto whole = RiggedGlb().bytes();
  std::mt19937 generator(1);
  for (int trial = 0; trial < 3000; ++trial) {
    auto bytes = whole;
    const std::size_t changes = 1 + generator() % 4;
    for (std::size_t i = 0; i < changes; ++i)
      bytes[generator() % bytes.size()] = static_cast<std::uint8_t>(generator());
    std::filesystem::remove(file("damaged.glb"));
    ASSERT_NO_FATAL_FAILURE(read_scene_or_refuse(write("damaged.glb", bytes))) << "trial " << trial;
  }
}

TEST_F(GltfSceneFile, StrangeValuesInSkinsNodesAndAnimationsNeverDoHarm) {
  RiggedGlb whole;
  whole.animate(0, "weights", whole.scalars({0, 1}), whole.scalars({0, 1}), "STEP");
  const std::vector<json> strange = {nullptr,
                                     -1,
                                     0,
                                     2,
                                     0xFFFFFFFFu,
                                     std::numeric_limits<std::uint64_t>::max(),
                                     0.5,
                                     1e308,
                                     "text",
                                     json::array({0, 0, 0}),
                                     json::object()};
  const json flat = whole.json.flatten();
  for (const auto& [pointer, value] : flat.items()) {
    const bool is_new = pointer.starts_with("/skins") || pointer.starts_with("/nodes") ||
                        pointer.starts_with("/animations") || pointer.starts_with("/accessors");
    if (!is_new) continue;
    for (json::json_pointer place(pointer); !place.empty(); place = place.parent_pointer()) {
      for (const json& replacement : strange) {
        GlbFile damaged = whole;
        damaged.json[place] = replacement;
        std::filesystem::remove(file("damaged.glb"));
        ASSERT_NO_FATAL_FAILURE(read_scene_or_refuse(write("damaged.glb", damaged.bytes())))
            << place << " = " << replacement;
      }
    }
  }
}

class GltfColors : public test::TestFiles {
 protected:
  std::vector<Rgb> read(const GlbFile& glb) const {
    return read_gltf_scene(write("colors.glb", glb.bytes()), {1000, false, true}).colors;
  }
  GlbFile glb_ = test::square_glb();
  json& primitive() { return glb_.json["meshes"][0]["primitives"][0]; }
};

TEST_F(GltfColors, AreThoseOfTheMaterialTimesThoseOfTheVertices) {
  EXPECT_THAT(read(glb_), IsEmpty());
  primitive()["material"] = 0;
  glb_.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.5, 0, 0.3}}}}}};
  EXPECT_EQ(read(glb_), std::vector<Rgb>(4, Rgb{255, 188, 0})) << "half as much light";
  const auto own = glb_.accessor(
      glb_.view(std::vector<std::uint8_t>{255, 255, 255, 9, 0, 0, 0, 9, 255, 0, 255, 9, 0, 255, 0, 9}),
      GlbFile::kByte, "VEC4", 4);
  glb_.json["accessors"][own]["normalized"] = true;
  primitive()["attributes"]["COLOR_0"] = own;
  EXPECT_EQ(read(glb_), (std::vector<Rgb>{{255, 188, 0}, {0, 0, 0}, {255, 0, 0}, {0, 188, 0}}));
}

TEST_F(GltfColors, AreWhiteWhereOnlyOtherPartsHaveSome) {
  json colored = primitive();
  colored["material"] = 0;
  glb_.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 1, 1}}}}}};
  glb_.json["meshes"][0]["primitives"].push_back(colored);
  const auto colors = read(glb_);
  ASSERT_EQ(colors.size(), 8U);
  EXPECT_EQ(colors[3], (Rgb{255, 255, 255}));
  EXPECT_EQ(colors[4], (Rgb{0, 0, 255}));
}

TEST_F(GltfColors, ThatCannotBeReadAreNamed) {
  primitive()["attributes"]["COLOR_0"] = glb_.vectors({1, 1, 1});
  EXPECT_THAT(data_error_of([&] { read(glb_); }), HasSubstr("1 colours for 4 vertices"));
  EXPECT_NO_THROW(read_gltf(file("colors.glb"))) << "nobody wants them";
  primitive()["attributes"].erase("COLOR_0");
  primitive()["material"] = 3;
  EXPECT_THAT(data_error_of([&] { read(glb_); }), HasSubstr("material"));
}

}  // namespace
}  // namespace pliant
