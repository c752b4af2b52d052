#include "framework/segmentation/bounding_box.h"

#include <memory>

#include "framework/geometry/has_point.h"
#include "framework/imaging/segmentation.h"
#include "framework/segmentation/parts.h"

namespace pliant {
namespace {

class BoundingBox : public Segmentation {
 public:
  BoundingBox(int speck, int margin) : speck_(speck), margin_(margin) {}

  std::optional<Region> find(const Frame& frame, const Rig& rig) const override {
    MaskImage foreground(rig.depth.width, rig.depth.height);
    for (std::size_t i = 0; i < foreground.size(); ++i) foreground.data()[i] = has_point(frame, i) ? 1 : 0;
    const auto window = window_of_parts(foreground, speck_);
    if (!window) return std::nullopt;
    return Region{widened(*window, margin_, rig.depth)};
  }

 private:
  int speck_;
  int margin_;
};

}  // namespace

void register_bounding_box(Registry& registry) {
  registry.add<Segmentation>(
      "bounding_box", "The window around all depth that was not cut [thesis 3.1]",
      {speck_parameter(), margin_parameter()}, [](const Parameters& section, const Registry&) {
        return std::make_unique<BoundingBox>(static_cast<int>(section.integer("speck")),
                                             static_cast<int>(section.integer("margin")));
      });
}

}  // namespace pliant
