#pragma once

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "experiments/study/sample.h"
#include "framework/core/parameters.h"

namespace pliant {

/// A number of runs as a section of an experiment file asks for it.
class Measure {
 public:
  /// The keys that every section has in which a number is asked for: `value`, `where` and `frames`.
  static std::vector<Parameter> rows();

  /// `section` has a table with these keys. Throws ConfigError as Expression and RowFilter do.
  /// `rows` and `frames_of` must outlive this.
  Measure(const Parameters& section, const std::vector<RunRow>& rows, const FramesOf& frames_of);

  /// Of those rows that meet these conditions, too. Where the section names frames, a row's number is its
  /// mean over them.
  Sample sample(const std::vector<std::string>& conditions) const;
  /// The rows that it is of and that meet these conditions, too.
  std::vector<RunRow> rows_that(const std::vector<std::string>& conditions) const;
  const Expression& expression() const { return expression_; }
  /// Each frame of a row that the section names, or all of them.
  std::vector<Numbers> frames(const RunRow& row) const;
  /// Which of its names no run, or frame, has, with the nearest that there is; empty where each is there, or
  /// no run has any number.
  std::string missing() const;

 private:
  RowFilter filter(const std::vector<std::string>& conditions) const;

  std::string place_;
  const std::vector<RunRow>& rows_;
  const FramesOf& frames_of_;
  std::optional<std::pair<double, double>> window_;  // the first and the last frame
  Expression expression_;
  std::vector<std::string> where_;
};

/// Says which of the names of a formula is not known, with the nearest that is; `whose`: as in "run". Empty
/// where all are, or nothing is.
std::string unknown_name(const Expression& expression, const std::set<std::string>& known,
                         const std::string& whose);

/// "AXIS=VALUE"
std::string condition(const std::string& axis, const std::string& value);

}  // namespace pliant
