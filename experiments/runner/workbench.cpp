#include "experiments/runner/workbench.h"

#include <fmt/format.h>

#include <type_traits>

#include "experiments/datasets/frame_source.h"
#include "experiments/runner/experiment.h"

namespace pliant {
namespace {

/// The same text for sections that say the same.
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
          }
        },
        value.value);
    text += ";";
  }
  return text + "}";
}

}  // namespace

Device& Workbench::device(const Parameters& experiment) {
  const std::string& name = experiment.text("device");
  auto& device = devices_[name + " " + fingerprint(experiment.section("kernels"))];
  if (device == nullptr) {
    device = std::make_unique<Device>(name, device_options(experiment));
    device->tell_of_building(tell_of_building_);
  }
  return *device;
}

const Workbench::Data& Workbench::data(const Parameters& experiment) {
  const Parameters& section = experiment.section("data");
  const auto seed = experiment.integer("seed");
  const std::string key = fmt::format("{} {}", seed, fingerprint(section));
  const auto known = data_.find(key);
  if (known != data_.end()) return known->second;
  const auto stream = registry_.make<FrameSource>(section)->open(static_cast<std::uint64_t>(seed));
  Data data{read_pair(*stream), stream->truth(2)};
  return data_.emplace(key, std::move(data)).first->second;
}

}  // namespace pliant
