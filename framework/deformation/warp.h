#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/deformation/graph.h"
#include "framework/deformation/skinning.h"
#include "framework/device/array.h"
#include "framework/geometry/point_set.h"

namespace pliant {

/// Numbers of a node's affine form: the columns of R - I, then t (mm). R and t are those of [Eq. 4.1];
/// the deviation from the identity is stored, not R, so that single precision keeps small motions.
inline constexpr int affine_size = 12;

/// Deforms points and normals [Eq. 4.1] on the device: p' = sum_j w_j (R_j (p - g_j) + g_j + t_j); a
/// normal turns with the cofactors of sum_j w_j R_j and stays of unit length ((0, 0, 0) stays so, and takes
/// the place of what single precision cannot turn). `affine`: affine_size numbers per node; `node_points`: x
/// y z per node; `moved` has the size of `rest`.
void warp(Device& device, const PointSet& rest, const Influences& influences, const Array<float>& node_points,
          const Array<float>& affine, PointSet& moved);

/// The points alone; `moved` has the size of `points`.
void warp_points(Device& device, const Array<float>& points, const Influences& influences,
                 const Array<float>& node_points, const Array<float>& affine, Array<float>& moved);

/// Plain C++ reference of both.
PointSet warp_reference(const PointSet& rest, const Influences& influences, const Array<float>& node_points,
                        const Array<float>& affine);

}  // namespace pliant
