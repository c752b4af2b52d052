#include "experiments/tasks/track_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pliant {
namespace {

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

}  // namespace

void TrackSummary::add(const FrameRecord& record, const std::optional<PoseError>& error,
                       const std::optional<FollowedErrors>& points) {
  const PoseEstimate& pose = record.pose;
  const double share = pose.samples > 0 ? static_cast<double>(pose.inliers) / pose.samples : 0;
  frames.push_back({record.state, static_cast<float>(pose.mean_error), static_cast<float>(share),
                    static_cast<float>(record.total_ms),
                    error ? static_cast<float>(error->translation) : unknown,
                    error ? static_cast<float>(error->rotation) : unknown,
                    static_cast<float>(record.rigid_error.mean), static_cast<float>(record.error.mean),
                    static_cast<float>(record.error.deviation), is_registered(record), is_rejected(record),
                    points ? static_cast<float>(points->visible.mean) : unknown,
                    points && points->moving.count > 0 ? static_cast<float>(points->moving.mean) : unknown});
  relocalized += record.relocalized ? 1 : 0;
  if (record.state != FrameState::tracked || count(FrameState::tracked) < 2) return;
  for (const auto& [stage, time] : record.time_ms) time_ms[stage] += time;
}

int TrackSummary::count(FrameState state) const {
  return static_cast<int>(std::count_if(frames.begin(), frames.end(),
                                        [&](const FrameFigures& frame) { return frame.state == state; }));
}

int TrackSummary::count(bool FrameFigures::*flag) const {
  return static_cast<int>(
      std::count_if(frames.begin(), frames.end(), [&](const FrameFigures& frame) { return frame.*flag; }));
}

bool TrackSummary::knows(float FrameFigures::*figure) const {
  return std::any_of(frames.begin(), frames.end(),
                     [&](const FrameFigures& frame) { return !std::isnan(frame.*figure); });
}

double TrackSummary::mean(float FrameFigures::*figure) const {
  double sum = 0;
  int known = 0;
  for (const FrameFigures& frame : frames) {
    if (frame.state != FrameState::tracked || std::isnan(frame.*figure)) continue;
    sum += static_cast<double>(frame.*figure);
    ++known;
  }
  return sum / std::max(known, 1);
}

double TrackSummary::mean_ms() const {
  double sum = 0;
  int timed = -1;
  for (const FrameFigures& frame : frames)
    if (frame.state == FrameState::tracked && ++timed > 0) sum += static_cast<double>(frame.total_ms);
  return timed > 0 ? sum / timed : 0;
}

std::optional<PoseError> TrackSummary::rmse() const {
  PoseError squares{0, 0};
  int known = 0;
  for (const FrameFigures& frame : frames) {
    if (frame.state != FrameState::tracked || std::isnan(frame.translation_error)) continue;
    squares.translation += std::pow(static_cast<double>(frame.translation_error), 2);
    squares.rotation += std::pow(static_cast<double>(frame.rotation_error), 2);
    ++known;
  }
  if (known == 0) return {};
  return PoseError{std::sqrt(squares.translation / known), std::sqrt(squares.rotation / known)};
}

}  // namespace pliant
