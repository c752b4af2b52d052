#pragma once

#include <memory>
#include <string>

#include "framework/core/registry.h"
#include "framework/problem/problem.h"

namespace pliant::bench {

/// The frozen problem that solvers are measured on: a flat sheet of 420 x 300 mm, 800 mm before the camera,
/// is asked to take the shape of one that is bent by 20 mm.
struct SheetSize {
  int nodes;  ///< a square number
  int constraints;
  double length_unit;  ///< mm: 1, or 1000 for a problem in metres
};

/// Energies and weights of [Eq. 4.6], k = 4. No random numbers: nodes on a grid, constraints spread evenly.
std::unique_ptr<Problem> make_sheet(const SheetSize& size, const Registry& registry, Device& device);

/// A component with the default values of its table, but for those given.
Parameters with_defaults(const Registry& registry, const std::string& kind, const std::string& name,
                         const std::vector<Parameters::Value>& given = {});

}  // namespace pliant::bench
