#include "framework/device/lanes.h"

#include "framework/device/lanes.cl.embed.h"

namespace pliant {

std::string with_lanes(std::string_view source) {
  return std::string(embedded::framework_device_lanes_cl).append(source);
}

}  // namespace pliant
