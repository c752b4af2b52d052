#pragma once

#include <vector>

#include "framework/geometry/surface.h"

namespace pliant {

/// Chooses which points of the source become nodes of its deformation graph [thesis 4.3].
class GraphBuilder {
 public:
  static constexpr const char* kind = "graph";
  virtual ~GraphBuilder() = default;
  /// Indices of points of `source`, ascending, without repetition.
  virtual std::vector<int> select_nodes(const Surface& source) const = 0;
};

}  // namespace pliant
