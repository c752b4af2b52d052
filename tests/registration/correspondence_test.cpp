#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "framework/registration/projective.h"
#include "framework/registration/residual.h"

namespace pliant {
namespace {

constexpr Camera camera{50, 50, 20, 15, 41, 31};

/// A wavy wall with holes, some pixels without a normal.
Target make_target(std::mt19937& random) {
  std::uniform_real_distribution<float> draw(0, 1);
  SurfaceMap map{Image<Eigen::Vector3f>(camera.width, camera.height, Eigen::Vector3f::Zero()),
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

struct Limits {
  double max_distance;
  double max_angle;
  int search_radius;
};

void PrintTo(const Limits& limits, std::ostream* out) {
  *out << limits.max_distance << " mm, " << limits.max_angle << " rad, " << limits.search_radius << " pixels";
}

class Projective : public ::testing::TestWithParam<Limits> {};

TEST_P(Projective, TheDeviceAgreesWithTheReference) {
  Device device;
  std::mt19937 random(11);
  const Target target = make_target(random);
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
  const ProjectiveCorrespondence projective(GetParam().max_distance, GetParam().max_angle,
                                            GetParam().search_radius);
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

INSTANTIATE_TEST_SUITE_P(Limits, Projective,
                         ::testing::Values(Limits{15, 3.2, 0}, Limits{1000, 0.7, 0}, Limits{30, 0.9, 0},
                                           Limits{30, 0.9, 3}, Limits{60, 3.2, 12}));

TEST(ProjectiveMatch, LooksAroundOnlyWhereTheProjectedPixelIsRejected) {
  Device device;
  SurfaceMap map{Image<Eigen::Vector3f>(camera.width, camera.height, Eigen::Vector3f::Zero()),
                 Image<Eigen::Vector3f>(camera.width, camera.height, Eigen::Vector3f::Zero())};
  map.points(24, 15) = camera.unproject(24, 15, 400).cast<float>();
  const Target target(camera, map);
  const Eigen::Vector3f point = camera.unproject(20, 15, 400).cast<float>();  // four pixels, 32 mm away
  const PointSet moved{Array<float>(std::vector<float>(point.data(), point.data() + 3)),
                       Array<float>(std::vector<float>{0, 0, 0})};
  Constraints constraints;
  constraints.points = Array<float>(moved.points.host());
  constraints.data = Array<float>(std::vector<float>(6));
  constraints.confidence = Array<float>(std::vector<float>(1));
  const Array<int> selected(std::vector<int>{0});
  ProjectiveCorrespondence(50, 1, 3).match(device, moved, selected, target, constraints);
  EXPECT_EQ(constraints.confidence.host()[0], 0) << "beyond the radius";
  ProjectiveCorrespondence(30, 1, 4).match(device, moved, selected, target, constraints);
  EXPECT_EQ(constraints.confidence.host()[0], 0) << "beyond the distance";
  ProjectiveCorrespondence(50, 1, 4).match(device, moved, selected, target, constraints);
  EXPECT_EQ(constraints.confidence.host()[0], 1);
  EXPECT_NEAR(constraints.data.host()[0], 32, 1e-3);
}

/// Device and reference measure alike; gives what was measured.
Residual expect_agreement(Device& device, const ProjectiveCorrespondence& projective, const Target& target,
                          const PointSet& moved) {
  ResidualMeter meter(device, projective, target, moved.points.size() / 3);
  std::vector<float> per_point;
  projective.measure_reference(moved, target, per_point);
  const Residual expected = sum_residuals_reference(target, moved.points, per_point);
  const Residual measured = meter.measure(moved);
  EXPECT_EQ(measured.matched, expected.matched);
  EXPECT_EQ(measured.landed, expected.landed);
  EXPECT_EQ(measured.lost, expected.lost);
  EXPECT_NEAR(measured.mean, expected.mean, 1e-4 * expected.mean);
  for (std::size_t i = 0; i < per_point.size(); ++i)
    EXPECT_NEAR(meter.per_point().host()[i], per_point[i], 1e-3) << "point " << i;
  return measured;
}

TEST_P(Projective, MeasuresLikeItsReference) {
  Device device;
  std::mt19937 random(5);
  const Target target = make_target(random);
  const PointSet moved = make_moved(random, 1111);
  const Residual residual = expect_agreement(
      device, {GetParam().max_distance, GetParam().max_angle, GetParam().search_radius}, target, moved);
  EXPECT_GT(residual.landed, 300);
  EXPECT_GT(residual.matched, 50);
  EXPECT_LT(residual.matched, residual.landed);
}

// A residual of what no constraint follows would ask for nodes where they can do nothing.
TEST(ResidualMeter, KnowsNothingWhereTheMatchIsRejected) {
  Device device;
  std::mt19937 random(5);
  const Target target = make_target(random);
  const PointSet moved = make_moved(random, 800);
  const ProjectiveCorrespondence projective(30, 0.9, 0);
  std::vector<int> all(800);
  std::iota(all.begin(), all.end(), 0);
  Constraints constraints;
  constraints.points = Array<float>(moved.points.host());
  constraints.data = Array<float>(std::vector<float>(6 * 800));
  constraints.confidence = Array<float>(std::vector<float>(800));
  projective.match(device, moved, Array<int>(all), target, constraints);
  ResidualMeter meter(device, projective, target, 800);
  meter.measure(moved);
  for (std::size_t i = 0; i < 800; ++i) {
    const Eigen::Map<const Eigen::Vector3f> pull(constraints.data.host().data() + 6 * i);
    const bool is_matched = constraints.confidence.host()[i] > 0;
    ASSERT_NEAR(meter.per_point().host()[i], is_matched ? pull.norm() : -1, 1e-3) << "point " << i;
  }
}

/// What is not finite in a target that was made by hand.
void spoil(Target& target, std::mt19937& random) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (auto* vectors : {&target.points, &target.normals})
    for (float& value : vectors->write_host())
      if (random() % 10 == 0) value = random() % 2 == 0 ? infinity : std::numeric_limits<float>::quiet_NaN();
}

TEST(ResidualMeter, PointsOfTheTargetThatAreNotFiniteCountAsNone) {
  Device device;
  std::mt19937 random(5);
  Target target = make_target(random);
  spoil(target, random);
  const Residual measured = expect_agreement(device, {1000, 1, 0}, target, make_moved(random, 1111));
  EXPECT_GT(measured.matched, 100);
  EXPECT_EQ(measured.lost, 0);
}

TEST(ProjectiveCorrespondence, TakesNothingFromTheTargetThatIsNotFinite) {
  Device device;
  std::mt19937 random(6);
  Target target = make_target(random);
  spoil(target, random);
  const PointSet moved = make_moved(random, 500);
  std::vector<int> all(500);
  std::iota(all.begin(), all.end(), 0);
  const Array<int> selected(all);
  Constraints found;
  found.points = Array<float>(moved.points.host());
  found.data = Array<float>(std::vector<float>(6 * 500));
  found.confidence = Array<float>(std::vector<float>(500));
  Constraints expected = found;
  for (const int radius : {0, 3}) {
    const ProjectiveCorrespondence correspondence(1e4, 1.5, radius);
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
  const Target target = make_target(random);
  PointSet moved = make_moved(random, 700);
  auto& values = moved.points.write_host();
  values[0] = std::numeric_limits<float>::quiet_NaN();
  values[1001] = std::numeric_limits<float>::infinity();
  values[2000] = 2e18F;
  EXPECT_EQ(expect_agreement(device, {1000, 1, 0}, target, moved).lost, 3);
}

TEST(ResidualMeter, IsZeroWhereNothingLands) {
  Device device;
  std::mt19937 random(5);
  const Target target = make_target(random);
  const ProjectiveCorrespondence projective(1000, 1, 0);
  ResidualMeter meter(device, projective, target, 1);
  const Residual residual =
      meter.measure({Array<float>(std::vector<float>{0, 0, -10}), Array<float>(std::vector<float>{0, 0, 0})});
  EXPECT_EQ(residual.landed, 0);
  EXPECT_EQ(residual.mean, 0);
  EXPECT_EQ(meter.per_point().host()[0], -1);
}

}  // namespace
}  // namespace pliant
