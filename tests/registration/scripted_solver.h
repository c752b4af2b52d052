#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "framework/core/error.h"
#include "framework/deformation/warp.h"
#include "framework/problem/problem.h"
#include "framework/problem/solver.h"

namespace pliant::test {

/// Affine forms of nodes that all go by `z` mm along z.
inline std::vector<float> lifted(std::size_t nodes, float z) {
  std::vector<float> forms(affine_size * nodes, 0);
  for (std::size_t j = 0; j < nodes; ++j) forms[affine_size * j + 11] = z;
  return forms;
}

/// Puts all nodes where a list says, one value (mm along z) a solve, whatever the problem asks for; fails
/// when the list is at its end.
class ScriptedSolver : public Solver {
 public:
  explicit ScriptedSolver(std::vector<float> heights) : heights_(std::move(heights)) {}

  std::unique_ptr<BoundSolver> bind(Problem& problem, Device&) const override {
    return std::make_unique<Bound>(problem, heights_);
  }

 private:
  class Bound : public BoundSolver {
   public:
    Bound(Problem& problem, const std::vector<float>& heights) : problem_(problem), heights_(heights) {}
    void solve() override {
      if (solves_ == heights_.size()) throw NumericalError("the script is at its end");
      problem_.unknowns() = Array<float>(lifted(problem_.graph().nodes.size(), heights_[solves_++]));
    }
    std::vector<SolverSummary> summaries() override { return std::vector<SolverSummary>(solves_); }

   private:
    Problem& problem_;
    const std::vector<float>& heights_;
    std::size_t solves_ = 0;
  };

  std::vector<float> heights_;
};

}  // namespace pliant::test
