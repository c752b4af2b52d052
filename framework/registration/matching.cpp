#include "framework/registration/matching.h"

#include "framework/geometry/surface_map.h"
#include "framework/registration/matching.cl.embed.h"

namespace pliant {

cl::Kernel matching_kernel(Device& device, const std::string& name) {
  static const std::string source = with_surface_map(embedded::framework_registration_matching_cl);
  return device.kernel(source, name);
}

}  // namespace pliant
