#include "solvers/gauss_newton/dense_cholesky.h"

#include <fmt/format.h>

#include "framework/core/error.h"
#include "solvers/gauss_newton/dense_cholesky.cl.embed.h"
#include "solvers/gauss_newton/reductions.h"
#include "solvers/gauss_newton/stepwise.h"

namespace pliant {
namespace {

constexpr int block = 64;             // BLOCK in dense_cholesky.cl
constexpr int most_unknowns = 46336;  // whole blocks; the kernels count the elements of the matrix in an int

/// Rounded up to whole blocks.
int checked_size(int unknowns) {
  const int n = (unknowns + block - 1) / block * block;
  if (n > most_unknowns)
    throw DeviceError(
        fmt::format("dense_cholesky solves for {} unknowns at most, not for {}: their matrix has "
                    "{} bytes; block_pcg and structured need none",
                    most_unknowns, unknowns, sizeof(float) * static_cast<std::size_t>(n) * n));
  return n;
}

class DenseCholeskySteps : public StepSolver {
 public:
  explicit DenseCholeskySteps(NormalEquations& equations)
      : equations_(equations),
        device_(equations.device()),
        unknowns_(equations.stride() * equations.node_count()),
        n_(checked_size(unknowns_)),
        blocks_(n_ / block),
        matrix_(device_.allocate(sizeof(float) * size() * size())),
        tiles_(device_.allocate(sizeof(float) * block * size())),
        scratch_(device_.allocate(sizeof(float) * block * block)),
        inverses_(device_.allocate(sizeof(float) * block * size())),
        inverses_transposed_(device_.allocate(sizeof(float) * block * size())),
        step_(device_.allocate(sizeof(float) * size())) {}

  void solve(const Buffer& status) override {
    form(status);
    factor(status);
    substitute(status);
  }
  const Buffer& step() const override { return step_; }

 private:
  std::size_t size() const { return static_cast<std::size_t>(n_); }
  cl::Kernel kernel(const char* name) {
    static const std::string source = with_reductions(embedded::solvers_gauss_newton_dense_cholesky_cl);
    return device_.kernel(source, name, fmt::format("-DSTRIDE={}", equations_.stride()));
  }

  void form(const Buffer& status) {
    auto clear = kernel("clear_matrix");
    auto scatter = kernel("scatter");
    auto negate = kernel("negate");
    device_.run("mm", clear, size(), 16, status, unknowns_, n_, matrix_);
    device_.run("mm", scatter, equations_.block_rows().size(), 16, status, equations_.block_count(), n_,
                equations_.block_rows().device(device_), equations_.block_columns().device(device_),
                equations_.blocks(), matrix_);
    device_.run("solver", negate, size(), 64, status, unknowns_, n_, equations_.gradient(), step_);
  }

  void factor(const Buffer& status) {
    auto diagonal = kernel("diagonal");
    auto panel = kernel("panel");
    auto update = kernel("update");
    for (int k = 0; k < blocks_; ++k) {
      device_.run("cholesky", diagonal, 1, 1, status, k, n_, matrix_, scratch_, inverses_,
                  inverses_transposed_);
      const auto rest = static_cast<std::size_t>(n_ - (k + 1) * block);
      device_.run("cholesky", panel, rest / 4, 1, status, k, n_, matrix_, inverses_transposed_, tiles_);
      device_.run("cholesky", update, rest / 8 * (rest / 32), 1, status, k, n_,
                  static_cast<cl_int>(rest / 32), matrix_, tiles_);
    }
  }

  void substitute(const Buffer& status) {
    auto diagonal = kernel("solve_diagonal");
    auto below = kernel("eliminate_below");
    auto above = kernel("eliminate_above");
    for (int k = 0; k < blocks_; ++k) {
      device_.run("solver", diagonal, 1, 1, status, k, inverses_, step_);
      device_.run("solver", below, static_cast<std::size_t>(n_ - (k + 1) * block), 64, status, k, n_, matrix_,
                  step_);
    }
    for (int k = blocks_ - 1; k >= 0; --k) {
      device_.run("solver", diagonal, 1, 1, status, k, inverses_transposed_, step_);
      device_.run("solver", above, static_cast<std::size_t>(4 * k), 4, status, k, n_, matrix_, step_);
    }
  }

  NormalEquations& equations_;
  Device& device_;
  cl_int unknowns_;
  cl_int n_;
  cl_int blocks_;
  Buffer matrix_;
  Buffer tiles_;
  Buffer scratch_;
  Buffer inverses_;
  Buffer inverses_transposed_;
  Buffer step_;
};

class DenseCholesky : public LinearSolver {
 public:
  std::unique_ptr<Minimiser> bind(Problem& problem, Device& device,
                                  const MinimiserOptions& options) const override {
    return make_stepwise_minimiser(problem, device, options, "dense_cholesky", make_dense_cholesky_steps);
  }
};

}  // namespace

std::unique_ptr<StepSolver> make_dense_cholesky_steps(NormalEquations& equations) {
  return std::make_unique<DenseCholeskySteps>(equations);
}

void register_dense_cholesky(Registry& registry) {
  registry.add<LinearSolver>(
      "dense_cholesky", "Dense L L^T and triangular solves on the device, single precision [thesis 4.6]", {},
      [](const Parameters&, const Registry&) { return std::make_unique<DenseCholesky>(); });
}

}  // namespace pliant
