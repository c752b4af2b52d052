#include "framework/registration/nonrigid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "framework/core/error.h"
#include "framework/deformation/warm_start.h"
#include "framework/deformation/warp.h"
#include "framework/registration/history.h"
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

bool has_failed(const SolverSummary& summary) {
  return summary.termination == "failed" || !std::isfinite(summary.initial_energy + summary.final_energy);
}

std::string reason_of_failure(const SolverSummary& summary) {
  return summary.failure.empty() ? "the energy is not finite" : summary.failure;
}

/// One run of the loop.
class Loop {
 public:
  Loop(const NonRigidInput& input, const NonRigidMethod& method, Device& device)
      : method_(method),
        device_(device),
        input_(input),
        nodes_(timed(times_, "ans", [&] { return select_nodes(); })),
        samples_(timed(times_, "acs", [&] { return method.sampler->select(device, view_of(input)); })),
        follows_all_(!nodes_->is_fixed() || !samples_->is_fixed()),
        history_(method.stopping, method.schedule),
        trust_(std::min(1.0, std::pow(method.trusted_noise / input.noise, 2))),
        graph_(make_graph()),
        matched_(constrain()),
        moved_{followed().points.clone(), followed().normals.clone()},
        meter_(device, *method.correspondence, std::min(moved_.points.size() / 3, input.pixels.count),
               method.stopping.cut) {
    if (input.graph) start_from(input.graph->affine);
    meter_.measure(moved_, input_.target);
    match_and_make_problem();
    if (input.graph) problem_->unknowns() = input.graph->affine.clone();
  }

  void run(const Observer& observer) {
    bind_solver();
    check_start(meter_.read());
    while (termination_.empty()) {
      iterate();
      const bool has_adapted = termination_.empty() && decide();
      if (observer) observer(view());
      if (has_adapted) renew();
    }
    history_.close();
  }

  NonRigidResult take_result();
  Deformation take_deformation();
  std::unique_ptr<Problem> take_problem() {
    set_weights();
    return std::move(problem_);
  }

 private:
  std::unique_ptr<NodeSelection> select_nodes() {
    if (input_.graph) return std::make_unique<FixedSelection<NodeSelection>>(input_.graph->nodes);
    return method_.graph->select_nodes(device_, view_of(input_));
  }

  static SurfaceView view_of(const NonRigidInput& input) {
    return {input.pixels, input.rest, input.target.camera};
  }

  void end(const std::string& termination, const std::string& reason) {
    termination_ = termination;
    reason_ = reason;
  }

  // --- graph, constraints and problem ---

  std::shared_ptr<EmbeddedGraph> make_graph() {
    return std::make_shared<EmbeddedGraph>(
        embed_graph(device_, *nodes_, input_.rest, method_.nearest_nodes, input_.name));
  }

  MatchedConstraints constrain() { return make_constraints(device_, input_, *samples_, follows_all_); }

  /// The host makes the problem that the constraints are part of while the device matches them.
  void match_and_make_problem() {
    match();
    if (graph_->edges.empty()) connect(*graph_, times_);
    problem_ = make_problem(device_, method_, input_.features, *graph_, matched_);
    has_pulled_ = false;
  }

  /// Where a graph that was given has moved the followed points so far.
  void start_from(const Array<float>& affine) {
    const Influences& all = graph_->influences;
    const auto picked =
        follows_all_ ? Influences{} : pick_influences(device_, all, Array<int>(matched_.points));
    warp(device_, followed(), follows_all_ ? all : picked, graph_->node_points, affine, moved_);
  }

  void bind_solver() { solver_ = method_.solver->bind(*problem_, device_); }

  void match() {
    method_.correspondence->match(device_, moved_, matched_.selected, input_.target, *matched_.constraints);
    if (!matched_.weights.empty()) weigh(device_, matched_.weights, *matched_.constraints);
    is_matched_ = true;
  }

  /// The points that are deformed and measured in each iteration. Where nodes and constraints stay as they
  /// are, the constrained points are enough.
  const PointSet& followed() const { return follows_all_ ? input_.rest : matched_.rest; }

  void update_source() {
    warp(device_, followed(), follows_all_ ? graph_->influences : matched_.constraints->influences,
         graph_->node_points, problem_->unknowns(), moved_);
    is_matched_ = false;
  }

  /// Goes on with what adapting chose, if it chose anything.
  void renew() {
    if (nodes_->points().empty())
      end("no_nodes", "the graph has lost all its nodes");
    else if (samples_->points().empty())
      end("no_constraints", "the sampler chose no point");
    if (termination_.empty()) rebuild();
  }

  /// Makes graph and problem anew; the deformation so far is kept.
  void rebuild() {
    Array<float> start = std::move(problem_->unknowns());
    if (nodes_->points() != graph_->nodes) {
      auto next = make_graph();
      start = carry_over(device_, {*graph_, start}, *next);
      graph_ = std::move(next);
    }
    matched_ = constrain();
    match_and_make_problem();
    problem_->unknowns() = std::move(start);
    bind_solver();
  }

  // --- iterations ---

  void check_start(const Residual& residual) {
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

  void record(const Residual& residual) {
    history_.add(residual, graph_, problem_->unknowns());
    shown_ = history_.last_iteration();
  }

  /// Matches, minimises, updates the source and measures.
  void iterate() {
    try {
      if (!is_matched_) match();
      set_weights();
      solver_->solve();
      shown_.reset();
      update_source();
      meter_.measure(moved_, input_.target);
      const Residual residual = meter_.read();
      summaries_.push_back(solver_->summaries().back());
      if (has_failed(summaries_.back()))
        end("failed", reason_of_failure(summaries_.back()));
      else
        judge(residual);
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
    const auto& terms = problem_->terms();
    return has_pulled_ = std::any_of(terms.begin(), terms.end(), [&](const Term& term) {
             return term.constraints != nullptr && term.energy.weight > 0 &&
                    any_in_force(device_, *term.constraints);
           });
  }

  static bool rests_on_matches(const Energy& energy) {
    return energy.stencil == Stencil::per_constraint && !energy.uses_features();
  }

  /// Weighs the terms as they count at this point of the schedule.
  void set_weights() {
    std::size_t term = 0;
    for (const Energy& energy : method_.energies) {
      if (!applies(method_, energy)) continue;
      const Energy now = energy.at(method_.schedule.remaining(iterations_));
      problem_->set_weight(term, rests_on_matches(energy) ? trust_ * now.weight : now.weight);
      problem_->set_loss_scale(term, now.loss.scale);
      ++term;
    }
  }

  /// Ends the loop, or adapts graph and constraints to the residual and lets it go on: whether they are
  /// others.
  bool decide() {
    const StoppingRule& rule = method_.stopping;
    if (history_.last().residual_mean < rule.residual)
      termination_ = "residual";
    else if (iterations_ >= rule.max_iterations)
      termination_ = "max_iterations";
    else
      return adapt();
    return false;
  }

  /// Only a softer or a first new graph promises more where nothing was gained: adaptive constraints seldom
  /// stay the same, and a graph that has grown without gaining would grow on.
  bool adapt() {
    const bool was_stuck = history_.is_stuck();
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

  IterationView view() const {
    return {iterations_,           !termination_.empty(),
            history_.last(),       *graph_,
            *matched_.constraints, moved_,
            meter_.per_point(),    input_.rest,
            problem_->unknowns()};
  }

  // --- the end ---

  /// Puts the source where an iteration led.
  PointSet deformed_to(const History::State& state) {
    is_returned_shown_ = follows_all_ && shown_ == state.iteration;
    if (is_returned_shown_) return std::move(moved_);
    PointSet points = unwritten(input_.rest);
    warp(device_, input_.rest, state.graph->influences, state.graph->node_points, state.unknowns, points);
    return points;
  }

  /// The nodes of a graph that was given are behind the points and have no match.
  std::vector<std::uint8_t> find_matched(const PointSet& registered) const {
    std::vector<std::uint8_t> found = find_matched_pixels(registered);
    found.resize(registered.points.size() / 3);
    return found;
  }

  std::vector<std::uint8_t> find_matched_pixels(const PointSet& registered) const {
    if (is_returned_shown_ && method_.correspondence->measures_matches())
      return flags(meter_.per_point(), [](float residual) { return residual >= 0; });
    Constraints constraints = unmatched_at(input_.rest.points.clone());
    constraints.confidence = Array<float>(input_.pixels.count);
    method_.correspondence->match(device_, registered, first_indices(input_.pixels.count), input_.target,
                                  constraints);
    return flags(constraints.confidence, [](float confidence) { return confidence > 0; });
  }

  StageTimes times_;
  const NonRigidMethod& method_;
  Device& device_;
  const NonRigidInput& input_;
  std::unique_ptr<NodeSelection> nodes_;
  std::unique_ptr<PointSelection> samples_;
  bool follows_all_;
  History history_;
  double trust_;  ///< in matches, by the noise of the depth they rest on
  std::shared_ptr<EmbeddedGraph> graph_;
  MatchedConstraints matched_;
  PointSet moved_;  ///< the followed points
  ResidualMeter meter_;
  std::unique_ptr<Problem> problem_;
  std::unique_ptr<BoundSolver> solver_;
  bool is_matched_ = false;           ///< whether the constraints are those of `moved_`
  bool has_pulled_ = false;           ///< whether a constraint of the present problem had a match
  bool has_grown_ = false;            ///< whether the graph is another than at first
  std::optional<std::size_t> shown_;  ///< the iteration that `moved_` was measured after, if it was
  bool is_returned_shown_ = false;    ///< whether what is returned is what was measured last
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
  const History::State& best = history_.best();
  const PointSet registered = deformed_to(best);
  result.points = unflatten(registered.points);
  result.normals = unflatten(registered.normals);
  result.matched = find_matched(registered);
  result.node_positions = best.graph->positions;
  result.graph_cells = best.graph->cells;
  result.counts.source_points = static_cast<int>(input_.pixels.count);
  result.counts.matched_points =
      static_cast<int>(std::count(result.matched.begin(), result.matched.end(), std::uint8_t{1}));
  result.counts.nodes = static_cast<int>(best.graph->nodes.size());
  result.counts.edges = static_cast<int>(best.graph->edges.size());
  result.counts.constraints = static_cast<int>(matched_.points.size());
  result.counts.unknowns = method_.transform->unknowns * result.counts.nodes;
  result.counts.outer_iterations = iterations_;
  result.history = history_.take_steps();
  result.returned_iteration = static_cast<int>(best.iteration);
  result.termination = termination_;
  result.reason = reason_;
  if (reason_.empty() && best.iteration == 0)
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

Deformation Loop::take_deformation() {
  // What failed after the last measurement is no place to be.
  const History::State last = shown_ ? History::State{*shown_, graph_, problem_->unknowns().clone()}
                                     : History::State{history_.best().iteration, history_.best().graph,
                                                      history_.best().unknowns.clone()};
  return {last.graph,
          last.unknowns.clone(),
          deformed_to(last),
          iterations_,
          static_cast<int>(matched_.points.size()),
          std::move(termination_),
          std::move(reason_)};
}

}  // namespace

NonRigid::NonRigid(const NonRigidMethod& method, Device& device) : method_(method), device_(device) {}

NonRigidResult NonRigid::run(const NonRigidInput& input, const Observer& observer) const {
  Loop loop(input, method_, device_);
  loop.run(observer);
  return loop.take_result();
}

Deformation NonRigid::deform(const NonRigidInput& input) const {
  Loop loop(input, method_, device_);
  loop.run({});
  return loop.take_deformation();
}

std::unique_ptr<Problem> NonRigid::freeze(const NonRigidInput& input) const {
  return Loop(input, method_, device_).take_problem();
}

}  // namespace pliant
