#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>

#include "framework/device/device.h"
#include "framework/evaluation/truth.h"
#include "framework/geometry/frame_stream.h"
#include "framework/geometry/mesh.h"

namespace pliant {

/// Of data that is made: frames a second.
inline constexpr double frame_rate = 30;

/// A stream of an experiment's data. Its truth is asked for apart, by who measures results, and never goes
/// with the frames.
class DataStream : public FrameStream {
 public:
  /// What is known of the pair of the first frame and frame `number` (the first is 1), whether they were read
  /// or not; nothing where nothing is known.
  virtual std::optional<PairTruth> truth(int number) const = 0;
  /// Where the depth camera is in frame `number`: from its frame, mm, to one that stays; nothing where that
  /// is not known.
  virtual std::optional<Eigen::Isometry3d> camera_pose(int /*number*/) const { return std::nullopt; }
  /// The whole surface of what is there in frame `number`, seen or not, in the frame of its depth camera, mm;
  /// nothing where that is not known.
  virtual std::optional<Mesh> surface(int /*number*/) const { return std::nullopt; }
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
