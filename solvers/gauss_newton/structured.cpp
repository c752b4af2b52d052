#include "solvers/gauss_newton/structured.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "framework/core/error.h"
#include "framework/problem/structure.h"
#include "solvers/gauss_newton/linear_solver.h"
#include "solvers/gauss_newton/structured/kernels.h"

namespace pliant {
namespace {

constexpr int chunk = 64;  // CHUNK in instance_terms.cl
constexpr int batch = 16;  // nodes whose values lie in one float16
constexpr std::size_t group = 16;
constexpr std::size_t state_bytes = 64;  // no less than a State in structured/minimiser.cl

int rounded_up(int value, int multiple) { return (value + multiple - 1) / multiple * multiple; }

/// One kind of instances (all edges, or all constraints) on the device, as `assemble` takes it.
struct Instances {
  Incidences incidences;
  NodeLists lists;
  Buffer nodes, starts, entries, places, lever_arms, contributions;

  void upload(Device& device, int padded, const std::vector<std::uint16_t>& block_places) {
    lists.starts.resize(static_cast<std::size_t>(padded) + 1, lists.starts.back());
    for (int& node : incidences.nodes) node = std::max(node, 0);  // an empty slot has a lever arm of zero
    nodes = device.upload(incidences.nodes);
    starts = device.upload(lists.starts);
    entries = device.upload(lists.entries);
    places = device.upload(block_places);
    lever_arms = device.allocate(4 * sizeof(float) * incidences.nodes.size());
    contributions = device.allocate(4 * sizeof(float) * incidences.size());
  }
};

/// A term per edge or per constraint, and where its instances stand among those of its kind.
struct InstanceTerm {
  const Term* term;
  Instances* kind;
  cl_int first;
  cl_int count;
  cl_int add;  ///< another term has already written to the same instances
  cl_int first_partial;
  cl_int first_change;  ///< of a term that couples the axes
  cl::Kernel evaluate;
  cl::Kernel change;

  int partials() const { return (count + chunk - 1) / chunk; }
};

class StructuredMinimiser : public Minimiser {
 public:
  StructuredMinimiser(Problem& problem, Device& device, const MinimiserOptions& options)
      : problem_(problem),
        device_(device),
        options_(options),
        node_count_(problem.node_count()),
        padded_(rounded_up(problem.node_count(), batch)) {
    collect_terms();
    lay_out();
    make_kernels();
    make_lever_arms();
  }

  void enqueue(const Buffer& status) override {
    upload_node_weights();
    for (auto& term : instance_terms_) evaluate("jacobian", term, status);
    device_.run("mm", assemble_, static_cast<std::size_t>(padded_), group, status, padded_, count_of(edges_),
                edges_.nodes, edges_.starts, edges_.entries, edges_.lever_arms, edges_.contributions,
                edges_.places, count_of(constraints_), constraints_.nodes, constraints_.starts,
                constraints_.entries, constraints_.lever_arms, constraints_.contributions,
                constraints_.places, row_starts_, matrix_, gradient_);
    if (is_coupled())
      minimise_step_by_step(status);
    else
      run_minimiser(solve_, status, gradient_, partial_count_, partials_,
                    problem_.unknowns().write_device(device_));
    // The changes of many steps hide what is left of the energy; that of one does not.
    const bool sums_anew = options_.max_iterations > 1;
    if (sums_anew)
      for (auto& term : instance_terms_) evaluate("energy", term, status);
    device_.run("energy", conclude_, 1, 1, status, sums_anew ? partial_count_ + 1 : 0, partials_);
  }

  std::string description() const override { return "structured"; }

 private:
  static cl_int count_of(const Instances& kind) { return static_cast<cl_int>(kind.incidences.size()); }

  void collect_terms() {
    const int edge_count = static_cast<int>(problem_.graph().edges.size());
    edges_.incidences.per_instance = 2;
    constraints_.incidences.per_instance = 1;
    for (const auto& term : problem_.terms()) {
      if (term.energy.stencil == Stencil::per_node) {
        node_terms_.push_back(&term);
        continue;
      }
      InstanceTerm made{&term, &edges_, 0, edge_count, 0, partial_count_, coupled_partial_count_, {}, {}};
      if (term.constraints) {
        made.kind = &constraints_;
        made.first = first_of(term.constraints.get(), !enters_matrix(term.energy), made.add);
        made.count = static_cast<int>(term.constraints->size());
        if (!enters_matrix(term.energy)) coupled_partial_count_ += made.partials();
      } else {
        const auto own = edge_incidences(problem_.graph()).nodes;
        made.first = static_cast<int>(edges_.incidences.size());
        edges_.incidences.nodes.insert(edges_.incidences.nodes.end(), own.begin(), own.end());
      }
      partial_count_ += made.partials();
      instance_terms_.push_back(std::move(made));
    }
    for (const auto& set : sets_) append_slots(set.constraints->influences);
  }

  /// Where the instances of a set of constraints begin; `add` becomes true when a term of the same sort has
  /// been there before.
  int first_of(const Constraints* constraints, bool coupled, cl_int& add) {
    auto set = std::find_if(sets_.begin(), sets_.end(),
                            [&](const ConstraintSet& known) { return known.constraints == constraints; });
    if (set == sets_.end()) {
      set = sets_.insert(set, {constraints, constraint_count_, {false, false}});
      constraint_count_ += static_cast<int>(constraints->size());
      auto& slots = constraints_.incidences.per_instance;
      slots = std::max(slots, constraints->influences.per_point);
    }
    add = static_cast<cl_int>(std::exchange(set->written[coupled ? 1 : 0], true));
    return set->first;
  }

  void append_slots(const Influences& influences) {
    const auto k = static_cast<std::size_t>(influences.per_point);
    const auto slots = static_cast<std::size_t>(constraints_.incidences.per_instance);
    const auto& from = influences.nodes.host();
    auto& to = constraints_.incidences.nodes;
    if (k == slots) {
      to.insert(to.end(), from.begin(), from.end());
      return;
    }
    for (std::size_t i = 0; i + k <= from.size(); i += k) {
      to.insert(to.end(), &from[i], &from[i] + k);
      to.insert(to.end(), slots - k, -1);
    }
  }

  void lay_out() {
    edges_.lists = list_by_node(edges_.incidences, node_count_);
    constraints_.lists = list_by_node(constraints_.incidences, node_count_);
    auto pattern = find_blocks({&edges_.incidences, &constraints_.incidences},
                               {&edges_.lists, &constraints_.lists}, node_count_);
    for (int node = node_count_; node < padded_; ++node) {
      pattern.columns.push_back(node);
      pattern.starts.push_back(static_cast<int>(pattern.columns.size()));
    }
    edges_.upload(device_, padded_, pattern.places[0]);
    constraints_.upload(device_, padded_, pattern.places[1]);
    row_starts_ = device_.upload(pattern.starts);
    columns_ = device_.upload(pattern.columns);

    constexpr auto number = sizeof(float);
    const auto nodes = static_cast<std::size_t>(padded_);
    matrix_ = device_.allocate(number * 16 * pattern.columns.size());
    diagonal_ = device_.allocate(number * 78 * nodes);
    factors_ = device_.allocate(number * 78 * nodes);
    gradient_ = device_.allocate(number * 16 * nodes);
    vectors_ = device_.allocate(number * (7 * 12 + 16) * nodes);  // seven in chunks, one node by node
    partials_ = device_.allocate(number * static_cast<std::size_t>(partial_count_ + 1));
    allocate_coupled(nodes);
  }

  /// What only terms that couple the axes need; kernels take it in any case.
  void allocate_coupled(std::size_t nodes) {
    constexpr auto number = sizeof(float);
    const auto instances = is_coupled() ? constraints_.incidences.size() : 0;
    if (!is_coupled()) nodes = 0;
    // Zeros: a set of constraints may have terms of only one of the two sorts.
    if (is_coupled()) constraints_.contributions = device_.upload(std::vector<float>(4 * instances, 0.0F));
    point_hessians_ = device_.upload(std::vector<float>(8 * instances, 0.0F));
    coupled_contributions_ = device_.upload(std::vector<float>(4 * instances, 0.0F));
    hessian_products_ = device_.allocate(number * 4 * instances);
    coupled_diagonal_ = device_.allocate(number * 78 * nodes);
    coupled_gradient_ = device_.allocate(number * 12 * nodes);
    trial_ = device_.allocate(number * 12 * nodes);
    changes_ = device_.allocate(number * static_cast<std::size_t>(coupled_partial_count_));
    state_ = device_.allocate(state_bytes);
  }

  void make_kernels() {
    local_ = static_cast<std::size_t>(device_.work_group_size());
    const auto source =
        minimiser_source(node_terms_, constraints_.incidences.per_instance, is_coupled(), local_);
    const auto kernel = [&](const char* name) { return device_.kernel(source, name); };
    assemble_ = kernel("assemble");
    conclude_ = kernel("conclude");
    if (is_coupled()) {
      assemble_coupled_ = kernel("assemble_coupled");
      begin_ = kernel("begin");
      step_ = kernel("next_step");
      take_ = kernel("take_step");
      end_ = kernel("end");
    } else {
      solve_ = kernel("solve");
    }
    for (auto& term : instance_terms_) {
      term.evaluate = term_kernel(term, "evaluate");
      if (!enters_matrix(term.term->energy)) term.change = term_kernel(term, "change");
    }
  }

  cl::Kernel term_kernel(const InstanceTerm& term, const std::string& name) {
    return device_.kernel(instance_terms_source(term.term->energy),
                          name + "_" + term.term->energy.equation.name,
                          fmt::format("-DK={}", term.kind->incidences.per_instance));
  }

  /// The weight of each term per node and the scale of its loss.
  void upload_node_weights() {
    std::vector<float> weights;
    for (const auto* term : node_terms_)
      weights.insert(weights.end(), {weight_of(*term), static_cast<float>(term->energy.loss.scale)});
    node_weights_ = device_.upload(weights);
  }

  /// What the instances' nodes and points fix once and for all.
  void make_lever_arms() {
    const auto& node_points = problem_.node_points().device(device_);
    for (auto& term : instance_terms_) {
      if (term.kind != &edges_) continue;
      auto kernel = term_kernel(term, "lever_arms");
      device_.run("weights", kernel, static_cast<std::size_t>(rounded_up(term.count, batch) / batch), 4,
                  node_points, term.count, edges_.nodes, term.first, edges_.lever_arms);
    }
    for (const auto& set : sets_)
      compute_lever_arms(device_, *set.constraints, problem_.node_points(), set.first,
                         constraints_.incidences.per_instance, constraints_.lever_arms);
  }

  bool is_coupled() const { return coupled_partial_count_ > 0; }

  /// A kernel over the system as a whole: one work-group.
  template <class... Arguments>
  void run_minimiser(cl::Kernel& kernel, const Buffer& status, const Arguments&... arguments) {
    device_.run("solver", kernel, local_, local_, status, node_count_, padded_ / batch,
                options_.max_iterations, options_.tolerance, options_.damping, node_weights_, row_starts_,
                columns_, matrix_, diagonal_, factors_, vectors_, count_of(edges_), edges_.nodes,
                edges_.starts, edges_.entries, edges_.lever_arms, edges_.contributions,
                count_of(constraints_), constraints_.nodes, constraints_.starts, constraints_.entries,
                constraints_.lever_arms, constraints_.contributions, point_hessians_, hessian_products_,
                coupled_diagonal_, coupled_gradient_, arguments...);
  }

  void minimise_step_by_step(const Buffer& status) {
    const auto& unknowns = problem_.unknowns().write_device(device_);
    run_minimiser(begin_, status, gradient_, partial_count_, partials_, unknowns, state_);
    for (int iteration = 0;
         iteration < options_.max_iterations && (iteration == 0 || !has_ended(device_, status));
         ++iteration) {
      // The first time what was evaluated at the start still holds.
      for (auto& term : instance_terms_)
        if (!enters_matrix(term.term->energy) && iteration > 0) evaluate("jacobian", term, status);
      device_.run("mm", assemble_coupled_, static_cast<std::size_t>(padded_ / batch), 1, status,
                  padded_ / batch, count_of(constraints_), constraints_.nodes, constraints_.starts,
                  constraints_.entries, constraints_.lever_arms, constraints_.contributions, point_hessians_,
                  coupled_contributions_, coupled_diagonal_, coupled_gradient_);
      run_minimiser(step_, status, state_, trial_);
      for (auto& term : instance_terms_)
        if (!enters_matrix(term.term->energy)) measure_change(term, status);
      run_minimiser(take_, status, state_, coupled_partial_count_, changes_, unknowns);
    }
    run_minimiser(end_, status, state_, partial_count_, partials_, unknowns);
  }

  void evaluate(const std::string& stage, InstanceTerm& term, const Buffer& status) {
    const auto& node_points = problem_.node_points().device(device_);
    const auto* constraints = term.term->constraints.get();
    const auto& data = constraints ? constraints->data.device(device_) : node_points;
    const auto& confidence = constraints ? constraints->confidence.device(device_) : node_points;
    device_.run(stage, term.evaluate, static_cast<std::size_t>(term.partials()), 1, status, term.count,
                weight_of(*term.term), loss_scale_of(term), problem_.unknowns().device(device_), term.first,
                term.kind->nodes, term.kind->lever_arms, node_points, data, confidence, term.add,
                !enters_matrix(term.term->energy) ? coupled_contributions_ : term.kind->contributions,
                point_hessians_, term.first_partial, partials_);
  }

  void measure_change(InstanceTerm& term, const Buffer& status) {
    const auto& constraints = *term.term->constraints;
    device_.run("energy", term.change, static_cast<std::size_t>(term.partials()), 1, status, term.count,
                weight_of(*term.term), loss_scale_of(term), problem_.unknowns().device(device_), trial_,
                term.first, term.kind->nodes, term.kind->lever_arms, constraints.data.device(device_),
                constraints.confidence.device(device_), term.first_change, changes_);
  }

  cl_float weight_of(const Term& term) const {
    return static_cast<cl_float>(problem_.effective_weight(term));
  }

  static cl_float loss_scale_of(const InstanceTerm& term) {
    return static_cast<cl_float>(term.term->energy.loss.scale);
  }

  struct ConstraintSet {
    const Constraints* constraints;
    cl_int first;
    std::array<bool, 2> written;  ///< by a term that separates, by one that couples the axes
  };

  Problem& problem_;
  Device& device_;
  MinimiserOptions options_;
  cl_int node_count_;
  cl_int padded_;
  std::size_t local_ = 1;
  std::vector<const Term*> node_terms_;
  std::vector<InstanceTerm> instance_terms_;
  std::vector<ConstraintSet> sets_;
  Instances edges_;
  Instances constraints_;
  cl_int partial_count_ = 0;
  cl_int coupled_partial_count_ = 0;
  int constraint_count_ = 0;
  Buffer row_starts_, columns_, matrix_, diagonal_, factors_, gradient_, vectors_;
  Buffer node_weights_, partials_;
  Buffer point_hessians_, coupled_contributions_, hessian_products_, coupled_diagonal_, coupled_gradient_;
  Buffer trial_, changes_, state_;
  cl::Kernel assemble_, assemble_coupled_, solve_, begin_, step_, take_, end_, conclude_;
};

class Structured : public LinearSolver {
 public:
  std::unique_ptr<Minimiser> bind(Problem& problem, Device& device,
                                  const MinimiserOptions& options) const override {
    const auto obstacle = structured_obstacle(problem);
    if (!obstacle.empty()) throw ConfigError("linear solver structured: " + obstacle);
    return std::make_unique<StructuredMinimiser>(problem, device, options);
  }
};

}  // namespace

std::string structured_obstacle(const Problem& problem) {
  if (!problem.transform().is_free())
    return fmt::format("transform {} couples the axes of a node", problem.transform().name);
  for (const auto& term : problem.terms())
    if (term.energy.stencil == Stencil::per_edge && !enters_matrix(term.energy))
      return fmt::format("energy {} couples the axes of neighbouring nodes", term.energy.equation.name);
  return "";
}

void register_structured(Registry& registry) {
  registry.add<LinearSolver>(
      "structured", "Conjugate gradients that exploit that most energies treat x, y and z apart", {},
      [](const Parameters&, const Registry&) { return std::make_unique<Structured>(); });
}

}  // namespace pliant
