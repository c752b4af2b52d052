#include "framework/geometry/frame_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "framework/core/error.h"
#include "framework/geometry/color_at_depth.h"
#include "framework/geometry/has_point.h"

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

namespace {

bool is_black(const ColorImage& image) {
  return std::all_of(image.pixels().begin(), image.pixels().end(),
                     [](const Rgb& color) { return color == Rgb{}; });
}

/// Gives the frame its colour at the depth's pixels; false when none of what was in colour is seen there.
bool carry_color(Frame& frame, const Rig& rig) {
  const bool was_black = is_black(frame.color);
  frame.color = color_at_depth(frame, rig);
  return was_black || !is_black(frame.color);
}

}  // namespace

FramePair read_pair(FrameStream& stream) {
  CheckedStream frames(stream);
  const auto seeing = [&](const char* which) {
    Frame frame = frames.require(which);
    if (!sees_something(frame))
      throw DataError(fmt::format("{}: {} sees nothing: no valid depth{}", stream.name(), which,
                                  frame.mask.empty() ? "" : " inside its mask"));
    return frame;
  };
  FramePair pair{stream.name(), stream.rig().depth, seeing("the source"), seeing("the target")};
  const bool source_is_seen = carry_color(pair.source, stream.rig());
  const bool target_is_seen = carry_color(pair.target, stream.rig());
  pair.warnings = stream.warnings();
  if (!source_is_seen || !target_is_seen)
    pair.warnings.push_back(fmt::format(
        "the colour camera sees nothing of the {}'s depth; check its intrinsics and where it stands, in mm",
        source_is_seen ? "target" : "source"));
  return pair;
}

}  // namespace pliant
