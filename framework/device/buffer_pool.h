#pragma once

#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#include <CL/opencl.hpp>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace pliant {

/// Memory on a device. Copies share it; when the last one goes, the device's pool may give it out again.
class Buffer {
 public:
  Buffer() = default;
  explicit Buffer(std::shared_ptr<const cl::Buffer> held) : held_(std::move(held)) {}
  const cl::Buffer& operator*() const { return *held_; }

 private:
  std::shared_ptr<const cl::Buffer> held_;
};

/// Host memory for what is on its way to a device: a ring that is filled over and over, and waits for what is
/// oldest where it is full.
class StagingRing {
 public:
  /// Enqueues a write of a copy of `data`.
  void send(const cl::CommandQueue& queue, const cl::Buffer& to, const void* data, std::size_t bytes);

  /// How many times memory was asked for so far.
  std::uint64_t allocations() const { return allocations_; }

 private:
  struct Flight {
    std::size_t begin, end;  ///< in the ring
    cl::Event written;
  };
  std::size_t make_room(std::size_t bytes);
  void land();

  std::vector<std::byte> ring_;
  std::size_t next_ = 0;
  std::deque<Flight> flights_;  // the oldest first
  std::uint64_t allocations_ = 0;
};

/// Buffers of one context, given out again once all others have dropped them: fresh pages cost more than most
/// kernels do, and a stream of frames asks for the same again and again. All commands go through one in-order
/// queue: what still uses a dropped buffer comes before whatever its next owner enqueues. Failures come
/// through as cl::Error.
class BufferPool {
 public:
  explicit BufferPool(cl::Context context) : context_(std::move(context)) {}

  /// A buffer of at least so many uninitialised bytes, at most `most` where a larger one would be made.
  Buffer take(std::size_t bytes, std::size_t most);
  /// Gives back to the device what nobody uses.
  void drop_unused();

  /// How many buffers were made so far.
  std::uint64_t allocations() const { return allocations_; }
  /// What they take together, those that were dropped since included.
  std::uint64_t allocated_bytes() const { return allocated_bytes_; }

 private:
  cl::Context context_;
  std::multimap<std::size_t, std::shared_ptr<const cl::Buffer>> buffers_;  // by size
  std::uint64_t allocations_ = 0;
  std::uint64_t allocated_bytes_ = 0;
};

}  // namespace pliant
