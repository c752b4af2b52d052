#include "framework/pose/features_relocalizer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "framework/core/angle.h"
#include "framework/geometry/color_at_depth.h"
#include "framework/pose/color_features.h"
#include "framework/pose/surface_features.h"

namespace pliant {
namespace {

constexpr int most_candidates = 4;  // of each kind of features

/// What of a frame the surface is seen of, colour at its pixels.
Frame shown(const Frame& frame, const Rig& rig, const SurfaceMap& seen) {
  Frame part;
  part.color = color_at_depth(frame, rig);
  part.depth = DepthImage(seen.camera.width, seen.camera.height, 0);
  const PixelWindow& window = seen.window;
  for (int v = window.top; v < window.top + window.height; ++v)
    for (int u = window.left; u < window.left + window.width; ++u)
      part.depth(u, v) = finite_or_none(seen.points(), window.offset(u, v)).z();
  return part;
}

/// Of the object as a frame shows it, in an image where it has so many `pixels` at most; empty without
/// colour.
ModelFeatures color_features(const Frame& frame, const Rig& rig, const SurfaceMap& seen, double pixels) {
  if (frame.color.empty()) return {};
  constexpr double least_scale = 0.05;
  const Frame part = shown(frame, rig, seen);
  ColorFeatures found = find_color_features(part, seen.camera, scale_of_features(part, least_scale, pixels));
  return {std::move(found.descriptors), std::move(found.points)};
}

ModelFeatures surface_features(const SurfaceMap& seen) {
  SurfaceFeatures found = find_surface_features(seen);
  return {std::move(found.descriptors), std::move(found.points)};
}

void move(ModelFeatures& features, const Eigen::Isometry3d& motion) {
  for (Eigen::Vector3d& point : features.points) point = motion * point;
}

/// Whether the nearest feature is nearer by `ratio` than any that lies elsewhere on the model: the same
/// place is in many keyframes.
bool is_distinct(const std::vector<int>& features, const std::vector<float>& squared,
                 const std::vector<Eigen::Vector3d>& points, double ratio) {
  constexpr double elsewhere = 20;  // mm
  const auto point = [&](std::size_t i) { return points[static_cast<std::size_t>(features[i])]; };
  for (std::size_t i = 1; i < features.size(); ++i)
    if ((point(i) - point(0)).norm() > elsewhere) return squared[0] < ratio * ratio * squared[i];
  return true;
}

/// The poses that most matches agree on, each of those that agree with none before; the best first.
std::vector<AlignmentResult> poses_of(PointMatches matches, const FeaturesRelocalizerOptions& options,
                                      int min_inliers) {
  std::vector<AlignmentResult> poses;
  for (int i = 0; i < most_candidates; ++i) {
    AlignmentResult found = fit_rigid_ransac(matches, options.ransac, options.seed);
    if (found.inliers < min_inliers) break;
    PointMatches rest;
    for (std::size_t m = 0; m < matches.size(); ++m)
      if ((found.motion * matches.from[m] - matches.to[m]).norm() >= options.ransac.inlier_distance)
        rest.add(matches.from[m], matches.to[m]);
    matches = std::move(rest);
    poses.push_back(std::move(found));
  }
  std::stable_sort(poses.begin(), poses.end(),
                   [](const AlignmentResult& a, const AlignmentResult& b) { return a.inliers > b.inliers; });
  return poses;
}

}  // namespace

FeaturesRelocalizer::FeaturesRelocalizer(const Rig& rig, const FeaturesRelocalizerOptions& options)
    : rig_(rig), options_(options) {}

void FeaturesRelocalizer::remember(const Frame& frame, const SurfaceMap& seen,
                                   const Eigen::Isometry3d& camera_from_model) {
  const Eigen::Isometry3d model_from_camera = camera_from_model.inverse();
  if (!keyframes_) {
    const auto middle = middle_of(seen);
    if (!middle) return;
    keyframes_.emplace(options_.keyframes, model_from_camera * *middle);
  }
  if (!keyframes_->wants(camera_from_model)) return;
  Keyframe keyframe{camera_from_model, color_features(frame, rig_, seen, options_.pixels),
                    surface_features(seen)};
  move(keyframe.color, model_from_camera);
  move(keyframe.surface, model_from_camera);
  keyframes_->add(std::move(keyframe));
  is_gathered_ = false;
}

void FeaturesRelocalizer::gather() {
  const auto renew = [](Known& known) {
    known.index.reset();
    if (!known.features.points.empty())
      known.index = std::make_unique<FeatureIndex>(known.features.descriptors, known.features.points.size());
  };
  color_.features = {};
  surface_.features = {};
  for (const Keyframe& keyframe : keyframes_->all()) {
    color_.features.append(keyframe.color);
    surface_.features.append(keyframe.surface);
  }
  renew(color_);
  renew(surface_);
  is_gathered_ = true;
}

std::vector<AlignmentResult> FeaturesRelocalizer::by_color(const Frame& frame, const SurfaceMap& seen) const {
  constexpr int neighbours = 8;
  ModelFeatures features = color_features(frame, rig_, seen, options_.pixels);
  if (!color_.index || features.points.empty()) return {};
  const auto found = color_.index->nearest(features.descriptors, features.points.size(), neighbours);
  const auto& known = color_.features.points;
  PointMatches matches;
  for (std::size_t i = 0; i < features.points.size(); ++i)
    if (is_distinct(found.features[i], found.squared[i], known, options_.ratio))
      matches.add(known[static_cast<std::size_t>(found.features[i][0])], features.points[i]);
  return poses_of(std::move(matches), options_, options_.min_inliers);
}

std::vector<AlignmentResult> FeaturesRelocalizer::by_surface(const SurfaceMap& seen) const {
  constexpr int neighbours = 3;
  ModelFeatures features = surface_features(seen);
  if (!surface_.index || features.points.empty()) return {};
  const auto found = surface_.index->nearest(features.descriptors, features.points.size(), neighbours);
  PointMatches matches;
  for (std::size_t i = 0; i < features.points.size(); ++i)
    for (const int other : found.features[i])
      matches.add(surface_.features.points[static_cast<std::size_t>(other)], features.points[i]);
  return poses_of(std::move(matches), options_, 3);
}

std::vector<Eigen::Isometry3d> FeaturesRelocalizer::candidates(const Frame& frame, const SurfaceMap& seen) {
  if (!keyframes_) return {};
  if (!is_gathered_) gather();
  std::vector<AlignmentResult> poses = by_color(frame, seen);
  if (poses.empty() || poses.front().inliers < options_.enough) {
    const auto more = by_surface(seen);
    poses.insert(poses.end(), more.begin(), more.end());
  }
  std::vector<Eigen::Isometry3d> starts;
  for (const AlignmentResult& pose : poses) starts.push_back(pose.motion);
  return starts;
}

namespace {

class FeaturesRelocalizerKind : public RelocalizerKind {
 public:
  explicit FeaturesRelocalizerKind(const FeaturesRelocalizerOptions& options) : options_(options) {}
  std::unique_ptr<Relocalizer> make(Device&, const Rig& rig) const override {
    return std::make_unique<FeaturesRelocalizer>(rig, options_);
  }

 private:
  FeaturesRelocalizerOptions options_;
};

ParameterTable features_table() {
  const FeaturesRelocalizerOptions options;
  return {
      integer("keyframes", options.keyframes.most)
          .range(2, 1000)
          .doc("are kept at most; then the older of the two nearest to each other goes"),
      real("keyframe_distance", options.keyframes.distance)
          .unit("mm")
          .above(0)
          .doc("the model's middle moves from one keyframe to the next"),
      real("keyframe_angle", whole_degrees(options.keyframes.angle))
          .unit("degree")
          .above(0)
          .doc("or the model turns"),
      real("pixels", options.pixels)
          .unit("pixel")
          .range(100, 1e7)
          .doc("of the object at most in the image where colour features are looked for: it is shrunk, which "
               "makes a keyframe faster and of fewer features"),
      real("ratio", options.ratio)
          .range(0.1, 1)
          .doc("greatest ratio of a colour match's descriptor distance to that of the nearest elsewhere"),
      integer("min_inliers", options.min_inliers)
          .range(3, 100000)
          .doc("with fewer agreeing colour features there is no pose"),
      integer("enough", options.enough).range(3, 100000).doc("with fewer the surface's form is asked, too"),
      integer("iterations", options.ransac.iterations).range(1, 1000000).doc("triples that RANSAC tries"),
      real("inlier_distance", options.ransac.inlier_distance)
          .unit("mm")
          .above(0)
          .doc("a match agrees with a pose that brings its points nearer than this"),
      integer("seed", static_cast<std::int64_t>(options.seed)).at_least(0).doc("of RANSAC"),
  };
}

FeaturesRelocalizerOptions read_features(const Parameters& section) {
  FeaturesRelocalizerOptions options;
  options.keyframes.most = static_cast<int>(section.integer("keyframes"));
  options.keyframes.distance = section.real("keyframe_distance");
  options.keyframes.angle = section.real("keyframe_angle") * degree;
  options.pixels = section.real("pixels");
  options.ratio = section.real("ratio");
  options.min_inliers = static_cast<int>(section.integer("min_inliers"));
  options.enough = static_cast<int>(section.integer("enough"));
  options.ransac.iterations = static_cast<int>(section.integer("iterations"));
  options.ransac.inlier_distance = section.real("inlier_distance");
  options.seed = static_cast<std::uint64_t>(section.integer("seed"));
  return options;
}

}  // namespace

void register_features_relocalizer(Registry& registry) {
  registry.add<RelocalizerKind>(
      "features",
      "By features of colour or, where it has few, of the surface's form, against keyframes [SIFT, FPFH, "
      "FLANN, RANSAC]",
      features_table(), [](const Parameters& section, const Registry&) {
        return std::make_unique<FeaturesRelocalizerKind>(read_features(section));
      });
}

}  // namespace pliant
