#include "framework/pose/align_features.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <future>
#include <memory>

#include "framework/core/error.h"
#include "framework/pose/color_features.h"
#include "framework/pose/feature_index.h"

namespace pliant {
namespace {

/// Throws DataError unless there is enough to align.
ColorFeatures find_features(const Frame& frame, const Camera& camera, double scale,
                            const std::string& which) {
  if (frame.color.empty())
    throw DataError(fmt::format("{}: alignment `features` needs a colour image", which));
  ColorFeatures features = find_color_features(frame, camera, scale);
  if (features.points.size() < 2)
    throw DataError(
        fmt::format("{}: {} colour features with depth, too few to align", which, features.points.size()));
  return features;
}

PointMatches match(ColorFeatures& source, ColorFeatures& target, double ratio) {
  FeatureIndex index(target.descriptors, target.points.size());
  const FeatureNeighbours found = index.nearest(source.descriptors, source.points.size(), 2);
  PointMatches matches;
  for (std::size_t i = 0; i < found.features.size(); ++i) {
    if (!(found.squared[i][0] < ratio * ratio * found.squared[i][1])) continue;
    const auto nearest = static_cast<std::size_t>(found.features[i][0]);
    matches.add(source.points[i], target.points[nearest],
                static_cast<float>(feature_confidence(std::max(source.radii[i], target.radii[nearest]))));
  }
  return matches;
}

/// Whether at least half of the matches nearest to match `i`, among `others`, keep their distance to it.
bool agrees_with_neighbours(const PointMatches& matches, const std::vector<std::size_t>& others,
                            std::size_t i) {
  constexpr std::size_t neighbours = 6;
  const auto distance = [&](std::size_t j) { return (matches.from[i] - matches.from[j]).norm(); };
  std::vector<std::size_t> nearest;
  for (const std::size_t j : others)
    if (j != i) nearest.push_back(j);
  const std::size_t count = std::min(neighbours, nearest.size());
  std::partial_sort(
      nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(count), nearest.end(),
      [&](std::size_t a, std::size_t b) { return std::pair(distance(a), a) < std::pair(distance(b), b); });
  std::size_t agreeing = 0;
  for (std::size_t n = 0; n < count; ++n) {
    const double before = distance(nearest[n]);
    const double after = (matches.to[i] - matches.to[nearest[n]]).norm();
    agreeing += std::abs(after - before) <= 5 + before / 4 ? 1 : 0;
  }
  return count > 0 && 2 * agreeing >= count;
}

class FeatureAlignment : public Alignment {
 public:
  explicit FeatureAlignment(const FeatureOptions& options) : options_(options) {}

  AlignmentResult align(const AlignmentInput& input) const override {
    AlignmentResult result = align_by_features(input.pair, options_, input.seed);
    if (result.inliers < options_.min_inliers)
      throw DataError(fmt::format("{}: {}, alignment needs at least {}", input.pair.name,
                                  agreement(result.inliers, result.matches), options_.min_inliers));
    result.method = "features";
    result.reason = agreement(result.inliers, result.matches);
    return result;
  }

 private:
  FeatureOptions options_;
};

}  // namespace

std::string agreement(int inliers, int matches) {
  return fmt::format("{} of {} feature matches agree on a rigid motion", inliers, matches);
}

PointMatches keep_deformable(const PointMatches& matches, const Eigen::Isometry3d& motion,
                             double max_deformation) {
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < matches.size(); ++i)
    if ((motion * matches.from[i] - matches.to[i]).norm() < max_deformation) near.push_back(i);
  PointMatches kept;
  for (const std::size_t i : near) {
    if (agrees_with_neighbours(matches, near, i))
      kept.add(matches.from[i], matches.to[i], matches.confidence[i]);
  }
  return kept;
}

double feature_confidence(double radius) {
  constexpr double precise_radius = 5;  // mm
  return std::min(1.0, std::pow(precise_radius / radius, 2));
}

PointMatches match_features(const FramePair& pair, double ratio, double least_scale) {
  constexpr double fewest_pixels = 6000;
  const double scale = scale_of_features(pair.source, least_scale, fewest_pixels);
  // Both at once: most of the detector runs on one processor only.
  auto found = std::async(std::launch::async, [&] {
    return find_features(pair.target, pair.camera, scale, pair.name + ", target");
  });
  ColorFeatures source = find_features(pair.source, pair.camera, scale, pair.name + ", source");
  ColorFeatures target = found.get();
  return match(source, target, ratio);
}

AlignmentResult align_by_features(const FramePair& pair, const FeatureOptions& options, std::uint64_t seed) {
  const PointMatches matches = match_features(pair, options.ratio, options.scale);
  AlignmentResult result = fit_rigid_ransac(matches, options.ransac, seed);
  result.features = keep_deformable(matches, result.motion, options.max_deformation);
  return result;
}

std::vector<Parameter> feature_rows() {
  const FeatureOptions defaults;
  return {
      real("scale", defaults.scale)
          .range(0.1, 1)
          .doc("Images are shrunk by this before features are looked for: half takes a quarter of the time; "
               "less where the object would be left with fewer than 6000 pixels"),
      real("ratio", defaults.ratio)
          .range(0.1, 1)
          .doc("Greatest ratio of a match's descriptor distance to that of the second best"),
      integer("iterations", defaults.ransac.iterations).range(1, 1000000).doc("Triples that RANSAC tries"),
      real("inlier_distance", defaults.ransac.inlier_distance)
          .unit("mm")
          .above(0)
          .doc("A match agrees with a motion that brings its points nearer than this"),
      integer("min_inliers", defaults.min_inliers)
          .range(3, 100000)
          .doc("With fewer agreeing matches there is no alignment"),
      real("max_deformation", defaults.max_deformation)
          .unit("mm")
          .above(0)
          .doc("Matches further than this from the rigid motion are no constraints of the energy `feature`"),
  };
}

FeatureOptions read_feature_options(const Parameters& section) {
  FeatureOptions options;
  options.scale = section.real("scale");
  options.ratio = section.real("ratio");
  options.min_inliers = static_cast<int>(section.integer("min_inliers"));
  options.max_deformation = section.real("max_deformation");
  options.ransac.iterations = static_cast<int>(section.integer("iterations"));
  options.ransac.inlier_distance = section.real("inlier_distance");
  return options;
}

void register_feature_alignment(Registry& registry) {
  registry.add<Alignment>(
      "features", "Rigid motion that most matches of colour features agree with [SIFT, FLANN, RANSAC]",
      ParameterTable(feature_rows()), [](const Parameters& parameters, const Registry&) {
        return std::make_unique<FeatureAlignment>(read_feature_options(parameters));
      });
}

}  // namespace pliant
