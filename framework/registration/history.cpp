#include "framework/registration/history.h"

#include <cmath>
#include <utility>

namespace pliant {

void History::add(const Residual& residual, const std::shared_ptr<const EmbeddedGraph>& graph,
                  const Array<float>& unknowns) {
  const std::size_t iteration = steps_.size();
  steps_.push_back({residual.mean, residual.robust, residual.matched});
  const double enough = (1 - rule_.min_gain) * steps_.front().robust;
  const auto is_better_than = [&](const std::shared_ptr<const State>& best) {
    return iteration == 0 || (residual.robust < enough && residual.robust < steps_[best->iteration].robust);
  };
  const bool is_best_of_all = is_better_than(best_of_all_);
  const bool is_best = (iteration == 0 || is_after_schedule(iteration)) && is_better_than(best_);
  if (!is_best && !is_best_of_all) return;
  const auto here = std::make_shared<const State>(State{iteration, graph, unknowns.clone()});
  if (is_best_of_all) best_of_all_ = here;
  if (is_best) best_ = here;
}

bool History::is_stuck() const {
  const auto last = steps_.rbegin();
  const double now = last->residual_mean;
  const auto is_near = [&](const Step& earlier) {
    return std::abs(earlier.residual_mean - now) < rule_.min_progress * earlier.residual_mean;
  };
  return is_near(last[1]) || (steps_.size() > 2 && now < last[1].residual_mean && is_near(last[2]));
}

void History::close() {
  if (!is_after_schedule(last_iteration())) best_ = std::move(best_of_all_);
}

}  // namespace pliant
