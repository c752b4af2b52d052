#include "solvers/gauss_newton/structured.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "framework/core/error.h"
#include "framework/device/lanes.h"
#include "framework/problem/equation_source.h"
#include "framework/problem/structure.h"
#include "solvers/gauss_newton/linear_solver.h"
#include "solvers/gauss_newton/node_terms.cl.embed.h"
#include "solvers/gauss_newton/rows.cl.embed.h"
#include "solvers/gauss_newton/structured.cl.embed.h"

namespace pliant {
namespace {

constexpr int chunk = 64;  // CHUNK in rows.cl
constexpr int lanes = 16;  // nodes that the course handles at once
constexpr std::size_t group = 16;
constexpr std::size_t course_bytes = 64;  // no less than a Course in structured.cl

int rounded_up(int value, int multiple) { return (value + multiple - 1) / multiple * multiple; }

/// Whether an energy's J^T J is M (x) I_3 and does not change from step to step: then it is assembled once.
bool enters_matrix(const Energy& energy) {
  return energy.equation.axis_separable() && !energy.loss.is_robust();
}

std::string rows_source(const Energy& energy) {
  const auto& name = energy.equation.name;
  return with_lanes(fmt::format(
      "{0}#define NAME_RESIDUAL {1}_residual\n#define NAME_JACOBIAN {1}_jacobian\n#define NAME_ROW {1}_row\n"
      "#define KERNEL(x) x##_{1}\n#define ROWS {2}\n#define PER_EDGE {3}\n#define SEPARABLE {4}\n"
      "#define ROBUST {5}\n{6}{7}",
      equation_source(energy, "float16"), name, energy.residuals,
      static_cast<int>(energy.stencil == Stencil::per_edge), static_cast<int>(enters_matrix(energy)),
      static_cast<int>(energy.loss.is_robust()), loss_source(energy.loss, "float16"),
      embedded::solvers_gauss_newton_rows_cl));
}

/// The functions of every term per node, and three that call them all.
std::string node_terms_source(const std::vector<const Term*>& terms) {
  // From the order 4 axis + c to that of the equations.
  std::string text = "#define COLUMNWISE(m) (3 * ((m) % 4) + (m) / 4)\n" + losses_source("float16");
  std::string add, change, energy;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const Energy& term = terms[i]->energy;
    const auto& name = term.equation.name;
    if (std::none_of(terms.begin(), terms.begin() + static_cast<std::ptrdiff_t>(i),
                     [&](const Term* other) { return other->energy.equation.name == name; }))
      text += equation_source(term, "float16");
    text += fmt::format(
        "#undef NAME_RESIDUAL\n#undef NAME_JACOBIAN\n#undef TERM\n#undef ROWS\n#undef ROBUST\n"
        "#define NAME_RESIDUAL {0}_residual\n#define NAME_JACOBIAN {0}_jacobian\n#define TERM(x) x##_{1}\n"
        "#define ROWS {2}\n#define ROBUST {3}\n{4}{5}",
        name, i, term.residuals, static_cast<int>(term.loss.is_robust()), loss_choice_source(term.loss),
        embedded::solvers_gauss_newton_node_terms_cl);
    add += fmt::format("  add_{}(u, inside * weights[{}], weights[{}], packed, gradient);\n", i, 2 * i,
                       2 * i + 1);
    change +=
        fmt::format("  change += change_{}(u, v, inside * weights[{}], weights[{}]);\n", i, 2 * i, 2 * i + 1);
    energy +=
        fmt::format("  energy += energy_{}(u, inside * weights[{}], weights[{}]);\n", i, 2 * i, 2 * i + 1);
  }
  return text + fmt::format(
                    "float16 add_node_terms(const float16* u, float16 inside, global const float* weights,\n"
                    "                       float16* packed, float16* gradient) {{\n"
                    "  float16 energy = 0;\n{}  return energy;\n}}\n"
                    "float16 change_of_node_terms(const float16* u, const float16* v, float16 inside,\n"
                    "                             global const float* weights) {{\n"
                    "  float16 change = 0;\n{}  return change;\n}}\n"
                    "float16 energy_of_node_terms(const float16* u, float16 inside, global const float* "
                    "weights) {{\n"
                    "  float16 energy = 0;\n{}  return energy;\n}}\n",
                    add, change, energy);
}

/// One kind of instances (all edges, or all constraints) on the device, as `assemble` takes it.
struct Kind {
  Incidences incidences;
  NodeLists lists;
  cl::Buffer nodes, starts, entries, places, arms, forces;

  void upload(Device& device, int padded, const std::vector<std::uint16_t>& block_places) {
    lists.starts.resize(static_cast<std::size_t>(padded) + 1, lists.starts.back());
    for (int& node : incidences.nodes) node = std::max(node, 0);  // an empty slot has an arm of zero
    nodes = device.upload(incidences.nodes);
    starts = device.upload(lists.starts);
    entries = device.upload(lists.entries);
    places = device.upload(block_places);
    arms = device.allocate(4 * sizeof(float) * incidences.nodes.size());
    forces = device.allocate(4 * sizeof(float) * incidences.size());
  }
};

/// A term per edge or per constraint, and where its instances stand among those of its kind.
struct RowTerm {
  const Term* term;
  Kind* kind;
  cl_int first;
  cl_int count;
  cl_int add;  ///< another term has already written to the same instances
  cl_int first_partial;
  cl_int first_change;  ///< of a term that couples the axes
  cl::Kernel evaluate;
  cl::Kernel change;

  int partials() const { return (count + chunk - 1) / chunk; }
};

class StructuredCourse : public Course {
 public:
  StructuredCourse(Problem& problem, Device& device, const CourseOptions& options)
      : problem_(problem),
        device_(device),
        options_(options),
        node_count_(problem.node_count()),
        padded_(rounded_up(problem.node_count(), lanes)) {
    collect_terms();
    lay_out();
    make_kernels();
    make_arms();
  }

  void enqueue(const cl::Buffer& status) override {
    upload_node_weights();
    for (auto& term : row_terms_) evaluate("jacobian", term, status);
    device_.run("mm", assemble_, static_cast<std::size_t>(padded_), group, status, padded_, count_of(edges_),
                edges_.nodes, edges_.starts, edges_.entries, edges_.arms, edges_.forces, edges_.places,
                count_of(constraints_), constraints_.nodes, constraints_.starts, constraints_.entries,
                constraints_.arms, constraints_.forces, constraints_.places, rows_, matrix_, gradient_);
    if (is_coupled())
      minimise_step_by_step(status);
    else
      run_course(solve_, status, gradient_, partial_count_, partials_,
                 problem_.unknowns().write_device(device_));
    // The changes of many steps hide what is left of the energy; that of one does not.
    const bool sums_anew = options_.max_iterations > 1;
    if (sums_anew)
      for (auto& term : row_terms_) evaluate("energy", term, status);
    device_.run("energy", conclude_, 1, 1, status, sums_anew ? partial_count_ + 1 : 0, partials_);
  }

  std::string description() const override { return "structured"; }

 private:
  static cl_int count_of(const Kind& kind) { return static_cast<cl_int>(kind.incidences.size()); }

  void collect_terms() {
    const int edge_count = static_cast<int>(problem_.graph().edges.size());
    edges_.incidences.per_instance = 2;
    constraints_.incidences.per_instance = 1;
    for (const auto& term : problem_.terms()) {
      if (term.energy.stencil == Stencil::per_node) {
        node_terms_.push_back(&term);
        continue;
      }
      RowTerm made{&term, &edges_, 0, edge_count, 0, partial_count_, coupled_partial_count_, {}, {}};
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
      row_terms_.push_back(std::move(made));
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
    rows_ = device_.upload(pattern.starts);
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
    if (is_coupled()) constraints_.forces = device_.upload(std::vector<float>(4 * instances, 0.0F));
    couplings_ = device_.upload(std::vector<float>(8 * instances, 0.0F));
    coupled_forces_ = device_.upload(std::vector<float>(4 * instances, 0.0F));
    pulls_ = device_.allocate(number * 4 * instances);
    coupled_diagonal_ = device_.allocate(number * 78 * nodes);
    coupled_gradient_ = device_.allocate(number * 12 * nodes);
    trial_ = device_.allocate(number * 12 * nodes);
    changes_ = device_.allocate(number * static_cast<std::size_t>(coupled_partial_count_));
    course_ = device_.allocate(course_bytes);
  }

  void make_kernels() {
    local_ = static_cast<std::size_t>(device_.work_group_size());
    const std::string source = with_lanes(
        fmt::format("#define LANES {}\n#define SLOTS {}\n#define K {}\n#define COUPLED {}\n{}{}", local_,
                    max_influences, constraints_.incidences.per_instance, static_cast<int>(is_coupled()),
                    node_terms_source(node_terms_), embedded::solvers_gauss_newton_structured_cl));
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
    for (auto& term : row_terms_) {
      term.evaluate = row_kernel(term, "evaluate");
      if (!enters_matrix(term.term->energy)) term.change = row_kernel(term, "change");
    }
  }

  cl::Kernel row_kernel(const RowTerm& term, const std::string& name) {
    return device_.kernel(rows_source(term.term->energy), name + "_" + term.term->energy.equation.name,
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
  void make_arms() {
    const auto& node_points = problem_.node_points().device(device_);
    for (auto& term : row_terms_) {
      if (term.kind != &edges_) continue;
      auto kernel = row_kernel(term, "arms");
      device_.run("weights", kernel, static_cast<std::size_t>(rounded_up(term.count, lanes) / lanes), 4,
                  node_points, term.count, edges_.nodes, term.first, edges_.arms);
    }
    for (const auto& set : sets_)
      compute_arms(device_, *set.constraints, problem_.node_points(), set.first,
                   constraints_.incidences.per_instance, constraints_.arms);
  }

  bool is_coupled() const { return coupled_partial_count_ > 0; }

  /// A kernel over the system as a whole: one work-group.
  template <class... Arguments>
  void run_course(cl::Kernel& kernel, const cl::Buffer& status, const Arguments&... arguments) {
    device_.run("solver", kernel, local_, local_, status, node_count_, padded_ / lanes,
                options_.max_iterations, options_.tolerance, options_.damping, node_weights_, rows_, columns_,
                matrix_, diagonal_, factors_, vectors_, count_of(edges_), edges_.nodes, edges_.starts,
                edges_.entries, edges_.arms, edges_.forces, count_of(constraints_), constraints_.nodes,
                constraints_.starts, constraints_.entries, constraints_.arms, constraints_.forces, couplings_,
                pulls_, coupled_diagonal_, coupled_gradient_, arguments...);
  }

  void minimise_step_by_step(const cl::Buffer& status) {
    const auto& unknowns = problem_.unknowns().write_device(device_);
    run_course(begin_, status, gradient_, partial_count_, partials_, unknowns, course_);
    for (int iteration = 0; iteration < options_.max_iterations; ++iteration) {
      // The first time what was evaluated at the start still holds.
      for (auto& term : row_terms_)
        if (!enters_matrix(term.term->energy) && iteration > 0) evaluate("jacobian", term, status);
      device_.run("mm", assemble_coupled_, static_cast<std::size_t>(padded_ / lanes), 1, status,
                  padded_ / lanes, count_of(constraints_), constraints_.nodes, constraints_.starts,
                  constraints_.entries, constraints_.arms, constraints_.forces, couplings_, coupled_forces_,
                  coupled_diagonal_, coupled_gradient_);
      run_course(step_, status, course_, trial_);
      for (auto& term : row_terms_)
        if (!enters_matrix(term.term->energy)) measure_change(term, status);
      run_course(take_, status, course_, coupled_partial_count_, changes_, unknowns);
    }
    run_course(end_, status, course_, partial_count_, partials_, unknowns);
  }

  void evaluate(const std::string& stage, RowTerm& term, const cl::Buffer& status) {
    const auto& node_points = problem_.node_points().device(device_);
    const auto* constraints = term.term->constraints.get();
    const auto& data = constraints ? constraints->data.device(device_) : node_points;
    const auto& confidence = constraints ? constraints->confidence.device(device_) : node_points;
    device_.run(stage, term.evaluate, static_cast<std::size_t>(term.partials()), 1, status, term.count,
                weight_of(*term.term), loss_scale_of(term), problem_.unknowns().device(device_), term.first,
                term.kind->nodes, term.kind->arms, node_points, data, confidence, term.add,
                !enters_matrix(term.term->energy) ? coupled_forces_ : term.kind->forces, couplings_,
                term.first_partial, partials_);
  }

  void measure_change(RowTerm& term, const cl::Buffer& status) {
    const auto& constraints = *term.term->constraints;
    device_.run("energy", term.change, static_cast<std::size_t>(term.partials()), 1, status, term.count,
                weight_of(*term.term), loss_scale_of(term), problem_.unknowns().device(device_), trial_,
                term.first, term.kind->nodes, term.kind->arms, constraints.data.device(device_),
                constraints.confidence.device(device_), term.first_change, changes_);
  }

  cl_float weight_of(const Term& term) const {
    return static_cast<cl_float>(problem_.effective_weight(term));
  }

  static cl_float loss_scale_of(const RowTerm& term) {
    return static_cast<cl_float>(term.term->energy.loss.scale);
  }

  struct ConstraintSet {
    const Constraints* constraints;
    cl_int first;
    std::array<bool, 2> written;  ///< by a term that separates, by one that couples the axes
  };

  Problem& problem_;
  Device& device_;
  CourseOptions options_;
  cl_int node_count_;
  cl_int padded_;
  std::size_t local_ = 1;
  std::vector<const Term*> node_terms_;
  std::vector<RowTerm> row_terms_;
  std::vector<ConstraintSet> sets_;
  Kind edges_;
  Kind constraints_;
  cl_int partial_count_ = 0;
  cl_int coupled_partial_count_ = 0;
  int constraint_count_ = 0;
  cl::Buffer rows_, columns_, matrix_, diagonal_, factors_, gradient_, vectors_;
  cl::Buffer node_weights_, partials_;
  cl::Buffer couplings_, coupled_forces_, pulls_, coupled_diagonal_, coupled_gradient_;
  cl::Buffer trial_, changes_, course_;
  cl::Kernel assemble_, assemble_coupled_, solve_, begin_, step_, take_, end_, conclude_;
};

class Structured : public LinearSolver {
 public:
  std::unique_ptr<Course> bind(Problem& problem, Device& device,
                               const CourseOptions& options) const override {
    const auto obstacle = structured_obstacle(problem);
    if (!obstacle.empty()) throw ConfigError("linear solver structured: " + obstacle);
    return std::make_unique<StructuredCourse>(problem, device, options);
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
