#include "framework/device/compact.h"

#include "framework/device/compact.cl.embed.h"

namespace pliant {

Array<int> compact(Device& device, const std::string& stage, const Array<int>& flags) {
  constexpr std::size_t chunk = 256;  // CHUNK in compact.cl
  constexpr std::size_t group = 16;
  constexpr auto source = embedded::framework_device_compact_cl;
  auto count = device.kernel(source, "count_flags");
  auto scan = device.kernel(source, "scan_counts");
  auto gather = device.kernel(source, "gather_raised");
  const auto chunks = (flags.size() + chunk - 1) / chunk;
  const auto size = static_cast<cl_int>(flags.size());
  const cl::Buffer counts = device.allocate(chunks * sizeof(cl_int));
  const cl::Buffer starts = device.allocate((1 + chunks) * sizeof(cl_int));
  device.run(stage, count, chunks, group, size, flags.device(device), counts);
  device.run(stage, scan, 1, 1, static_cast<cl_int>(chunks), counts, starts);
  cl_int total = 0;
  device.read(starts, &total, sizeof(total));
  Array<int> indices(static_cast<std::size_t>(total));
  device.run(stage, gather, chunks, group, size, flags.device(device), starts, indices.write_device(device));
  return indices;
}

std::vector<int> compact_reference(const std::vector<int>& flags) {
  std::vector<int> indices;
  for (std::size_t i = 0; i < flags.size(); ++i)
    if (flags[i] != 0) indices.push_back(static_cast<int>(i));
  return indices;
}

}  // namespace pliant
