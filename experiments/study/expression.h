#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/study/run_row.h"

namespace pliant {

/// A formula over named numbers, as "1000 / time_ms.total" or "adaptive <= 1.05 * uniform"; names may have
/// dots. A comparison is 1 where it holds, else 0.
class Expression {
 public:
  /// Throws ConfigError, which begins with `place`, for what is no formula.
  Expression(const std::string& text, const std::string& place);
  Expression(Expression&&) noexcept;
  ~Expression();

  /// In alphabetical order.
  const std::vector<std::string>& names() const { return names_; }
  /// None where a name has no number, or the result is not finite.
  std::optional<double> value(const Numbers& numbers) const;

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
  std::vector<std::string> names_;
};

}  // namespace pliant
