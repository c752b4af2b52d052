#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <random>
#include <unordered_map>

#include "framework/core/error.h"
#include "framework/imaging/depth_map.h"
#include "framework/pose/align_automatic.h"
#include "framework/pose/align_features.h"
#include "framework/pose/align_icp.h"
#include "framework/pose/alignments.h"

namespace pliant {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

Eigen::Isometry3d a_motion() {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.rotate(Eigen::AngleAxisd(0.2, Eigen::Vector3d(0.2, 0.3, 1).normalized()));
  motion.pretranslate(Eigen::Vector3d(40, -25, 30));
  return motion;
}

Eigen::Vector3d random_point(std::mt19937& random) {
  std::uniform_real_distribution<double> side(-300, 300);
  return {side(random), side(random), 1000 + side(random)};
}

PointMatches make_matches(int good, int bad) {
  std::mt19937 random(3);
  PointMatches matches;
  for (int i = 0; i < good + bad; ++i) {
    const Eigen::Vector3d from = random_point(random);
    matches.add(from, i < good ? a_motion() * from : random_point(random));
  }
  return matches;
}

TEST(RigidRansac, FindsTheExactMotionAmongHalfOutliers) {
  const AlignmentResult result = fit_rigid_ransac(make_matches(60, 60), {}, 1);
  EXPECT_TRUE(result.motion.matrix().isApprox(a_motion().matrix(), 1e-9)) << result.motion.matrix();
  EXPECT_EQ(result.matches, 120);
  EXPECT_EQ(result.inliers, 60);
}

TEST(RigidRansac, FindsTheMotionOfATenth) {
  const AlignmentResult result = fit_rigid_ransac(make_matches(20, 180), {}, 1);
  EXPECT_TRUE(result.motion.matrix().isApprox(a_motion().matrix(), 1e-2)) << result.motion.matrix();
  EXPECT_GE(result.inliers, 20);
}

/// Three noisy matches alone tilt the motion; all of them together must not.
TEST(RigidRansac, FitsToAllInliers) {
  PointMatches matches = make_matches(400, 100);
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 5);
  for (Eigen::Vector3d& point : matches.to)
    point += Eigen::Vector3d(noise(random), noise(random), noise(random));
  const AlignmentResult one_triple = fit_rigid_ransac(matches, {.iterations = 20}, 1);
  const Eigen::Vector3d corner(300, 300, 1300);
  EXPECT_LT((one_triple.motion * corner - a_motion() * corner).norm(), 1.5);
  EXPECT_GE(one_triple.inliers, 395);
}

TEST(RigidRansac, NeedsATriangle) {
  EXPECT_EQ(fit_rigid_ransac(make_matches(2, 0), {}, 1).inliers, 0);
  PointMatches line;
  for (int i = 0; i < 50; ++i) line.add({10.0 * i, 0, 1000}, {10.0 * i, 0, 1000});
  const AlignmentResult result = fit_rigid_ransac(line, {}, 1);
  EXPECT_EQ(result.inliers, 0);
  EXPECT_TRUE(result.motion.matrix().isIdentity());
}

TEST(RigidRansac, SameSeedSameBits) {
  const PointMatches matches = make_matches(30, 170);
  const RansacOptions few{.iterations = 100};
  EXPECT_EQ(fit_rigid_ransac(matches, few, 7).motion.matrix(),
            fit_rigid_ransac(matches, few, 7).motion.matrix());
  bool seed_matters = false;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    seed_matters |= fit_rigid_ransac(matches, few, seed).motion.matrix() !=
                    fit_rigid_ransac(matches, few, 7).motion.matrix();
  }
  EXPECT_TRUE(seed_matters);
}

// --- a plane with a random pattern, seen before and after a rigid motion ---

const Camera pattern_camera{300, 300, 159.5, 119.5, 320, 240};

double lattice_value(std::int64_t x, std::int64_t y, std::uint64_t pattern) {
  const std::uint64_t seed =
      pattern + 1000003 * static_cast<std::uint64_t>(x + 5000) + static_cast<std::uint64_t>(y + 5000);
  // Every pixel asks for four of few: setting up a generator each time took most of the test.
  static std::unordered_map<std::uint64_t, double> values;
  const auto [value, is_new] = values.try_emplace(seed);
  if (is_new) value->second = static_cast<double>(std::mt19937_64(seed)() % 1000) / 1000;
  return value->second;
}

/// Smooth random brightness over the plane, in 0 .. 1; `x`, `y` and `cell` in mm.
double brightness(double x, double y, double cell, std::uint64_t pattern) {
  const double i = std::floor(x / cell);
  const double j = std::floor(y / cell);
  const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
  const double s = smooth(x / cell - i);
  const double t = smooth(y / cell - j);
  const auto at = [&](int di, int dj) {
    return lattice_value(static_cast<std::int64_t>(i) + di, static_cast<std::int64_t>(j) + dj, pattern);
  };
  return (1 - s) * (1 - t) * at(0, 0) + s * (1 - t) * at(1, 0) + (1 - s) * t * at(0, 1) + s * t * at(1, 1);
}

Frame render_plane(const Eigen::Isometry3d& motion, std::uint64_t pattern) {
  const Eigen::Vector3d origin = motion * Eigen::Vector3d(0, 0, 800);
  const Eigen::Vector3d normal = motion.linear() * Eigen::Vector3d::UnitZ();
  Frame frame{DepthImage(320, 240), ColorImage(320, 240), {}};
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      const Eigen::Vector3d ray = pattern_camera.unproject(u, v, 1);
      const double depth = origin.dot(normal) / ray.dot(normal);
      const Eigen::Vector3d at = motion.inverse() * (depth * ray);
      const double value =
          0.5 * brightness(at.x(), at.y(), 15, pattern) + 0.5 * brightness(at.x(), at.y(), 40, pattern + 1);
      frame.depth(u, v) = static_cast<float>(depth);
      const auto grey = static_cast<std::uint8_t>(255 * value);
      frame.color(u, v) = {grey, grey, grey};
    }
  }
  return frame;
}

FramePair moved_plane() {
  static const FramePair pair{"plane", pattern_camera, render_plane(Eigen::Isometry3d::Identity(), 11),
                              render_plane(a_motion(), 11)};
  return pair;
}

AlignmentResult align(const Alignment& alignment, const FramePair& pair, std::uint64_t seed,
                      bool wants_features) {
  static Device device;  // its kernels are built once
  const DepthMap depth(pair.source);
  const SurfaceMap source = make_surface_map(device, depth, pair.camera);
  const SurfaceMap target = make_surface_map(device, DepthMap(pair.target), pair.camera);
  return alignment.align(
      {pair, device, source, Array<int>(pixels_with_depth(depth)), target, seed, wants_features});
}

std::unique_ptr<Alignment> make_features(std::int64_t min_inliers = 8) {
  Registry registry;
  register_alignments(registry);
  return registry.make<Alignment>(Parameters("features", {{"scale", 1.0},
                                                          {"ratio", 0.85},
                                                          {"iterations", std::int64_t{2000}},
                                                          {"inlier_distance", 30.0},
                                                          {"min_inliers", min_inliers},
                                                          {"max_deformation", 120.0}}));
}

TEST(FeatureAlignment, FindsHowAPlaneMoved) {
  const AlignmentResult result = align(*make_features(), moved_plane(), 1, true);
  EXPECT_GE(result.inliers, 30);
  for (const Eigen::Vector3d& corner : {Eigen::Vector3d(-300, -200, 800), Eigen::Vector3d(300, 200, 800)}) {
    EXPECT_LT((result.motion * corner - a_motion() * corner).norm(), 2);
  }
}

TEST(FeatureAlignment, FindsFewerFeaturesOfTheSamePlacesInShrunkImages) {
  const PointMatches whole = match_features(moved_plane(), 0.85);
  const PointMatches half = match_features(moved_plane(), 0.85, 0.5);
  EXPECT_GE(half.size(), 20u);
  EXPECT_LT(half.size(), whole.size());
  std::vector<double> errors;
  for (std::size_t i = 0; i < half.size(); ++i)
    errors.push_back((a_motion() * half.from[i] - half.to[i]).norm());
  std::nth_element(errors.begin(), errors.begin() + std::ssize(errors) / 2, errors.end());
  EXPECT_LT(errors[errors.size() / 2], 1) << "mm, the median; half a pixel is 1.3 mm";
}

TEST(FeatureAlignment, DoesNotShrinkWhatCoversFewPixels) {
  FramePair small = moved_plane();
  small.source.mask = MaskImage(320, 240, 0);
  for (int v = 80; v < 150; ++v)
    for (int u = 120; u < 200; ++u) small.source.mask(u, v) = 1;
  EXPECT_GE(match_features(small, 0.85).size(), 4u);
  EXPECT_EQ(match_features(small, 0.85, 0.25).from, match_features(small, 0.85).from);
}

/// The greatest distance of a match's source point from the plane at 800 mm that 9 of 10 stay below.
double distance_of_most(const PointMatches& matches) {
  std::vector<double> distances;
  for (const Eigen::Vector3d& point : matches.from) distances.push_back(std::abs(point.z() - 800));
  const auto most = distances.begin() + std::ssize(distances) * 9 / 10;
  std::nth_element(distances.begin(), most, distances.end());
  return *most;
}

TEST(FeatureAlignment, AveragesTheNoiseOfDepth) {
  FramePair noisy = moved_plane();
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0, 5);
  for (int v = 0; v < 240; ++v)
    for (int u = 0; u < 320; ++u) noisy.source.depth(u, v) += noise(random);
  EXPECT_LT(distance_of_most(match_features(moved_plane(), 0.85)), 1e-3);
  EXPECT_LT(distance_of_most(match_features(noisy, 0.85)), 3) << "mm; a single pixel's: 8";
}

TEST(FeatureAlignment, TakesNoDepthFromWhatLiesBehind) {
  FramePair stepped = moved_plane();
  for (int v = 0; v < 240; ++v)
    for (int u = 160; u < 320; ++u) stepped.source.depth(u, v) = 1200;
  for (const Eigen::Vector3d& point : match_features(stepped, 0.85).from)
    EXPECT_LT(std::min(std::abs(point.z() - 800), std::abs(point.z() - 1200)), 1e-3);
}

TEST(FeatureAlignment, TrustsAFeatureByTheInverseSquareOfItsRadius) {
  EXPECT_EQ(feature_confidence(1), 1);
  EXPECT_EQ(feature_confidence(5), 1);
  EXPECT_DOUBLE_EQ(feature_confidence(10), 0.25);
  EXPECT_DOUBLE_EQ(feature_confidence(50), 0.01);
}

TEST(FeatureAlignment, TrustsFeaturesOfShrunkImagesLess) {
  const auto mean_confidence = [](const PointMatches& matches) {
    double sum = 0;
    for (const float confidence : matches.confidence) sum += confidence;
    return sum / static_cast<double>(matches.confidence.size());
  };
  const PointMatches whole = match_features(moved_plane(), 0.85);
  ASSERT_EQ(whole.confidence.size(), whole.size());
  EXPECT_GT(mean_confidence(whole), 1.2 * mean_confidence(match_features(moved_plane(), 0.85, 0.5)));
}

TEST(FeatureAlignment, GivesTheMatchesThatGoWithTheMotion) {
  const AlignmentResult result = align_by_features(moved_plane(), {}, 1);
  EXPECT_GE(result.features.size(), static_cast<std::size_t>(0.8 * result.inliers));
  EXPECT_LE(result.features.size(), static_cast<std::size_t>(result.matches));
  for (std::size_t i = 0; i < result.features.size(); ++i)
    EXPECT_LT((result.motion * result.features.from[i] - result.features.to[i]).norm(), 120);
}

TEST(FeatureAlignment, SameSeedSameBits) {
  const AlignmentResult first = align(*make_features(), moved_plane(), 5, true);
  const AlignmentResult second = align(*make_features(), moved_plane(), 5, true);
  EXPECT_EQ(first.motion.matrix(), second.motion.matrix());
  EXPECT_EQ(first.inliers, second.inliers);
}

TEST(FeatureAlignment, UsesOnlyTheMaskAndPixelsWithDepth) {
  FramePair pair = moved_plane();
  pair.source.mask = MaskImage(320, 240, 1);
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 160; ++u) pair.source.mask(u, v) = 0;
    for (int u = 160; u < 200; ++u) pair.source.depth(u, v) = 0;
  }
  const PointMatches matches = match_features(pair, 0.85);
  EXPECT_GT(matches.size(), 10u);
  for (const Eigen::Vector3d& point : matches.from) EXPECT_GT(pattern_camera.project(point).x(), 198);
}

TEST(FeatureAlignment, NeedsColor) {
  FramePair pair = moved_plane();
  pair.target.color = {};
  EXPECT_THAT([&] { align(*make_features(), pair, 1, true); },
              ThrowsMessage<DataError>(AllOf(HasSubstr("plane, target"), HasSubstr("colour image"))));
}

TEST(FeatureAlignment, NeedsFeatures) {
  FramePair pair = moved_plane();
  pair.source.color = ColorImage(320, 240, Rgb{90, 90, 90});
  EXPECT_THAT([&] { align(*make_features(), pair, 1, true); },
              ThrowsMessage<DataError>(AllOf(HasSubstr("plane, source"), HasSubstr("0 colour features"))));
}

TEST(FeatureAlignment, NeedsInliersAndSaysHowManyThereAre) {
  const int inliers = align(*make_features(), moved_plane(), 1, true).inliers;
  EXPECT_THAT([&] { align(*make_features(inliers + 1), moved_plane(), 1, true); },
              ThrowsMessage<DataError>(AllOf(HasSubstr("plane: " + std::to_string(inliers) + " of "),
                                             HasSubstr("at least " + std::to_string(inliers + 1)))));
}

TEST(FeatureAlignment, RefusesUnrelatedImages) {
  FramePair pair = moved_plane();
  pair.target = render_plane(a_motion(), 77);
  EXPECT_THROW(align(*make_features(), pair, 1, true), DataError);
}

Parameters icp_parameters(const std::string& component) {
  return {component,
          {{"max_distance", 10.0},
           {"max_angle", 20.0},
           {"step", std::int64_t{1}},
           {"levels", std::int64_t{4}},
           {"iterations", std::int64_t{10}},
           {"coarse_distance", 1.0},
           {"coarse_angle", 75.0},
           {"trim", 2.5},
           {"search_angle", 30.0}}};
}

std::unique_ptr<Alignment> make_icp() {
  Registry registry;
  register_alignments(registry);
  return registry.make<Alignment>(icp_parameters("icp"));
}

/// A plane out of which a bump grows.
FramePair bulging_plane() {
  FramePair pair = moved_plane();
  pair.target.depth = pair.source.depth;
  pair.target.color = {};
  for (int v = 0; v < 240; ++v)
    for (int u = 0; u < 320; ++u)
      pair.target.depth(u, v) -=
          static_cast<float>(25 * std::exp(-(std::pow(u - 200, 2) + std::pow(v - 100, 2)) / 1800.0));
  return pair;
}

TEST(IcpAlignment, FindsHowAPlaneTurned) {
  const AlignmentResult result = align(*make_icp(), moved_plane(), 1, false);
  EXPECT_EQ(result.method, "icp");
  EXPECT_THAT(result.reason, HasSubstr("two-way residual"));
  const Eigen::Vector3d normal = a_motion().linear() * Eigen::Vector3d::UnitZ();
  EXPECT_GT(normal.dot(result.motion.linear() * Eigen::Vector3d::UnitZ()), 0.9999);
}

TEST(IcpAlignment, StaysWhereThingsOnlyDeform) {
  const AlignmentResult result = align(*make_icp(), bulging_plane(), 1, false);
  EXPECT_EQ(result.method, "none");
  EXPECT_TRUE(result.motion.matrix().isIdentity(0));
  EXPECT_THAT(result.reason, HasSubstr("not clearly nearer"));
}

TEST(IcpAlignment, NeedsATarget) {
  FramePair pair = moved_plane();
  pair.target.depth = DepthImage(320, 240);
  EXPECT_THAT([&] { align(*make_icp(), pair, 1, false); },
              ThrowsMessage<DataError>(AllOf(HasSubstr("plane: alignment `icp` failed"),
                                             HasSubstr("0 of 76800 points have a match"))));
}

std::unique_ptr<Alignment> make_automatic() {
  Registry registry;
  register_alignments(registry);
  return registry.make<Alignment>(
      Parameters("automatic", {{"icp", Parameters::Sections{{"icp", icp_parameters("")}}, true},
                               {"near_enough", 20.0},
                               {"scale", 1.0},
                               {"ratio", 0.85},
                               {"iterations", std::int64_t{2000}},
                               {"inlier_distance", 30.0},
                               {"min_inliers", std::int64_t{8}},
                               {"max_deformation", 120.0}}));
}

TEST(AutomaticAlignment, MovesWhereFeaturesBringTheSourceNearer) {
  const AlignmentResult result = align(*make_automatic(), moved_plane(), 1, true);
  EXPECT_EQ(result.method.substr(0, 8), "features");
  for (const Eigen::Vector3d& corner : {Eigen::Vector3d(-300, -200, 800), Eigen::Vector3d(300, 200, 800)})
    EXPECT_LT((result.motion * corner - a_motion() * corner).norm(), 2);
  EXPECT_GT(result.features.size(), 10u);
}

TEST(IcpAlignment, TellsAnyGainFromAClearOne) {
  RigidIcpResult result;
  result.before.mean = 10;
  result.after.mean = 9;
  EXPECT_TRUE(is_nearer(result));
  EXPECT_FALSE(is_clearly_nearer(result));
  result.after.mean = 10;
  EXPECT_FALSE(is_nearer(result));
  result.after.mean = 1;
  result.failed = true;
  EXPECT_FALSE(is_nearer(result));
}

TEST(AutomaticAlignment, LooksForNoFeaturesThatNobodyNeeds) {
  FramePair near = moved_plane();
  near.target = render_plane(Eigen::Isometry3d(Eigen::Translation3d(0, 0, 15)), 11);
  EXPECT_GT(align(*make_automatic(), near, 1, true).matches, 10);
  const AlignmentResult result = align(*make_automatic(), near, 1, false);
  EXPECT_EQ(result.matches, 0);
  EXPECT_EQ(result.method, "icp");
  EXPECT_THAT(result.reason, HasSubstr("no need of features"));
  EXPECT_GT(align(*make_automatic(), moved_plane(), 1, false).matches, 10) << "too far away to stay";
}

TEST(AutomaticAlignment, GoesByDepthWithoutColorTextureOrAgreementAndSaysWhy) {
  FramePair colorless = moved_plane();
  colorless.target.color = {};
  FramePair plain = moved_plane();
  plain.source.color = ColorImage(320, 240, Rgb{90, 90, 90});
  FramePair unrelated = moved_plane();
  unrelated.target = render_plane(a_motion(), 77);
  const std::pair<const FramePair*, const char*> cases[] = {{&colorless, "no features without colour"},
                                                            {&plain, "0 colour features"},
                                                            {&unrelated, "fewer than 8"}};
  for (const auto& [pair, why] : cases) {
    const AlignmentResult result = align(*make_automatic(), *pair, 1, true);
    EXPECT_EQ(result.method, "icp");
    EXPECT_THAT(result.reason, AllOf(HasSubstr(why), HasSubstr("ICP: two-way residual")));
    EXPECT_EQ(result.features.size(), 0u);
    const Eigen::Vector3d normal = a_motion().linear() * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d middle(0, 0, 800);
    EXPECT_LT(std::abs(normal.dot(result.motion * middle - a_motion() * middle)), 1);
    EXPECT_GT(normal.dot(result.motion.linear() * Eigen::Vector3d::UnitZ()), 0.9999);
  }
}

TEST(AutomaticAlignment, FailsWhereItIsFarAndFindsNothing) {
  FramePair pair = bulging_plane();
  for (int v = 0; v < 240; ++v)
    for (int u = 0; u < 320; ++u) pair.target.depth(u, v) = (u / 40 + v / 40) % 2 == 0 ? 500.0F : 3000.0F;
  const AlignmentResult result = align(*make_automatic(), pair, 1, false);
  EXPECT_EQ(result.method, "none") << result.reason;
  EXPECT_TRUE(result.failed);
}

TEST(AutomaticAlignment, StaysWhereThingsOnlyDeform) {
  const AlignmentResult result = align(*make_automatic(), bulging_plane(), 1, false);
  EXPECT_FALSE(result.failed);
  EXPECT_EQ(result.method, "none");
  EXPECT_TRUE(result.motion.matrix().isIdentity(0));
  EXPECT_THAT(result.reason, AllOf(HasSubstr("no features without colour"), HasSubstr("not clearly nearer")));
}

// Slid out of view along itself, the plane lies no nearer for being brought back.
TEST(AutomaticAlignment, KeepsOnlyFeaturesThatADeformationCouldHaveMadeOfWhereItStays) {
  const auto slid = [](double distance) {
    FramePair pair = moved_plane();
    pair.target = render_plane(Eigen::Isometry3d(Eigen::Translation3d(distance, 0, 0)), 11);
    return align(*make_automatic(), pair, 1, true);
  };
  const AlignmentResult near = slid(60);
  EXPECT_TRUE(near.motion.matrix().isIdentity(0));
  EXPECT_GT(near.features.size(), 10u);
  const AlignmentResult far = slid(150);  // beyond max_deformation
  EXPECT_TRUE(far.motion.matrix().isIdentity(0));
  for (std::size_t i = 0; i < far.features.size(); ++i)
    EXPECT_LT((far.motion * far.features.from[i] - far.features.to[i]).norm(), 120);
}

// Of 8 x 5 pixels it looks at (2, 2), seen straight ahead, and (6, 2).
TEST(CutResidual, OfTwoPixelsByHand) {
  FramePair pair;
  pair.camera = {100, 100, 2, 2, 8, 5};
  pair.source.depth = DepthImage(8, 5);
  pair.target.depth = DepthImage(8, 5, 530);
  const auto stay = Eigen::Isometry3d::Identity();
  EXPECT_EQ(cut_residual(pair, stay), 100) << "no point of the source";
  pair.source.depth(2, 2) = 500;
  EXPECT_NEAR(cut_residual(pair, stay), 30, 1e-9);
  EXPECT_NEAR(cut_residual(pair, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 10))), 20, 1e-9);
  EXPECT_NEAR(cut_residual(pair, stay, 25), 25, 1e-9);
  pair.source.depth(6, 2) = 500;  // at (20, 0, 500); its pixel's target at (21.2, 0, 530)
  EXPECT_NEAR(cut_residual(pair, stay), (30 + std::hypot(1.2, 30)) / 2, 1e-9);
  pair.target.depth(2, 2) = 0;
  EXPECT_NEAR(cut_residual(pair, stay), (100 + std::hypot(1.2, 30)) / 2, 1e-9);
  pair.source.mask = MaskImage(8, 5, 1);
  pair.source.mask(2, 2) = 0;
  EXPECT_NEAR(cut_residual(pair, stay), std::hypot(1.2, 30), 1e-9);
  pair.target.mask = MaskImage(8, 5);
  EXPECT_EQ(cut_residual(pair, stay), 100);
  pair.target.mask = {};
  EXPECT_EQ(cut_residual(pair, Eigen::Isometry3d(Eigen::Translation3d(0, 0, -600))), 100) << "behind";
  EXPECT_EQ(cut_residual(pair, Eigen::Isometry3d(Eigen::Translation3d(90, 0, 0))), 100) << "outside";
}

TEST(CutResidual, IsTheMeanDistanceAndCountsMissesInFull) {
  FramePair pair;
  pair.camera = {100, 100, 16, 16, 32, 32};
  pair.source.depth = DepthImage(32, 32, 500);
  pair.target.depth = DepthImage(32, 32, 510);
  const double obliqueness = std::hypot(1.0, 0.15);  // of the ray furthest out
  const double residual = cut_residual(pair, Eigen::Isometry3d::Identity());
  EXPECT_GE(residual, 10);
  EXPECT_LE(residual, 10 * obliqueness * obliqueness);
  pair.target.depth = DepthImage(32, 32, 0);
  EXPECT_EQ(cut_residual(pair, Eigen::Isometry3d::Identity(), 40), 40);
}

/// A sheet of paper that is rolled: neighbours keep their distance.
PointMatches rolled_sheet() {
  PointMatches matches;
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) {
      const double s = 20.0 * i;
      matches.add({s, 20.0 * j, 800},
                  {150 * std::sin(s / 150), 20.0 * j, 800 - 150 * (1 - std::cos(s / 150))});
    }
  }
  return matches;
}

TEST(KeepDeformable, KeepsABendingSheetWhole) {
  EXPECT_EQ(keep_deformable(rolled_sheet(), Eigen::Isometry3d::Identity(), 200).size(), 100u);
}

TEST(KeepDeformable, DropsMatchesThatFlyOffTheSurface) {
  PointMatches matches = rolled_sheet();
  matches.to[44] += Eigen::Vector3d(0, 60, 0);    // within reach, but away from its neighbours
  matches.to[77] += Eigen::Vector3d(0, 0, 1000);  // out of reach
  matches.confidence[99] = 0.5F;
  const PointMatches kept = keep_deformable(matches, Eigen::Isometry3d::Identity(), 200);
  EXPECT_EQ(kept.size(), 98u);
  EXPECT_EQ(kept.confidence.size(), 98u);
  EXPECT_EQ(kept.confidence.back(), 0.5F) << "goes with its match";
  for (const auto& point : kept.from) {
    EXPECT_NE(point, matches.from[44]);
    EXPECT_NE(point, matches.from[77]);
  }
}

TEST(NoAlignment, LeavesTheSourceWhereItIs) {
  Registry registry;
  register_alignments(registry);
  const AlignmentResult result =
      align(*registry.make<Alignment>(Parameters("none", {})), moved_plane(), 1, true);
  EXPECT_TRUE(result.motion.matrix().isIdentity(0));
  EXPECT_EQ(result.matches, 0);
}

}  // namespace
}  // namespace pliant
