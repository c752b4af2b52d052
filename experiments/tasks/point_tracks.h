#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "experiments/view/even_choice.h"
#include "framework/core/parameters.h"
#include "framework/geometry/rig.h"

namespace pliant {

/// Writes where points of the model's surface went over the frames of a stream: a mesh whose vertices keep
/// their identity and order. Vertices are mm in the model's frame: the camera's motion is not in them.
class PointTracks {
 public:
  struct Options {
    bool gltf = false;  ///< tracks.glb: one mesh, animated through up to `most_keys` frames
    bool ply = false;   ///< tracks/frame_0123.ply, a mesh for every frame that is recorded
    int every = 1;      ///< frames from one that is recorded to the next, from the first on
    int step = 1;       ///< pixels from point to point, in u and v
    /// Neighbours whose depths differ by more than this times their depth are not joined by triangles.
    double gap_per_depth = 0.05;
  };
  /// Of the recorded frames, evenly spaced from the first on; where there are more, at least half as many.
  static constexpr std::size_t most_keys = 64;
  static constexpr const char* gltf_name = "tracks.glb";

  PointTracks(std::filesystem::path folder, const Options& options)
      : folder_(std::move(folder)), options_(options), keys_(most_keys) {}

  /// Where the points are after frame `number` at `time` (s). `pixels`: where the frame that began the model
  /// saw each. Both are as many in every call. Throws DataError when a file cannot be written.
  void add(int number, double time, const std::vector<Eigen::Vector2i>& pixels,
           const std::vector<Eigen::Vector3f>& points);
  /// Writes what takes all frames, and gives all files.
  std::vector<std::filesystem::path> finish() const;

 private:
  struct Key {
    int number = 0;
    double time = 0;  // s
    std::vector<Eigen::Vector3f> points;
  };
  void write_gltf(const std::filesystem::path& file) const;

  std::filesystem::path folder_;
  Options options_;
  int first_ = 0;  // number of the first frame that is recorded
  std::vector<Eigen::Vector3i> triangles_;
  std::vector<std::filesystem::path> files_;
  EvenChoice<Key> keys_;
};

/// What the `record` of an experiment asks for; null where it asks for none. Throws ConfigError where no
/// points are followed.
std::unique_ptr<PointTracks> make_point_tracks(const Parameters& experiment,
                                               const std::filesystem::path& folder, const Rig& rig);

}  // namespace pliant
