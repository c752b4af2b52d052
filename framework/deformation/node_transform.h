#pragma once

#include <string>
#include <string_view>

#include "framework/core/registry.h"
#include "framework/deformation/warp.h"

namespace pliant {

/// Which affine forms (see affine_size in warp.h) a node may take. Whatever it is, nodes carry affine forms;
/// a transform that is not free keeps them on a surface of `unknowns` dimensions among all, along which
/// solvers step. Its functions are written once (see quaternion.h), compiled in double for the host and as
/// OpenCL C from `source` for the device, where they are called `<name>_retract` and so on.
/// By default: every form.
struct NodeTransform {
  static constexpr const char* kind = "transform";

  std::string name = "affine";
  int unknowns = affine_size;    ///< free numbers a node: the length of a step
  std::string_view source = {};  ///< text of the functions; empty where every form will do
  /// The form that a step leads to from a form of this transform.
  void (*retract)(const double* form, const double* step, double* moved) = nullptr;
  /// T^T v: v (affine_size numbers) into `unknowns` numbers, T the derivative of retract by the step at zero.
  void (*pull_back)(const double* form, const double* v, double* pulled) = nullptr;
  /// The form of this transform nearest to any form: from where a solve starts.
  void (*nearest)(const double* form, double* nearest) = nullptr;

  bool is_free() const { return source.empty(); }
};

/// `quaternion`: a rotation, kept by a unit quaternion, and a translation: 7 numbers with one condition, so
/// 6 unknowns.
NodeTransform quaternion_transform();

/// Adds `affine` (12 unknowns, the affine form itself) [thesis 4.1] and `quaternion`.
void register_transforms(Registry& registry);

}  // namespace pliant
