#pragma once

#include <string>
#include <utility>
#include <vector>

#include "experiments/study/expression.h"
#include "experiments/study/run_row.h"

namespace pliant {

/// What some runs have of one number.
class Sample {
 public:
  /// Of the rows that the filter takes; those without the number are passed over.
  Sample(const Expression& expression, const std::vector<RunRow>& rows, const RowFilter& filter);

  explicit Sample(std::vector<double> values) : values_(std::move(values)) {}

  int count() const { return static_cast<int>(values_.size()); }
  // Of an empty sample all of these are NaN.
  double mean() const;
  double deviation() const;  ///< standard deviation of the population
  double median() const;     ///< the lower one of two in the middle
  double least() const;
  double most() const;
  /// By the name of one of them: mean, sd, median, min, max.
  double statistic(const std::string& name) const;

 private:
  std::vector<double> values_;
};

/// What `statistic` knows.
std::vector<std::string> statistic_names();

}  // namespace pliant
