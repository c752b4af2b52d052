#pragma once

#include <memory>
#include <vector>

#include "framework/problem/problem.h"

namespace pliant {

/// J^T J and J^T r of a problem on the device, by the numbers that its transform leaves free, the matrix as
/// the blocks of its lower triangle that are not zero by structure. Everything is enqueued, nothing waits.
/// Kernels do nothing while word 0 of `status` is not zero: the solve has ended.
class NormalEquations {
 public:
  /// `problem` and `device` must outlive this; the problem's structure is fixed from here on; weights,
  /// scales, targets and confidences are taken as they are at each call.
  NormalEquations(Device& device, Problem& problem);
  ~NormalEquations();
  NormalEquations(const NormalEquations&) = delete;
  NormalEquations& operator=(const NormalEquations&) = delete;

  /// Forms blocks() and gradient() at problem.unknowns().
  void assemble(const Buffer& status);

  /// Writes partial sums of E_tot at `unknowns`, to be added up in order.
  void sum_energy(const Buffer& unknowns, const Buffer& status);
  const Buffer& energy_partials() const { return energy_partials_; }
  int energy_partial_count() const { return energy_partial_count_; }

  /// Places of a node in blocks, gradient and steps: its transform's unknowns (12 of `affine`, 6 of
  /// `quaternion`) and zeros up to a multiple of four.
  int stride() const { return (problem_->transform().unknowns + 3) / 4 * 4; }
  /// Row-major blocks of stride x stride, one per pair; block rows and columns with row >= column, sorted.
  const Buffer& blocks() const;
  const Array<int>& block_rows() const { return block_rows_; }
  const Array<int>& block_columns() const { return block_columns_; }
  int block_count() const { return static_cast<int>(block_rows_.size()); }
  /// stride numbers a node: half the gradient of E_tot.
  const Buffer& gradient() const;
  int node_count() const { return problem_->node_count(); }
  Device& device() const { return *device_; }

 private:
  struct Kind;
  struct TermKernels;
  struct Projected;
  void add_term(const Term& term);
  Kind& kind_of(const Constraints* constraints);
  cl_float weight_of(const TermKernels& term) const;
  static cl_float loss_scale_of(const TermKernels& term);
  void assemble_term(TermKernels& term, const Buffer& status);
  void project(const Buffer& status);

  Device* device_;
  Problem* problem_;
  Array<int> edges_;
  Array<int> block_rows_;
  Array<int> block_columns_;
  Array<int> diagonal_;
  Buffer blocks_;                         // by affine forms, as energies see nodes
  Buffer gradient_;                       // likewise
  std::unique_ptr<Projected> projected_;  // of a transform that is not free
  Buffer energy_partials_;
  int energy_partial_count_ = 0;
  std::vector<std::unique_ptr<Kind>> kinds_;
  std::vector<std::unique_ptr<TermKernels>> terms_;
};

}  // namespace pliant
