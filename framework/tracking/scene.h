#pragma once

#include <cstdint>
#include <vector>

#include "framework/device/device.h"
#include "framework/geometry/frame.h"
#include "framework/geometry/point_set.h"
#include "framework/geometry/surface.h"
#include "framework/geometry/surface_map.h"
#include "framework/pose/alignment.h"
#include "framework/registration/matched_problem.h"
#include "framework/tracking/method.h"

namespace pliant {

/// What stays as it is while a pair is registered. All lists of points have the order of `source`.
struct Scene {
  const FramePair& pair;
  AlignmentResult alignment;
  PointMatches features;  ///< those of the alignment, `from` moved as `aligned` is
  double target_noise;    ///< of its depth as given: standard deviation, mm; 0 where the method does not ask
  SurfaceMap target;      ///< filtered
  Surface source;         ///< as given; its normals are those of the filtered surface
  Surface aligned;        ///< what is registered: the source, filtered, after the initial alignment
  PointSet rest;          ///< `aligned` on the device
  /// mm; the points of the source as given, after the initial alignment; empty where no filter sets them
  /// apart from `aligned`.
  std::vector<Eigen::Vector3f> unfiltered;
};

/// `pair` must outlive the scene. Adds to `times` what the host spent on each stage. Throws DataError as
/// `check` of a pair does, and when the source has no point.
Scene make_scene(const FramePair& pair, const Method& method, Device& device, std::uint64_t seed,
                 StageTimes& times);

/// What its non-rigid registration begins with; refers to the scene, which must outlive it.
NonRigidInput input_of(const Scene& scene);

}  // namespace pliant
