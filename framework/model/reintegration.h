#pragma once

#include <memory>

#include "framework/model/deforming_model.h"

namespace pliant {

/// The thesis's way to take up a deformation [4.8]: the deformed surface is fused into the model again, from
/// where its camera saw it, as if `weight` frames had shown it. What is not in view stays as it was.
class Reintegration : public DeformingModel {
 public:
  /// The device must outlive this.
  Reintegration(Device& device, std::unique_ptr<ReferenceModel> model, int weight);

  void integrate(const DepthMap& depth, const Camera& camera,
                 const Eigen::Isometry3d& camera_from_model) override;
  const SurfaceMap& view(const Camera& camera, const PixelWindow& window,
                         const Eigen::Isometry3d& camera_from_model) override;
  DeformationStart start() override;
  void deform(const ModelDeformation& deformation) override;
  void follow(const Array<float>& points) override;
  const Array<float>& followed() const override { return followed_; }
  Mesh mesh() const override { return model_->mesh(); }

 private:
  void move_followed(const ModelDeformation& deformation);

  Device& device_;
  std::unique_ptr<ReferenceModel> model_;
  int weight_;
  const SurfaceMap* view_ = nullptr;  ///< the last one
  DepthMap drawn_;                    ///< of the last deformation
  Array<float> followed_;
};

/// Neighbouring points whose depths differ by more than so many times a pixel's width on the surface belong
/// to different parts of it.
inline constexpr float steepest_cell = 10;

/// The depth that a camera would see of the points of a map (one a pixel, not always in it) as a surface:
/// between four neighbouring ones where it is not torn, of several the nearest; without depth elsewhere.
/// `drawn`: over the map's window. Only enqueues.
void draw_depth(Device& device, const SurfaceMap& map, DepthMap& drawn);

/// Plain C++ reference of draw_depth.
void draw_depth_reference(const SurfaceMap& map, DepthMap& drawn);

}  // namespace pliant
