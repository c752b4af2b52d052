#include "framework/device/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>

#include "framework/core/error.h"
#include "framework/device/kernel_cache.h"

namespace pliant {
namespace {

constexpr std::size_t most_staged = 16 << 20;  // bytes: what is larger is not copied once more on the host

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

// Drivers pad names with spaces and, some of them, with a terminating zero.
std::string trimmed(std::string text) {
  while (!text.empty() && (text.back() == '\0' || std::isspace(static_cast<unsigned char>(text.back()))))
    text.pop_back();
  const auto first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first);
}

DeviceInfo describe(const cl::Device& device) {
  const cl::Platform platform(device.getInfo<CL_DEVICE_PLATFORM>());
  DeviceInfo info;
  info.name = trimmed(device.getInfo<CL_DEVICE_NAME>());
  info.vendor = trimmed(device.getInfo<CL_DEVICE_VENDOR>());
  info.platform = trimmed(platform.getInfo<CL_PLATFORM_NAME>());
  info.version = trimmed(device.getInfo<CL_DEVICE_VERSION>());
  info.driver = trimmed(device.getInfo<CL_DRIVER_VERSION>());
  info.is_gpu = (device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_GPU) != 0;
  info.compute_units = static_cast<int>(device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
  info.memory_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
  info.most_bytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
  return info;
}

std::vector<cl::Device> all_devices() {
  std::vector<cl::Device> devices;
  std::vector<cl::Platform> platforms;
  try {
    cl::Platform::get(&platforms);
  } catch (const cl::Error&) {
    return devices;  // the loader reports "no platform" as an error
  }
  for (const auto& platform : platforms) {
    std::vector<cl::Device> found;
    try {
      platform.getDevices(CL_DEVICE_TYPE_ALL, &found);
    } catch (const cl::Error&) {
      continue;  // a platform without devices reports an error too
    }
    devices.insert(devices.end(), found.begin(), found.end());
  }
  // A CPU first: "any" then means the same device on most machines.
  std::stable_sort(devices.begin(), devices.end(), [](const cl::Device& a, const cl::Device& b) {
    return describe(a).is_gpu < describe(b).is_gpu;
  });
  return devices;
}

bool matches(const DeviceInfo& info, const std::string& selection) {
  if (selection == "any") return true;
  if (selection == "cpu") return !info.is_gpu;
  if (selection == "gpu") return info.is_gpu;
  return lower(info.name + " " + info.platform).find(selection) != std::string::npos;
}

}  // namespace

std::vector<DeviceInfo> Device::list() {
  open_kernel_cache();
  std::vector<DeviceInfo> infos;
  for (const auto& device : all_devices()) infos.push_back(describe(device));
  return infos;
}

std::string Device::why_none() {
  const std::string problem = kernel_cache_problem();
  return problem.empty() ? "there is no OpenCL device: install a driver, e.g. the package pocl-opencl-icd"
                         : "there is no OpenCL device: " + problem;
}

std::string Device::complaint(const DeviceOptions& options) {
  if (const int width = options.vector_width.value_or(1); width != 1 && width != 16)
    return fmt::format("a vector width of {}; expected 1 or 16", width);
  if (const int size = options.work_group_size.value_or(1);
      size < 1 || !std::has_single_bit(static_cast<unsigned>(size)))
    return fmt::format("a work-group of {} work-items; expected a power of two", size);
  return "";
}

Device::Device(const std::string& selection, const DeviceOptions& options)
    : options_(options), kernel_cache_(open_kernel_cache()) {
  if (const std::string wrong = complaint(options); !wrong.empty()) throw DeviceError(wrong);
  const auto devices = all_devices();
  const auto chosen = std::find_if(devices.begin(), devices.end(), [&](const cl::Device& device) {
    return matches(describe(device), lower(selection));
  });
  if (chosen == devices.end()) {
    std::string known;
    for (const auto& info : list()) known += (known.empty() ? "" : ", ") + info.name;
    throw DeviceError(fmt::format("no OpenCL device matches '{}'; {}", selection,
                                  known.empty() ? why_none() : "there are: " + known));
  }
  device_ = *chosen;
  info_ = describe(device_);
  check_work_group();
  try {
    context_ = cl::Context(device_);
    queue_ = cl::CommandQueue(context_, device_, CL_QUEUE_PROFILING_ENABLE);
    pool_ = std::make_unique<BufferPool>(context_);
  } catch (const cl::Error& error) {
    fail("opening device " + info_.name, error);
  }
}

/// Memory that the queue still reads from must not go before it is through.
Device::~Device() {
  if (queue_() != nullptr) clFinish(queue_());
}

void Device::check_work_group() const {
  const auto most = device_.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>();
  if (static_cast<std::size_t>(work_group_size()) > most)
    throw DeviceError(fmt::format("a work-group of {} work-items is too large for {}: one may have {}",
                                  work_group_size(), info_.name, most));
}

cl::Kernel Device::kernel(std::string_view source, const std::string& name, const std::string& options) {
  Program& made = program_of(source, options);
  auto& kernel = made.kernels[name];
  if (kernel() != nullptr) return kernel;
  try {
    if (made.program() == nullptr) made.program = build(source, options);
    return kernel = cl::Kernel(made.program, name.c_str());
  } catch (const cl::BuildError& error) {
    std::string log;
    for (const auto& entry : error.getBuildLog()) log += entry.second;
    throw DeviceError(fmt::format("kernel {} does not build on {}:\n{}", name, info_.name, log));
  } catch (const cl::Error& error) {
    fail("making kernel " + name, error);
  }
}

cl::Program Device::build(std::string_view source, const std::string& options) {
  const std::string all_options =
      fmt::format("-cl-std=CL1.2 -DWIDTH={} {} {}", width(), options_.build_options, options);
  const std::string identity =
      fmt::format("{}\n{}\n{}\n{}\n{}", info_.platform, info_.driver, info_.name, all_options, source);
  const bool is_new = !is_noted(kernel_cache_, identity);
  if (is_new && tell_of_building_)
    std::exchange(tell_of_building_,
                  {})({info_.name, 0, "building kernels; the driver keeps them for later runs"});
  cl::Program program(context_, std::string(source));
  program.build({device_}, all_options.c_str());
  ++programs_built_;
  if (is_new) note(kernel_cache_, identity);
  return program;
}

Device::Program& Device::program_of(std::string_view source, const std::string& options) {
  const auto known = std::find_if(programs_.begin(), programs_.end(), [&](const Program& program) {
    return program.source == source && program.options == options;
  });
  if (known != programs_.end()) return *known;
  return programs_.emplace_back(Program{options, std::string(source), {}, {}});
}

void Device::enqueue(const std::string& stage, const cl::Kernel& kernel, std::size_t global,
                     std::size_t local) {
  if (global == 0) return;
  const auto rounded = local == 0 ? global : (global + local - 1) / local * local;
  cl::Event event;
  try {
    queue_.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(rounded),
                                local == 0 ? cl::NullRange : cl::NDRange(local), nullptr,
                                measuring_ ? &event : nullptr);
  } catch (const cl::Error& error) {
    fail(fmt::format("running kernel {} over {} work-items", kernel.getInfo<CL_KERNEL_FUNCTION_NAME>(),
                     rounded),
         error);
  }
  if (measuring_) records_.push_back({stage, kernel, event});
}

Buffer Device::allocate(std::size_t bytes) const {
  // Asked first, because some drivers give out memory that is not there.
  if (bytes > info_.most_bytes)
    throw DeviceError(
        fmt::format("a buffer of {} bytes is too large for {}: one may have {}, all together {}", bytes,
                    info_.name, info_.most_bytes, info_.memory_bytes));
  try {
    return pool_->take(bytes, info_.most_bytes);
  } catch (const cl::Error&) {
    pool_->drop_unused();
    finish();  // a driver frees what is dropped once no command uses it any more
  }
  try {
    return pool_->take(bytes, info_.most_bytes);
  } catch (const cl::Error& error) {
    fail(fmt::format("allocating {} bytes on {}, of {} in all", bytes, info_.name, info_.memory_bytes),
         error);
  }
}

Buffer Device::upload(const void* data, std::size_t bytes) const {
  Buffer made = allocate(bytes);
  if (bytes == 0) return made;
  if (bytes > most_staged) {
    write(made, data, bytes);
    return made;
  }
  ++counts_.uploads;
  counts_.uploaded_bytes += bytes;
  try {
    staging_.send(queue_, *made, data, bytes);
  } catch (const cl::Error& error) {
    fail(fmt::format("writing {} bytes", bytes), error);
  }
  return made;
}

Buffer Device::copy(const Buffer& from, std::size_t bytes) const {
  Buffer made = allocate(bytes);
  if (bytes == 0) return made;
  try {
    queue_.enqueueCopyBuffer(*from, *made, 0, 0, bytes);
  } catch (const cl::Error& error) {
    fail(fmt::format("copying {} bytes", bytes), error);
  }
  return made;
}

void Device::write(const Buffer& buffer, const void* data, std::size_t bytes) const {
  if (bytes == 0) return;
  ++counts_.uploads;
  counts_.uploaded_bytes += bytes;
  try {
    queue_.enqueueWriteBuffer(*buffer, CL_TRUE, 0, bytes, data);
  } catch (const cl::Error& error) {
    fail(fmt::format("writing {} bytes", bytes), error);
  }
}

void Device::read(const Buffer& buffer, void* data, std::size_t bytes) const {
  if (bytes == 0) return;
  ++counts_.reads;
  counts_.read_bytes += bytes;
  try {
    queue_.enqueueReadBuffer(*buffer, CL_TRUE, 0, bytes, data);
  } catch (const cl::Error& error) {
    fail(fmt::format("reading {} bytes", bytes), error);
  }
}

cl::Event Device::read_later(const Buffer& buffer, void* data, std::size_t bytes) const {
  ++counts_.reads;
  counts_.read_bytes += bytes;
  cl::Event event;
  try {
    queue_.enqueueReadBuffer(*buffer, CL_FALSE, 0, bytes, data, nullptr, &event);
    queue_.flush();  // or a driver may begin only when somebody waits
  } catch (const cl::Error& error) {
    fail(fmt::format("reading {} bytes", bytes), error);
  }
  return event;
}

void Device::wait(const cl::Event& event) const {
  try {
    event.wait();
  } catch (const cl::Error& error) {
    fail("waiting for a copy to the host", error);
  }
}

void Device::fill_zero(const Buffer& buffer, std::size_t bytes) const {
  if (bytes == 0) return;
  try {
    queue_.enqueueFillBuffer(*buffer, cl_uchar{0}, 0, bytes);
  } catch (const cl::Error& error) {
    fail(fmt::format("clearing {} bytes", bytes), error);
  }
}

void Device::finish() const {
  try {
    queue_.finish();
  } catch (const cl::Error& error) {
    fail("waiting for the device", error);
  }
}

DeviceCounts Device::counts() const {
  DeviceCounts counts = counts_;
  counts.allocations = pool_->allocations() + staging_.allocations();
  counts.allocated_bytes = pool_->allocated_bytes();
  return counts;
}

StageTimes Device::take_stage_times() {
  return take_times([](const Record& record) { return record.stage; });
}

StageTimes Device::take_kernel_times() {
  return take_times([](const Record& record) { return record.kernel.getInfo<CL_KERNEL_FUNCTION_NAME>(); });
}

template <class Name>
StageTimes Device::take_times(Name name) {
  if (records_.empty()) return {};
  finish();
  StageTimes times;
  for (const auto& record : records_) {
    const auto begin = record.event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
    const auto end = record.event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
    times[name(record)] += static_cast<double>(end - begin) * 1e-6;
  }
  records_.clear();
  return times;
}

void Device::fail(const std::string& what, const cl::Error& error) {
  throw DeviceError(fmt::format("OpenCL failed while {}: {} returned {}", what, error.what(), error.err()));
}

}  // namespace pliant
