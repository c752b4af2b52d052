#include "tests/datasets/data_of.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "experiments/datasets/datasets.h"
#include "framework/config/config.h"
#include "framework/core/error.h"
#include "framework/io/file.h"

namespace pliant::test {

std::unique_ptr<FrameSource> data_of(const std::string& section) {
  const auto path =
      std::filesystem::temp_directory_path() / ("pliant_data_" + std::to_string(::getpid()) + ".yaml");
  const std::string text = "data: " + section + "\n";
  write_file(path.string(), {text.begin(), text.end()});
  Registry registry;
  register_datasets(registry);
  const Experiment experiment =
      load_experiment({path, {}, {}}, {component("data", FrameSource::kind)}, registry);
  std::filesystem::remove(path);
  return registry.make<FrameSource>(experiment.values.section("data"));
}

Device& shared_device() {
  // Never closed: OpenCL drivers end before what is static here does.
  static Device& device = *new Device;
  return device;
}

LoadedPair load(const FrameSource& source, std::uint64_t seed) {
  const auto stream = source.open(shared_device(), seed);
  return {read_pair(*stream), stream->truth(2)};
}

std::string config_error_of(const std::string& section) {
  try {
    data_of(section);
  } catch (const ConfigError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no ConfigError for " << section;
  return "";
}

int count_points(const DepthImage& depth) {
  int count = 0;
  for (const float value : depth.pixels()) count += value > 0 ? 1 : 0;
  return count;
}

}  // namespace pliant::test
