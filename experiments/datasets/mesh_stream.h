#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/datasets/frame_source.h"
#include "experiments/datasets/mesh_scene.h"
#include "framework/geometry/mesh_renderer.h"

namespace pliant {

/// The frames of a scene, rendered on a device when they are asked for, with exact truth: scene flow, optical
/// flow and visibility of what each pixel of the first frame shows, also under noise. There is no background.
/// Without sensor terms the depth of every pixel is exact (not rounded to whole millimetres). The mesh may
/// leave the image after the first frame, if there are more than the two of a pair.
class MeshStream : public DataStream {
 public:
  /// `seed`: of the sensor. `device` must outlive this.
  MeshStream(std::shared_ptr<const MeshScene> scene, Device& device, std::uint64_t seed);

  std::string name() const override { return scene_->name; }
  const Rig& rig() const override { return scene_->rig; }
  /// Throws DataError, with the size of the mesh, when no pixel of a frame sees it that has to, or the camera
  /// is inside of it.
  std::optional<Frame> next() override;
  std::vector<std::string> warnings() const override { return scene_->warnings; }
  std::optional<PairTruth> truth(int number) const override;
  std::optional<Eigen::Isometry3d> camera_pose(int number) const override;
  std::optional<Mesh> surface(int number) const override;
  std::optional<TruePoints> points_of(int first, const std::vector<Eigen::Vector2i>& pixels,
                                      int number) const override;

  const MeshScene& scene() const { return *scene_; }
  /// The exact depth of a frame, which no sensor has seen.
  DepthImage exact_depth(int number) const;

 private:
  struct Seen {
    int number = 0;         ///< of the frame
    Array<float> vertices;  ///< mm in the depth camera's frame
    MeshView view;
  };
  Seen see(int number) const;
  /// The same of the frame that was seen last, without seeing it again: its truth is asked for after it is
  /// given.
  const Seen& latest(int number) const;
  /// The same of the frame whose points were followed last.
  const Seen& first(int number) const;
  ColorImage color_of(const Seen& seen) const;
  void check_is_seen(const DepthImage& exact, int number) const;

  std::shared_ptr<const MeshScene> scene_;
  Device& device_;
  MeshRenderer renderer_;
  DepthSensor sensor_;
  Array<float> rest_;  // vertices at rest in the mesh's own frame, which colour belongs to
  mutable std::optional<Seen> first_;
  mutable std::optional<Seen> latest_;
  int given_ = 0;
};

/// A source of the frames of one scene.
class MeshSource : public FrameSource {
 public:
  explicit MeshSource(MeshScene scene) : scene_(std::make_shared<const MeshScene>(std::move(scene))) {}
  std::unique_ptr<DataStream> open(Device& device, std::uint64_t seed) const override {
    return std::make_unique<MeshStream>(scene_, device, seed);
  }

 private:
  std::shared_ptr<const MeshScene> scene_;
};

}  // namespace pliant
