#pragma once

#include <map>
#include <memory>
#include <string>

#include "framework/core/registry.h"
#include "framework/device/device.h"
#include "framework/geometry/frame.h"

namespace pliant {

/// Opens devices and loads data, each once however many runs ask for it.
class Workbench {
 public:
  /// `registry` must outlive this.
  explicit Workbench(const Registry& registry) : registry_(registry) {}

  const Registry& registry() const { return registry_; }
  /// Throws DeviceError when there is none that the experiment would take.
  Device& device(const Parameters& experiment);
  /// Throws DataError when it cannot be used.
  const FramePair& pair(const Parameters& experiment);

 private:
  const Registry& registry_;
  std::map<std::string, std::unique_ptr<Device>> devices_;  // by what was asked for
  std::map<std::string, FramePair> pairs_;                  // by data section and seed
};

}  // namespace pliant
