#include "framework/problem/normal_equations.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <tuple>

#include "framework/deformation/warp.h"
#include "framework/problem/assembly.cl.embed.h"
#include "framework/problem/equation_source.h"
#include "framework/problem/evaluate.cl.embed.h"

namespace pliant {
namespace {

constexpr int energy_chunk = 64;  // CHUNK in evaluate.cl
constexpr std::size_t group_size = 16;

/// Lists of contributions, one list per owner (a block or a node), in the order of the instances.
class ContributionLists {
 public:
  explicit ContributionLists(std::size_t owners) : lists_(owners) {}
  void add(std::size_t owner, std::initializer_list<int> entry) {
    lists_[owner].insert(lists_[owner].end(), entry);
  }
  std::pair<Array<int>, Array<int>> packed(int words_per_entry) const {
    std::vector<int> starts{0};
    std::vector<int> entries;
    for (const auto& list : lists_) {
      entries.insert(entries.end(), list.begin(), list.end());
      starts.push_back(static_cast<int>(entries.size()) / words_per_entry);
    }
    return {Array<int>(std::move(starts)), Array<int>(std::move(entries))};
  }

 private:
  std::vector<std::vector<int>> lists_;
};

/// The blocks of the lower triangle that some instance makes non-zero, by row.
std::vector<std::vector<int>> find_blocks(const Problem& problem) {
  std::vector<std::vector<int>> columns(static_cast<std::size_t>(problem.node_count()));
  for (int node = 0; node < problem.node_count(); ++node) columns[static_cast<std::size_t>(node)] = {node};
  for (const auto& term : problem.terms())
    for (std::size_t i = 0; i < instance_count(problem, term); ++i) {
      const auto nodes = coupled_nodes(problem, term, i);
      for (const int row : nodes)
        for (const int column : nodes) {
          auto& list = columns[static_cast<std::size_t>(row)];
          if (row > column && std::find(list.begin(), list.end(), column) == list.end())
            list.push_back(column);
        }
    }
  for (auto& list : columns) std::sort(list.begin(), list.end());
  return columns;
}

const char* stencil_macro(Stencil stencil) {
  return stencil == Stencil::per_node   ? "PER_NODE"
         : stencil == Stencil::per_edge ? "PER_EDGE"
                                        : "PER_CONSTRAINT";
}

std::string evaluation_source(const Energy& energy) {
  return fmt::format(
      "{0}\n{5}\n#define {2}\n#define ROWS {3}\n"
      "#define NAME_RESIDUAL {1}_residual\n#define NAME_JACOBIAN {1}_jacobian\n#define KERNEL(x) "
      "x##_{1}\n{4}",
      equation_source(energy, "float"), energy.equation.name, stencil_macro(energy.stencil), energy.residuals,
      embedded::framework_problem_evaluate_cl, loss_source(energy.loss));
}

}  // namespace

struct NormalEquations::TermKernels {
  const Term* term;
  int count;
  float weight;
  cl::Kernel evaluate;
  cl::Kernel energy;
  cl::Kernel gather_matrix;    // mm
  cl::Kernel gather_gradient;  // mv
  Array<int> matrix_starts, matrix_entries;
  Array<int> gradient_starts, gradient_entries;
  cl::Buffer rows;  // what evaluate leaves for gathering
};

NormalEquations::NormalEquations(Device& device, Problem& problem) : device_(&device), problem_(&problem) {
  const auto columns = find_blocks(problem);
  std::vector<int> rows, cols, diagonal;
  for (std::size_t row = 0; row < columns.size(); ++row)
    for (const int column : columns[row]) {
      if (column == static_cast<int>(row)) diagonal.push_back(static_cast<int>(rows.size()));
      rows.push_back(static_cast<int>(row));
      cols.push_back(column);
    }
  const auto block_index = [&](int row, int column) {
    const auto& list = columns[static_cast<std::size_t>(row)];
    const auto place = std::lower_bound(list.begin(), list.end(), column) - list.begin();
    return static_cast<std::size_t>(diagonal[static_cast<std::size_t>(row)] + 1 -
                                    static_cast<int>(list.size()) + static_cast<int>(place));
  };

  std::vector<int> edges;
  for (const auto& edge : problem.graph().edges) edges.insert(edges.end(), {edge.from, edge.to});
  edges_ = Array<int>(std::move(edges));

  for (const auto& term : problem.terms()) {
    const auto stencil = term.energy.stencil;
    const auto instances = instance_count(problem, term);
    auto made = std::make_unique<TermKernels>();
    made->term = &term;
    made->count = static_cast<int>(instances);
    made->weight = static_cast<float>(problem.effective_weight(term));
    const auto source = evaluation_source(term.energy);
    made->evaluate = device.kernel(source, "evaluate_" + term.energy.equation.name);
    made->energy = device.kernel(source, "energy_" + term.energy.equation.name);
    energy_partial_count_ += (made->count + energy_chunk - 1) / energy_chunk;

    if (stencil != Stencil::per_node) {
      const bool per_edge = stencil == Stencil::per_edge;
      const std::string suffix = per_edge ? "edges" : "constraints";
      made->gather_matrix = device.kernel(embedded::framework_problem_assembly_cl, "mm_" + suffix);
      made->gather_gradient = device.kernel(embedded::framework_problem_assembly_cl, "mv_" + suffix);
      made->rows = device.allocate(sizeof(float) * instances *
                                   static_cast<std::size_t>(per_edge ? 25 * term.energy.residuals : 9));
      ContributionLists matrix(rows.size());
      ContributionLists gradient(columns.size());
      for (std::size_t i = 0; i < instances; ++i) {
        const auto nodes = coupled_nodes(problem, term, i);
        for (int a = 0; a < static_cast<int>(nodes.size()); ++a) {
          const int row = nodes[static_cast<std::size_t>(a)];
          gradient.add(static_cast<std::size_t>(row), {static_cast<int>(i), a});
          for (int b = 0; b < static_cast<int>(nodes.size()); ++b) {
            const int column = nodes[static_cast<std::size_t>(b)];
            if (row >= column) matrix.add(block_index(row, column), {static_cast<int>(i), a, b});
          }
        }
      }
      std::tie(made->matrix_starts, made->matrix_entries) = matrix.packed(3);
      std::tie(made->gradient_starts, made->gradient_entries) = gradient.packed(2);
    }
    terms_.push_back(std::move(made));
  }

  block_rows_ = Array<int>(std::move(rows));
  block_columns_ = Array<int>(std::move(cols));
  diagonal_ = Array<int>(std::move(diagonal));
  blocks_ = device.allocate(sizeof(float) * 144 * block_rows_.size());
  gradient_ = device.allocate(sizeof(float) * problem.unknowns().size());
  energy_partials_ = device.allocate(sizeof(float) * static_cast<std::size_t>(energy_partial_count_));
}

NormalEquations::~NormalEquations() = default;

void NormalEquations::assemble(const cl::Buffer& status) {
  auto clear = device_->kernel(embedded::framework_problem_assembly_cl, "clear");
  const auto block_values = 144 * block_rows_.size();
  device_->run("mm", clear, block_values, 256, status, static_cast<cl_int>(block_values), blocks_);
  device_->run("mv", clear, problem_->unknowns().size(), 256, status,
               static_cast<cl_int>(problem_->unknowns().size()), gradient_);
  for (auto& term : terms_) assemble_term(*term, status);
}

void NormalEquations::assemble_term(TermKernels& term, const cl::Buffer& status) {
  auto& device = *device_;
  const auto& unknowns = problem_->unknowns().device(device);
  const auto& node_points = problem_->node_points().device(device);
  const auto count = static_cast<std::size_t>(term.count);
  const auto nodes = static_cast<cl_int>(node_count());
  const cl_int residuals = term.term->energy.residuals;
  switch (term.term->energy.stencil) {
    case Stencil::per_node:
      device.run("jacobian", term.evaluate, count, group_size, status, term.count, term.weight, unknowns,
                 diagonal_.device(device), blocks_, gradient_);
      break;
    case Stencil::per_edge:
      device.run("jacobian", term.evaluate, count, group_size, status, term.count, term.weight, unknowns,
                 node_points, edges_.device(device), term.rows);
      device.run("mm", term.gather_matrix, block_rows_.size(), group_size, status, block_count(), residuals,
                 term.matrix_starts.device(device), term.matrix_entries.device(device), term.rows, blocks_);
      device.run("mv", term.gather_gradient, static_cast<std::size_t>(nodes), group_size, status, nodes,
                 residuals, term.gradient_starts.device(device), term.gradient_entries.device(device),
                 term.rows, gradient_);
      break;
    case Stencil::per_constraint: {
      const auto& constraints = *term.term->constraints;
      const auto& points = constraints.points.device(device);
      const auto& weights = constraints.influences.weights.device(device);
      const cl_int k = constraints.influences.per_point;
      device.run("jacobian", term.evaluate, count, group_size, status, term.count, term.weight, unknowns,
                 node_points, points, k, constraints.influences.nodes.device(device), weights,
                 constraints.data.device(device), constraints.confidence.device(device), term.rows);
      device.run("mm", term.gather_matrix, block_rows_.size(), group_size, status, block_count(),
                 term.matrix_starts.device(device), term.matrix_entries.device(device), term.rows, points, k,
                 constraints.influences.nodes.device(device), weights, node_points, blocks_);
      device.run("mv", term.gather_gradient, static_cast<std::size_t>(nodes), group_size, status, nodes,
                 term.gradient_starts.device(device), term.gradient_entries.device(device), term.rows, points,
                 k, weights, node_points, gradient_);
      break;
    }
  }
}

void NormalEquations::sum_energy(const cl::Buffer& unknowns, const cl::Buffer& status) {
  auto& device = *device_;
  const auto& node_points = problem_->node_points().device(device);
  std::size_t offset = 0;
  for (auto& term : terms_) {
    const auto partials = static_cast<std::size_t>((term->count + energy_chunk - 1) / energy_chunk);
    if (partials == 0) continue;
    const auto first = static_cast<cl_int>(offset);
    switch (term->term->energy.stencil) {
      case Stencil::per_node:
        device.run("energy", term->energy, partials, 1, status, term->count, term->weight, unknowns,
                   energy_partials_, first);
        break;
      case Stencil::per_edge:
        device.run("energy", term->energy, partials, 1, status, term->count, term->weight, unknowns,
                   node_points, edges_.device(device), energy_partials_, first);
        break;
      case Stencil::per_constraint: {
        const auto& constraints = *term->term->constraints;
        device.run(
            "energy", term->energy, partials, 1, status, term->count, term->weight, unknowns, node_points,
            constraints.points.device(device), static_cast<cl_int>(constraints.influences.per_point),
            constraints.influences.nodes.device(device), constraints.influences.weights.device(device),
            constraints.data.device(device), constraints.confidence.device(device), energy_partials_, first);
        break;
      }
    }
    offset += partials;
  }
}

}  // namespace pliant
