#include "experiments/study/sample.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace pliant {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

}  // namespace

Sample::Sample(const Expression& expression, const std::vector<RunRow>& rows, const RowFilter& filter) {
  for (const RunRow& row : rows) {
    if (!filter.takes(row)) continue;
    if (const auto value = expression.value(row.numbers)) values_.push_back(*value);
  }
}

double Sample::mean() const { return std::accumulate(values_.begin(), values_.end(), 0.0) / count(); }

double Sample::deviation() const {
  const double middle = mean();
  double sum = 0;
  for (const double value : values_) sum += (value - middle) * (value - middle);
  return std::sqrt(sum / count());
}

double Sample::median() const {
  if (values_.empty()) return nothing;
  std::vector<double> sorted = values_;
  std::sort(sorted.begin(), sorted.end());
  return sorted[(sorted.size() - 1) / 2];
}

double Sample::least() const {
  return values_.empty() ? nothing : *std::min_element(values_.begin(), values_.end());
}

double Sample::most() const {
  return values_.empty() ? nothing : *std::max_element(values_.begin(), values_.end());
}

double Sample::statistic(const std::string& name) const {
  if (name == "mean") return mean();
  if (name == "sd") return deviation();
  if (name == "median") return median();
  if (name == "min") return least();
  if (name == "max") return most();
  throw std::logic_error("no statistic is called " + name);
}

std::vector<std::string> statistic_names() { return {"mean", "sd", "median", "min", "max"}; }

}  // namespace pliant
