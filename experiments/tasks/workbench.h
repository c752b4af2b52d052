#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "experiments/datasets/frame_source.h"
#include "framework/core/error.h"
#include "framework/core/registry.h"
#include "framework/device/device.h"
#include "framework/evaluation/truth.h"
#include "framework/geometry/frame.h"

namespace pliant {

/// The keys under which an experiment says how kernels are shaped.
ParameterTable kernels_table();

/// What an experiment asks of its device. Throws ConfigError for what no device has.
DeviceOptions device_options(const Parameters& experiment);

/// The same text for sections that say the same, of the same files.
std::string fingerprint(const Parameters& section);

/// Opens devices and loads data, each once however many runs ask for it.
class Workbench {
 public:
  /// `registry` must outlive this. `tell_of_building`: see Device.
  explicit Workbench(const Registry& registry, ProgressSink tell_of_building = {})
      : registry_(registry), tell_of_building_(std::move(tell_of_building)) {}

  const Registry& registry() const { return registry_; }
  /// Throws DeviceError when there is none that the experiment would take.
  Device& device(const Parameters& experiment);
  /// The frames of the experiment's data, made on its device. Throws DataError as FrameSource::open does,
  /// DeviceError as above.
  std::unique_ptr<DataStream> open(const Parameters& experiment);
  /// The first two frames of the experiment's data, made on its device; valid until another is asked for.
  /// Throws DataError when they cannot be used, DeviceError as above.
  const FramePair& pair(const Parameters& experiment) { return data(experiment).pair; }
  /// What is known of that pair, for who measures.
  const std::optional<PairTruth>& truth(const Parameters& experiment) { return data(experiment).truth; }

 private:
  struct Data {
    FramePair pair;
    std::optional<PairTruth> truth;
  };
  const Data& data(const Parameters& experiment);

  const Registry& registry_;
  ProgressSink tell_of_building_;
  std::map<std::string, std::unique_ptr<Device>> devices_;  // by what was asked for
  std::map<std::string, Data> data_;                        // by device, data section and seed
};

/// Does the work of a run. What a registration finds wrong is told with the place it came from, because the
/// framework knows of no files.
template <class Work>
auto told_with_place(const std::string& place, Work work) {
  try {
    return work();
  } catch (const DataError& error) {
    throw DataError(place + ": " + error.what());
  } catch (const NumericalError& error) {
    throw NumericalError(place + ": " + error.what());
  }
}

/// The same for work on a pair, with what is odd about it: that may well be the reason.
template <class Work>
auto told_with_place(const std::string& place, const FramePair& pair, Work work) {
  try {
    return told_with_place(place, work);
  } catch (const DataError& error) {
    std::string message = error.what();
    for (const auto& warning : pair.warnings) message += "; warning: " + warning;
    throw DataError(message);
  }
}

}  // namespace pliant
