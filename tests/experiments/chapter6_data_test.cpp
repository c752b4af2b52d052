// The sequences of chapter 6 are what its experiments take them for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "experiments/datasets/datasets.h"
#include "experiments/datasets/mesh_stream.h"
#include "framework/config/config.h"
#include "tests/datasets/data_of.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;

// Frames of the keys; see docs/chapter6.md.
constexpr int rest = 127;
constexpr int held = 151;
constexpr int holding = 175;
constexpr int released = 199;
constexpr int last = 229;

/// mm, by how far a vertex is from where the rigid motion since frame `from` would have it in frame `to`, at
/// most.
double deformation(const DataStream& stream, int from, int to) {
  const Eigen::Isometry3d motion = stream.camera_pose(to)->inverse() * *stream.camera_pose(from);
  const Mesh before = *stream.surface(from);
  const Mesh after = *stream.surface(to);
  double most = 0;
  for (std::size_t i = 0; i < before.vertices.size(); ++i)
    most = std::max(most,
                    (motion * before.vertices[i].cast<double>() - after.vertices[i].cast<double>()).norm());
  return most;
}

/// Whether the image shows something, and nothing at its border.
bool is_whole(const DepthImage& depth) {
  bool shows = false;
  for (int v = 0; v < depth.height(); ++v)
    for (int u = 0; u < depth.width(); ++u) {
      if (!(depth(u, v) > 0)) continue;
      shows = true;
      if (u == 0 || v == 0 || u == depth.width() - 1 || v == depth.height() - 1) return false;
    }
  return shows;
}

class Chapter6Data : public ::testing::Test {
 protected:
  std::unique_ptr<DataStream> open(const std::string& file) {
    const ConfigSource source{
        file, {"data.image_width=160", "data.image_height=120", "data.focal_length=131.25"}, {}};
    Registry registry;
    register_datasets(registry);
    const Experiment experiment = load_experiment(source, {component("data", FrameSource::kind)}, registry);
    return registry.make<FrameSource>(experiment.values.section("data"))->open(shared_device(), 1);
  }
};

TEST_F(Chapter6Data, DeformsWhileItIsHeldAndNeitherBeforeNorAfter) {
  int sequences = 0;
  for (const auto& entry : fs::directory_iterator(PLIANT_EXPERIMENTS "/chapter6/data")) {
    const std::string name = entry.path().stem().string();
    if (!entry.is_regular_file() || name == "leaves") continue;
    SCOPED_TRACE(name);
    ++sequences;
    const auto stream = open(entry.path().string());
    const auto& scene = dynamic_cast<const MeshStream&>(*stream);
    ASSERT_EQ(scene.scene().frames, last);
    for (const SceneKey& key : scene.scene().keys)
      EXPECT_TRUE(is_whole(scene.exact_depth(1 + static_cast<int>(std::lround(30 * key.time)))));
    EXPECT_GT(deformation(*stream, 1, held), 4);
    EXPECT_LT(deformation(*stream, held, holding), 1e-3);
    for (const int neutral : {rest, released, last}) EXPECT_LT(deformation(*stream, 1, neutral), 1e-3);
  }
  EXPECT_EQ(sequences, 10);
}

TEST_F(Chapter6Data, AHeadLeavesAndReturns) {
  const auto stream = open(PLIANT_EXPERIMENTS "/chapter6/data/leaves.yaml");
  const auto& scene = dynamic_cast<const MeshStream&>(*stream);
  const auto shows = [&](int number) {
    const auto pixels = scene.exact_depth(number).pixels();
    return std::any_of(pixels.begin(), pixels.end(), [](float depth) { return depth > 0; });
  };
  EXPECT_TRUE(shows(1));
  EXPECT_FALSE(shows(178));
  EXPECT_TRUE(shows(scene.scene().frames));
}

}  // namespace
}  // namespace pliant::test
