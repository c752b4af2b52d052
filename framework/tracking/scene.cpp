#include "framework/tracking/scene.h"

#include <cmath>
#include <optional>
#include <utility>

#include "framework/core/error.h"
#include "framework/core/stopwatch.h"
#include "framework/imaging/bilateral.h"
#include "framework/imaging/depth_map.h"

namespace pliant {
namespace {

DepthMap make_depth_map(const Frame& frame, StageTimes& times) {
  return timed(times, "surface", [&] { return DepthMap(frame); });
}

PointSet make_map(const DepthMap& given, const std::optional<DepthMap>& filtered, const Camera& camera,
                  Device& device) {
  return make_surface_map(device, filtered ? *filtered : given, camera);
}

Surface read_surface(const PointSet& set, const std::vector<int>& pixels, const Frame& frame) {
  const int width = frame.depth.width();
  Surface surface{unflatten(set.points), unflatten(set.normals), {}, {}};
  surface.pixels.reserve(pixels.size());
  for (const int pixel : pixels) surface.pixels.emplace_back(pixel % width, pixel / width);
  if (frame.color.empty()) return surface;
  surface.colors.reserve(pixels.size());
  for (const int pixel : pixels) surface.colors.push_back(frame.color.data()[pixel]);
  return surface;
}

std::vector<Eigen::Vector3f> unprojected(const std::vector<Eigen::Vector2i>& pixels, const FramePair& pair) {
  std::vector<Eigen::Vector3f> points;
  points.reserve(pixels.size());
  for (const Eigen::Vector2i& pixel : pixels)
    points.push_back(
        pair.camera.unproject(pixel.x(), pixel.y(), pair.source.depth(pixel.x(), pixel.y())).cast<float>());
  return points;
}

std::vector<Eigen::Vector3f> moved_by(const Eigen::Isometry3d& motion, std::vector<Eigen::Vector3f> points) {
  for (Eigen::Vector3f& point : points) point = (motion * point.cast<double>()).cast<float>();
  return points;
}

PointMatches moved_by(const Eigen::Isometry3d& motion, PointMatches features) {
  for (Eigen::Vector3d& point : features.from) point = motion * point;
  return features;
}

}  // namespace

Scene make_scene(const FramePair& pair, const Method& method, Device& device, std::uint64_t seed,
                 StageTimes& times) {
  check(pair);
  // Enqueued first: the device makes the surfaces while the host finds the alignment.
  const DepthMap depth = make_depth_map(pair.source, times);
  const auto filtered = method.filter->filter(device, depth, pair.camera);
  const PointSet map = make_map(depth, filtered, pair.camera, device);
  const DepthMap target_depth = make_depth_map(pair.target, times);
  SurfaceMap target(
      pair.camera,
      make_map(target_depth, method.filter->filter(device, target_depth, pair.camera), pair.camera, device));
  const double noise = std::isfinite(method.trusted_noise) ? estimate_noise(target_depth) : 0;

  const Array<int> pixels(timed(times, "surface", [&] { return pixels_with_depth(depth); }));
  if (pixels.empty()) throw DataError(pair.name + ": the source has no point");
  const AlignmentResult alignment = timed(times, "alignment", [&] {
    return method.alignment->align({pair, device, map, pixels, target, seed, uses_features(method)});
  });

  PointSet rest = pick_points(device, map, pixels, alignment.motion);
  Surface as_given = read_surface(pick_points(device, map, pixels), pixels.host(), pair.source);
  Surface aligned = read_surface(rest, pixels.host(), pair.source);
  std::vector<Eigen::Vector3f> unfiltered;
  if (filtered) {
    as_given.points = unprojected(as_given.pixels, pair);
    unfiltered = moved_by(alignment.motion, as_given.points);
  }
  return {pair,
          alignment,
          moved_by(alignment.motion, alignment.features),
          noise,
          std::move(target),
          std::move(as_given),
          std::move(aligned),
          std::move(rest),
          std::move(unfiltered)};
}

NonRigidInput input_of(const Scene& scene) {
  return {scene.pair.name, scene.aligned, scene.rest, scene.target, scene.target_noise, scene.features};
}

}  // namespace pliant
