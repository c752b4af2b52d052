#include "experiments/view/augmentation_section.h"

#include <gmock/gmock.h>

#include "framework/config/config.h"
#include "tests/io/glb_file.h"
#include "tests/io/test_files.h"

namespace pliant {
namespace {

using test::data_error_of;
using ::testing::HasSubstr;

/// A triangle of 1, 2 and 3 m along the axes of a glTF file.
class AugmentationSection : public test::TestFiles {
 protected:
  AugmentationSection() {
    const std::size_t positions = glb_.vectors({1, 0, 0, 0, 2, 0, 0, 0, 3});
    glb_.json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", positions}}}}}}}};
    write("axes.glb", glb_.bytes());
  }

  Augmentation::Object object(const std::string& keys) const {
    const ConfigText text{"augmentation: {mesh: " + keys + "}\n", "text",
                          std::filesystem::path(file("x")).parent_path()};
    const Experiment experiment =
        load_experiment({text, {}, {}}, {group("augmentation", augmentation_table())}, Registry());
    return read_object(experiment.values.section("augmentation"));
  }

  /// Vertices in the model's frame.
  std::vector<Eigen::Vector3d> placed(const std::string& keys) const {
    const Augmentation::Object read = object(keys);
    std::vector<Eigen::Vector3d> vertices;
    for (const Eigen::Vector3f& vertex : read.mesh.vertices)
      vertices.push_back(read.model_from_object * vertex.cast<double>());
    return vertices;
  }

  test::GlbFile glb_;
};

TEST_F(AugmentationSection, StandsUprightAndLooksAtTheCamera) {
  const auto vertices = placed("axes.glb, at: [10, 20, 700]");
  EXPECT_LT((vertices[0] - Eigen::Vector3d(1010, 20, 700)).norm(), 1e-6);
  EXPECT_LT((vertices[1] - Eigen::Vector3d(10, -1980, 700)).norm(), 1e-6) << "up in the image";
  EXPECT_LT((vertices[2] - Eigen::Vector3d(10, 20, -2300)).norm(), 1e-6) << "towards the camera";
}

TEST_F(AugmentationSection, IsScaledAndTurned) {
  const auto vertices = placed("axes.glb, scale: 10, turn: [0, 0, 90]");
  EXPECT_LT((vertices[0] - Eigen::Vector3d(0, 10, 0)).norm(), 1e-6);
  EXPECT_LT((vertices[1] - Eigen::Vector3d(20, 0, 0)).norm(), 1e-6);
}

TEST_F(AugmentationSection, HasTheColourOfTheFileOrTheSection) {
  EXPECT_EQ(object("axes.glb, color: [1, 2, 255]").mesh.colors, std::vector<Rgb>(3, Rgb{1, 2, 255}));
  glb_.json["meshes"][0]["primitives"][0]["material"] = 0;
  glb_.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {0, 1, 0, 1}}}}}};
  write("green.glb", glb_.bytes());
  EXPECT_EQ(object("green.glb").mesh.colors, std::vector<Rgb>(3, Rgb{0, 255, 0}));
  write("red.obj", std::string("v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3\n"));
  EXPECT_EQ(object("red.obj").mesh.colors, std::vector<Rgb>(3, Rgb{255, 0, 0}));
}

TEST_F(AugmentationSection, AFileThatCannotBeReadIsNamed) {
  write("none.glb", std::string("nothing"));
  EXPECT_THAT(data_error_of([&] { object("none.glb"); }), HasSubstr("none.glb"));
}

}  // namespace
}  // namespace pliant
