#pragma once

#include <string>
#include <vector>

namespace pliant {

/// The values between the ends of an axis, with round ones to be marked.
struct ChartAxis {
  bool is_log = false;
  double low = 0;
  double high = 1;  ///< above `low`
  std::vector<double> ticks;

  /// Where a value lies: 0 at the low end, 1 at the high one.
  double place(double value) const;
  /// Whether it has a place at all: a logarithm takes no other than positive values.
  bool takes(double value) const;
};

/// Holds all values that it takes, with a little air. `from_zero`: zero, too, if it is linear.
ChartAxis axis_around(const std::vector<double>& values, bool is_log, bool from_zero = false);

/// As short as its place at an axis wants it.
std::string tick_label(double value);

}  // namespace pliant
