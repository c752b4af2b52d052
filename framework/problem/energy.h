#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "framework/core/registry.h"

// Declared only, as nobody needs its definition but who makes equations (make_equation.h).
namespace ceres {
template <typename T, int N>
struct Jet;
}  // namespace ceres

namespace pliant {

/// What one instance of an energy looks at. The framework evaluates, assembles and gathers per stencil,
/// so that an energy is nothing but its equation.
///
/// | stencil        | u                                                          | data                |
/// |----------------|------------------------------------------------------------|---------------------|
/// | per_node       | 12: affine form of the node                                | none                |
/// | per_edge       | 24: affine forms of `from` and `to`                        | 3: g_to - g_from    |
/// | per_constraint | 3: displacement p' - p of the constrained point            | 6: q - p, normal at q |
///
/// An affine form is the columns of R - I, then t. Lengths in mm, camera frame.
enum class Stencil { per_node, per_edge, per_constraint };

inline constexpr int max_stencil_inputs = 24;
inline constexpr int max_stencil_data = 6;
inline constexpr int max_residuals = 12;

constexpr int input_size(Stencil stencil) {
  return stencil == Stencil::per_node ? 12 : stencil == Stencil::per_edge ? 24 : 3;
}
constexpr int data_size(Stencil stencil) {
  return stencil == Stencil::per_node ? 0 : stencil == Stencil::per_edge ? 3 : 6;
}
/// Length of the scalar row of an axis-separable term.
constexpr int row_size(Stencil stencil) { return input_size(stencil) / 3; }
const char* to_string(Stencil stencil);

/// One residual with its Jacobian, written once in an equation.h and compiled three ways: in double for
/// Ceres, over jets to check the Jacobian, and as OpenCL C from its text for the device. make_equation.h
/// fills it.
struct Equation {
  using Jet = ceres::Jet<double, max_stencil_inputs>;

  std::string name;         ///< the functions are `<name>_residual`, `<name>_jacobian` and `<name>_row`
  std::string_view source;  ///< text of the equation.h
  void (*residual)(const double* u, const double* data, double* r) = nullptr;
  void (*jacobian)(const double* u, const double* data, double* jacobian) = nullptr;
  void (*residual_jet)(const Jet* u, const Jet* data, Jet* r) = nullptr;
  /// Only of a term that treats x, y and z alike and apart: its three residuals are
  /// r[axis] = sum over m of row[m] * u[3 m + axis] + constant. See row_size() for the length of `row`.
  void (*row)(const double* data, double* row) = nullptr;

  bool axis_separable() const { return row != nullptr; }
};

/// Where the constraints of a per_constraint energy come from.
enum class ConstraintSource {
  surface,   ///< sampled points, matched anew in every outer iteration
  features,  ///< the colour features that the initial alignment matched
};

/// How a squared residual s counts (loss.h).
struct Loss {
  std::string name = "none";  ///< one of loss_names()
  double scale = 10;          ///< unit of the residual

  bool is_robust() const { return name != "none"; }
  double value(double s) const;      ///< rho(s)
  double weight(double s) const;     ///< rho'(s)
  double curvature(double s) const;  ///< rho''(s)
};
const std::vector<std::string>& loss_names();

/// One term of E_tot [Eq. 4.6]: weight * sum over instances of rho(|r|^2).
struct Energy {
  static constexpr const char* kind = "energy";

  Stencil stencil = Stencil::per_node;
  int residuals = 0;       ///< length of r
  bool in_length = false;  ///< r is a length (mm), so its weight changes with the unit of length
  Equation equation;
  double weight = 1;
  ConstraintSource source = ConstraintSource::surface;  ///< of a per_constraint energy
  Loss loss = {};                                       ///< where takes_loss()
  /// Of the first outer iteration of a registration, where they differ from `weight` and `loss.scale`.
  std::optional<double> initial_weight = {};
  std::optional<double> initial_loss_scale = {};

  /// Whether its residual is a length that may be an outlier. (The rows of edges stay as they are from step
  /// to step: solvers rest on that.)
  bool takes_loss() const {
    return stencil == Stencil::per_constraint || (stencil == Stencil::per_node && in_length);
  }

  /// The energy as it counts on the way from its initial weight and loss scale (`remaining` = 1) to the final
  /// ones (0), which they approach geometrically.
  Energy at(double remaining) const;

  bool uses_features() const {
    return stencil == Stencil::per_constraint && source == ConstraintSource::features;
  }
};

/// Registers an energy whose parameters are its weight and, where it takes one, its loss.
/// Throws std::logic_error for more residuals than max_residuals.
void add_energy(Registry& registry, const std::string& name, const std::string& doc, const Energy& energy);

}  // namespace pliant
