#include "experiments/datasets/approaching_wall.h"

#include <memory>

#include "experiments/datasets/frame_source.h"
#include "experiments/datasets/virtual_camera.h"

namespace pliant {
namespace {

struct Wall {
  Camera camera;
  int frames = 0;
  double distance = 0;  // mm, in the first frame
  double speed = 0;     // mm a second
};

class WallStream : public DataStream {
 public:
  explicit WallStream(const Wall& wall) : wall_(wall), rig_{wall.camera} {}

  std::string name() const override { return "approaching wall"; }
  const Rig& rig() const override { return rig_; }

  std::optional<Frame> next() override {
    if (given_ == wall_.frames) return std::nullopt;
    ++given_;
    const double depth = wall_.distance - approach(given_);
    Frame frame;
    frame.depth = DepthImage(wall_.camera.width, wall_.camera.height, static_cast<float>(depth));
    frame.time = time_of(given_);
    return frame;
  }

  std::optional<PairTruth> truth(int number) const override {
    const Eigen::Vector3f motion(0, 0, static_cast<float>(-approach(number)));
    return PairTruth{Image<Eigen::Vector3f>(wall_.camera.width, wall_.camera.height, motion)};
  }

 private:
  static double time_of(int number) { return (number - 1) / 30.0; }
  double approach(int number) const { return wall_.speed * time_of(number); }

  Wall wall_;
  Rig rig_;
  int given_ = 0;
};

class ApproachingWall : public FrameSource {
 public:
  explicit ApproachingWall(const Wall& wall) : wall_(wall) {}
  std::unique_ptr<DataStream> open(Device& /*device*/, std::uint64_t /*seed*/) const override {
    return std::make_unique<WallStream>(wall_);
  }

 private:
  Wall wall_;
};

std::unique_ptr<FrameSource> make_wall(const Parameters& section, const Registry& /*components*/) {
  return std::make_unique<ApproachingWall>(Wall{virtual_camera(section),
                                                static_cast<int>(section.integer("frames")),
                                                section.real("distance"), section.real("speed")});
}

}  // namespace

void register_approaching_wall(Registry& registry) {
  registry.add<FrameSource>(
      "approaching_wall", "A wall that comes nearer, with its true motion",
      with_camera({
          integer("frames", 30).range(2, 1000).doc("length of the stream"),
          real("distance", 1000).unit("mm").above(0).doc("of the wall from the camera, at first"),
          real("speed", 100).unit("mm/s").doc("towards the camera"),
      }),
      make_wall);
}

}  // namespace pliant
