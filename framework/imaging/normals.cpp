#include "framework/imaging/normals.h"

#include <memory>

#include "framework/imaging/cross_product.h"
#include "framework/imaging/integral_images.h"
#include "framework/imaging/plane_fit.h"

namespace pliant {
namespace {

Parameter depth_change() {
  return real("depth_change", 0.02)
      .range(0, 1)
      .above(0)
      .doc("Part of the depth by which it may change from a pixel to the next on one surface");
}

}  // namespace

void register_normals(Registry& registry) {
  registry.add<Normals>(
      "integral_images",
      "Direction of least variance in a window by integral images, in constant time [Holzer et al. 2012]",
      {
          integer("radius", 3)
              .unit("pixel")
              .range(1, IntegralImages::max_radius)
              .doc("Half the side of the window, which shrinks at holes and jumps of depth"),
          depth_change(),
      },
      [](const Parameters& parameters, const Registry&) {
        return std::make_unique<IntegralImages>(static_cast<int>(parameters.integer("radius")),
                                                parameters.real("depth_change"));
      });
  registry.add<Normals>(
      "plane_fit", "Plane through the points of a window whose depth is near that of its centre",
      {
          integer("radius", default_normal_radius)
              .unit("pixel")
              .range(1, max_window_radius)
              .doc("Half the side of the window, which grows where depth is sparse"),
          real("depth_step", default_depth_step)
              .unit("mm")
              .above(0)
              .doc("What is further from the centre's depth takes no part"),
      },
      [](const Parameters& parameters, const Registry&) {
        return std::make_unique<PlaneFit>(static_cast<int>(parameters.integer("radius")),
                                          static_cast<float>(parameters.real("depth_step")));
      });
  registry.add<Normals>("cross_product", "Cross product of the differences between neighbours",
                        {
                            integer("reach", 1)
                                .unit("pixel")
                                .range(1, max_window_radius)
                                .doc("How far the neighbours are away"),
                            depth_change(),
                        },
                        [](const Parameters& parameters, const Registry&) {
                          return std::make_unique<CrossProduct>(static_cast<int>(parameters.integer("reach")),
                                                                parameters.real("depth_change"));
                        });
}

}  // namespace pliant
