#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "framework/config/config_sweep.h"

namespace pliant {

using Numbers = std::map<std::string, double>;

/// A run of a study: what told it from the others, and its numbers.
struct RunRow {
  std::string name;
  std::vector<SweptValue> axes;  ///< in the order of the sweep
  Numbers numbers;               ///< of its entry in result.json, under dotted names as "metrics.epe_mean"

  /// Its value on an axis; none where it was not swept over it.
  std::optional<std::string> on(const std::string& axis) const;
};

/// The axis that the entries of `runs` are on.
inline constexpr const char* runs_axis = "run";

RunRow make_run_row(const std::string& name, const nlohmann::ordered_json& json);

/// What is told of a frame as numbers under dotted names; true is 1 and false 0.
Numbers numbers_of_frame(const nlohmann::ordered_json& json);

/// Gives what a run tells of each of its frames, in their order; `frame`, the number of each, is always
/// there. Nothing where it has no frames, or was not made.
using FramesOf = std::function<std::vector<Numbers>(const RunRow&)>;

/// A choice of rows: those that have certain values on certain axes.
class RowFilter {
 public:
  RowFilter() = default;
  /// Conditions as "method=ED"; "method=Ad*" takes whatever begins so. Throws ConfigError, which begins with
  /// `place`, for one of another form, or whose axis or value no row has.
  RowFilter(const std::vector<std::string>& conditions, const std::vector<RunRow>& rows,
            const std::string& place);

  bool takes(const RunRow& row) const;

 private:
  std::vector<SweptValue> conditions_;
};

/// Throws what making such a filter would.
void check_conditions(const std::vector<std::string>& conditions, const std::vector<RunRow>& rows,
                      const std::string& place);

/// The axes that rows have values on, in their order.
std::vector<std::string> axes_of(const std::vector<RunRow>& rows);

/// The values that the rows have on an axis, each once, in the order of the rows. Throws ConfigError, which
/// begins with `place` and names the nearest axis, where they have none.
std::vector<std::string> values_on(const std::string& axis, const std::vector<RunRow>& rows,
                                   const std::string& place);

}  // namespace pliant
