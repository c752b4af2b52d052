#include "experiments/tasks/workbench.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <type_traits>

namespace pliant {

ParameterTable kernels_table() {
  return {
      integer("vector_width")
          .optional()
          .range(1, 16)
          .doc("of the vectors that kernels are written over: 1 or 16; 16 on a CPU, 1 on a GPU by default"),
      integer("work_group_size")
          .optional()
          .range(1, 4096)
          .doc("work-items that solve one system together, a power of two; 1 on a CPU, 128 on a GPU by "
               "default"),
  };
}

DeviceOptions device_options(const Parameters& experiment) {
  const Parameters& kernels = experiment.section("kernels");
  const auto number = [&](const std::string& name) {
    return kernels.has(name) ? std::optional(static_cast<int>(kernels.integer(name))) : std::nullopt;
  };
  DeviceOptions options{number("vector_width"), number("work_group_size"), ""};
  const std::string wrong = Device::complaint(options);
  if (!wrong.empty()) throw ConfigError(fmt::format("{}: 'kernels' asks for {}", kernels.place(), wrong));
  return options;
}

namespace {

// Of 640x480 pixels with their truth they are half a gigabyte.
constexpr std::size_t most_pairs = 48;

/// Of a file, or of how many there are in a folder and the last of them to change, so that others under the
/// same name are not taken for them; of any other word nothing.
std::string time_of_change(const std::filesystem::path& word) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (!word.is_absolute()) return "";
  if (fs::is_regular_file(word, ignored))
    return fmt::format("@{}", fs::last_write_time(word, ignored).time_since_epoch().count());
  if (!fs::is_directory(word, ignored)) return "";
  int count = 0;
  auto latest = fs::file_time_type::min();
  for (const auto& entry : fs::recursive_directory_iterator(word, ignored)) {
    ++count;
    latest = std::max(latest, entry.last_write_time(ignored));
  }
  return fmt::format("@{}/{}", count, latest.time_since_epoch().count());
}

/// The same text for experiments that ask for the same device.
std::string device_key(const Parameters& experiment) {
  return experiment.text("device") + " " + fingerprint(experiment.section("kernels"));
}

}  // namespace

std::string fingerprint(const Parameters& section) {
  std::string text = section.component() + "{";
  for (const auto& value : section.values()) {
    text += value.name + "=";
    std::visit(
        [&](const auto& held) {
          using Held = std::decay_t<decltype(held)>;
          if constexpr (std::is_same_v<Held, Parameters::Sections>) {
            for (const auto& [label, inner] : held) text += label + ":" + fingerprint(inner);
          } else if constexpr (std::is_same_v<Held, std::vector<std::string>>) {
            for (const auto& word : held) text += word + ",";
          } else if constexpr (std::is_same_v<Held, std::vector<double>>) {
            for (const double number : held) text += fmt::format("{},", number);
          } else {
            text += fmt::format("{}", held);
            if constexpr (std::is_same_v<Held, std::string>) text += time_of_change(held);
          }
        },
        value.value);
    text += ";";
  }
  return text + "}";
}

Device& Workbench::device(const Parameters& experiment) {
  auto& device = devices_[device_key(experiment)];
  if (device == nullptr) {
    device = std::make_unique<Device>(experiment.text("device"), device_options(experiment));
    device->tell_of_building(tell_of_building_);
  }
  return *device;
}

std::unique_ptr<DataStream> Workbench::open(const Parameters& experiment) {
  return registry_.make<FrameSource>(experiment.section("data"))
      ->open(device(experiment), static_cast<std::uint64_t>(experiment.integer("seed")));
}

const Workbench::Data& Workbench::data(const Parameters& experiment) {
  const Parameters& section = experiment.section("data");
  const auto seed = experiment.integer("seed");
  const std::string key = fmt::format("{} {} {}", device_key(experiment), seed, fingerprint(section));
  const auto known = data_.find(key);
  if (known != data_.end()) return known->second;
  const auto stream = open(experiment);
  Data data{read_pair(*stream), stream->truth(2)};
  if (data.truth) check(*data.truth, data.pair);
  if (data_.size() >= most_pairs) data_.clear();
  return data_.emplace(key, std::move(data)).first->second;
}

}  // namespace pliant
