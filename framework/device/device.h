#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "framework/core/log.h"
#include "framework/core/stopwatch.h"
#include "framework/device/buffer_pool.h"

namespace pliant {

/// What `pliant devices` tells of an OpenCL device.
struct DeviceInfo {
  std::string name;
  std::string vendor;
  std::string platform;
  std::string version;  ///< OpenCL version text of the device
  std::string driver;
  bool is_gpu = false;
  int compute_units = 0;
  std::size_t memory_bytes = 0;
  std::size_t most_bytes = 0;  ///< that one buffer may have
};

/// How kernels are shaped; by default as suits the kind of device. Results differ by rounding.
struct DeviceOptions {
  std::optional<int> vector_width;     ///< of the explicit vectors: 16 (on CPUs) or 1 (on GPUs)
  std::optional<int> work_group_size;  ///< a power of two: 1 (on CPUs), 128 (on GPUs)
  std::string build_options;           ///< of every program, e.g. "-cl-opt-disable"
};

/// What a device was asked for since it was opened.
struct DeviceCounts {
  std::uint64_t allocations = 0;  ///< of memory on the device, and on the host for what is on its way there
  std::uint64_t allocated_bytes = 0;  ///< on the device
  std::uint64_t uploads = 0;          ///< copies from the host to the device
  std::uint64_t uploaded_bytes = 0;
  std::uint64_t reads = 0;  ///< copies from the device to the host
  std::uint64_t read_bytes = 0;
};

/// An OpenCL device with one in-order queue. Kernels are enqueued and never waited for; only reading
/// results back waits. Not thread-safe. Failures raise DeviceError.
class Device {
 public:
  /// Opens a device: "any" (a CPU first, because that is where results are reproducible everywhere),
  /// "cpu", "gpu", or a part of the device's or platform's name (case ignored).
  explicit Device(const std::string& selection = "any", const DeviceOptions& options = {});
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  static std::vector<DeviceInfo> list();
  /// Why the list is empty, and what to do about it.
  static std::string why_none();
  /// What is wrong with options whatever the device; empty when nothing is.
  static std::string complaint(const DeviceOptions& options);
  const DeviceInfo& info() const { return info_; }

  const cl::Context& context() const { return context_; }
  const cl::CommandQueue& queue() const { return queue_; }

  /// Values of the explicit vectors that kernels are written over.
  int width() const { return options_.vector_width.value_or(info_.is_gpu ? 1 : 16); }
  /// Work-items of kernels that run in a single work-group.
  int work_group_size() const { return options_.work_group_size.value_or(info_.is_gpu ? 128 : 1); }

  /// The kernel `name` of a program. A program and its kernels are made once per source and options and kept;
  /// drivers keep binaries on disk beyond that. All who ask for a kernel share it, arguments included.
  /// `-DWIDTH=<width()>` is always defined. Throws DeviceError with the build log when the source does not
  /// compile.
  cl::Kernel kernel(std::string_view source, const std::string& name, const std::string& options = "");

  /// `tell` is called once, before the first program that no run is known to have built here: those take
  /// seconds each, while drivers keep what they have built.
  void tell_of_building(ProgressSink tell) { tell_of_building_ = std::move(tell); }

  /// How many programs kernel() has built so far: a computation during which it rises has waited for the
  /// compiler, or for the driver to load what it kept on disk.
  int programs_built() const { return programs_built_; }

  /// Enqueues a kernel over a one-dimensional range. `local` = 0 leaves the group size to the driver;
  /// otherwise `global` is rounded up to a multiple of it.
  template <class... Arguments>
  void run(const std::string& stage, cl::Kernel& kernel, std::size_t global, std::size_t local,
           const Arguments&... arguments) {
    cl_uint index = 0;
    (set_argument(kernel, index++, arguments), ...);
    enqueue(stage, kernel, global, local);
  }

  /// A buffer of at least so many uninitialised bytes; DeviceError names the size, and what the device has,
  /// when it does not fit. Buffers that all others have dropped are given out again.
  Buffer allocate(std::size_t bytes) const;

  /// A buffer with a copy of host values, which may change at once. Waits only where many bytes are under
  /// way.
  Buffer upload(const void* data, std::size_t bytes) const;
  template <class T>
  Buffer upload(const std::vector<T>& values) const {
    return upload(values.data(), sizeof(T) * values.size());
  }

  /// A buffer with the values that another one will have by then; only enqueues.
  Buffer copy(const Buffer& from, std::size_t bytes) const;

  /// Waits for everything enqueued so far.
  void write(const Buffer& buffer, const void* data, std::size_t bytes) const;
  /// Waits for everything enqueued so far.
  void read(const Buffer& buffer, void* data, std::size_t bytes) const;
  /// Only enqueues: `data` must stay where it is until wait() for what is returned.
  cl::Event read_later(const Buffer& buffer, void* data, std::size_t bytes) const;
  void wait(const cl::Event& event) const;
  void fill_zero(const Buffer& buffer, std::size_t bytes) const;
  void finish() const;

  DeviceCounts counts() const;

  /// While true (default: false) every kernel's time is recorded under its stage's name.
  void measure_stages(bool on) { measuring_ = on; }
  /// Waits, then gives what was recorded since the last call: added up by stage, or by kernel.
  StageTimes take_stage_times();
  StageTimes take_kernel_times();

 private:
  template <class T>
  static const T& argument(const T& value) {
    return value;
  }
  static const cl::Buffer& argument(const Buffer& buffer) { return *buffer; }

  template <class T>
  void set_argument(cl::Kernel& kernel, cl_uint index, const T& value) {
    try {
      kernel.setArg(index, argument(value));
    } catch (const cl::Error& error) {
      fail("setting argument " + std::to_string(index) + " of " + kernel.getInfo<CL_KERNEL_FUNCTION_NAME>(),
           error);
    }
  }
  void enqueue(const std::string& stage, const cl::Kernel& kernel, std::size_t global, std::size_t local);
  [[noreturn]] static void fail(const std::string& what, const cl::Error& error);

  DeviceOptions options_;
  DeviceInfo info_;
  cl::Device device_;
  cl::Context context_;
  cl::CommandQueue queue_;
  struct Program {
    std::string options, source;
    cl::Program program;
    std::unordered_map<std::string, cl::Kernel> kernels;
  };
  void check_work_group() const;
  Program& program_of(std::string_view source, const std::string& options);
  cl::Program build(std::string_view source, const std::string& options);

  std::filesystem::path kernel_cache_;
  ProgressSink tell_of_building_;
  std::deque<Program> programs_;  // few: told apart by the length of their sources sooner than by any hash
  int programs_built_ = 0;
  std::unique_ptr<BufferPool> pool_;
  mutable StagingRing staging_;
  mutable DeviceCounts counts_;
  bool measuring_ = false;
  struct Record {
    std::string stage;
    cl::Kernel kernel;
    cl::Event event;
  };
  template <class Name>
  StageTimes take_times(Name name);
  std::vector<Record> records_;
};

}  // namespace pliant
