#include <memory>

#include "framework/model/tsdf.h"

namespace pliant {
namespace {

class TsdfKind : public ModelKind {
 public:
  explicit TsdfKind(const Parameters& section)
      : resolution_(static_cast<int>(section.integer("resolution"))),
        is_fitted_(section.text("volume") == "fitted"),
        size_(section.real("size")),
        distance_(section.real("distance")),
        margin_(section.real("margin")),
        truncation_{section.real("truncation"), section.real("least_truncation")},
        max_weight_(static_cast<int>(section.integer("max_weight"))) {}

  std::unique_ptr<ReferenceModel> make(Device& device, const SurfaceMap& seen) const override {
    const TsdfGrid grid = is_fitted_ ? grid_around(seen, resolution_, margin_, truncation_)
                                     : grid_before_camera(resolution_, size_, distance_, truncation_);
    return std::make_unique<Tsdf>(device, grid, max_weight_);
  }

 private:
  int resolution_;
  bool is_fitted_;
  double size_, distance_, margin_;
  TruncationBand truncation_;
  int max_weight_;
};

}  // namespace

void register_models(Registry& registry) {
  registry.add<ModelKind>(
      "tsdf", "Signed distances to the surface on a dense grid, averaged over the frames",
      {
          integer("resolution", 256)
              .unit("voxel")
              .range(32, 512)
              .multiple_of(TsdfGrid::brick_width)
              .doc("Voxels along the longest side of the volume; 3 bytes each"),
          choice("volume", {"scene", "fitted"}, "scene")
              .doc("scene: a cube before the first camera; fitted: what is around the first frame's points"),
          real("size", 3000).unit("mm").range(10, 1e5).doc("Side of a scene's cube"),
          real("distance", 300).unit("mm").range(0, 1e6).doc("From the first camera to a scene's cube"),
          real("margin", 0.25)
              .range(0, 10)
              .doc("Around the first frame's points, in parts of the longest side of the box around them"),
          real("truncation", 5)
              .unit("voxel")
              .range(2, 100)
              .doc("How far from the surface distances are known"),
          real("least_truncation", 6)
              .unit("mm")
              .range(0, 1000)
              .doc("As far at least; more than three times the noise of depth, which else tears the surface"),
          integer("max_weight", 64)
              .range(1, Tsdf::greatest_weight)
              .doc("Frames after which later ones weigh as if there had been no more"),
      },
      [](const Parameters& section, const Registry&) { return std::make_unique<TsdfKind>(section); });
}

}  // namespace pliant
