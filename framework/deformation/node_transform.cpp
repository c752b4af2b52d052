#include "framework/deformation/node_transform.h"

#include "framework/deformation/quaternion.h"
#include "framework/deformation/quaternion.h.embed.h"

namespace pliant {

NodeTransform quaternion_transform() {
  return {"quaternion",
          6,
          embedded::framework_deformation_quaternion_h,
          &quaternion_retract<double>,
          &quaternion_pull_back<double>,
          &quaternion_nearest<double>};
}

void register_transforms(Registry& registry) {
  registry.add<NodeTransform>(
      "affine", "12 unknowns a node: a free 3x3 matrix and a translation [thesis 4.1]", {},
      [](const Parameters&, const Registry&) { return std::make_unique<NodeTransform>(); });
  registry.add<NodeTransform>("quaternion",
                              "6 unknowns a node: a rotation, kept by a unit quaternion, and a translation; "
                              "energy rotation is then 0",
                              {}, [](const Parameters&, const Registry&) {
                                return std::make_unique<NodeTransform>(quaternion_transform());
                              });
}

}  // namespace pliant
