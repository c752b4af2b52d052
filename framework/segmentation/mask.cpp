#include "framework/segmentation/mask.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "framework/core/error.h"
#include "framework/geometry/has_point.h"
#include "framework/imaging/segmentation.h"
#include "framework/io/images.h"
#include "framework/segmentation/parts.h"

namespace pliant {
namespace {

class MaskFile : public Segmentation {
 public:
  explicit MaskFile(const std::string& file) : file_(file) {
    MaskImage mask = read_mask(file);
    const auto window = window_of_parts(mask, 1);
    if (!window) throw DataError(file + ": the mask is black all over");
    region_ = {*window, std::move(mask)};
  }

  std::optional<Region> find(const Frame& frame, const Rig& rig) const override {
    check_size(rig.depth);
    for (std::size_t i = 0; i < frame.depth.size(); ++i)
      if (region_.mask.data()[i] != 0 && has_point(frame, i)) return region_;
    return std::nullopt;
  }

 private:
  void check_size(const Camera& camera) const {
    const MaskImage& mask = region_.mask;
    if (mask.width() != camera.width || mask.height() != camera.height)
      throw DataError(fmt::format("{}: the mask has {} x {} pixels, the depth images have {} x {}", file_,
                                  mask.width(), mask.height(), camera.width, camera.height));
  }

  std::string file_;
  Region region_;
};

}  // namespace

void register_mask(Registry& registry) {
  registry.add<Segmentation>(
      "mask", "The object as a mask image shows it, once for all frames",
      {path("file").doc("PNG of the depth's size, not black and not transparent on the object")},
      [](const Parameters& section, const Registry&) {
        return std::make_unique<MaskFile>(section.text("file"));
      });
}

}  // namespace pliant
