#include "framework/registration/registration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "framework/core/error.h"
#include "framework/core/stopwatch.h"
#include "framework/deformation/warm_start.h"
#include "framework/registration/residual.h"
#include "framework/registration/scene.h"

namespace pliant {
namespace {

template <class T>
std::vector<T> pick(const std::vector<T>& values, const std::vector<int>& indices) {
  std::vector<T> picked;
  picked.reserve(indices.size());
  for (const int index : indices) picked.push_back(values[static_cast<std::size_t>(index)]);
  return picked;
}

/// The deformation graph and how the source hangs on it: what only other nodes make anew.
struct Skeleton {
  std::vector<int> nodes;  ///< points of the source
  std::vector<Eigen::Vector3f> positions;
  Array<float> node_points;  ///< the positions again, for the device
  Influences influences;     ///< of every point of the source
  std::vector<Edge> edges;
  std::vector<GraphCell> cells;  ///< of the nodes, where they have some
};

/// Constraints and the problem that they and a skeleton make: what each adaptation makes anew.
struct Model {
  Array<int> selected;   ///< the points that are constrained, among those that are followed
  Array<float> weights;  ///< of these; empty: all the same
  std::shared_ptr<Constraints> constraints;
  std::unique_ptr<Problem> problem;
};

void check_selection(const Scene& scene, const char* what, const std::vector<int>& selected) {
  if (selected.empty())
    throw DataError(fmt::format("{}: no {} falls on the source; choose a finer one", scene.pair.name, what));
}

std::vector<int> first_indices(std::size_t count) {
  std::vector<int> indices(count);
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

std::shared_ptr<Constraints> make_constraints(const std::vector<Eigen::Vector3f>& points,
                                              Influences influences) {
  auto constraints = std::make_shared<Constraints>();
  constraints->points = flatten(points);
  constraints->influences = std::move(influences);
  constraints->data = Array<float>(std::vector<float>(6 * points.size(), 0.0F));
  constraints->confidence = Array<float>(std::vector<float>(points.size(), 0.0F));
  return constraints;
}

/// The features that the initial alignment found, as constraints whose targets stay.
std::shared_ptr<Constraints> make_feature_constraints(Device& device, const Method& method,
                                                      const Scene& scene,
                                                      const std::vector<Eigen::Vector3f>& node_positions) {
  const PointMatches& features = scene.alignment.features;
  std::vector<Eigen::Vector3f> points;
  std::vector<float> pulls;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const Eigen::Vector3d point = scene.alignment.motion * features.from[i];
    points.push_back(point.cast<float>());
    const Eigen::Vector3f pull = (features.to[i] - point).cast<float>();
    pulls.insert(pulls.end(), {pull.x(), pull.y(), pull.z(), 0, 0, 0});
  }
  auto constraints = make_constraints(
      points, compute_influences(device, flatten(points), node_positions, method.nearest_nodes));
  constraints->data = Array<float>(std::move(pulls));
  constraints->confidence = Array<float>(features.confidence);
  return constraints;
}

/// Whether an energy becomes a term of the problem: one that never counts would only be evaluated in vain.
bool applies(const Method& method, const Energy& energy) {
  return energy.weight > 0 && (!energy.uses_features() || uses_features(method));
}

std::vector<Term> make_terms(Device& device, const Method& method, const Scene& scene,
                             const std::vector<Eigen::Vector3f>& node_positions,
                             const std::shared_ptr<Constraints>& surface) {
  std::shared_ptr<Constraints> features;
  if (uses_features(method)) features = make_feature_constraints(device, method, scene, node_positions);
  std::vector<Term> terms;
  for (const Energy& energy : method.energies) {
    if (!applies(method, energy)) continue;
    std::shared_ptr<Constraints> constraints;
    if (energy.stencil == Stencil::per_constraint) constraints = energy.uses_features() ? features : surface;
    terms.push_back({energy, std::move(constraints)});
  }
  return terms;
}

Skeleton make_skeleton(const Scene& scene, const Method& method, Device& device,
                       const NodeSelection& selection, StageTimes& times) {
  const std::vector<int>& nodes = selection.points();
  check_selection(scene, "node of the graph", nodes);
  Skeleton skeleton;
  skeleton.nodes = nodes;
  skeleton.cells = selection.cells();
  skeleton.positions = pick(scene.aligned.points, nodes);
  skeleton.node_points = flatten(skeleton.positions);
  skeleton.influences =
      compute_influences(device, scene.rest.points, skeleton.positions, method.nearest_nodes);
  skeleton.influences.nodes.host();  // waits here for the device: its "weights" are not the time of "edges"
  skeleton.edges =
      timed(times, "edges", [&] { return find_edges(skeleton.influences, static_cast<int>(nodes.size())); });
  return skeleton;
}

Model make_model(const Scene& scene, const Method& method, Device& device, const Skeleton& skeleton,
                 const PointSelection& selection, bool follows_all) {
  const std::vector<int>& samples = selection.points();
  check_selection(scene, "constraint", samples);
  Array<int> selected(samples);
  auto constraints = make_constraints(pick(scene.aligned.points, samples),
                                      pick_influences(device, skeleton.influences, selected));
  if (!follows_all) selected = Array<int>(first_indices(samples.size()));
  auto problem = std::make_unique<Problem>(DeformationGraph{skeleton.positions, skeleton.edges},
                                           make_terms(device, method, scene, skeleton.positions, constraints),
                                           method.length_unit, *method.transform);
  return {std::move(selected), Array<float>(selection.weights()), std::move(constraints), std::move(problem)};
}

constexpr double least_matched_share = 0.5;  ///< with less the result comes with a warning

/// Room for a deformed set of points.
PointSet unwritten(const PointSet& rest) {
  return {Array<float>(rest.points.size()), Array<float>(rest.normals.size())};
}

/// One registration [thesis Figure 4.1].
class Registration {
 public:
  Registration(const FramePair& pair, const Method& method, Device& device, std::uint64_t seed)
      : method_(method),
        device_(device),
        scene_(make_scene(pair, method, device, seed, times_)),
        nodes_(timed(times_, "ans",
                     [&] { return method.graph->select_nodes(device, scene_.aligned, pair.camera); })),
        samples_(timed(times_, "acs",
                       [&] { return method.sampler->select(device, scene_.aligned, pair.camera); })),
        skeleton_(std::make_shared<Skeleton>(make_skeleton(scene_, method, device, *nodes_, times_))),
        follows_all_(!nodes_->is_fixed() || !samples_->is_fixed()),
        sampled_(follows_all_ ? PointSet{}
                              : pick_points(device, scene_.rest, Array<int>(samples_->points()))),
        model_(make_new_model()),
        moved_(followed()),
        meter_(device, *method.correspondence, scene_.target, moved_.points.size() / 3, method.stopping.cut) {
  }

  void match() {
    set_weights();
    method_.correspondence->match(device_, moved_, model_.selected, scene_.target, *model_.constraints);
    if (!model_.weights.empty()) weigh(device_, model_.weights, *model_.constraints);
  }

  void run(const ProgressSink& progress) {
    bind_solver();
    measure_start();
    while (termination_.empty()) {
      iterate();
      if (termination_.empty()) decide();
      report(progress);
    }
    collect_summaries();
    history_.resize(static_cast<std::size_t>(iterations_) + 1);  // without solves that have failed
    if (!is_after_schedule(history_.size() - 1)) best_ = best_of_all_;
    deform_best();
  }

  RegistrationResult take_result();
  std::unique_ptr<Problem> take_problem() { return std::move(model_.problem); }

 private:
  void bind_solver() { solver_ = method_.solver->bind(*model_.problem, device_); }

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
    warp(device_, followed(), follows_all_ ? skeleton_->influences : model_.constraints->influences,
         skeleton_->node_points, model_.problem->unknowns(), moved_);
  }

  /// The points that are deformed and measured in each iteration. Where nodes and constraints stay as they
  /// are, the constrained points are enough.
  const PointSet& followed() const { return follows_all_ ? scene_.rest : sampled_; }

  /// Where an iteration led.
  struct State {
    std::size_t iteration = 0;
    std::shared_ptr<const Skeleton> skeleton;
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
      if (iteration == 0 || is_better) best = {iteration, skeleton_, model_.problem->unknowns()};
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
      registered_ = unwritten(scene_.rest);
      warp(device_, scene_.rest, best_.skeleton->influences, best_.skeleton->node_points, best_.unknowns,
           registered_);
    }
    matched_ = is_there && method_.correspondence->measures_matches() ? with_residual() : find_matched();
    deform_unfiltered();
  }

  std::vector<std::uint8_t> with_residual() const {
    const auto& residuals = meter_.per_point().host();
    std::vector<std::uint8_t> known(residuals.size());
    std::transform(residuals.begin(), residuals.end(), known.begin(),
                   [](float residual) { return static_cast<std::uint8_t>(residual >= 0); });
    return known;
  }

  std::vector<std::uint8_t> find_matched() {
    const std::size_t count = scene_.aligned.size();
    Constraints constraints;
    constraints.points = scene_.rest.points;
    constraints.data = Array<float>(6 * count);
    constraints.confidence = Array<float>(count);
    method_.correspondence->match(device_, registered_, Array<int>(first_indices(count)), scene_.target,
                                  constraints);
    const auto& confidence = constraints.confidence.host();
    std::vector<std::uint8_t> matched(confidence.size());
    std::transform(confidence.begin(), confidence.end(), matched.begin(),
                   [](float value) { return static_cast<std::uint8_t>(value > 0); });
    return matched;
  }

  /// Moves each point that was given as the filtered one in its place was moved. The transforms are not
  /// applied to it: nothing determines what they do across the surface they were fitted to, and noise would
  /// be stretched by that.
  void deform_unfiltered() {
    auto& moved = registered_.points.write_host();
    for (std::size_t i = 0; i < scene_.unfiltered.size(); ++i)
      Eigen::Map<Eigen::Vector3f>(moved.data() + 3 * i) += scene_.unfiltered[i] - scene_.aligned.points[i];
  }

  void measure_start() {
    const Residual residual = meter_.measure(moved_);
    if (residual.lost > 0)
      throw NumericalError(
          fmt::format("{}: {} point(s) of the source are not finite where the alignment puts them",
                      scene_.pair.name, residual.lost));
    if (residual.landed == 0)
      throw DataError(
          fmt::format("{}: no point of the source projects onto a point of the target; an initial "
                      "alignment may help",
                      scene_.pair.name));
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

  /// Whether any energy asks a point to go anywhere. Waits for the device: asked once a model, and when
  /// nothing is matched.
  bool is_pulled() {
    const auto& terms = model_.problem->terms();
    return has_pulled_ = std::any_of(terms.begin(), terms.end(), [&](const Term& term) {
             return term.constraints != nullptr && term.energy.weight > 0 &&
                    any_in_force(device_, *term.constraints);
           });
  }

  /// Ends the loop, or adapts graph and constraints to the residual and lets it go on.
  void decide() {
    const StoppingRule& rule = method_.stopping;
    if (history_.back().residual_mean < rule.residual)
      termination_ = "residual";
    else if (iterations_ >= rule.max_iterations)
      termination_ = "max_iterations";
    else
      adapt();
  }

  /// Whether the residual stays, or has come down to where it was before the last adaptation: constraints
  /// that are taken away where the surface fits, and given back once it no longer does, may swing for ever.
  bool is_stuck() const {
    const auto last = history_.rbegin();
    const double now = last->residual_mean;
    const auto is_near = [&](const RegistrationResult::Step& earlier) {
      return std::abs(earlier.residual_mean - now) < method_.stopping.min_progress * earlier.residual_mean;
    };
    return is_near(last[1]) || (history_.size() > 2 && now < last[1].residual_mean && is_near(last[2]));
  }

  /// Weighs the terms as they count at this point of the schedule.
  void set_weights() {
    std::size_t term = 0;
    for (const Energy& energy : method_.energies) {
      if (!applies(method_, energy)) continue;
      const Energy now = energy.at(method_.schedule.remaining(iterations_));
      model_.problem->set_weight(term, now.weight);
      model_.problem->set_loss_scale(term, now.loss.scale);
      ++term;
    }
  }

  /// Only a softer or a first new graph promises more where nothing was gained: adaptive constraints seldom
  /// stay the same, and a graph that has grown without gaining would grow on.
  void adapt() {
    const bool was_stuck = is_stuck();
    const bool is_softer = method_.schedule.remaining(iterations_ - 1) > 0;
    const bool may_grow = is_softer || !was_stuck || !has_grown_;
    const bool has_new_nodes = may_grow && adapt_nodes();
    if (!is_softer && !has_new_nodes && was_stuck)
      termination_ = "no_progress";
    else if (const bool has_new_samples = adapt_samples(); has_new_nodes || has_new_samples)
      renew();
    has_grown_ = has_grown_ || has_new_nodes;
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

  Model make_new_model() { return make_model(scene_, method_, device_, *skeleton_, *samples_, follows_all_); }

  /// Makes the model of the graph and constraints anew; the deformation so far is kept.
  void rebuild() {
    Array<float> start = model_.problem->unknowns();
    if (nodes_->points() != skeleton_->nodes) {
      Skeleton next = make_skeleton(scene_, method_, device_, *nodes_, times_);
      start = carry_over(device_, {skeleton_->nodes, skeleton_->influences, start}, next.nodes,
                         scene_.aligned.points);
      skeleton_ = std::make_shared<Skeleton>(std::move(next));
    }
    model_ = make_new_model();
    has_pulled_ = false;
    model_.problem->unknowns() = std::move(start);
    bind_solver();
  }

  void report(const ProgressSink& progress) const {
    if (!progress) return;
    const double done =
        termination_.empty() ? static_cast<double>(iterations_) / method_.stopping.max_iterations : 1.0;
    progress({scene_.pair.name, done,
              fmt::format("iteration {}: residual {:.3f} mm", iterations_, history_.back().residual_mean)});
  }

  StageTimes times_;
  const Method& method_;
  Device& device_;
  Scene scene_;
  std::unique_ptr<NodeSelection> nodes_;
  std::unique_ptr<PointSelection> samples_;
  bool has_grown_ = false;  ///< whether the graph is another than at first
  std::shared_ptr<const Skeleton> skeleton_;
  bool follows_all_;
  bool has_pulled_ = false;  ///< whether a constraint of the present model was in force
  PointSet sampled_;         ///< the constrained points at rest, where only they are followed
  Model model_;
  PointSet moved_;                    ///< those that are followed
  std::optional<std::size_t> shown_;  ///< the iteration that `moved_` was measured after, if it was
  PointSet registered_;               ///< all, at the end
  ResidualMeter meter_;
  std::unique_ptr<BoundSolver> solver_;
  std::vector<RegistrationResult::Step> history_;
  State best_;         ///< of the alignment and the iterations after the schedule
  State best_of_all_;  ///< of these and those of the schedule
  std::vector<std::uint8_t> matched_;
  int iterations_ = 0;
  std::string termination_;  ///< empty while the loop goes on
  std::string reason_;
  std::vector<SolverSummary> summaries_;
};

/// One summary for each iteration, and perhaps some of solves that were taken back.
void record_solves(std::vector<SolverSummary> summaries, RegistrationResult& result) {
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

RegistrationResult Registration::take_result() {
  RegistrationResult result;
  result.points = unflatten(registered_.points);
  result.normals = unflatten(registered_.normals);
  result.matched = std::move(matched_);
  result.node_positions = best_.skeleton->positions;
  result.graph_cells = best_.skeleton->cells;
  result.counts.source_points = static_cast<int>(scene_.source.size());
  result.counts.matched_points =
      static_cast<int>(std::count(result.matched.begin(), result.matched.end(), std::uint8_t{1}));
  result.counts.nodes = static_cast<int>(best_.skeleton->nodes.size());
  result.counts.edges = static_cast<int>(best_.skeleton->edges.size());
  result.counts.constraints = static_cast<int>(model_.selected.size());
  result.counts.unknowns = method_.transform->unknowns * result.counts.nodes;
  result.counts.outer_iterations = iterations_;
  result.history = std::move(history_);
  result.returned_iteration = static_cast<int>(best_.iteration);
  result.termination = termination_;
  result.reason = reason_;
  result.warnings = warnings_of(method_, result.counts);
  if (result.counts.matched_points < least_matched_share * result.counts.source_points)
    result.warnings.push_back(fmt::format(
        "only {} of {} points of the source have a match at the end; the others went with their neighbours",
        result.counts.matched_points, result.counts.source_points));
  result.time_ms = times_;
  for (const auto& [stage, time] : device_.take_stage_times())
    if (!is_waited_for(stage)) result.time_ms[stage] += time;
  record_solves(std::move(summaries_), result);
  result.source = std::move(scene_.source);
  result.aligned_points = std::move(scene_.unfiltered.empty() ? scene_.aligned.points : scene_.unfiltered);
  result.alignment = scene_.alignment;
  return result;
}

}  // namespace

std::vector<std::string> warnings_of(const Method& method, const RegistrationResult::Counts& counts) {
  if (counts.nodes > method.nearest_nodes) return {};
  return {fmt::format("the graph has {} node(s): all of them move every point, though nearest_nodes is {}",
                      counts.nodes, method.nearest_nodes)};
}

RegistrationResult register_pair(const FramePair& pair, const Method& method, Device& device,
                                 std::uint64_t seed, const ProgressSink& progress) {
  const Stopwatch watch;
  device.take_stage_times();  // of whatever came before
  Registration registration(pair, method, device, seed);
  registration.run(progress);
  RegistrationResult result = registration.take_result();
  result.warnings.insert(result.warnings.begin(), pair.warnings.begin(), pair.warnings.end());
  result.total_ms = watch.milliseconds();
  return result;
}

std::unique_ptr<Problem> freeze_problem(const FramePair& pair, const Method& method, Device& device,
                                        std::uint64_t seed) {
  Registration registration(pair, method, device, seed);
  registration.match();
  return registration.take_problem();
}

}  // namespace pliant
