#include "framework/io/trajectory_file.h"

#include <fmt/format.h>

#include <cmath>

#include "framework/core/error.h"
#include "framework/io/file.h"
#include "framework/io/text_lines.h"

namespace pliant {
namespace {

constexpr double millimetres = 1000;  // a metre

TimedPose read_pose(const TextLines& lines, const TextLines::Line& line) {
  constexpr std::size_t columns = 8;
  if (line.words.size() != columns)
    lines.fail(line.number, fmt::format("{} words, expected TIME TX TY TZ QX QY QZ QW", line.words.size()));
  const auto value = [&](std::size_t word) { return lines.real(line, word); };
  const Eigen::Vector3d place(value(1), value(2), value(3));
  const Eigen::Quaterniond turn(value(7), value(4), value(5), value(6));
  constexpr double rounding = 0.01;
  if (!(std::abs(turn.norm() - 1) <= rounding))
    lines.fail(line.number, fmt::format("the quaternion has length {:g}, expected 1", turn.norm()));
  return {value(0), Eigen::Translation3d(millimetres * place) * turn.normalized()};
}

}  // namespace

std::string trajectory_line(const TimedPose& pose) {
  const Eigen::Vector3d place = pose.pose.translation() / millimetres;
  const Eigen::Quaterniond turn(pose.pose.linear());
  return fmt::format("{:.6f} {:.7f} {:.7f} {:.7f} {:.8f} {:.8f} {:.8f} {:.8f}\n", pose.time, place.x(),
                     place.y(), place.z(), turn.x(), turn.y(), turn.z(), turn.w());
}

void write_trajectory(const std::string& path, const Trajectory& trajectory) {
  std::string text = "# time tx ty tz qx qy qz qw\n";
  for (const TimedPose& pose : trajectory) text += trajectory_line(pose);
  write_file(path, {text.begin(), text.end()});
}

Trajectory read_trajectory(const std::string& path) {
  TextLines lines(path);
  Trajectory trajectory;
  while (const auto line = lines.next()) {
    if (line->empty()) continue;
    const TimedPose pose = read_pose(lines, *line);
    if (!trajectory.empty() && !(pose.time > trajectory.back().time))
      lines.fail(line->number, fmt::format("the time {:.6f} is not later than {:.6f} in the line before",
                                           pose.time, trajectory.back().time));
    trajectory.push_back(pose);
  }
  if (trajectory.empty()) throw DataError(path + ": no pose");
  return trajectory;
}

}  // namespace pliant
