#include "solvers/gauss_newton/block_pcg.h"

#include <fmt/format.h>

#include "solvers/gauss_newton/block_pcg.cl.embed.h"
#include "solvers/gauss_newton/reductions.h"
#include "solvers/gauss_newton/stepwise.h"

namespace pliant {
namespace {

class BlockPcgSteps : public StepSolver {
 public:
  explicit BlockPcgSteps(NormalEquations& equations)
      : equations_(equations),
        device_(equations.device()),
        node_count_(equations.node_count()),
        local_(static_cast<std::size_t>(device_.work_group_size())) {
    lay_out();
    // How far the residual falls in the preconditioned norm: what is left is for the next step.
    const auto options = fmt::format("-DRELATIVE=1e-4f -DGROUPS={}", equations.stride() / 4);
    const auto source = with_reductions(embedded::solvers_gauss_newton_block_pcg_cl, local_);
    const auto kernel = [&](const char* name) { return device_.kernel(source, name, options); };
    expand_ = kernel("expand");
    invert_ = kernel("invert_diagonals");
    solve_ = kernel("solve");
    const auto nodes = static_cast<std::size_t>(node_count_);
    const auto vector_bytes = sizeof(float) * static_cast<std::size_t>(equations.stride());
    const auto block_bytes = vector_bytes * static_cast<std::size_t>(equations.stride());
    rows_ = device_.allocate(block_bytes * static_cast<std::size_t>(block_count_));
    inverses_ = device_.allocate(block_bytes * nodes);
    vectors_ = device_.allocate(3 * vector_bytes * nodes);
    step_ = device_.allocate(vector_bytes * nodes);
  }

  void solve(const Buffer& status) override {
    device_.run("mm", expand_, static_cast<std::size_t>(block_count_), 16, status, block_count_, sources_,
                equations_.blocks(), rows_);
    device_.run("solver", invert_, static_cast<std::size_t>(node_count_), 16, status, node_count_, starts_,
                rows_, inverses_);
    device_.run("solver", solve_, local_, local_, status, node_count_, starts_, columns_, rows_, inverses_,
                equations_.gradient(), vectors_, step_);
  }
  const Buffer& step() const override { return step_; }

 private:
  /// Rows of both triangles out of the lower one, the diagonal block first in each.
  void lay_out() {
    const auto& lower_rows = equations_.block_rows().host();
    const auto& lower_columns = equations_.block_columns().host();
    std::vector<int> starts(static_cast<std::size_t>(node_count_) + 1, 0);
    const auto is_diagonal = [&](std::size_t block) { return lower_rows[block] == lower_columns[block]; };
    for (std::size_t block = 0; block < lower_rows.size(); ++block) {
      ++starts[static_cast<std::size_t>(lower_rows[block]) + 1];
      if (!is_diagonal(block)) ++starts[static_cast<std::size_t>(lower_columns[block]) + 1];
    }
    for (std::size_t node = 1; node < starts.size(); ++node) starts[node] += starts[node - 1];
    block_count_ = starts.back();
    std::vector<int> sources(static_cast<std::size_t>(block_count_)), columns(sources.size());
    std::vector<int> next;
    for (std::size_t node = 0; node + 1 < starts.size(); ++node) next.push_back(starts[node] + 1);
    const auto put = [&](int place, int column, std::size_t block, int transposed) {
      columns[static_cast<std::size_t>(place)] = column;
      sources[static_cast<std::size_t>(place)] = 2 * static_cast<int>(block) + transposed;
    };
    for (std::size_t block = 0; block < lower_rows.size(); ++block) {
      const int row = lower_rows[block], column = lower_columns[block];
      if (is_diagonal(block)) {
        put(starts[static_cast<std::size_t>(row)], row, block, 0);
      } else {
        put(next[static_cast<std::size_t>(row)]++, column, block, 0);
        put(next[static_cast<std::size_t>(column)]++, row, block, 1);
      }
    }
    starts_ = device_.upload(starts);
    sources_ = device_.upload(sources);
    columns_ = device_.upload(columns);
  }

  NormalEquations& equations_;
  Device& device_;
  cl_int node_count_;
  cl_int block_count_ = 0;
  std::size_t local_;
  Buffer starts_, sources_, columns_;
  Buffer rows_, inverses_, vectors_, step_;
  cl::Kernel expand_, invert_, solve_;
};

class BlockPcg : public LinearSolver {
 public:
  std::unique_ptr<Minimiser> bind(Problem& problem, Device& device,
                                  const MinimiserOptions& options) const override {
    return make_stepwise_minimiser(problem, device, options, "block_pcg", [](NormalEquations& equations) {
      return std::make_unique<BlockPcgSteps>(equations);
    });
  }
};

}  // namespace

void register_block_pcg(Registry& registry) {
  registry.add<LinearSolver>("block_pcg",
                             "Conjugate gradients over sparse blocks, for any energy and transform", {},
                             [](const Parameters&, const Registry&) { return std::make_unique<BlockPcg>(); });
}

}  // namespace pliant
