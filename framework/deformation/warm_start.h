#pragma once

#include "framework/deformation/embedded_graph.h"
#include "framework/device/array.h"

namespace pliant {

/// A deformation of a surface by a graph whose nodes are points of that surface.
struct SurfaceDeformation {
  const EmbeddedGraph& graph;
  const Array<float>& affine;  ///< affine_size numbers a node (see warp.h)
};

/// An affine form: the columns of R - I, then t (mm); see warp.h.
using AffineForm = Eigen::Matrix<float, 3, 4>;

/// The blended deformation [Eq. 4.1] about a point (mm), as an affine form centred there. `nodes`: at rest,
/// mm; `affine`: their forms; `influences`: of points among which it is number `place`. Waits for the device.
AffineForm blended_form(const std::vector<Eigen::Vector3f>& nodes, const Array<float>& affine,
                        const Influences& influences, std::size_t place, const Eigen::Vector3f& point);

/// Affine forms with which another graph of the same surface starts where `before` ended: a node that was
/// there keeps its transform; one that is new moves as the surface there was moved, by the blend of the
/// transforms around it (its quadtree parent's the nearest).
Array<float> carry_over(Device& device, const SurfaceDeformation& before, const EmbeddedGraph& next);

}  // namespace pliant
