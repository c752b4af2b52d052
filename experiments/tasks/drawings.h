#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "experiments/report/artefacts.h"
#include "experiments/report/heat_map.h"
#include "framework/deformation/node_selection.h"
#include "framework/geometry/camera.h"

namespace pliant {

// Pictures of a surface that a camera saw, and of what became of it.

/// The z of each point, mm.
std::vector<float> depths(const std::vector<Eigen::Vector3f>& points);

/// The value that `share` of the finite values stay below; 0 when there are none.
float quantile(std::vector<float> values, double share);

/// Values per point of a surface, at the pixels that the points came from; NaN elsewhere.
Image<float> at_pixels(const Surface& surface, const Camera& camera, const std::vector<float>& values);

/// Fits a surface from where it starts to where it ends: a room behind it would otherwise take all the
/// colours.
ColorScale depth_scale(const Surface& source, const std::vector<Eigen::Vector3f>& moved);

Picture heat_map(const std::string& name, const std::string& caption, Image<float> values,
                 const ColorScale& scale, const std::string& subtitle);

/// The depth of a source as it was given.
Picture draw_source(const Surface& source, const Camera& camera, const ColorScale& scale);

/// The graph over the source; `nodes` as the source was given, mm.
Picture draw_last_graph(const Surface& source, const Camera& camera,
                        const std::vector<Eigen::Vector3d>& nodes, const std::vector<GraphCell>& cells);

}  // namespace pliant
