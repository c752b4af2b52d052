#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "framework/geometry/camera.h"
#include "framework/geometry/image.h"

namespace pliant {

/// An image of one sensor: of depth and colour the one that is there.
struct SensorImage {
  DepthImage depth;       ///< mm
  ColorImage color;       ///< as its own camera sees it
  std::int64_t time = 0;  ///< microseconds, by the device's clock
};

/// A camera that OpenNI2 drives, or a recording of one (.oni). Images are not mirrored, whatever the device
/// does.
class OpenNiDevice {
 public:
  struct Settings {
    std::string recording = {};  ///< a file; empty: a camera
    std::string uri = {};        ///< of a camera; empty: the first one that is found
    bool color = true;           ///< whether colour is wanted where there is some
    /// Whether depth is seen through the colour camera (OpenNI's image registration). Of a camera: asked for,
    /// and by default wherever the camera can. Of a recording, which does not tell: known by the user; no by
    /// default.
    std::optional<bool> registered = std::nullopt;
  };

  /// Opens it and starts its sensors: of a camera, in the mode with the most pixels at 30 frames a second or
  /// more. Throws DataError, which says what to do, where there is no such camera, file or depth sensor.
  explicit OpenNiDevice(const Settings& settings);
  ~OpenNiDevice();

  const std::string& name() const;
  bool has_color() const;
  bool is_registered() const;
  /// Of the depth images, by the field of view; focal lengths are 0 where the device does not tell it. The
  /// principal point is the middle of the image, which is all that OpenNI2 knows.
  Camera depth_camera() const;
  Camera color_camera() const;
  /// Depth images a second, as the mode says; 0 where it does not.
  int rate() const;
  std::vector<std::string> warnings() const;

  /// The next image of any sensor, in the order of their coming; waits for it. None after a recording's last.
  /// Throws SourceLost when a camera is unplugged or gives nothing for 5 s, DataError when a recording ends
  /// before its last image.
  std::optional<SensorImage> next();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pliant
