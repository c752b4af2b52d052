#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "framework/geometry/frame_stream.h"

namespace pliant {

/// Reads a stream ahead on a thread of its own, so that reading and decoding overlap what its reader does.
/// Frames, errors and the end come as from the stream and in its order; both of the latter come again when
/// asked for again. A stream that needs the device (FrameStream::reads_on_host) is not read ahead but when it
/// is asked.
class PrefetchedStream : public FrameStream {
 public:
  /// `stream` must outlive this, and nobody else may read it. At most `ahead` (1 or more) frames wait beside
  /// the one that is being read.
  explicit PrefetchedStream(FrameStream& stream, std::size_t ahead = 2);
  /// Waits for the frame that is being read.
  ~PrefetchedStream() override;
  PrefetchedStream(const PrefetchedStream&) = delete;
  PrefetchedStream& operator=(const PrefetchedStream&) = delete;

  std::string name() const override { return stream_.name(); }
  const Rig& rig() const override { return stream_.rig(); }
  std::optional<Frame> next() override;
  /// Those that the stream had after it had read what was given last.
  std::vector<std::string> warnings() const override;

 private:
  /// What the stream gave once: a frame, an error, or neither at its end.
  struct Reading {
    std::optional<Frame> frame;
    std::exception_ptr error;
    std::vector<std::string> warnings;
  };

  Reading read();
  void read_ahead();

  FrameStream& stream_;
  std::size_t ahead_;
  std::vector<std::string> warnings_;
  std::mutex mutex_;  // of what stands below it
  std::condition_variable changed_;
  std::deque<Reading> readings_;
  bool stops_ = false;
  std::thread thread_;  // absent where the stream is read when asked
};

}  // namespace pliant
