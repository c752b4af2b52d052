#include "framework/evaluation/metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "framework/core/error.h"

namespace pliant {
namespace {

using Points = std::vector<Eigen::Vector3f>;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();
const Camera camera{100, 100, 4, 3, 9, 7};

SurfaceImage empty_map() {
  return {Image<Eigen::Vector3f>(9, 7, Eigen::Vector3f::Zero()),
          Image<Eigen::Vector3f>(9, 7, Eigen::Vector3f::Zero())};
}

Eigen::Vector3f at_pixel(double u, double v, double depth) {
  return camera.unproject(u, v, depth).cast<float>();
}

/// Points at 1 m but for a hole at the pixel (2, 2).
SurfaceImage wall_with_hole() {
  SurfaceImage map = empty_map();
  for (int v = 0; v < 7; ++v) {
    for (int u = 0; u < 9; ++u) {
      if (u != 2 || v != 2) map.points(u, v) = at_pixel(u, v, 1000);
    }
  }
  return map;
}

/// One point in each of the first pixels, row by row.
Surface surface_of(const Points& points) {
  Surface surface;
  for (std::size_t i = 0; i < points.size(); ++i) {
    surface.points.push_back(points[i]);
    surface.pixels.emplace_back(static_cast<int>(i) % 9, static_cast<int>(i) / 9);
  }
  return surface;
}

FramePair blank_pair() {
  const Frame frame{DepthImage(9, 7), {}, {}};
  return {"pair", camera, frame, frame};
}

Evaluation against_wall(const Points& source) {
  return Evaluation(blank_pair(), std::nullopt, surface_of(source), wall_with_hole());
}

TEST(Residual, IsTheDistanceToThePointAtTheNearestPixel) {
  // 1003 mm at the pixel (5.4, 3.4): rounds to (5, 3), not to a neighbour.
  const Eigen::Vector3f point = at_pixel(5.4, 3.4, 1003);
  const std::vector<float> residuals = against_wall({point}).residuals({point});
  ASSERT_EQ(residuals.size(), 1u);
  EXPECT_FLOAT_EQ(residuals[0], (point - at_pixel(5, 3, 1000)).norm());
}

TEST(Residual, CoversPointsThatLandOnAValidPixelOnly) {
  const Points points{at_pixel(4, 3, 1010),
                      at_pixel(6, 3, 1020),
                      at_pixel(2, 2, 1000),
                      at_pixel(9, 3, 1000),
                      at_pixel(4, -1, 1000),
                      {0, 0, -1000},
                      {0, 0, 0},
                      {1e30f, 0, 1e-30f}};
  const Evaluation evaluation = against_wall(points);
  const std::vector<float> residuals = evaluation.residuals(points);
  EXPECT_NEAR(residuals[0], 10, 1e-3);
  for (std::size_t i = 2; i < points.size(); ++i) EXPECT_TRUE(std::isnan(residuals[i])) << i;
  EXPECT_DOUBLE_EQ(evaluation.measure(points).coverage, 2.0 / 8);
}

TEST(Residual, CountsTheOuterHalfOfBorderPixels) {
  const Points points{at_pixel(-0.4, -0.4, 1000), at_pixel(8.4, 6.4, 1000), at_pixel(-0.6, 3, 1000)};
  EXPECT_DOUBLE_EQ(against_wall(points).measure(points).coverage, 2.0 / 3);
}

TEST(Metrics, MeanAndPopulationDeviation) {
  const Points points{at_pixel(4, 3, 1010), at_pixel(4, 3, 1020)};
  const Metrics metrics = against_wall(points).measure(points);
  EXPECT_NEAR(metrics.residual_mean, 15, 1e-3);
  EXPECT_NEAR(metrics.residual_sd, 5, 1e-3);
  EXPECT_NEAR(metrics.nearest_mean, 15, 1e-3);
  EXPECT_NEAR(metrics.nearest_sd, 5, 1e-3);
  EXPECT_FALSE(metrics.truth.has_value());
}

TEST(Metrics, NearestAgreesWithBruteForce) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> side(-100, 100);
  SurfaceImage target = empty_map();
  for (std::size_t i = 0; i < target.points.size(); ++i) {
    target.points.data()[i] = {side(random), side(random), 500 + side(random)};
  }
  Points points;
  for (int i = 0; i < 200; ++i) points.emplace_back(side(random), side(random), 500 + side(random));
  const Evaluation evaluation(blank_pair(), std::nullopt, surface_of({points[0]}), target);
  const std::vector<float> nearest = evaluation.nearest(points);
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    float least = infinity;
    for (const Eigen::Vector3f& other : target.points.pixels())
      least = std::min(least, (points[i] - other).norm());
    EXPECT_NEAR(nearest[i], least, 1e-3);
    sum += least;
  }
  EXPECT_NEAR(evaluation.measure(points).nearest_mean, sum / 200, 1e-3);
}

TEST(Metrics, EmptyPixelsAreNoTargetPoints) {
  const Points near_the_camera{{0, 0, 1}};
  EXPECT_NEAR(against_wall(near_the_camera).nearest(near_the_camera)[0], 999, 1e-2);
}

TEST(Metrics, NonFinitePointsPoisonNothing) {
  const Points points{at_pixel(4, 3, 1010), {nan, 0, 1000}, {0, infinity, 1000}, {0, 0, infinity}};
  const Evaluation evaluation = against_wall(points);
  const Metrics metrics = evaluation.measure(points);
  EXPECT_NEAR(metrics.residual_mean, 10, 1e-3);
  EXPECT_NEAR(metrics.nearest_mean, 10, 1e-3);
  EXPECT_NEAR(metrics.nearest_sd, 0, 1e-3);
  EXPECT_DOUBLE_EQ(metrics.coverage, 0.25);
  EXPECT_TRUE(std::isnan(evaluation.nearest(points)[1]));
}

TEST(Metrics, NothingCoveredGivesZerosNotNaN) {
  const Points points{{nan, nan, nan}};
  const Metrics metrics = against_wall(points).measure(points);
  EXPECT_EQ(metrics.coverage, 0);
  EXPECT_EQ(metrics.residual_mean, 0);
  EXPECT_EQ(metrics.residual_sd, 0);
  EXPECT_EQ(metrics.nearest_mean, 0);
}

TEST(Metrics, NeedsATarget) {
  EXPECT_THAT([] { Evaluation(blank_pair(), std::nullopt, surface_of({}), empty_map()); },
              testing::ThrowsMessage<DataError>(testing::HasSubstr("pair: the target has no point")));
}

TEST(Metrics, NeedsATruthThatFitsThePair) {
  const PairTruth truth{Image<Eigen::Vector3f>(4, 3, Eigen::Vector3f::Zero())};
  EXPECT_THAT(
      [&] {
        Evaluation(blank_pair(), truth, surface_of({{0, 0, 1000}}), wall_with_hole());
      },
      testing::ThrowsMessage<DataError>(testing::HasSubstr("pair: the scene flow is 4 x 3 pixels")));
}

TEST(EndPointError, ComparesWithTheTruePosition) {
  PairTruth truth{Image<Eigen::Vector3f>(9, 7, Eigen::Vector3f(nan, nan, nan))};
  truth.scene_flow(0, 0) = {0, 0, 10};
  truth.scene_flow(1, 0) = {0.5f, 0, 0};  // moves less than 1 mm
  const Points source{{0, 0, 1000}, {50, 0, 1000}, {100, 0, 1000}};
  const Evaluation evaluation(blank_pair(), truth, surface_of(source), wall_with_hole());
  const Points moved{{0, 0, 1004}, {50, 0, 1000}, {0, 0, 0}};
  const std::vector<float> errors = evaluation.end_point_errors(moved);
  ASSERT_EQ(errors.size(), 3u);
  EXPECT_FLOAT_EQ(errors[0], 6);
  EXPECT_FLOAT_EQ(errors[1], 0.5);
  EXPECT_TRUE(std::isnan(errors[2]));
  const Metrics metrics = evaluation.measure(moved);
  ASSERT_TRUE(metrics.truth.has_value());
  EXPECT_NEAR(metrics.truth->epe_mean, 3.25, 1e-4);
  EXPECT_NEAR(metrics.truth->epe_sd, 2.75, 1e-4);
  EXPECT_NEAR(metrics.truth->epe_moving_mean, 6, 1e-4);
}

TEST(EndPointError, PercentileIsTheErrorThat95PercentDoNotExceed) {
  PairTruth truth{Image<Eigen::Vector3f>(9, 7, Eigen::Vector3f::Zero())};
  Points source(20, Eigen::Vector3f(0, 0, 1000));
  const Evaluation evaluation(blank_pair(), truth, surface_of(source), wall_with_hole());
  for (std::size_t i = 0; i < source.size(); ++i) source[i].z() += static_cast<float>(20 - i);
  const Metrics metrics = evaluation.measure(source);
  EXPECT_NEAR(metrics.truth->epe_p95, 19, 1e-3);
  EXPECT_EQ(metrics.truth->epe_moving_mean, 0);
}

// On the left something stands 200 mm before the wall; below, the target is cut off.
TEST(EndPointError, TellsWhatTheTargetShowsFromWhatItHides) {
  SurfaceImage target = wall_with_hole();
  for (int v = 0; v < 7; ++v) {
    for (int u = 0; u < 9; ++u) {
      if (v >= 4)
        target.points(u, v) = Eigen::Vector3f::Zero();
      else if (u <= 3)
        target.points(u, v) = at_pixel(u, v, 800);
    }
  }
  PairTruth truth{Image<Eigen::Vector3f>(9, 7, Eigen::Vector3f(0, 0, 5))};
  truth.scene_flow(4, 0) = {nan, nan, nan};
  const Points source{at_pixel(6, 2, 995), at_pixel(1, 2, 995), at_pixel(6, 6, 995), at_pixel(12, 2, 995),
                      at_pixel(6, 1, 995)};
  const Evaluation evaluation(blank_pair(), truth, surface_of(source), target);
  Points moved = source;  // the seen one is off by 1 mm; behind, cut off and out of view: 2, 4 and 6 mm
  for (std::size_t i = 0; i < 4; ++i) moved[i].z() = 1000 + std::array{1.0F, 2.0F, 4.0F, 6.0F}[i];
  const Metrics::Truth errors = evaluation.measure(moved).truth.value();
  EXPECT_NEAR(errors.epe_seen_mean, 1, 1e-3);
  EXPECT_NEAR(errors.epe_hidden_mean, 4, 1e-3);
  EXPECT_DOUBLE_EQ(errors.hidden_share, 0.75);
}

TEST(EndPointError, TakesVisibilityFromTheTruthWhereThatKnows) {
  PairTruth truth{Image<Eigen::Vector3f>(9, 7, Eigen::Vector3f(0, 0, 5))};
  truth.visible = MaskImage(9, 7, 0);
  truth.visible(0, 0) = 1;
  const Points source{at_pixel(6, 2, 995), at_pixel(6, 1, 995)};  // both where the wall is seen
  const Evaluation evaluation(blank_pair(), truth, surface_of(source), wall_with_hole());
  Points moved = source;
  moved[0].z() = 1001;
  moved[1].z() = 1004;
  const Metrics::Truth errors = evaluation.measure(moved).truth.value();
  EXPECT_NEAR(errors.epe_seen_mean, 1, 1e-3);
  EXPECT_NEAR(errors.epe_hidden_mean, 4, 1e-3);
  EXPECT_DOUBLE_EQ(errors.hidden_share, 0.5);
}

TEST(EndPointError, TruthThatDoesNotFitIsAnError) {
  PairTruth truth{Image<Eigen::Vector3f>(9, 7, Eigen::Vector3f::Zero())};
  truth.visible = MaskImage(9, 6, 0);
  EXPECT_THAT([&] { check(truth, blank_pair()); },
              testing::ThrowsMessage<DataError>(testing::HasSubstr("pair: the visibility is 9 x 6 pixels")));
  truth.visible = {};
  truth.optical_flow = Image<Eigen::Vector2f>(1, 7, Eigen::Vector2f::Zero());
  EXPECT_THAT(
      [&] { check(truth, blank_pair()); },
      testing::ThrowsMessage<DataError>(testing::HasSubstr("pair: the optical flow is 1 x 7 pixels")));
}

TEST(EndPointError, IsAbsentWhereNothingIsKnown) {
  const Points source{{0, 0, 1000}};
  EXPECT_TRUE(against_wall(source).end_point_errors(source).empty());
  const PairTruth truth{Image<Eigen::Vector3f>(9, 7, Eigen::Vector3f(nan, nan, nan))};
  const Evaluation evaluation(blank_pair(), truth, surface_of(source), wall_with_hole());
  EXPECT_FALSE(evaluation.measure(source).truth.has_value());
}

}  // namespace
}  // namespace pliant
