#include <gmock/gmock.h>

#include <cstdlib>

#include "framework/config/config.h"
#include "framework/core/error.h"
#include "framework/imaging/depth_map.h"
#include "framework/pose/alignment.h"
#include "framework/pose/alignments.h"

// What the reader of docs/adding-a-component.md has after the section on alignments. Built by follow.cmake in
// a copy of the room `framework/pose` that was changed as the document says.
namespace pliant::test {
namespace {

const Camera camera{100, 100, 31.5, 23.5, 64, 48};

class Centroids : public testing::Test {
 protected:
  Centroids() { register_alignments(registry_); }

  /// The alignment that the experiment of the document asks for.
  std::unique_ptr<Alignment> make() {
    const char* file = std::getenv("PLIANT_POSE_EXAMPLE");
    if (file == nullptr) throw std::runtime_error("PLIANT_POSE_EXAMPLE is not set");
    const auto experiment =
        load_experiment({file, {}, {}}, {component("alignment", Alignment::kind)}, registry_);
    return registry_.make<Alignment>(experiment.values.section("alignment"));
  }

  /// A square of 10 x 10 pixels at some distance (mm); nothing at 0.
  static Frame square(float distance) {
    Frame frame{DepthImage(camera.width, camera.height), {}, {}};
    for (int v = 10; v < 20; ++v)
      for (int u = 10; u < 20; ++u) frame.depth(u, v) = distance;
    return frame;
  }

  AlignmentResult align(float target_distance) {
    const FramePair pair{"square", camera, square(500), square(target_distance), {}};
    const DepthMap depth(pair.source);
    const SurfaceMap source = make_surface_map(device_, depth, camera);
    const SurfaceMap target = make_surface_map(device_, DepthMap(pair.target), camera);
    return make()->align({pair, device_, source, Array<int>(pixels_with_depth(depth)), target, 1, false});
  }

  Device device_;
  Registry registry_;
};

TEST_F(Centroids, AreListed) { EXPECT_NE(registry_.find("alignment", "centroids"), nullptr); }

TEST_F(Centroids, ArePutOnEachOther) {
  const AlignmentResult result = align(600);
  EXPECT_FALSE(result.failed);
  EXPECT_EQ(result.method, "centroids");
  const Eigen::Vector3d expected = camera.unproject(14.5, 14.5, 600) - camera.unproject(14.5, 14.5, 500);
  EXPECT_LT((result.motion.translation() - expected).norm(), 1e-2);
}

TEST_F(Centroids, AreLeftWhereTheyAreTooFarApart) {
  const AlignmentResult result = align(800);
  EXPECT_TRUE(result.failed);
  EXPECT_THAT(result.reason, testing::HasSubstr("mm apart"));
}

TEST_F(Centroids, NeedPoints) { EXPECT_THROW(align(0), DataError); }

}  // namespace
}  // namespace pliant::test
