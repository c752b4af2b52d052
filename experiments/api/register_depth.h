#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "framework/core/log.h"
#include "framework/core/registry.h"
#include "framework/geometry/camera.h"

namespace pliant {

/// What a camera of width x height pixels saw at one moment, in arrays of the caller's: row by row from the
/// top left pixel, without gaps. They are read during the call only.
struct DepthView {
  /// width x height values along the optical axis. Zero, negative, infinite values and NaN are holes.
  std::variant<std::span<const float>, std::span<const std::uint16_t>> depth;
  double depth_scale = 1;  ///< mm a unit of `depth`: 1 for mm, 1000 for m, 0.2 for TUM's files
  std::span<const std::uint8_t> rgb = {};   ///< width x height x 3: red, green, blue; or empty
  std::span<const std::uint8_t> mask = {};  ///< width x height, non-zero on the object; or empty: all of it
};

struct DepthRegistrationOptions {
  /// How to register, in YAML: the keys of an experiment file without `data`, `handles`, `runs` and `sweep`.
  /// `extends` names a method that comes with Pliant ("methods/best.yaml", "methods/best_depth.yaml", ...) or
  /// a file.
  std::string recipe = "extends: methods/best.yaml";
  /// Values laid over it, as by `pliant run --set`: "graph.nodes=60", "device=gpu", "seed=2".
  std::vector<std::string> sets = {};
  /// Called after each iteration, and once where kernels are built, from the thread that registers.
  ProgressSink progress = {};
};

/// What a registration came to. Points are in mm in the camera's frame: x right, y down, z forward. The five
/// lists have one entry per pixel of the source that has depth and lies on the mask, in row-major order.
struct DepthRegistrationResult {
  std::vector<Eigen::Vector2i> pixels;  ///< (column, row) in the source
  std::vector<Eigen::Vector3f> before;  ///< the point seen there
  std::vector<Eigen::Vector3f> after;   ///< where it went: by `rigid_motion`, then the deformation
  /// Of the deformed surface at `after`, unit length; (0, 0, 0) where it has none.
  std::vector<Eigen::Vector3f> normals;
  /// 1 where the point has a match on the target at the end; what has none went with its neighbours.
  std::vector<std::uint8_t> matched;

  /// From the source to where its deformation begins; mm.
  Eigen::Isometry3d rigid_motion = Eigen::Isometry3d::Identity();
  double residual_before = 0;  ///< mean distance of matches in mm, after the rigid motion alone
  double residual_after = 0;   ///< the same in the end
  int nodes = 0;               ///< of the deformation graph
  int iterations = 0;          ///< of matching and minimising
  double time_ms = 0;          ///< of it all; the first registration with a recipe also builds its kernels

  /// Why it ended: "residual", "no_progress" or "max_iterations"; "no_constraints", "no_nodes" or "failed"
  /// where it could not go on, and then the result is what was reached until then.
  std::string termination;
  std::string reason;                 ///< in words, where there is more to say
  std::vector<std::string> warnings;  ///< what is odd about the input, or was done otherwise than asked for
};

/// Registers depth images to each other, one pair after the other, by one recipe on one device [thesis
/// Figure 4.1]. The same input gives the same bits on the same device. Not thread-safe; several objects may
/// work at once.
class DepthRegistration {
 public:
  /// Throws ConfigError with everything that is wrong with the options, DeviceError when there is no device
  /// as they ask for.
  explicit DepthRegistration(const DepthRegistrationOptions& options = {});
  /// With components of one's own: `components` holds register_everything's and those.
  DepthRegistration(const DepthRegistrationOptions& options, const Registry& components);
  DepthRegistration(DepthRegistration&&) noexcept;
  DepthRegistration& operator=(DepthRegistration&&) noexcept;
  ~DepthRegistration();

  /// Deforms the surface that `source` shows onto that of `target`; `camera` saw both. Throws DataError when
  /// an array is null or has not as many values as the camera has pixels, when the camera or a depth_scale is
  /// no such thing, and when there is too little depth to begin with; DeviceError and NumericalError as they
  /// say.
  DepthRegistrationResult run(const DepthView& source, const DepthView& target, const Camera& camera);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// The same for a single pair. Opening the device and loading its kernels costs more than registering small
/// images: for several pairs keep a DepthRegistration.
DepthRegistrationResult register_depth(const DepthView& source, const DepthView& target, const Camera& camera,
                                       const DepthRegistrationOptions& options = {});

}  // namespace pliant
