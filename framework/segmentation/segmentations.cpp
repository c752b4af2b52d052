#include "framework/segmentation/segmentations.h"

#include <memory>

#include "framework/imaging/segmentation.h"
#include "framework/segmentation/bounding_box.h"
#include "framework/segmentation/haar.h"
#include "framework/segmentation/mask.h"

namespace pliant {
namespace {

class WholeImage : public Segmentation {
 public:
  std::optional<Region> find(const Frame& /*frame*/, const Rig& rig) const override {
    return Region{whole_image(rig.depth)};
  }
};

}  // namespace

void register_segmentations(Registry& registry) {
  registry.add<Segmentation>(
      "none", "Takes the whole image for the object", {},
      [](const Parameters&, const Registry&) { return std::make_unique<WholeImage>(); });
  register_bounding_box(registry);
  register_mask(registry);
  register_haar(registry);
}

}  // namespace pliant
