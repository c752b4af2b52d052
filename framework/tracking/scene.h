#pragma once

#include <cstdint>
#include <vector>

#include "framework/device/device.h"
#include "framework/geometry/frame.h"
#include "framework/geometry/pixel_index.h"
#include "framework/geometry/point_set.h"
#include "framework/geometry/surface.h"
#include "framework/geometry/surface_map.h"
#include "framework/pose/alignment.h"
#include "framework/registration/matched_problem.h"
#include "framework/tracking/method.h"

namespace pliant {

/// What stays as it is while a pair is registered. All lists of points have the order of `pixels`.
struct Scene {
  const FramePair& pair;
  AlignmentResult alignment;
  PointMatches features;  ///< those of the alignment, `from` moved as the source is
  double target_noise;    ///< of its depth as given: standard deviation, mm; 0 where the method does not ask
  SurfaceMap target;      ///< filtered
  std::vector<int> offsets;  ///< of the source's points, in the window of `pixels`
  PixelIndex pixels;         ///< of the source
  PointSet given;            ///< the source before any alignment, filtered
  PointSet rest;             ///< what is registered: the source, filtered, after the initial alignment
  bool is_filtered;          ///< whether the source's points are others than those that were seen
};

/// What the host wants of a scene: copied from the device, where that has been asked to make it.
struct ScenePoints {
  Surface source;  ///< as given, before any alignment; its normals are those of the filtered surface
  std::vector<Eigen::Vector3f> aligned;  ///< mm; what is registered
  /// mm; the points of the source as given, after the initial alignment; empty where no filter sets them
  /// apart from `aligned`.
  std::vector<Eigen::Vector3f> unfiltered;
};
ScenePoints read_points(const Scene& scene);

/// `pair` must outlive the scene. Adds to `times` what the host spent on each stage. Throws DataError as
/// `check` of a pair does, and when the source has no point.
Scene make_scene(const FramePair& pair, const Method& method, Device& device, std::uint64_t seed,
                 StageTimes& times);

/// What its non-rigid registration begins with; refers to the scene, which must outlive it.
NonRigidInput input_of(const Scene& scene);

}  // namespace pliant
