#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "framework/device/device.h"
#include "framework/evaluation/truth.h"
#include "framework/geometry/frame_stream.h"
#include "framework/geometry/mesh.h"

namespace pliant {

/// Of data that is made: frames a second.
inline constexpr double frame_rate = 30;

/// Where points of a surface truly are in a frame.
struct TruePoints {
  std::vector<Eigen::Vector3f> positions;  ///< mm in the depth camera's frame; NaN where it is not known
  std::vector<bool> visible;               ///< whether the frame shows the point
};

/// A stream of an experiment's data. Its truth is asked for apart, by who measures results, and never goes
/// with the frames.
class DataStream : public FrameStream {
 public:
  /// What is known of the pair of the first frame and frame `number` (the first is 1), whether they were read
  /// or not; nothing where nothing is known.
  virtual std::optional<PairTruth> truth(int number) const = 0;
  /// Where the depth camera is in frame `number`: from its frame, mm, to one that stays, or that goes with
  /// what is seen as far as that is known to move rigidly; nothing where that is not known.
  virtual std::optional<Eigen::Isometry3d> camera_pose(int /*number*/) const { return std::nullopt; }
  /// The whole surface of what is there in frame `number`, seen or not, in the frame of its depth camera, mm;
  /// nothing where that is not known.
  virtual std::optional<Mesh> surface(int /*number*/) const { return std::nullopt; }
  /// Where the points are in frame `number` that frame `first` shows at pixels of its depth camera, whatever
  /// errors that has; nothing where that is not known. The pixels lie in the image.
  virtual std::optional<TruePoints> points_of(int /*first*/, const std::vector<Eigen::Vector2i>& /*pixels*/,
                                              int /*number*/) const {
    return std::nullopt;
  }
};

/// Where an experiment's frames come from.
class FrameSource {
 public:
  static constexpr const char* kind = "data";
  virtual ~FrameSource() = default;
  /// A stream from the first frame on; it may outlive the source but not the device, on which frames may be
  /// rendered. Every stream opened with one seed on the same kind of device gives the same bits, unless a
  /// live camera is behind it. Throws DataError naming the file at fault.
  virtual std::unique_ptr<DataStream> open(Device& device, std::uint64_t seed) const = 0;
};

}  // namespace pliant
