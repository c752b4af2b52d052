#include "framework/tracking/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "framework/core/error.h"
#include "framework/imaging/bilateral.h"
#include "tests/geometry/made_depth.h"

namespace pliant {
namespace {

const Camera kCamera{300, 290, 84.5, 40, 165, 83};

class QuarterTurn : public Alignment {
 public:
  AlignmentResult align(const AlignmentInput&) const override {
    AlignmentResult result;
    result.motion =
        Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ());
    return result;
  }
};

class Unfiltered : public DepthFilter {
 public:
  std::optional<DepthMap> filter(Device&, const DepthMap&, const Camera&) const override {
    return std::nullopt;
  }
};

Method method_with(std::unique_ptr<DepthFilter> filter) {
  Method method;
  method.filter = std::move(filter);
  method.alignment = std::make_unique<QuarterTurn>();
  return method;
}

FramePair made_pair() {
  FramePair pair{"made", kCamera, made_depth(kCamera), made_depth(kCamera, 0)};
  pair.source.color = ColorImage(kCamera.width, kCamera.height);
  for (int u = 0; u < kCamera.width; ++u) pair.source.color(u, 40) = {static_cast<std::uint8_t>(u), 1, 2};
  return pair;
}

/// Largest distance between points of two lists, mm.
double difference(const std::vector<Eigen::Vector3f>& a, const std::vector<Eigen::Vector3f>& b) {
  EXPECT_EQ(a.size(), b.size());
  double worst = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    worst = std::max<double>(worst, (a[i] - b[i]).norm());
  return worst;
}

/// Largest distance between points at the same pixels, mm.
double difference(const SurfaceMap& map, const SurfaceImage& image) {
  double worst = 0;
  for (int v = 0; v < image.points.height(); ++v)
    for (int u = 0; u < image.points.width(); ++u)
      worst =
          std::max<double>(worst, (finite_or_none(map, map.points(), {u, v}) - image.points(u, v)).norm());
  return worst;
}

std::vector<Eigen::Vector3f> turned(std::vector<Eigen::Vector3f> points) {
  for (auto& point : points) point = Eigen::Vector3f(1 - point.y(), 2 + point.x(), 3 + point.z());
  return points;
}

TEST(Scene, HoldsTheSurfacesOfThePair) {
  Device device;
  StageTimes times;
  const FramePair pair = made_pair();
  const Scene scene = make_scene(pair, method_with(std::make_unique<Unfiltered>()), device, 1, times);
  const Surface expected = make_surface(make_surface_image(pair.source, kCamera), pair.source.color);
  const ScenePoints points = read_points(scene);
  EXPECT_LT(difference(points.source.points, expected.points), 1e-3);
  EXPECT_LT(difference(points.source.normals, expected.normals), 2e-3);
  EXPECT_EQ(points.source.pixels, expected.pixels);
  EXPECT_EQ(points.source.colors, expected.colors);
  EXPECT_LT(difference(points.aligned, turned(expected.points)), 1e-3);
  EXPECT_EQ(scene.pixels.points.host(), index_pixels(expected).points.host());
  EXPECT_EQ(unflatten(scene.rest.points), points.aligned);
  const auto given = unflatten(scene.given.normals);
  const auto turned_normals = unflatten(scene.rest.normals);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const Eigen::Vector3f n = given[i];
    ASSERT_LT((turned_normals[i] - Eigen::Vector3f(-n.y(), n.x(), n.z())).norm(), 1e-5);
  }
  EXPECT_TRUE(points.unfiltered.empty());
  EXPECT_LT(difference(scene.target, make_surface_image(pair.target, kCamera)), 1e-3);
}

TEST(Scene, FiltersWhatIsRegisteredAndKeepsWhatWasGiven) {
  Device device;
  StageTimes times;
  FramePair pair = made_pair();
  const BilateralFilter filter(4.5, 30, 6);
  const Scene scene =
      make_scene(pair, method_with(std::make_unique<BilateralFilter>(4.5, 30, 6)), device, 1, times);
  const ScenePoints points = read_points(scene);
  const Surface given = make_surface(make_surface_image(pair.source, kCamera), {});
  pair.source.depth = filter.filter_reference(pair.source.depth);
  pair.target.depth = filter.filter_reference(pair.target.depth);
  const Surface smooth = make_surface(make_surface_image(pair.source, kCamera), {});
  EXPECT_LT(difference(points.source.points, given.points), 1e-3);
  EXPECT_LT(difference(points.aligned, turned(smooth.points)), 1e-2);
  EXPECT_LT(difference(points.source.normals, smooth.normals), 2e-2);
  EXPECT_LT(difference(points.unfiltered, turned(given.points)), 1e-3);
  EXPECT_GT(difference(given.points, smooth.points), 1) << "the filter did something";
  EXPECT_LT(difference(scene.target, make_surface_image(pair.target, kCamera)), 1e-2);
}

TEST(Scene, MayFilterTheSourceAlone) {
  Device device;
  StageTimes times;
  const FramePair pair = made_pair();
  Method method = method_with(std::make_unique<Unfiltered>());
  method.source_filter = std::make_unique<BilateralFilter>(4.5, 30, 6);
  const Scene scene = make_scene(pair, method, device, 1, times);
  EXPECT_LT(difference(scene.target, make_surface_image(pair.target, kCamera)), 1e-3);
  const ScenePoints points = read_points(scene);
  EXPECT_GT(difference(points.aligned, turned(points.source.points)), 1) << "the filter did something";
}

TEST(Scene, NeedsAPoint) {
  Device device;
  StageTimes times;
  FramePair pair = made_pair();
  pair.source.depth = DepthImage(kCamera.width, kCamera.height);
  EXPECT_THROW(make_scene(pair, method_with(std::make_unique<Unfiltered>()), device, 1, times), DataError);
}

}  // namespace
}  // namespace pliant
