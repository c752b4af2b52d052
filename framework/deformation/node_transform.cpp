#include "framework/deformation/node_transform.h"

#include "framework/deformation/warp.h"

namespace pliant {

void register_transforms(Registry& registry) {
  registry.add<NodeTransform>("affine",
                              "12 unknowns a node: a free 3x3 matrix and a translation [thesis 4.1]", {},
                              [](const Parameters&, const Registry&) {
                                return std::make_unique<NodeTransform>(NodeTransform{affine_size});
                              });
}

}  // namespace pliant
