#pragma once

#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#include <CL/opencl.hpp>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

namespace pliant {

/// Buffers of one context, used again once all others have dropped them, and host memory for what is on its
/// way to the device. Fresh pages cost more than most kernels do, and a stream of frames asks for the same
/// again and again. Failures come through as cl::Error.
///
/// All commands are expected to go through one in-order queue: what still uses a dropped buffer then comes
/// before whatever its next owner enqueues.
class BufferPool {
 public:
  explicit BufferPool(cl::Context context) : context_(std::move(context)) {}

  /// A buffer of at least so many uninitialised bytes, at most `most` where a larger one would be made.
  cl::Buffer take(std::size_t bytes, std::size_t most);
  /// Gives back to the device what nobody uses.
  void drop_unused();

  /// Enqueues a write of a copy of `data`, and does not wait.
  void send(const cl::CommandQueue& queue, const cl::Buffer& to, const void* data, std::size_t bytes);

  /// How many times memory was asked for so far, on the device and for copies on the host.
  std::uint64_t allocations() const { return allocations_; }

 private:
  struct Staging {
    std::vector<std::byte> bytes;
    cl::Event written;
  };
  Staging& free_staging(std::size_t bytes);

  cl::Context context_;
  std::multimap<std::size_t, cl::Buffer> buffers_;  // by size
  std::vector<std::unique_ptr<Staging>> staging_;
  std::uint64_t allocations_ = 0;
};

}  // namespace pliant
