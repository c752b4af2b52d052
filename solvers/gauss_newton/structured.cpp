#include "solvers/gauss_newton/structured.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "framework/core/error.h"
#include "framework/problem/equation_source.h"
#include "framework/problem/structure.h"
#include "solvers/gauss_newton/arms.cl.embed.h"
#include "solvers/gauss_newton/linear_solver.h"
#include "solvers/gauss_newton/node_terms.cl.embed.h"
#include "solvers/gauss_newton/rows.cl.embed.h"
#include "solvers/gauss_newton/structured.cl.embed.h"

namespace pliant {
namespace {

constexpr int chunk = 64;  // CHUNK in rows.cl
constexpr int lanes = 16;  // nodes that the course handles at once
constexpr std::size_t group = 16;

int rounded_up(int value, int multiple) { return (value + multiple - 1) / multiple * multiple; }

std::string rows_source(const Energy& energy) {
  const auto& name = energy.equation.name;
  return fmt::format(
      "{0}#define NAME_RESIDUAL {1}_residual\n#define NAME_JACOBIAN {1}_jacobian\n#define NAME_ROW {1}_row\n"
      "#define KERNEL(x) x##_{1}\n#define ROWS {2}\n#define PER_EDGE {3}\n#define SEPARABLE {4}\n{5}",
      equation_source(energy, "float"), name, energy.residuals,
      static_cast<int>(energy.stencil == Stencil::per_edge),
      static_cast<int>(energy.equation.axis_separable()), embedded::solvers_gauss_newton_rows_cl);
}

/// The functions of every term per node, and three that call them all.
std::string node_terms_source(const std::vector<const Term*>& terms) {
  // From the order 4 axis + c to that of the equations.
  std::string text = "#define COLUMNWISE(m) (3 * ((m) % 4) + (m) / 4)\n";
  std::string add, change, energy;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const auto& name = terms[i]->energy.equation.name;
    text += fmt::format(
        "{0}#undef NAME_RESIDUAL\n#undef NAME_JACOBIAN\n#undef TERM\n#undef ROWS\n"
        "#define NAME_RESIDUAL {1}_residual\n#define NAME_JACOBIAN {1}_jacobian\n#define TERM(x) x##_{1}\n"
        "#define ROWS {2}\n{3}",
        equation_source(terms[i]->energy, "float16"), name, terms[i]->energy.residuals,
        embedded::solvers_gauss_newton_node_terms_cl);
    add += fmt::format("  add_{}(u, inside * weights[{}], packed, gradient);\n", name, i);
    change += fmt::format("  change += change_{}(u, v, inside * weights[{}]);\n", name, i);
    energy += fmt::format("  energy += energy_{}(u, inside * weights[{}]);\n", name, i);
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
  cl::Kernel evaluate;

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
    evaluate("jacobian", status);
    device_.run("mm", assemble_, static_cast<std::size_t>(padded_), group, status, padded_, edges_.starts,
                edges_.entries, edges_.places, edges_.arms, edges_.forces, constraints_.starts,
                constraints_.entries, constraints_.places, constraints_.arms, constraints_.forces, rows_,
                matrix_, gradient_);
    device_.run("solver", solve_, local_, local_, status, node_count_, padded_ / lanes,
                options_.max_iterations, options_.tolerance, options_.damping, node_weights_, rows_, columns_,
                matrix_, diagonal_, preconditioner_, vectors_, gradient_, count_of(edges_), edges_.nodes,
                edges_.starts, edges_.entries, edges_.arms, edges_.forces, count_of(constraints_),
                constraints_.nodes, constraints_.starts, constraints_.entries, constraints_.arms,
                constraints_.forces, partial_count_, partials_, problem_.unknowns().write_device(device_));
    evaluate("energy", status);
    device_.run("energy", conclude_, 1, 1, status, partial_count_ + 1, partials_);
  }

  std::string description() const override { return "structured"; }

 private:
  static cl_int count_of(const Kind& kind) { return static_cast<cl_int>(kind.incidences.size()); }

  void collect_terms() {
    const int edge_count = static_cast<int>(problem_.graph().edges.size());
    int constraint_count = 0;
    std::map<const Constraints*, int> first_of;
    edges_.incidences.per_instance = 2;
    constraints_.incidences.per_instance = 1;
    for (const auto& term : problem_.terms()) {
      if (term.energy.stencil == Stencil::per_node) {
        node_terms_.push_back(&term);
        continue;
      }
      RowTerm made{&term, &edges_, 0, edge_count, 0, partial_count_, {}};
      if (term.constraints) {
        const auto [found, fresh] = first_of.emplace(term.constraints.get(), constraint_count);
        made.kind = &constraints_;
        made.first = found->second;
        made.count = static_cast<int>(term.constraints->size());
        made.add = static_cast<int>(!fresh);
        if (fresh) {
          sets_.push_back({term.constraints.get(), constraint_count});
          constraint_count += made.count;
          constraints_.incidences.per_instance =
              std::max(constraints_.incidences.per_instance, term.constraints->influences.per_point);
        }
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
    std::vector<float> weights;
    for (const auto* term : node_terms_)
      weights.push_back(static_cast<float>(problem_.effective_weight(*term)));
    node_weights_ = device_.upload(weights);

    constexpr auto number = sizeof(float);
    const auto nodes = static_cast<std::size_t>(padded_);
    matrix_ = device_.allocate(number * 16 * pattern.columns.size());
    diagonal_ = device_.allocate(number * 78 * nodes);
    preconditioner_ = device_.allocate(number * 78 * nodes);
    gradient_ = device_.allocate(number * 12 * nodes);
    vectors_ = device_.allocate(number * (7 * 12 + 16) * nodes);  // seven in chunks, one node by node
    partials_ = device_.allocate(number * static_cast<std::size_t>(partial_count_ + 1));
  }

  void make_kernels() {
    local_ = device_.info().is_gpu ? 128 : 1;
    const auto source =
        fmt::format("#define LANES {}\n#define SLOTS {}\n#define K {}\n{}{}", local_, max_influences,
                    constraints_.incidences.per_instance, node_terms_source(node_terms_),
                    embedded::solvers_gauss_newton_structured_cl);
    const char* tune = std::getenv("PLIANT_TUNE");
    assemble_ = device_.kernel(source, "assemble", tune ? tune : "");
    solve_ = device_.kernel(source, "solve", tune ? tune : "");
    conclude_ = device_.kernel(source, "conclude", tune ? tune : "");
    for (auto& term : row_terms_) term.evaluate = row_kernel(term, "evaluate");
  }

  cl::Kernel row_kernel(const RowTerm& term, const std::string& name) {
    return device_.kernel(rows_source(term.term->energy), name + "_" + term.term->energy.equation.name,
                          fmt::format("-DK={}", term.kind->incidences.per_instance));
  }

  /// What the instances' nodes and points fix once and for all.
  void make_arms() {
    const auto& node_points = problem_.node_points().device(device_);
    for (auto& term : row_terms_) {
      if (term.kind != &edges_) continue;
      auto kernel = row_kernel(term, "arms");
      device_.run("weights", kernel, static_cast<std::size_t>(term.count), 64, node_points, term.count,
                  edges_.nodes, term.first, edges_.arms);
    }
    auto kernel = device_.kernel(embedded::solvers_gauss_newton_arms_cl, "arms_of_constraints");
    for (const auto& set : sets_) {
      const auto& influences = set.constraints->influences;
      device_.run("weights", kernel, set.constraints->size(), 64, set.constraints->points.device(device_),
                  static_cast<cl_int>(set.constraints->size()), static_cast<cl_int>(influences.per_point),
                  influences.nodes.device(device_), influences.weights.device(device_), node_points,
                  set.first, static_cast<cl_int>(constraints_.incidences.per_instance), constraints_.arms);
    }
  }

  void evaluate(const std::string& stage, const cl::Buffer& status) {
    const auto& unknowns = problem_.unknowns().device(device_);
    const auto& node_points = problem_.node_points().device(device_);
    for (auto& term : row_terms_) {
      const auto* constraints = term.term->constraints.get();
      const auto& data = constraints ? constraints->data.device(device_) : node_points;
      const auto& confidence = constraints ? constraints->confidence.device(device_) : node_points;
      device_.run(stage, term.evaluate, static_cast<std::size_t>(term.partials()), 1, status, term.count,
                  static_cast<cl_float>(problem_.effective_weight(*term.term)), unknowns, term.first,
                  term.kind->nodes, term.kind->arms, node_points, data, confidence, term.add,
                  term.kind->forces, term.first_partial, partials_);
    }
  }

  struct ConstraintSet {
    const Constraints* constraints;
    cl_int first;
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
  cl::Buffer rows_, columns_, matrix_, diagonal_, preconditioner_, gradient_, vectors_;
  cl::Buffer node_weights_, partials_;
  cl::Kernel assemble_, solve_, conclude_;
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
  for (const auto& term : problem.terms())
    if (term.energy.stencil != Stencil::per_node && !term.energy.equation.axis_separable())
      return fmt::format("energy {} couples the axes", term.energy.equation.name);
  return "";
}

void register_structured(Registry& registry) {
  registry.add<LinearSolver>(
      "structured", "Conjugate gradients that exploit that most energies treat x, y and z apart", {},
      [](const Parameters&, const Registry&) { return std::make_unique<Structured>(); });
}

}  // namespace pliant
