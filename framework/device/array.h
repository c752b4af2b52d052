#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "framework/device/device.h"

namespace pliant {

/// Values that live on the host, on one device, or on both; each side is brought up to date when it is
/// asked for. Reading on the host after the device wrote waits for the device. Copied only by clone().
template <class T>
class Array {
 public:
  Array() = default;
  explicit Array(std::vector<T> values) : host_(std::move(values)), size_(host_.size()) {}
  /// Uninitialised values that a device will write.
  explicit Array(std::size_t size) : size_(size), host_is_current_(size == 0) {}
  Array(const Array&) = delete;
  Array(Array&&) noexcept = default;
  Array& operator=(const Array&) = delete;
  Array& operator=(Array&& other) noexcept {
    settle();
    host_ = std::move(other.host_);
    size_ = other.size_;
    buffer_ = std::move(other.buffer_);
    device_ = other.device_;
    arriving_ = std::move(other.arriving_);
    host_is_current_ = other.host_is_current_;
    device_is_current_ = other.device_is_current_;
    return *this;
  }
  ~Array() { settle(); }

  /// The same values, which share nothing with these; the copy is made where the values are, and waits for
  /// nothing.
  Array clone() const {
    Array copy(size_);
    copy.device_ = device_;
    if (host_is_current_ || device_ == nullptr) {
      copy.host_ = host();
      copy.host_is_current_ = true;
    } else {
      copy.buffer_ = device_->copy(buffer_, bytes());
      copy.device_is_current_ = true;
    }
    return copy;
  }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }

  const std::vector<T>& host() const {
    if (host_is_current_) return host_;
    host_.resize(size_);
    fetch();
    if (arriving_() != nullptr) device_->wait(arriving_);
    arriving_ = cl::Event();
    host_is_current_ = true;
    return host_;
  }
  /// Begins to copy to the host what is enqueued to be written by now; host() then waits for that alone.
  void fetch() const {
    if (host_is_current_ || device_ == nullptr || size_ == 0 || arriving_() != nullptr) return;
    host_.resize(size_);
    arriving_ = device_->read_later(buffer_, host_.data(), bytes());
  }
  /// Copies the values to `to`, without keeping them on the host.
  void copy_to(T* to) const {
    if (host_is_current_ || device_ == nullptr || arriving_() != nullptr)
      std::copy(host().begin(), host().end(), to);
    else
      device_->read(buffer_, to, bytes());
  }
  /// For changing values on the host (not their number); the device's copy becomes stale.
  std::vector<T>& write_host() {
    host();
    device_is_current_ = false;
    return host_;
  }

  const Buffer& device(Device& device) const {
    if (device_ != nullptr && device_ != &device) host();  // devices exchange through the host
    if (device_ != &device || !device_is_current_) {
      // Another buffer rather than the old one, whose values a clone or a kernel may still read.
      buffer_ = host_is_current_ ? device.upload(host_.data(), bytes()) : device.allocate(bytes());
      device_ = &device;
      device_is_current_ = true;
    }
    return buffer_;
  }
  /// Room for so many values, or more, that a device will write; what is large enough stays as it is.
  void make_room(std::size_t size) {
    if (size_ < size) *this = Array(size);
  }
  /// For kernels that write; the host's copy becomes stale.
  const Buffer& write_device(Device& device) {
    settle();
    this->device(device);
    host_is_current_ = false;
    return buffer_;
  }

 private:
  std::size_t bytes() const { return size_ * sizeof(T); }
  /// Whoever is about to give up host_ waits for what is still being copied there.
  void settle() const {
    if (arriving_() != nullptr) clWaitForEvents(1, &arriving_());
    arriving_ = cl::Event();
  }

  mutable std::vector<T> host_;
  std::size_t size_ = 0;
  mutable Buffer buffer_;
  mutable Device* device_ = nullptr;
  mutable cl::Event arriving_;  ///< of a copy to the host that is under way
  mutable bool host_is_current_ = true;
  mutable bool device_is_current_ = false;
};

}  // namespace pliant
