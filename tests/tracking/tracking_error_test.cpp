#include "framework/tracking/tracking_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "framework/core/angle.h"
#include "tests/device/shapes.h"

namespace pliant {
namespace {

using Vectors = std::vector<Eigen::Vector3f>;

const Camera kCamera{50, 48, 20.3, 14.7, 41, 31};
const PixelWindow kModelWindow{4, 3, 33, 21};
const PixelWindow kSeenWindow{7, 2, 25, 27};

/// A map whose point and normal of a pixel are what `vectors_of(u, v)` gives.
template <class VectorsOf>
SurfaceMap made_map(const PixelWindow& window, const VectorsOf& vectors_of) {
  Vectors points, normals;
  for (int v = window.top; v < window.top + window.height; ++v) {
    for (int u = window.left; u < window.left + window.width; ++u) {
      const auto& [point, normal] = vectors_of(u, v);
      points.push_back(point);
      normals.push_back(normal);
    }
  }
  return {kCamera, window, {flatten(points), flatten(normals)}};
}

using PointAndNormal = std::pair<Eigen::Vector3f, Eigen::Vector3f>;
const PointAndNormal kNone{{0, 0, 0}, {0, 0, 0}};

double wave(double u, double v) { return 500 + 20 * std::sin(0.3 * u) + 15 * std::cos(0.2 * v); }

/// With holes, points beside their pixels, some behind the camera, some without a normal, some turned away.
SurfaceMap made_model(std::mt19937& random) {
  std::uniform_real_distribution<double> draw(0, 1);
  return made_map(kModelWindow, [&](int u, int v) -> PointAndNormal {
    if (draw(random) < 0.15) return kNone;
    const double x = u + 3 * draw(random) - 1.5, y = v + 3 * draw(random) - 1.5;
    const Eigen::Vector3f point = kCamera.unproject(x, y, wave(x, y) + 30 * draw(random) - 15).cast<float>();
    if (draw(random) < 0.05) return {-point, {0, 0, -1}};
    if (draw(random) < 0.05) return {point, {0, 0, 0}};
    const Eigen::Vector3f tilt(static_cast<float>(4 * draw(random) - 2), 0, -1);
    return {point, tilt.normalized()};
  });
}

SurfaceMap made_seen(std::mt19937& random) {
  std::uniform_real_distribution<double> draw(0, 1);
  constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
  return made_map(kSeenWindow, [&](int u, int v) -> PointAndNormal {
    if (draw(random) < 0.15) return kNone;
    if (draw(random) < 0.05) return {{unknown, unknown, unknown}, {0, 0, -1}};
    const Eigen::Vector3f tilt(static_cast<float>(8 * draw(random) - 4), 0, -1);
    return {kCamera.unproject(u, v, wave(u, v)).cast<float>(), tilt.normalized()};
  });
}

TrackingErrorOptions options_with(int radius, double max_distance = 30) {
  TrackingErrorOptions options;
  options.radius = radius;
  options.max_distance = max_distance;
  return options;
}

/// What the distances that are known come to.
TrackingError summed(const std::vector<float>& distances) {
  TrackingError error;
  double squares = 0;
  for (const float distance : distances) {
    if (!(distance >= 0)) continue;
    ++error.matched;
    error.mean += distance;
    squares += double{distance} * distance;
  }
  if (error.matched == 0) return error;
  error.mean /= error.matched;
  error.deviation = std::sqrt(std::max(0.0, squares / error.matched - error.mean * error.mean));
  return error;
}

class TrackingErrorTest : public ::testing::TestWithParam<DeviceOptions> {
 protected:
  /// Device and reference alike; gives what was measured.
  TrackingError expect_agreement(const SurfaceMap& model, const SurfaceMap& seen,
                                 const TrackingErrorOptions& options) {
    TrackingErrorMeter meter(device_, options);
    const TrackingError measured = meter.measure(model, seen);
    const std::vector<float> expected = tracking_error_reference(model, seen, options);
    EXPECT_EQ(meter.per_pixel().size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_NEAR(meter.per_pixel().host()[i], expected[i], 1e-3) << "pixel " << i;
    const TrackingError sum = summed(expected);
    EXPECT_EQ(measured.matched, sum.matched);
    EXPECT_NEAR(measured.mean, sum.mean, 1e-4 * sum.mean);
    EXPECT_NEAR(measured.deviation, sum.deviation, 1e-3 * sum.mean);
    return measured;
  }

  Device device_{"any", GetParam()};
};

TEST_P(TrackingErrorTest, TheDeviceAgreesWithTheReference) {
  for (const int radius : {0, 3}) {
    for (const double max_distance : {30, 10}) {
      SCOPED_TRACE(std::to_string(radius) + " pixels, " + std::to_string(max_distance) + " mm");
      std::mt19937 random(3);
      const SurfaceMap model = made_model(random);
      const TrackingError error =
          expect_agreement(model, made_seen(random), options_with(radius, max_distance));
      EXPECT_GT(error.matched, 80);
      EXPECT_LT(error.matched, 400);
      EXPECT_GT(error.deviation, 0.1);
    }
  }
}

TEST_P(TrackingErrorTest, AMeterMeasuresOtherWindowsAfterwards) {
  TrackingErrorMeter meter(device_, options_with(3));
  std::mt19937 random(3);
  const SurfaceMap model = made_model(random);
  const SurfaceMap seen = made_seen(random);
  const double expected = meter.measure(model, seen).mean;
  EXPECT_NEAR(meter.measure(seen, seen).mean, 0, 1e-4);
  EXPECT_EQ(meter.per_pixel().size(), kSeenWindow.size());
  EXPECT_EQ(meter.measure(model, seen).mean, expected) << "the same bits";
}

INSTANTIATE_TEST_SUITE_P(DeviceShapes, TrackingErrorTest, ::testing::ValuesIn(test::device_shapes));

/// A wall, its depth what `depth_of(u, v)` says.
template <class DepthOf>
SurfaceMap wall(const DepthOf& depth_of) {
  return made_map(whole_image(kCamera), [&](int u, int v) -> PointAndNormal {
    return {kCamera.unproject(u, v, depth_of(u, v)).template cast<float>(), {0, 0, -1}};
  });
}

TrackingError measured(const SurfaceMap& model, const SurfaceMap& seen, const TrackingErrorOptions& options) {
  Device device;
  return TrackingErrorMeter(device, options).measure(model, seen);
}

TEST(TrackingError, AveragesNoiseOutAndNoDeformation) {
  const SurfaceMap model = wall([](int, int) { return 500; });
  const SurfaceMap noisy = wall([](int u, int v) { return 500 + ((u + v) % 2 == 0 ? 2 : -2); });
  const SurfaceMap moved = wall([](int, int) { return 505; });
  EXPECT_NEAR(measured(model, noisy, options_with(0)).mean, 2, 1e-3);
  EXPECT_LT(measured(model, noisy, options_with(3)).mean, 0.15);
  for (const int radius : {0, 3}) {
    const TrackingError error = measured(model, moved, options_with(radius));
    EXPECT_NEAR(error.mean, 5, 1e-3);
    EXPECT_NEAR(error.deviation, 0, 0.05);
    EXPECT_EQ(error.matched, kCamera.width * kCamera.height);
  }
}

/// What a camera sees of a slope, at pixels that are off by `shift`.
SurfaceMap slope(double shift) {
  const Eigen::Vector3d normal = Eigen::Vector3d(1, 0.5, -1).normalized();
  return made_map(whole_image(kCamera), [&](int u, int v) -> PointAndNormal {
    const Eigen::Vector3d ray = kCamera.unproject(u + shift, v + shift, 1);
    const Eigen::Vector3d point = ray * (normal.z() * 500 / normal.dot(ray));
    return {point.cast<float>(), normal.cast<float>()};
  });
}

TEST(TrackingError, OfASlopeIsNoneBetweenItsPixels) {
  const TrackingError error = measured(slope(0.4), slope(0), options_with(0));
  EXPECT_GT(error.matched, 500);
  EXPECT_NEAR(error.mean, 0, 1e-3);
  SurfaceMap without_normals = slope(0);
  without_normals.map.normals = Array<float>(without_normals.normals().size());
  EXPECT_GT(measured(slope(0.4), without_normals, options_with(0)).mean, 1);
}

TEST(TrackingError, LeavesOutWhatIsTooFarOrTurnsAway) {
  const SurfaceMap model = wall([](int, int) { return 500; });
  const SurfaceMap far = wall([](int u, int) { return u < 10 ? 529 : 531; });
  const TrackingError error = measured(model, far, options_with(0));
  EXPECT_EQ(error.matched, 10 * kCamera.height);
  EXPECT_NEAR(error.mean, 29, 1e-3);
  const auto leaning = [](double degrees) {
    const double angle = degrees * degree;
    SurfaceMap model = wall([](int, int) { return 500; });
    Vectors normals;
    for (const Eigen::Vector3f& point : unflatten(model.points())) {
      const Eigen::Vector3d way = -point.cast<double>().normalized();
      normals.push_back((Eigen::AngleAxisd(angle, way.unitOrthogonal()) * way).cast<float>());
    }
    model.map.normals = flatten(normals);
    return model;
  };
  EXPECT_EQ(measured(leaning(74), model, options_with(0)).matched, kCamera.width * kCamera.height);
  EXPECT_EQ(measured(leaning(76), model, options_with(0)).matched, 0);
}

TEST(TrackingError, OfNothingIsNothing) {
  const SurfaceMap nothing = made_map(kModelWindow, [](int, int) { return kNone; });
  const TrackingError error = measured(nothing, wall([](int, int) { return 500; }), options_with(3));
  EXPECT_EQ(error.matched, 0);
  EXPECT_EQ(error.mean, 0);
  EXPECT_EQ(error.deviation, 0);
}

}  // namespace
}  // namespace pliant
