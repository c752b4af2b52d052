#include "experiments/study/frame_points.h"

#include <map>
#include <set>
#include <utility>

namespace pliant {

std::vector<Chart::Point> frame_points(const Measure& measure, const std::vector<std::string>& conditions,
                                       std::string& missing) {
  std::set<std::string> known;
  std::map<double, std::vector<double>> values;  // by the number of the frame
  for (const RunRow& row : measure.rows_that(conditions))
    for (const Numbers& frame : measure.frames(row)) {
      for (const auto& [name, number] : frame) known.insert(name);
      std::vector<double>& here = values[frame.at("frame")];
      if (const auto value = measure.expression().value(frame)) here.push_back(*value);
    }
  missing = unknown_name(measure.expression(), known, "frame");
  std::vector<Chart::Point> points;
  for (auto& [frame, here] : values) {
    const Sample sample(std::move(here));
    points.push_back({frame, "", sample.mean(), sample.deviation(), sample.count()});
  }
  return points;
}

}  // namespace pliant
