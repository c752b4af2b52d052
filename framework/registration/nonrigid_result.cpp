#include "framework/registration/nonrigid_result.h"

#include <fmt/format.h>

namespace pliant {

std::vector<std::string> warnings_of(const NonRigidMethod& method, const NonRigidResult::Counts& counts) {
  if (counts.nodes > method.nearest_nodes) return {};
  return {fmt::format("the graph has {} node(s): all of them move every point, though nearest_nodes is {}",
                      counts.nodes, method.nearest_nodes)};
}

}  // namespace pliant
