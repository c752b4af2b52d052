#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/geometry/frame.h"
#include "framework/geometry/rig.h"

namespace pliant {

/// Frames that one rig sees, one after the other, each made or read when it is asked for. Frames are counted
/// from 1. Read it through a CheckedStream, which holds it to what is said here.
class FrameStream {
 public:
  virtual ~FrameStream() = default;

  /// What the stream is called in results and errors.
  virtual std::string name() const = 0;
  /// Known before the first frame; it never changes.
  virtual const Rig& rig() const = 0;
  /// The next frame, which fits the rig and is later than those before; none after the last. A frame that
  /// sees nothing has depth images full of holes. Throws DataError naming the file at fault.
  virtual std::optional<Frame> next() = 0;
  /// What is odd about the stream as far as it was read, though it can be used: a line each.
  virtual std::vector<std::string> warnings() const { return {}; }
  /// Whether `next` leaves the Device alone, so that it may run on another thread (see PrefetchedStream)
  /// while the device is used; all else that the stream can be asked does not depend on what `next` is doing
  /// then, but for `warnings`.
  virtual bool reads_on_host() const { return false; }
};

/// Reads a stream and refuses what a stream may not do, by DataErrors that name the stream and the frame: a
/// frame that does not fit the rig, as one that changes size; without depth image; whose time is not finite
/// or not later than that of the frame before.
class CheckedStream {
 public:
  /// `stream` must outlive this. Throws DataError as `check` of its rig does.
  explicit CheckedStream(FrameStream& stream);

  /// None after the last frame. Throws DataError also when the stream ends before its first frame.
  std::optional<Frame> next();
  /// The next frame where there must be one: throws DataError when the stream has ended, and says that
  /// `what`, as in "the target", is missing.
  Frame require(const std::string& what);

 private:
  void check_time(double time);

  FrameStream& stream_;
  int count_ = 0;  // frames read
  double time_ = 0;
};

/// The first two frames of a stream, their colour carried to the depth (color_at_depth). Throws DataError as
/// CheckedStream does, when the stream ends early, and when one of them sees nothing.
FramePair read_pair(FrameStream& stream);

}  // namespace pliant
