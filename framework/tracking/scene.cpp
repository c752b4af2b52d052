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

SurfaceMap make_map(const DepthMap& given, const std::optional<DepthMap>& filtered, const Camera& camera,
                    Device& device) {
  return make_surface_map(device, filtered ? *filtered : given, camera);
}

std::vector<Eigen::Vector2i> pixels_at(const std::vector<int>& offsets, const PixelWindow& window) {
  std::vector<Eigen::Vector2i> pixels;
  pixels.reserve(offsets.size());
  int begin = 0;  // of the row: offsets ascend, and a division each would take longer
  int row = 0;
  for (const int offset : offsets) {
    for (; offset - begin >= window.width; begin += window.width) ++row;
    pixels.emplace_back(window.left + offset - begin, window.top + row);
  }
  return pixels;
}

std::vector<Rgb> colors_at(const std::vector<Eigen::Vector2i>& pixels, const ColorImage& image) {
  std::vector<Rgb> colors;
  if (image.empty()) return colors;
  colors.reserve(pixels.size());
  for (const Eigen::Vector2i& pixel : pixels) colors.push_back(image(pixel.x(), pixel.y()));
  return colors;
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
  const DepthFilter& source_filter = method.source_filter ? *method.source_filter : *method.filter;
  const auto filtered = source_filter.filter(device, depth, pair.camera);
  const SurfaceMap map = make_map(depth, filtered, pair.camera, device);
  const DepthMap target_depth = make_depth_map(pair.target, times);
  SurfaceMap target =
      make_map(target_depth, method.filter->filter(device, target_depth, pair.camera), pair.camera, device);
  const double noise = std::isfinite(method.trusted_noise) ? estimate_noise(target_depth) : 0;

  std::vector<int> offsets = timed(times, "surface", [&] { return pixels_with_depth(depth); });
  if (offsets.empty()) throw DataError(pair.name + ": the source has no point");
  const Array<int> pixels(offsets);
  AlignmentResult alignment = timed(times, "alignment", [&] {
    return method.alignment->align({pair, device, map, pixels, target, seed, uses_features(method)});
  });

  PointSet given = pick_points(device, map.map, pixels);
  PointSet rest = pick_points(device, map.map, pixels, alignment.motion);
  // Copied to the host while there is nothing to wait for.
  given.points.fetch();
  given.normals.fetch();
  rest.points.fetch();
  PixelIndex index(map.window, offsets);
  PointMatches features = moved_by(alignment.motion, alignment.features);
  return {pair,
          std::move(alignment),
          std::move(features),
          noise,
          std::move(target),
          std::move(offsets),
          std::move(index),
          std::move(given),
          std::move(rest),
          filtered.has_value()};
}

ScenePoints read_points(const Scene& scene) {
  ScenePoints read;
  const FramePair& pair = scene.pair;
  read.source = {unflatten(scene.given.points),
                 unflatten(scene.given.normals),
                 pixels_at(scene.offsets, scene.pixels.window),
                 {}};
  read.source.colors = colors_at(read.source.pixels, pair.source.color);
  read.aligned = unflatten(scene.rest.points);
  if (!scene.is_filtered) return read;
  read.source.points = unprojected(read.source.pixels, pair);
  read.unfiltered = moved_by(scene.alignment.motion, read.source.points);
  return read;
}

NonRigidInput input_of(const Scene& scene) {
  return {scene.pair.name, scene.pixels, scene.rest, scene.target, scene.target_noise, scene.features};
}

}  // namespace pliant
