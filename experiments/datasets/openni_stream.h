#pragma once

#include "experiments/datasets/color_pairing.h"
#include "experiments/datasets/depth_camera.h"
#include "experiments/datasets/frame_source.h"
#include "experiments/datasets/openni_device.h"
#include "experiments/datasets/sequence.h"

namespace pliant {

/// The frames of a device of OpenNI2 or of a recording. A frame has the time of its depth, in seconds from
/// the first image on, and its colour by ColorPairing. Images whose time is not later than that of the one
/// before are left out; images that are missing between two others, by their times, are counted; warnings
/// tell both. A recording ends with its last frame, a camera goes on until it is unplugged (SourceLost).
class OpenNiStream : public DataStream {
 public:
  struct Settings {
    OpenNiDevice::Settings device;
    Selection selection;
    std::optional<CameraChoice> camera;  ///< of the depth; by default by the field of view
    std::string color_intrinsics = {};   ///< of the colour where it is not registered; likewise
    std::optional<Eigen::Isometry3d> color_from_depth = std::nullopt;  ///< mm
  };

  explicit OpenNiStream(const Settings& settings);

  std::string name() const override { return device_.name(); }
  const Rig& rig() const override { return rig_; }
  std::optional<Frame> next() override;
  std::vector<std::string> warnings() const override;
  bool reads_on_host() const override { return true; }
  std::optional<PairTruth> truth(int /*number*/) const override { return std::nullopt; }

 private:
  void set_depth_camera(const std::optional<CameraChoice>& choice);
  void set_color_camera(const Settings& settings);
  std::optional<Frame> read();
  void take(SensorImage image);
  void take_depth(DepthImage depth, double time);

  OpenNiDevice device_;
  Selection selection_;
  Rig rig_;
  ColorPairing pairing_;
  std::vector<std::string> warnings_;
  std::optional<std::int64_t> start_;  // microseconds, of the first image
  double time_ = 0;                    // s, of the last depth image
  int depths_ = 0;                     // images taken
  int read_ = 0;                       // frames
  int given_ = 0;
  int colorless_ = 0;      // frames
  int missing_ = 0;        // depth images
  int first_missing_ = 0;  // comes after this one
  int late_ = 0;           // depth images left out for their time
};

}  // namespace pliant
