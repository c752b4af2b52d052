#include "framework/registration/nonrigid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "framework/core/error.h"
#include "framework/deformation/warm_start.h"
#include "framework/deformation/warp.h"
#include "framework/registration/residual.h"

namespace pliant {
namespace {

constexpr double least_matched_share = 0.5;  ///< with less the result comes with a warning

/// Room for a deformed set of points.
PointSet unwritten(const PointSet& rest) {
  return {Array<float>(rest.points.size()), Array<float>(rest.normals.size())};
}

/// Of each value, whether `holds` of it.
template <class Predicate>
std::vector<std::uint8_t> flags(const Array<float>& values, Predicate holds) {
  std::vector<std::uint8_t> found(values.size());
  std::transform(values.host().begin(), values.host().end(), found.begin(),
                 [&](float value) { return static_cast<std::uint8_t>(holds(value)); });
  return found;
}

/// One run of the loop.
class Loop {
 public:
  Loop(const NonRigidInput& input, const NonRigidMethod& method, Device& device)
      : method_(method),
        device_(device),
        input_(input),
        nodes_(timed(times_, "ans",
                     [&] { return method.graph->select_nodes(device, input.source, input.target.camera); })),
        samples_(timed(times_, "acs",
                       [&] { return method.sampler->select(device, input.source, input.target.camera); })),
        graph_(make_graph()),
        follows_all_(!nodes_->is_fixed() || !samples_->is_fixed()),
        sampled_(follows_all_ ? PointSet{} : pick_points(device, input.rest, Array<int>(samples_->points()))),
        matched_problem_(make_problem()),
        moved_{followed().points.clone(), followed().normals.clone()},
        trust_(std::min(1.0, std::pow(method.trusted_noise / input.noise, 2))),
        meter_(device, *method.correspondence, input.target, moved_.points.size() / 3, method.stopping.cut) {}

  void match() {
    set_weights();
    method_.correspondence->match(device_, moved_, matched_problem_.selected, input_.target,
                                  *matched_problem_.constraints);
    if (!matched_problem_.weights.empty())
      weigh(device_, matched_problem_.weights, *matched_problem_.constraints);
  }

  void run(const Observer& observer) {
    bind_solver();
    measure_start();
    while (termination_.empty()) {
      iterate();
      const bool has_adapted = termination_.empty() && decide();
      if (observer) observer(view());
      if (has_adapted) renew();
    }
    collect_summaries();
    history_.resize(static_cast<std::size_t>(iterations_) + 1);  // without solves that have failed
    if (!is_after_schedule(history_.size() - 1)) best_ = std::move(best_of_all_);
    deform_best();
  }

  NonRigidResult take_result();
  std::unique_ptr<Problem> take_problem() { return std::move(matched_problem_.problem); }

 private:
  void bind_solver() { solver_ = method_.solver->bind(problem(), device_); }

  void end(const std::string& termination, const std::string& reason) {
    termination_ = termination;
    reason_ = reason;
  }

  /// A solve that failed has left the deformation as it was: the iterations before it are the result.
  void collect_summaries() {
    for (auto& summary : solver_->summaries()) summaries_.push_back(std::move(summary));
    const auto last = summaries_.begin() + std::min<std::ptrdiff_t>(std::ssize(summaries_), iterations_);
    const auto failed = std::find_if(summaries_.begin(), last, [](const SolverSummary& summary) {
      return summary.termination == "failed" || !std::isfinite(summary.initial_energy + summary.final_energy);
    });
    if (failed == last) return;
    iterations_ = static_cast<int>(failed - summaries_.begin());
    end("failed", failed->failure.empty() ? "the energy is not finite" : failed->failure);
  }

  void update_source() {
    warp(device_, followed(), follows_all_ ? graph_->influences : matched_problem_.constraints->influences,
         graph_->node_points, problem().unknowns(), moved_);
  }

  /// The points that are deformed and measured in each iteration. Where nodes and constraints stay as they
  /// are, the constrained points are enough.
  const PointSet& followed() const { return follows_all_ ? input_.rest : sampled_; }

  /// Where an iteration led.
  struct State {
    std::size_t iteration = 0;
    std::shared_ptr<const EmbeddedGraph> graph;
    Array<float> unknowns;
  };

  /// Keeps what was measured, and where if it is the best so far: later iterations may do worse, and adapting
  /// may lead astray. Those of the schedule do not have the weights yet that were asked for: they count only
  /// when nothing comes after it.
  void record(const Residual& residual) {
    const std::size_t iteration = history_.size();
    shown_ = iteration;
    history_.push_back({residual.mean, residual.robust, residual.matched});
    const double enough = (1 - method_.stopping.min_gain) * history_.front().robust;
    const auto keep_if_better = [&](State& best) {
      const bool is_better = residual.robust < enough && residual.robust < history_[best.iteration].robust;
      if (iteration == 0 || is_better) best = {iteration, graph_, problem().unknowns().clone()};
    };
    keep_if_better(best_of_all_);
    if (iteration == 0 || is_after_schedule(iteration)) keep_if_better(best_);
  }

  bool is_after_schedule(std::size_t iteration) const {
    return iteration > static_cast<std::size_t>(method_.schedule.iterations);
  }

  /// Puts the source where the best iteration led, and finds what is matched there.
  void deform_best() {
    const bool is_there = follows_all_ && shown_ == best_.iteration;
    if (is_there) {
      registered_ = std::move(moved_);
    } else {
      registered_ = unwritten(input_.rest);
      warp(device_, input_.rest, best_.graph->influences, best_.graph->node_points, best_.unknowns,
           registered_);
    }
    matched_ = is_there && method_.correspondence->measures_matches()
                   ? flags(meter_.per_point(), [](float residual) { return residual >= 0; })
                   : find_matched();
  }

  std::vector<std::uint8_t> find_matched() {
    const std::size_t count = input_.source.size();
    Constraints constraints;
    constraints.points = input_.rest.points.clone();
    constraints.data = Array<float>(6 * count);
    constraints.confidence = Array<float>(count);
    std::vector<int> all(count);
    std::iota(all.begin(), all.end(), 0);
    method_.correspondence->match(device_, registered_, Array<int>(std::move(all)), input_.target,
                                  constraints);
    return flags(constraints.confidence, [](float confidence) { return confidence > 0; });
  }

  void measure_start() {
    const Residual residual = meter_.measure(moved_);
    if (residual.lost > 0)
      throw NumericalError(
          fmt::format("{}: {} point(s) of the source are not finite where the alignment puts them",
                      input_.name, residual.lost));
    if (residual.landed == 0)
      throw DataError(
          fmt::format("{}: no point of the source projects onto a point of the target; an initial "
                      "alignment may help",
                      input_.name));
    record(residual);
  }

  /// Matches, minimises, updates the source and measures.
  void iterate() {
    try {
      match();
      solver_->solve();
      shown_.reset();
      update_source();
      judge(meter_.measure(moved_));
    } catch (const NumericalError& error) {
      end("failed", error.what());
    }
    if (termination_.empty()) ++iterations_;
  }

  /// Ends the loop when what an iteration came to is no result.
  void judge(const Residual& residual) {
    if (residual.lost > 0)
      end("failed",
          fmt::format("{} point(s) of the source were moved where nothing is finite", residual.lost));
    else if (residual.landed == 0)
      end("failed", "no point of the source projects onto a point of the target any more");
    else if ((residual.matched == 0 || !has_pulled_) && !is_pulled())
      end("no_constraints", "no constraint is in force: all matches are rejected, or all weights are zero");
    else if (residual.matched == 0)
      end("failed", "no point of the source has a match any more that is not rejected");
    else
      record(residual);
  }

  /// Whether any energy asks a point to go anywhere. Waits for the device: asked once a problem, and when
  /// nothing is matched.
  bool is_pulled() {
    const auto& terms = problem().terms();
    return has_pulled_ = std::any_of(terms.begin(), terms.end(), [&](const Term& term) {
             return term.constraints != nullptr && term.energy.weight > 0 &&
                    any_in_force(device_, *term.constraints);
           });
  }

  /// Ends the loop, or adapts graph and constraints to the residual and lets it go on: whether they are
  /// others.
  bool decide() {
    const StoppingRule& rule = method_.stopping;
    if (history_.back().residual_mean < rule.residual)
      termination_ = "residual";
    else if (iterations_ >= rule.max_iterations)
      termination_ = "max_iterations";
    else
      return adapt();
    return false;
  }

  /// Whether the residual stays, or has come down to where it was before the last adaptation: constraints
  /// that are taken away where the surface fits, and given back once it no longer does, may swing for ever.
  bool is_stuck() const {
    const auto last = history_.rbegin();
    const double now = last->residual_mean;
    const auto is_near = [&](const NonRigidResult::Step& earlier) {
      return std::abs(earlier.residual_mean - now) < method_.stopping.min_progress * earlier.residual_mean;
    };
    return is_near(last[1]) || (history_.size() > 2 && now < last[1].residual_mean && is_near(last[2]));
  }

  static bool is_matched(const Energy& energy) {
    return energy.stencil == Stencil::per_constraint && !energy.uses_features();
  }

  /// Weighs the terms as they count at this point of the schedule.
  void set_weights() {
    std::size_t term = 0;
    for (const Energy& energy : method_.energies) {
      if (!applies(method_, energy)) continue;
      const Energy now = energy.at(method_.schedule.remaining(iterations_));
      problem().set_weight(term, is_matched(energy) ? trust_ * now.weight : now.weight);
      problem().set_loss_scale(term, now.loss.scale);
      ++term;
    }
  }

  /// Only a softer or a first new graph promises more where nothing was gained: adaptive constraints seldom
  /// stay the same, and a graph that has grown without gaining would grow on.
  bool adapt() {
    const bool was_stuck = is_stuck();
    const bool is_softer = method_.schedule.remaining(iterations_ - 1) > 0;
    const bool may_grow = is_softer || !was_stuck || !has_grown_;
    const bool has_new_nodes = may_grow && adapt_nodes();
    has_grown_ = has_grown_ || has_new_nodes;
    if (is_softer || has_new_nodes || !was_stuck) return adapt_samples() || has_new_nodes;
    termination_ = "no_progress";
    return false;
  }

  /// Refines and collapses [Alg. 2, 3]; whether there are other nodes.
  bool adapt_nodes() {
    return timed(times_, "ans", [&] { return nodes_->adapt(device_, meter_.per_point()); });
  }

  /// Samples anew [thesis 4.5]; whether other points are constrained.
  bool adapt_samples() {
    return timed(times_, "acs", [&] { return samples_->adapt(device_, meter_.per_point()); });
  }

  /// Goes on with what adapting chose, if it chose anything.
  void renew() {
    collect_summaries();
    if (nodes_->points().empty())
      end("no_nodes", "the graph has lost all its nodes");
    else if (samples_->points().empty())
      end("no_constraints", "the sampler chose no point");
    if (termination_.empty()) rebuild();
  }

  std::shared_ptr<EmbeddedGraph> make_graph() {
    return std::make_shared<EmbeddedGraph>(embed_graph(device_, *nodes_, input_.source.points,
                                                       input_.rest.points, method_.nearest_nodes, input_.name,
                                                       times_));
  }

  MatchedProblem make_problem() {
    return make_matched_problem(device_, method_, input_, *graph_, *samples_, follows_all_);
  }

  Problem& problem() { return *matched_problem_.problem; }

  /// Makes graph and problem anew; the deformation so far is kept.
  void rebuild() {
    Array<float> start = std::move(problem().unknowns());
    if (nodes_->points() != graph_->nodes) {
      auto next = make_graph();
      start =
          carry_over(device_, {graph_->nodes, graph_->influences, start}, next->nodes, input_.source.points);
      graph_ = std::move(next);
    }
    matched_problem_ = make_problem();
    has_pulled_ = false;
    problem().unknowns() = std::move(start);
    bind_solver();
  }

  IterationView view() const {
    return {iterations_, !termination_.empty(), history_.back(), *graph_, *matched_problem_.constraints,
            moved_,      meter_.per_point()};
  }

  StageTimes times_;
  const NonRigidMethod& method_;
  Device& device_;
  const NonRigidInput& input_;
  std::unique_ptr<NodeSelection> nodes_;
  std::unique_ptr<PointSelection> samples_;
  bool has_grown_ = false;  ///< whether the graph is another than at first
  std::shared_ptr<const EmbeddedGraph> graph_;
  bool follows_all_;
  bool has_pulled_ = false;  ///< whether a constraint of the present problem had a match
  PointSet sampled_;         ///< the constrained points at rest, where only they are followed
  MatchedProblem matched_problem_;
  PointSet moved_;                    ///< those that are followed
  std::optional<std::size_t> shown_;  ///< the iteration that `moved_` was measured after, if it was
  PointSet registered_;               ///< all, at the end
  double trust_;                      ///< in matches, by the noise of the depth they rest on
  ResidualMeter meter_;
  std::unique_ptr<BoundSolver> solver_;
  std::vector<NonRigidResult::Step> history_;
  State best_;         ///< of the alignment and the iterations after the schedule
  State best_of_all_;  ///< of these and those of the schedule
  std::vector<std::uint8_t> matched_;
  int iterations_ = 0;
  std::string termination_;  ///< empty while the loop goes on
  std::string reason_;
  std::vector<SolverSummary> summaries_;
};

/// One summary for each iteration, and perhaps some of solves that were taken back.
void record_solves(std::vector<SolverSummary> summaries, NonRigidResult& result) {
  if (!summaries.empty())
    result.solver = {summaries.back().solver, summaries.back().linear_solver, summaries.back().termination};
  summaries.resize(std::min(summaries.size(), static_cast<std::size_t>(result.counts.outer_iterations)));
  if (summaries.empty()) return;
  result.energy.initial = summaries.front().initial_energy;
  result.energy.final = summaries.back().final_energy;
  for (const auto& summary : summaries) {
    result.energy.per_iteration.push_back(summary.final_energy);
    result.counts.solver_iterations += summary.iterations;
    for (const auto& [stage, time] : summary.time_ms) result.time_ms[stage] += time;
  }
}

/// Selecting ends with reading back what the device chose: the host's time of it holds the device's.
bool is_waited_for(const std::string& stage) { return stage == "ans" || stage == "acs"; }

NonRigidResult Loop::take_result() {
  NonRigidResult result;
  result.points = unflatten(registered_.points);
  result.normals = unflatten(registered_.normals);
  result.matched = std::move(matched_);
  result.node_positions = best_.graph->positions;
  result.graph_cells = best_.graph->cells;
  result.counts.source_points = static_cast<int>(input_.source.size());
  result.counts.matched_points =
      static_cast<int>(std::count(result.matched.begin(), result.matched.end(), std::uint8_t{1}));
  result.counts.nodes = static_cast<int>(best_.graph->nodes.size());
  result.counts.edges = static_cast<int>(best_.graph->edges.size());
  result.counts.constraints = static_cast<int>(matched_problem_.selected.size());
  result.counts.unknowns = method_.transform->unknowns * result.counts.nodes;
  result.counts.outer_iterations = iterations_;
  result.history = std::move(history_);
  result.returned_iteration = static_cast<int>(best_.iteration);
  result.termination = termination_;
  result.reason = reason_;
  if (reason_.empty() && best_.iteration == 0)
    result.reason = "no iteration gained stopping.min_gain on the alignment, which is the result";
  result.warnings = warnings_of(method_, result.counts);
  if (result.counts.matched_points < least_matched_share * result.counts.source_points)
    result.warnings.push_back(fmt::format(
        "only {} of {} points of the source have a match at the end; the others went with their neighbours",
        result.counts.matched_points, result.counts.source_points));
  result.time_ms = times_;
  for (const auto& [stage, time] : device_.take_stage_times())
    if (!is_waited_for(stage)) result.time_ms[stage] += time;
  record_solves(std::move(summaries_), result);
  return result;
}

}  // namespace

std::vector<std::string> warnings_of(const NonRigidMethod& method, const NonRigidResult::Counts& counts) {
  if (counts.nodes > method.nearest_nodes) return {};
  return {fmt::format("the graph has {} node(s): all of them move every point, though nearest_nodes is {}",
                      counts.nodes, method.nearest_nodes)};
}

NonRigid::NonRigid(const NonRigidMethod& method, Device& device) : method_(method), device_(device) {}

NonRigidResult NonRigid::run(const NonRigidInput& input, const Observer& observer) const {
  Loop loop(input, method_, device_);
  loop.run(observer);
  return loop.take_result();
}

std::unique_ptr<Problem> NonRigid::freeze(const NonRigidInput& input) const {
  Loop loop(input, method_, device_);
  loop.match();
  return loop.take_problem();
}

}  // namespace pliant
