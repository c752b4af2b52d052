#pragma once

#include <memory>

#include "framework/deformation/node_selection.h"
#include "framework/geometry/pixel_index.h"

namespace pliant {

/// Chooses which points of the source become nodes of its deformation graph [thesis 4.3].
class GraphBuilder {
 public:
  static constexpr const char* kind = "graph";
  virtual ~GraphBuilder() = default;
  /// What is returned keeps nothing of `source`.
  virtual std::unique_ptr<NodeSelection> select_nodes(Device& device, const SurfaceView& source) const = 0;
};

}  // namespace pliant
