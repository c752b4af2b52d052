#include "framework/geometry/prefetched_stream.h"

#include <utility>

namespace pliant {

PrefetchedStream::PrefetchedStream(FrameStream& stream, std::size_t ahead)
    : stream_(stream), ahead_(ahead), warnings_(stream.warnings()) {
  if (stream.reads_on_host()) thread_ = std::thread([this] { read_ahead(); });
}

PrefetchedStream::~PrefetchedStream() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stops_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

std::optional<Frame> PrefetchedStream::next() {
  if (!thread_.joinable()) return stream_.next();
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !readings_.empty(); });
  Reading& reading = readings_.front();
  warnings_ = reading.warnings;
  if (reading.error) std::rethrow_exception(reading.error);
  if (!reading.frame) return std::nullopt;
  std::optional<Frame> frame = std::move(reading.frame);
  readings_.pop_front();
  changed_.notify_all();
  return frame;
}

std::vector<std::string> PrefetchedStream::warnings() const {
  return thread_.joinable() ? warnings_ : stream_.warnings();
}

PrefetchedStream::Reading PrefetchedStream::read() {
  Reading reading;
  try {
    reading.frame = stream_.next();
  } catch (...) {
    reading.error = std::current_exception();
  }
  reading.warnings = stream_.warnings();
  return reading;
}

void PrefetchedStream::read_ahead() {
  for (bool goes_on = true; goes_on;) {
    Reading reading = read();
    goes_on = reading.frame.has_value();
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return stops_ || readings_.size() < ahead_; });
    if (stops_) return;
    readings_.push_back(std::move(reading));
    changed_.notify_all();
  }
}

}  // namespace pliant
