#include "framework/device/buffer_pool.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace pliant {
namespace {

constexpr std::size_t most_kept = 1024;      // buffers
constexpr std::size_t small = 1 << 16;       // bytes: whoever asks for less gets so many
constexpr std::size_t made_at_once = 32;     // small buffers
constexpr std::size_t medium = 1 << 20;      // bytes: up to here sizes are powers of two
constexpr std::size_t widest = 4;            // times what is asked for
constexpr std::size_t least_ring = 1 << 20;  // bytes
constexpr std::size_t ring_share = 4;        // what is sent takes at most one in so many of the ring
constexpr std::size_t most_flights = 256;    // of small ones a ring would hold many, and each has an event

bool is_unused(const std::shared_ptr<const cl::Buffer>& buffer) { return buffer.use_count() == 1; }

/// Sizes that others can use, too: what a stream asks for varies from frame to frame.
std::size_t rounded_up(std::size_t bytes) {
  if (bytes <= medium) return std::max(std::bit_ceil(bytes), small);
  const std::size_t step = std::bit_floor(bytes) / 8;
  return (bytes + step - 1) / step * step;
}

}  // namespace

void StagingRing::send(const cl::CommandQueue& queue, const cl::Buffer& to, const void* data,
                       std::size_t bytes) {
  const std::size_t begin = make_room(bytes);
  std::memcpy(ring_.data() + begin, data, bytes);
  cl::Event written;
  queue.enqueueWriteBuffer(to, CL_FALSE, 0, bytes, ring_.data() + begin, nullptr, &written);
  flights_.push_back({begin, begin + bytes, std::move(written)});
  next_ = begin + bytes;
}

/// Where in the ring so many bytes are free.
std::size_t StagingRing::make_room(std::size_t bytes) {
  if (ring_share * bytes > ring_.size()) {
    while (!flights_.empty()) land();
    ++allocations_;
    ring_ = std::vector<std::byte>(std::max(std::bit_ceil(ring_share * bytes), least_ring));
    next_ = 0;
  }
  const std::size_t begin = next_ + bytes <= ring_.size() ? next_ : 0;
  const auto is_in_the_way = [&](const Flight& flight) {
    return flight.begin < begin + bytes && begin < flight.end;
  };
  while (flights_.size() >= most_flights || std::any_of(flights_.begin(), flights_.end(), is_in_the_way))
    land();
  return begin;
}

void StagingRing::land() {
  flights_.front().written.wait();
  flights_.pop_front();
}

Buffer BufferPool::take(std::size_t bytes, std::size_t most) {
  const std::size_t size = rounded_up(bytes) <= most ? rounded_up(bytes) : bytes;
  const auto end = buffers_.upper_bound(widest * size);
  const auto found = std::find_if(buffers_.lower_bound(size), end,
                                  [](const auto& entry) { return is_unused(entry.second); });
  if (found != end) return Buffer(found->second);
  if (buffers_.size() >= most_kept) drop_unused();
  std::shared_ptr<const cl::Buffer> made;
  for (std::size_t i = 0; i < (size == small ? made_at_once : 1); ++i) {
    made = std::make_shared<const cl::Buffer>(context_, CL_MEM_READ_WRITE, size);
    buffers_.emplace(size, made);
    ++allocations_;
    allocated_bytes_ += size;
  }
  return Buffer(std::move(made));
}

void BufferPool::drop_unused() {
  std::erase_if(buffers_, [](const auto& entry) { return is_unused(entry.second); });
}

}  // namespace pliant
