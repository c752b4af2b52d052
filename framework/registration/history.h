#pragma once

#include <memory>
#include <vector>

#include "framework/deformation/embedded_graph.h"
#include "framework/registration/nonrigid_method.h"
#include "framework/registration/nonrigid_result.h"
#include "framework/registration/residual.h"

namespace pliant {

/// What was measured before the first and after each outer iteration, and where the best of them led: later
/// iterations may do worse, and adapting may lead astray. Those of the schedule do not have the weights yet
/// that were asked for: they count only when nothing comes after it.
class History {
 public:
  using Step = NonRigidResult::Step;

  /// Where an iteration led.
  struct State {
    std::size_t iteration = 0;
    std::shared_ptr<const EmbeddedGraph> graph;
    Array<float> unknowns;
  };

  History(const StoppingRule& rule, const Schedule& schedule) : rule_(rule), schedule_(schedule) {}

  void add(const Residual& residual, const std::shared_ptr<const EmbeddedGraph>& graph,
           const Array<float>& unknowns);

  const Step& last() const { return steps_.back(); }
  std::size_t last_iteration() const { return steps_.size() - 1; }

  /// Whether the residual stays, or has come down to where it was before the last adaptation: constraints
  /// that are taken away where the surface fits, and given back once it no longer does, may swing for ever.
  bool is_stuck() const;

  /// Settles what is best: nothing comes after this.
  void close();
  const State& best() const { return *best_; }
  std::vector<Step> take_steps() { return std::move(steps_); }

 private:
  bool is_after_schedule(std::size_t iteration) const {
    return iteration > static_cast<std::size_t>(schedule_.iterations);
  }

  const StoppingRule& rule_;
  const Schedule& schedule_;
  std::vector<Step> steps_;
  std::shared_ptr<const State> best_;         ///< of the alignment and the iterations after the schedule
  std::shared_ptr<const State> best_of_all_;  ///< of these and those of the schedule
};

}  // namespace pliant
