#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "framework/imaging/depth_filter.h"
#include "framework/imaging/normals.h"

namespace pliant {

/// How depth becomes a surface before it is tracked [thesis 3.1].
struct Acquisition {
  double depth_cut = 0;  ///< mm: what lies behind it is background; 0: nothing is cut
  std::unique_ptr<DepthFilter> filter;
  std::unique_ptr<Normals> normals;
  /// Points are those of the filtered depth, as the thesis has them, and not of the depth as it was measured.
  /// A filter flattens what bends, in every frame a little to the same side, and poses drift.
  bool filters_points = false;

  /// The farthest depth that is not cut, mm.
  float farthest() const;
};

/// The rows of an experiment file that describe it, and what they say.
std::vector<Parameter> acquisition_rows();
Acquisition make_acquisition(const Parameters& experiment, const Registry& registry);

/// The image without what lies beyond `farthest` mm, 0 there: what a Segmentation looks at.
DepthImage cut_depth(const DepthImage& depth, float farthest);

/// Makes of each frame of a stream what tracking looks at, on one device, in the same window of the image,
/// unless it is moved, and the same buffers from frame to frame: after the third none is made. A frame
/// without depth gives maps full of holes.
class Preprocessor {
 public:
  /// `acquisition` must outlive this. `region`: the window, within the image of the rig's depth camera
  /// (throws std::invalid_argument); without one the whole image.
  Preprocessor(Device& device, const Rig& rig, const Acquisition& acquisition,
               const std::optional<PixelWindow>& region = std::nullopt);

  /// Looks at another window from the next frame on; one of the same size takes no new buffer. Throws
  /// std::invalid_argument where it is not within the image.
  void move_to(const PixelWindow& region);

  /// Uploads the frame's depth and enqueues the rest; `frame` may change at once. Throws DataError, which
  /// names both sizes, when the frame does not fit the rig.
  void process(const Frame& frame);

  /// What the last frame showed: cut, inside its mask, not filtered.
  const DepthMap& depth() const { return depth_; }
  /// Its surface, camera frame: see Acquisition.
  const SurfaceMap& surface() const { return surface_; }

 private:
  Device& device_;
  Rig rig_;
  const Acquisition& acquisition_;
  DepthMap depth_;
  SurfaceMap surface_;
};

}  // namespace pliant
