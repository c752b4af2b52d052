#include "framework/geometry/frame_stream.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "framework/core/error.h"
#include "framework/geometry/color_at_depth.h"

namespace pliant {

CheckedStream::CheckedStream(FrameStream& stream) : stream_(stream) { check(stream.rig(), stream.name()); }

std::optional<Frame> CheckedStream::next() {
  std::optional<Frame> frame = stream_.next();
  if (!frame && count_ == 0) throw DataError(stream_.name() + ": the stream has no frame");
  if (!frame) return frame;
  ++count_;
  check(*frame, stream_.rig(), fmt::format("{}: frame {}'s", stream_.name(), count_));
  check_time(frame->time);
  return frame;
}

Frame CheckedStream::require(const std::string& what) {
  std::optional<Frame> frame = next();
  if (!frame)
    throw DataError(
        fmt::format("{}: the stream ends after frame {}; expected {} too", stream_.name(), count_, what));
  return *std::move(frame);
}

void CheckedStream::check_time(double time) {
  if (!std::isfinite(time))
    throw DataError(fmt::format("{}: the time of frame {} is {} s; expected a finite number", stream_.name(),
                                count_, time));
  if (count_ > 1 && time <= time_)
    throw DataError(
        fmt::format("{}: the time of frame {} is {} s; expected a later one than {} s, that of frame {}",
                    stream_.name(), count_, time, time_, count_ - 1));
  time_ = time;
}

FramePair read_pair(FrameStream& stream) {
  CheckedStream frames(stream);
  FramePair pair{stream.name(), stream.rig().depth, frames.require("the source"),
                 frames.require("the target")};
  for (Frame* frame : {&pair.source, &pair.target}) frame->color = color_at_depth(*frame, stream.rig());
  pair.warnings = stream.warnings();
  return pair;
}

}  // namespace pliant
