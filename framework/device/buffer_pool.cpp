#include "framework/device/buffer_pool.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace pliant {
namespace {

constexpr std::size_t most_kept = 1024;       // buffers
constexpr std::size_t smallest = 4096;        // bytes: a page
constexpr std::size_t always_fits = 1 << 16;  // bytes: whatever asks for less may have it
constexpr std::size_t widest = 4;             // times what is asked for

bool is_unused(const cl::Buffer& buffer) { return buffer.getInfo<CL_MEM_REFERENCE_COUNT>() == 1; }

bool is_over(const cl::Event& event) {
  return event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() <= CL_COMPLETE;  // below: it has failed
}

/// Close sizes share buffers.
std::size_t rounded_up(std::size_t bytes) {
  const std::size_t step = std::max(std::bit_floor(bytes) / 8, smallest);
  return std::max((bytes + step - 1) / step, std::size_t{1}) * step;  // OpenCL has no empty buffers
}

}  // namespace

cl::Buffer BufferPool::take(std::size_t bytes, std::size_t most) {
  const std::size_t size = rounded_up(bytes) <= most ? rounded_up(bytes) : bytes;
  const auto end = buffers_.upper_bound(std::max(widest * size, always_fits));
  const auto found = std::find_if(buffers_.lower_bound(size), end,
                                  [](const auto& entry) { return is_unused(entry.second); });
  if (found != end) return found->second;
  if (buffers_.size() >= most_kept) drop_unused();
  ++allocations_;
  return buffers_.emplace(size, cl::Buffer(context_, CL_MEM_READ_WRITE, size))->second;
}

void BufferPool::drop_unused() {
  std::erase_if(buffers_, [](const auto& entry) { return is_unused(entry.second); });
}

void BufferPool::send(const cl::CommandQueue& queue, const cl::Buffer& to, const void* data,
                      std::size_t bytes) {
  Staging& staging = free_staging(bytes);
  std::memcpy(staging.bytes.data(), data, bytes);
  queue.enqueueWriteBuffer(to, CL_FALSE, 0, bytes, staging.bytes.data(), nullptr, &staging.written);
}

BufferPool::Staging& BufferPool::free_staging(std::size_t bytes) {
  Staging* best = nullptr;
  for (const auto& staging : staging_) {
    if (staging->written() != nullptr && !is_over(staging->written)) continue;
    // The smallest that is large enough, else the largest.
    const auto rank = [&](const Staging& one) {
      const bool fits = one.bytes.size() >= bytes;
      return std::pair(fits ? 0 : 1, fits ? one.bytes.size() : ~one.bytes.size());
    };
    if (best == nullptr || rank(*staging) < rank(*best)) best = staging.get();
  }
  if (best == nullptr) best = staging_.emplace_back(std::make_unique<Staging>()).get();
  if (best->bytes.size() < bytes) {
    ++allocations_;
    best->bytes = std::vector<std::byte>(rounded_up(bytes));
  }
  return *best;
}

}  // namespace pliant
