#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>

#include "framework/core/angle.h"
#include "framework/registration/projective.h"
#include "framework/registration/residual.h"
#include "tests/device/shapes.h"

namespace pliant {

void PrintTo(const ProjectiveOptions& options, std::ostream* out) {
  *out << options.max_distance << " mm, " << options.max_angle << " rad, facing " << options.max_view_angle
       << " rad, " << options.search_radius << " pixels around, " << options.steps << " steps, rim "
       << options.rim << (options.symmetric ? ", symmetric" : "");
}

namespace {

constexpr Camera camera{50, 50, 20, 15, 41, 31};

/// A wavy wall with holes, some pixels without a normal.
SurfaceMap make_target(std::mt19937& random) {
  std::uniform_real_distribution<float> draw(0, 1);
  SurfaceImage map{Image<Eigen::Vector3f>(camera.width, camera.height, Eigen::Vector3f::Zero()),
                   Image<Eigen::Vector3f>(camera.width, camera.height, Eigen::Vector3f::Zero())};
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      if (draw(random) < 0.15F) continue;
      map.points(u, v) =
          camera.unproject(u, v, 400 + 20 * std::sin(0.3 * u) + 8 * draw(random)).cast<float>();
      if (draw(random) < 0.1F) continue;
      map.normals(u, v) = Eigen::Vector3f(draw(random) - 0.5F, draw(random) - 0.5F, -0.6F).normalized();
    }
  }
  return {camera, map};
}

/// Points before, beside and behind the camera; some without a normal.
PointSet make_moved(std::mt19937& random, std::size_t count) {
  std::uniform_real_distribution<float> draw(0, 1);
  std::vector<float> points, normals;
  for (std::size_t i = 0; i < count; ++i) {
    const float depth = draw(random) < 0.05F ? -100.0F : 380 + 60 * draw(random);
    for (const float value : {(draw(random) - 0.5F) * 420, (draw(random) - 0.5F) * 320, depth})
      points.push_back(value);
    const Eigen::Vector3f normal =
        draw(random) < 0.1F
            ? Eigen::Vector3f(0, 0, 0)
            : Eigen::Vector3f(Eigen::Vector3f(draw(random) - 0.5F, draw(random) - 0.5F, -0.5F).normalized());
    normals.insert(normals.end(), normal.data(), normal.data() + 3);
  }
  return {Array<float>(std::move(points)), Array<float>(std::move(normals))};
}

ProjectiveOptions limits(double max_distance, double max_angle, int search_radius = 0) {
  ProjectiveOptions options;
  options.max_distance = max_distance;
  options.max_angle = max_angle;
  options.max_view_angle = std::numbers::pi;
  options.search_radius = search_radius;
  return options;
}

/// What a method does with a target, and the shape of the kernels that do it.
class Projective : public ::testing::TestWithParam<std::tuple<ProjectiveOptions, DeviceOptions>> {
 protected:
  const ProjectiveCorrespondence projective{std::get<0>(GetParam())};
  Device device{"any", std::get<1>(GetParam())};
};

TEST_P(Projective, TheDeviceAgreesWithTheReference) {
  std::mt19937 random(11);
  const SurfaceMap target = make_target(random);
  const PointSet moved = make_moved(random, 900);
  std::vector<int> selected;
  for (int i = 0; i < 900; i += 2) selected.push_back(i);
  std::vector<float> rest;
  for (const int i : selected)
    for (int axis = 0; axis < 3; ++axis)
      rest.push_back(moved.points.host()[static_cast<std::size_t>(3 * i + axis)] + 3);
  const auto empty = [&] {
    Constraints constraints;
    constraints.points = Array<float>(rest);
    constraints.data = Array<float>(std::vector<float>(2 * rest.size(), 7.0F));
    constraints.confidence = Array<float>(std::vector<float>(selected.size(), 7.0F));
    return constraints;
  };
  Constraints constraints = empty();
  Constraints expected = empty();
  const Array<int> chosen(selected);
  projective.match(device, moved, chosen, target, constraints);
  projective.match_reference(moved, chosen, target, expected);
  int matched = 0;
  for (std::size_t i = 0; i < selected.size(); ++i) {
    ASSERT_EQ(constraints.confidence.host()[i], expected.confidence.host()[i]) << "constraint " << i;
    matched += constraints.confidence.host()[i] > 0 ? 1 : 0;
    for (std::size_t entry = 6 * i; entry < 6 * i + 6; ++entry)
      ASSERT_NEAR(constraints.data.host()[entry], expected.data.host()[entry], 1e-4) << "constraint " << i;
  }
  EXPECT_GT(matched, 20);
  EXPECT_LT(matched, 440);
}

std::vector<ProjectiveOptions> kinds_of_options() {
  std::vector<ProjectiveOptions> kinds{limits(15, 3.2), limits(1000, 0.7), limits(30, 0.9),
                                       limits(30, 0.9, 3), limits(60, 3.2, 12)};
  ProjectiveOptions closest = limits(30, 1.2);
  closest.steps = 4;
  kinds.push_back(closest);
  closest.max_view_angle = 0.8;
  closest.symmetric = true;
  kinds.push_back(closest);
  ProjectiveOptions careful = limits(100, 1.2);
  careful.steps = 2;
  careful.rim = 1;
  kinds.push_back(careful);
  return kinds;
}

INSTANTIATE_TEST_SUITE_P(Options, Projective,
                         ::testing::Combine(::testing::ValuesIn(kinds_of_options()),
                                            ::testing::ValuesIn(test::device_shapes)));

TEST(ProjectiveMatch, LooksAroundOnlyWhereTheProjectedPixelIsRejected) {
  Device device;
  SurfaceImage map{Image<Eigen::Vector3f>(camera.width, camera.height, Eigen::Vector3f::Zero()),
                   Image<Eigen::Vector3f>(camera.width, camera.height, Eigen::Vector3f::Zero())};
  map.points(24, 15) = camera.unproject(24, 15, 400).cast<float>();
  const SurfaceMap target(camera, map);
  const Eigen::Vector3f point = camera.unproject(20, 15, 400).cast<float>();  // four pixels, 32 mm away
  const PointSet moved{Array<float>(std::vector<float>(point.data(), point.data() + 3)),
                       Array<float>(std::vector<float>{0, 0, 0})};
  Constraints constraints;
  constraints.points = Array<float>(moved.points.host());
  constraints.data = Array<float>(std::vector<float>(6));
  constraints.confidence = Array<float>(std::vector<float>(1));
  const Array<int> selected(std::vector<int>{0});
  ProjectiveCorrespondence(limits(50, 1, 3)).match(device, moved, selected, target, constraints);
  EXPECT_EQ(constraints.confidence.host()[0], 0) << "beyond the radius";
  ProjectiveCorrespondence(limits(30, 1, 4)).match(device, moved, selected, target, constraints);
  EXPECT_EQ(constraints.confidence.host()[0], 0) << "beyond the distance";
  ProjectiveCorrespondence(limits(50, 1, 4)).match(device, moved, selected, target, constraints);
  EXPECT_EQ(constraints.confidence.host()[0], 1);
  EXPECT_NEAR(constraints.data.host()[0], 32, 1e-3);
}

/// A plane z = 400 + slope * x as the camera sees it, up to a column.
SurfaceMap make_slope(double slope, int columns = camera.width) {
  SurfaceImage map{Image<Eigen::Vector3f>(camera.width, camera.height, Eigen::Vector3f::Zero()),
                   Image<Eigen::Vector3f>(camera.width, camera.height, Eigen::Vector3f::Zero())};
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < columns; ++u) {
      map.points(u, v) =
          camera.unproject(u, v, 400 / (1 - slope * (u - camera.cx) / camera.fx)).cast<float>();
      map.normals(u, v) = Eigen::Vector3d(slope, 0, -1).normalized().cast<float>();
    }
  return {camera, map};
}

struct Match {
  bool is_found;
  Eigen::Vector3f pull;
  Eigen::Vector3f plane;
};

Match match_one(const ProjectiveOptions& options, const SurfaceMap& target, const Eigen::Vector3d& point,
                const Eigen::Vector3d& normal) {
  Device device;
  const auto array = [](const Eigen::Vector3d& v) {
    const Eigen::Vector3f value = v.cast<float>();
    return Array<float>(std::vector<float>(value.data(), value.data() + 3));
  };
  Constraints constraints;
  constraints.points = array(point);
  constraints.data = Array<float>(std::vector<float>(6));
  constraints.confidence = Array<float>(std::vector<float>(1));
  ProjectiveCorrespondence(options).match(device, {array(point), array(normal)},
                                          Array<int>(std::vector<int>{0}), target, constraints);
  const float* data = constraints.data.host().data();
  return {constraints.confidence.host()[0] > 0, Eigen::Vector3f(data), Eigen::Vector3f(data + 3)};
}

const Eigen::Vector3d towards_camera(0, 0, -1);

TEST(ClosestMatch, WalksToTheFootOfThePoint) {
  const SurfaceMap slope = make_slope(1);
  const Eigen::Vector3d point(0, 0, 360);  // its foot is (20, 0, 380); on its own ray the plane is 40 mm away
  ProjectiveOptions options = limits(100, 1.5);
  EXPECT_NEAR(match_one(options, slope, point, towards_camera).pull.norm(), 40, 0.1);
  options.steps = 4;
  const Match closest = match_one(options, slope, point, towards_camera);
  EXPECT_NEAR(closest.pull.norm(), std::sqrt(0.5) * 40, 1);
  EXPECT_NEAR(closest.pull.x(), -20, 6);  // to half a pixel
}

TEST(Match, IsDeniedToAPointThatTurnedAway) {
  const SurfaceMap wall = make_slope(0);
  const auto turned = [](double degrees) {
    const double angle = degrees * degree;
    return Eigen::Vector3d(std::sin(angle), 0, -std::cos(angle));
  };
  ProjectiveOptions options = limits(100, std::numbers::pi);
  options.max_view_angle = 80 * degree;
  const Eigen::Vector3d point(0, 0, 395);
  EXPECT_TRUE(match_one(options, wall, point, turned(79)).is_found);
  EXPECT_FALSE(match_one(options, wall, point, turned(81)).is_found);
  EXPECT_TRUE(match_one(options, wall, point, Eigen::Vector3d::Zero()).is_found) << "without a normal";
}

TEST(Match, IsDeniedNearWhereTheTargetEndsOrJumps) {
  ProjectiveOptions options = limits(100, 1);
  options.rim = 2;
  const auto found_at = [&](const SurfaceMap& target, int u) {
    return match_one(options, target, camera.unproject(u, 15, 395), towards_camera).is_found;
  };
  const SurfaceMap cut_off = make_slope(0, 30);
  EXPECT_TRUE(found_at(cut_off, 27));
  EXPECT_FALSE(found_at(cut_off, 28));
  SurfaceMap step = make_slope(0);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 30; u < camera.width; ++u)
      step.map.points.write_host()[static_cast<std::size_t>(3 * (v * camera.width + u) + 2)] +=
          170;  // 2 pixels: 160
  EXPECT_TRUE(found_at(step, 27));
  EXPECT_FALSE(found_at(step, 28));
  EXPECT_FALSE(found_at(make_slope(0), 1)) << "beside the image nothing is seen either";
}

TEST(Match, GivesPlanesHalfWayBetweenTheNormals) {
  ProjectiveOptions options = limits(100, 1.5);
  const Eigen::Vector3d point(0, 0, 395), leaning = Eigen::Vector3d(1, 0, -1).normalized();
  EXPECT_NEAR(match_one(options, make_slope(0), point, leaning).plane.x(), 0, 1e-6);
  options.symmetric = true;
  const Match match = match_one(options, make_slope(0), point, leaning);
  EXPECT_NEAR(match.plane.norm(), 1, 1e-6);
  EXPECT_NEAR(std::atan2(match.plane.x(), -match.plane.z()), std::numbers::pi / 8, 1e-5);
}

constexpr double cut = 12;  // mm

/// Device and reference measure alike; gives what was measured.
Residual expect_agreement(Device& device, const ProjectiveCorrespondence& projective,
                          const SurfaceMap& target, const PointSet& moved) {
  ResidualMeter meter(device, projective, moved.points.size() / 3, cut);
  std::vector<float> per_point;
  projective.measure_reference(moved, target, per_point);
  const Residual expected = sum_residuals_reference(target, moved.points, per_point, cut);
  meter.measure(moved, target);
  const Residual measured = meter.read();
  EXPECT_EQ(measured.matched, expected.matched);
  EXPECT_EQ(measured.landed, expected.landed);
  EXPECT_EQ(measured.lost, expected.lost);
  EXPECT_NEAR(measured.mean, expected.mean, 1e-4 * expected.mean);
  EXPECT_NEAR(measured.robust, expected.robust, 1e-4 * expected.robust);
  EXPECT_NEAR(measured.deviation, expected.deviation, 1e-3 * expected.deviation);
  for (std::size_t i = 0; i < per_point.size(); ++i)
    EXPECT_NEAR(meter.per_point().host()[i], per_point[i], 1e-3) << "point " << i;
  return measured;
}

TEST_P(Projective, MeasuresLikeItsReference) {
  std::mt19937 random(5);
  const SurfaceMap target = make_target(random);
  const PointSet moved = make_moved(random, 1111);
  const Residual residual = expect_agreement(device, projective, target, moved);
  EXPECT_GT(residual.landed, 300);
  EXPECT_GT(residual.matched, 50);
  EXPECT_LT(residual.matched, residual.landed);
}

// Where a map is kept only for a window, the rest of the image shows nothing.
TEST_P(Projective, AWindowChangesNothing) {
  std::mt19937 random(5);
  SurfaceMap whole = make_target(random);
  const PixelWindow window{9, 7, 24, 17};
  std::vector<float> points, normals;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t at = 3 * whole.window.offset(u, v) + axis;
        if (window.contains(u, v)) {
          points.push_back(whole.points().host()[at]);
          normals.push_back(whole.normals().host()[at]);
        } else {
          whole.map.points.write_host()[at] = whole.map.normals.write_host()[at] = 0;
        }
      }
  const SurfaceMap cropped(camera, window,
                           {Array<float>(std::move(points)), Array<float>(std::move(normals))});
  const PointSet moved = make_moved(random, 1111);
  std::vector<int> all(1111);
  std::iota(all.begin(), all.end(), 0);
  const auto match = [&](const SurfaceMap& target) {
    Constraints constraints;
    constraints.points = moved.points.clone();
    constraints.data = Array<float>(std::size_t{6 * 1111});
    constraints.confidence = Array<float>(std::size_t{1111});
    projective.match(device, moved, Array<int>(all), target, constraints);
    return constraints;
  };
  const Constraints expected = match(whole);
  const Constraints found = match(cropped);
  EXPECT_EQ(found.confidence.host(), expected.confidence.host());
  EXPECT_EQ(found.data.host(), expected.data.host());
  EXPECT_TRUE(any_in_force(device, expected));
  const Residual a = expect_agreement(device, projective, whole, moved);
  const Residual b = expect_agreement(device, projective, cropped, moved);
  EXPECT_EQ(a.robust, b.robust);
  EXPECT_EQ(a.landed, b.landed);
}

// A residual of what no constraint follows would ask for nodes where they can do nothing.
TEST(ResidualMeter, KnowsNothingWhereTheMatchIsRejected) {
  Device device;
  std::mt19937 random(5);
  const SurfaceMap target = make_target(random);
  const PointSet moved = make_moved(random, 800);
  const ProjectiveCorrespondence projective(limits(30, 0.9));
  std::vector<int> all(800);
  std::iota(all.begin(), all.end(), 0);
  Constraints constraints;
  constraints.points = Array<float>(moved.points.host());
  constraints.data = Array<float>(std::vector<float>(6 * 800));
  constraints.confidence = Array<float>(std::vector<float>(800));
  projective.match(device, moved, Array<int>(all), target, constraints);
  ResidualMeter meter(device, projective, 800, cut);
  meter.measure(moved, target);
  for (std::size_t i = 0; i < 800; ++i) {
    const Eigen::Map<const Eigen::Vector3f> pull(constraints.data.host().data() + 6 * i);
    const bool is_matched = constraints.confidence.host()[i] > 0;
    ASSERT_NEAR(meter.per_point().host()[i], is_matched ? pull.norm() : -1, 1e-3) << "point " << i;
  }
}

/// What is not finite in a target that was made by hand.
void spoil(SurfaceMap& target, std::mt19937& random) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (auto* vectors : {&target.map.points, &target.map.normals})
    for (float& value : vectors->write_host())
      if (random() % 10 == 0) value = random() % 2 == 0 ? infinity : std::numeric_limits<float>::quiet_NaN();
}

TEST(ResidualMeter, PointsOfTheTargetThatAreNotFiniteCountAsNone) {
  Device device;
  std::mt19937 random(5);
  SurfaceMap target = make_target(random);
  spoil(target, random);
  const Residual measured =
      expect_agreement(device, ProjectiveCorrespondence(limits(1000, 1)), target, make_moved(random, 1111));
  EXPECT_GT(measured.matched, 100);
  EXPECT_EQ(measured.lost, 0);
}

TEST(ProjectiveCorrespondence, TakesNothingFromTheTargetThatIsNotFinite) {
  Device device;
  std::mt19937 random(6);
  SurfaceMap target = make_target(random);
  spoil(target, random);
  const PointSet moved = make_moved(random, 500);
  std::vector<int> all(500);
  std::iota(all.begin(), all.end(), 0);
  const Array<int> selected(all);
  Constraints found;
  found.points = Array<float>(moved.points.host());
  found.data = Array<float>(std::vector<float>(6 * 500));
  found.confidence = Array<float>(std::vector<float>(500));
  Constraints expected;
  expected.points = found.points.clone();
  expected.data = found.data.clone();
  expected.confidence = found.confidence.clone();
  for (const int radius : {0, 3}) {
    const ProjectiveCorrespondence correspondence(limits(1e4, 1.5, radius));
    correspondence.match(device, moved, selected, target, found);
    correspondence.match_reference(moved, selected, target, expected);
    EXPECT_EQ(found.confidence.host(), expected.confidence.host());
    EXPECT_TRUE(any_in_force(device, found));
    for (const float value : found.data.host()) ASSERT_TRUE(std::isfinite(value));
  }
}

TEST(Constraints, AreInForceWhenOneIs) {
  Device device;
  Constraints constraints;
  EXPECT_FALSE(any_in_force(device, constraints)) << "there is none";
  for (const auto& [confidence, expected] : std::vector<std::pair<std::vector<float>, bool>>{
           {{0, 0, 0}, false}, {{0, 0, 0.5F}, true}, {{std::numeric_limits<float>::quiet_NaN()}, false}}) {
    constraints.points = Array<float>(std::vector<float>(3 * confidence.size()));
    constraints.confidence = Array<float>(confidence);
    EXPECT_EQ(any_in_force(device, constraints), expected);
  }
}

TEST(Constraints, AreWeighedOnTheDevice) {
  Device device;
  Constraints constraints;
  constraints.points = Array<float>(std::vector<float>(9));
  constraints.confidence = Array<float>(std::vector<float>{1, 0, 0.5F});
  weigh(device, Array<float>(std::vector<float>{0.25F, 0.5F, 0.125F}), constraints);
  EXPECT_THAT(constraints.confidence.host(), ::testing::ElementsAre(0.25F, 0, 0.0625F));
}

TEST(ResidualMeter, CountsThePointsThatAreLost) {
  Device device;
  std::mt19937 random(5);
  const SurfaceMap target = make_target(random);
  PointSet moved = make_moved(random, 700);
  auto& values = moved.points.write_host();
  values[0] = std::numeric_limits<float>::quiet_NaN();
  values[1001] = std::numeric_limits<float>::infinity();
  values[2000] = 2e18F;
  EXPECT_EQ(expect_agreement(device, ProjectiveCorrespondence(limits(1000, 1)), target, moved).lost, 3);
}

TEST(ResidualMeter, IsZeroWhereNothingLands) {
  Device device;
  std::mt19937 random(5);
  const SurfaceMap target = make_target(random);
  const ProjectiveCorrespondence projective(limits(1000, 1));
  ResidualMeter meter(device, projective, 1, cut);
  meter.measure({Array<float>(std::vector<float>{0, 0, -10}), Array<float>(std::vector<float>{0, 0, 0})},
                target);
  const Residual residual = meter.read();
  EXPECT_EQ(residual.landed, 0);
  EXPECT_EQ(residual.mean, 0);
  EXPECT_EQ(residual.robust, cut);
  EXPECT_EQ(meter.per_point().host()[0], -1);
}

}  // namespace
}  // namespace pliant
