#include "framework/problem/normal_equations.h"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "framework/deformation/warp.h"
#include "framework/problem/assembly.cl.embed.h"
#include "framework/problem/equation_source.h"
#include "framework/problem/evaluate.cl.embed.h"
#include "framework/problem/structure.h"

namespace pliant {
namespace {

constexpr int energy_chunk = 64;  // CHUNK in evaluate.cl
constexpr std::size_t group_size = 16;

const char* stencil_macro(Stencil stencil) {
  return stencil == Stencil::per_node   ? "PER_NODE"
         : stencil == Stencil::per_edge ? "PER_EDGE"
                                        : "PER_CONSTRAINT";
}

std::string evaluation_source(const Energy& energy) {
  return fmt::format(
      "{0}\n{5}\n#define {2}\n#define RESIDUALS {3}\n"
      "#define NAME_RESIDUAL {1}_residual\n#define NAME_JACOBIAN {1}_jacobian\n#define KERNEL(x) "
      "x##_{1}\n{4}",
      equation_source(energy, "float"), energy.equation.name, stencil_macro(energy.stencil), energy.residuals,
      embedded::framework_problem_evaluate_cl, loss_source(energy.loss, "float"));
}

}  // namespace

/// Who contributes to what, of one kind of instances: the edges, or one set of constraints.
struct NormalEquations::Kind {
  const Constraints* constraints;  ///< null: the edges
  Incidences incidences;
  NodeLists lists;
  Array<int> matrix_starts, matrix_entries;
  Array<int> gradient_starts, gradient_entries;
  Buffer lever_arms;  ///< of constraints
};

struct NormalEquations::TermKernels {
  const Term* term;
  Kind* kind;  ///< null for a term per node
  int count;
  cl::Kernel evaluate;
  cl::Kernel energy;
  cl::Kernel gather_matrix;    // mm
  cl::Kernel gather_gradient;  // mv
  Buffer rows;                 // what evaluate leaves for gathering
};

/// The normal equations along the steps of the problem's transform.
struct NormalEquations::Projected {
  Buffer blocks;
  Buffer gradient;
  cl::Kernel project_blocks;
  cl::Kernel project_gradient;
};

NormalEquations::NormalEquations(Device& device, Problem& problem) : device_(&device), problem_(&problem) {
  for (const auto& term : problem.terms()) add_term(term);
  std::vector<const Incidences*> incidences;
  std::vector<const NodeLists*> lists;
  for (const auto& kind : kinds_) {
    incidences.push_back(&kind->incidences);
    lists.push_back(&kind->lists);
  }
  auto blocks = find_lower_blocks(incidences, lists, node_count());
  for (std::size_t i = 0; i < kinds_.size(); ++i) {
    kinds_[i]->matrix_starts = Array<int>(std::move(blocks.contributions[i].starts));
    kinds_[i]->matrix_entries = Array<int>(std::move(blocks.contributions[i].entries));
    kinds_[i]->gradient_starts = Array<int>(std::move(kinds_[i]->lists.starts));
    kinds_[i]->gradient_entries = Array<int>(std::move(kinds_[i]->lists.entries));
  }
  edges_ = Array<int>(edge_incidences(problem.graph()).nodes);
  block_rows_ = Array<int>(std::move(blocks.rows));
  block_columns_ = Array<int>(std::move(blocks.columns));
  diagonal_ = Array<int>(std::move(blocks.diagonal));
  blocks_ = device.allocate(sizeof(float) * 144 * block_rows_.size());
  gradient_ = device.allocate(sizeof(float) * problem.unknowns().size());
  energy_partials_ = device.allocate(sizeof(float) * static_cast<std::size_t>(energy_partial_count_));
  if (problem.transform().is_free()) return;
  const auto source = transform_source(problem.transform(), stride());
  const auto width = static_cast<std::size_t>(stride());
  projected_ = std::make_unique<Projected>(
      Projected{device.allocate(sizeof(float) * width * width * block_rows_.size()),
                device.allocate(sizeof(float) * width * problem.graph().nodes.size()),
                device.kernel(source, "project_blocks"), device.kernel(source, "project_gradient")});
}

const Buffer& NormalEquations::blocks() const { return projected_ ? projected_->blocks : blocks_; }

const Buffer& NormalEquations::gradient() const { return projected_ ? projected_->gradient : gradient_; }

void NormalEquations::add_term(const Term& term) {
  auto& device = *device_;
  const auto instances = instance_count(*problem_, term);
  auto made = std::make_unique<TermKernels>();
  made->term = &term;
  made->kind = term.energy.stencil == Stencil::per_node ? nullptr : &kind_of(term.constraints.get());
  made->count = static_cast<int>(instances);
  const auto source = evaluation_source(term.energy);
  made->evaluate = device.kernel(source, "evaluate_" + term.energy.equation.name);
  made->energy = device.kernel(source, "energy_" + term.energy.equation.name);
  energy_partial_count_ += (made->count + energy_chunk - 1) / energy_chunk;
  if (made->kind != nullptr) {
    const bool per_edge = term.energy.stencil == Stencil::per_edge;
    const std::string suffix = per_edge ? "edges" : "constraints";
    const auto kernel = [&](const std::string& name) {
      return device.kernel(embedded::framework_problem_assembly_cl, name,
                           fmt::format("-DSLOTS={}", max_influences));
    };
    made->gather_matrix = kernel("mm_" + suffix);
    made->gather_gradient = kernel("mv_" + suffix);
    made->rows = device.allocate(sizeof(float) * instances *
                                 static_cast<std::size_t>(per_edge ? 25 * term.energy.residuals : 9));
  }
  terms_.push_back(std::move(made));
}

NormalEquations::Kind& NormalEquations::kind_of(const Constraints* constraints) {
  for (const auto& kind : kinds_)
    if (kind->constraints == constraints) return *kind;
  auto& made = *kinds_.emplace_back(std::make_unique<Kind>());
  made.constraints = constraints;
  made.incidences = constraints == nullptr
                        ? edge_incidences(problem_->graph())
                        : Incidences{constraints->influences.per_point, constraints->influences.nodes.host()};
  made.lists = list_by_node(made.incidences, node_count());
  if (constraints != nullptr) {
    made.lever_arms = device_->allocate(4 * sizeof(float) * made.incidences.nodes.size());
    compute_lever_arms(*device_, *constraints, problem_->node_points(), 0, made.incidences.per_instance,
                       made.lever_arms);
  }
  return made;
}

NormalEquations::~NormalEquations() = default;

cl_float NormalEquations::weight_of(const TermKernels& term) const {
  return static_cast<cl_float>(problem_->effective_weight(*term.term));
}

cl_float NormalEquations::loss_scale_of(const TermKernels& term) {
  return static_cast<cl_float>(term.term->energy.loss.scale);
}

void NormalEquations::assemble(const Buffer& status) {
  auto clear = device_->kernel(embedded::framework_problem_assembly_cl, "clear",
                               fmt::format("-DSLOTS={}", max_influences));
  const auto block_values = 144 * block_rows_.size();
  device_->run("mm", clear, block_values, 256, status, static_cast<cl_int>(block_values), blocks_);
  device_->run("mv", clear, problem_->unknowns().size(), 256, status,
               static_cast<cl_int>(problem_->unknowns().size()), gradient_);
  for (auto& term : terms_) assemble_term(*term, status);
  if (projected_) project(status);
}

void NormalEquations::project(const Buffer& status) {
  const auto& forms = problem_->unknowns().device(*device_);
  device_->run("mm", projected_->project_blocks, block_rows_.size(), group_size, status, block_count(),
               block_rows_.device(*device_), block_columns_.device(*device_), forms, blocks_,
               projected_->blocks);
  device_->run("mv", projected_->project_gradient, static_cast<std::size_t>(node_count()), group_size, status,
               node_count(), forms, gradient_, projected_->gradient);
}

void NormalEquations::assemble_term(TermKernels& term, const Buffer& status) {
  auto& device = *device_;
  const auto& unknowns = problem_->unknowns().device(device);
  const auto& node_points = problem_->node_points().device(device);
  const auto count = static_cast<std::size_t>(term.count);
  const auto nodes = static_cast<cl_int>(node_count());
  const cl_int residuals = term.term->energy.residuals;
  const cl_float weight = weight_of(term);
  const Kind* kind = term.kind;
  switch (term.term->energy.stencil) {
    case Stencil::per_node:
      device.run("jacobian", term.evaluate, count, group_size, status, term.count, weight,
                 loss_scale_of(term), unknowns, diagonal_.device(device), blocks_, gradient_);
      break;
    case Stencil::per_edge:
      device.run("jacobian", term.evaluate, count, group_size, status, term.count, weight, unknowns,
                 node_points, edges_.device(device), term.rows);
      device.run("mm", term.gather_matrix, block_rows_.size(), group_size, status, block_count(), residuals,
                 kind->matrix_starts.device(device), kind->matrix_entries.device(device), term.rows, blocks_);
      device.run("mv", term.gather_gradient, static_cast<std::size_t>(nodes), group_size, status, nodes,
                 residuals, kind->gradient_starts.device(device), kind->gradient_entries.device(device),
                 term.rows, gradient_);
      break;
    case Stencil::per_constraint: {
      const auto& constraints = *term.term->constraints;
      const auto& points = constraints.points.device(device);
      const auto& weights = constraints.influences.weights.device(device);
      const cl_int k = constraints.influences.per_point;
      device.run("jacobian", term.evaluate, count, group_size, status, term.count, weight,
                 loss_scale_of(term), unknowns, node_points, points, k,
                 constraints.influences.nodes.device(device), weights, constraints.data.device(device),
                 constraints.confidence.device(device), term.rows);
      device.run("mm", term.gather_matrix, block_rows_.size(), group_size, status, block_count(), k,
                 kind->matrix_starts.device(device), kind->matrix_entries.device(device), term.rows,
                 kind->lever_arms, blocks_);
      device.run("mv", term.gather_gradient, static_cast<std::size_t>(nodes), group_size, status, nodes, k,
                 kind->gradient_starts.device(device), kind->gradient_entries.device(device), term.rows,
                 kind->lever_arms, gradient_);
      break;
    }
  }
}

void NormalEquations::sum_energy(const Buffer& unknowns, const Buffer& status) {
  auto& device = *device_;
  const auto& node_points = problem_->node_points().device(device);
  std::size_t offset = 0;
  for (auto& term : terms_) {
    const cl_float weight = weight_of(*term);
    const auto partials = static_cast<std::size_t>((term->count + energy_chunk - 1) / energy_chunk);
    if (partials == 0) continue;
    const auto first = static_cast<cl_int>(offset);
    switch (term->term->energy.stencil) {
      case Stencil::per_node:
        device.run("energy", term->energy, partials, 1, status, term->count, weight, loss_scale_of(*term),
                   unknowns, energy_partials_, first);
        break;
      case Stencil::per_edge:
        device.run("energy", term->energy, partials, 1, status, term->count, weight, unknowns, node_points,
                   edges_.device(device), energy_partials_, first);
        break;
      case Stencil::per_constraint: {
        const auto& constraints = *term->term->constraints;
        device.run("energy", term->energy, partials, 1, status, term->count, weight, loss_scale_of(*term),
                   unknowns, node_points, constraints.points.device(device),
                   static_cast<cl_int>(constraints.influences.per_point),
                   constraints.influences.nodes.device(device), constraints.influences.weights.device(device),
                   constraints.data.device(device), constraints.confidence.device(device), energy_partials_,
                   first);
        break;
      }
    }
    offset += partials;
  }
}

}  // namespace pliant
