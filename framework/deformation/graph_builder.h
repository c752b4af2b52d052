#pragma once

#include <memory>

#include "framework/deformation/node_selection.h"
#include "framework/geometry/camera.h"
#include "framework/geometry/surface.h"

namespace pliant {

/// Chooses which points of the source become nodes of its deformation graph [thesis 4.3].
class GraphBuilder {
 public:
  static constexpr const char* kind = "graph";
  virtual ~GraphBuilder() = default;
  /// `source`: pixels are those of the camera's image. Both must outlive what is returned.
  virtual std::unique_ptr<NodeSelection> select_nodes(Device& device, const Surface& source,
                                                      const Camera& camera) const = 0;
};

}  // namespace pliant
