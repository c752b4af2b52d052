#include "experiments/datasets/tum_poses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "framework/core/error.h"
#include "framework/io/text_lines.h"

namespace pliant {
namespace {

constexpr double farthest = 0.1;  // s, between two poses that a third is made of
constexpr double millimetres = 1000;

Eigen::Isometry3d motion(const Eigen::Vector3d& place, const Eigen::Quaterniond& turn) {
  return Eigen::Translation3d(place) * turn;
}

}  // namespace

TumPoses::TumPoses(const std::string& path) {
  TextLines lines(path);
  while (const auto line = lines.next()) {
    if (line->empty()) continue;
    if (line->words.size() != 8)
      lines.fail(line->number,
                 fmt::format("{} words, expected TIME tx ty tz qx qy qz qw", line->words.size()));
    const auto number = [&](std::size_t word) { return lines.real(*line, word); };
    Pose pose{number(0), millimetres * Eigen::Vector3d(number(1), number(2), number(3)),
              Eigen::Quaterniond(number(7), number(4), number(5), number(6))};
    if (std::abs(pose.turn.norm() - 1) > 0.01)
      lines.fail(line->number,
                 fmt::format("the quaternion has the length {:.3g}, expected 1", pose.turn.norm()));
    pose.turn.normalize();
    if (!poses_.empty() && pose.time < poses_.back().time)
      lines.fail(line->number, fmt::format("the time {:.6f} is earlier than {:.6f} before it", pose.time,
                                           poses_.back().time));
    if (!poses_.empty() && pose.time == poses_.back().time) poses_.pop_back();
    poses_.push_back(pose);
  }
  if (poses_.empty()) throw DataError(path + ": no pose");
}

std::optional<Eigen::Isometry3d> TumPoses::at(double time) const {
  const auto after = std::lower_bound(poses_.begin(), poses_.end(), time,
                                      [](const Pose& pose, double moment) { return pose.time < moment; });
  if (after == poses_.end()) return std::nullopt;
  if (after->time == time) return motion(after->place, after->turn);
  if (after == poses_.begin()) return std::nullopt;
  const Pose& before = *std::prev(after);
  const double length = after->time - before.time;
  if (length > farthest) return std::nullopt;
  const double share = (time - before.time) / length;
  return motion(before.place + share * (after->place - before.place), before.turn.slerp(share, after->turn));
}

}  // namespace pliant
