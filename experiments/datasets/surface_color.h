#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "experiments/modeller/figure.h"
#include "framework/geometry/image.h"
#include "framework/geometry/mesh_renderer.h"

namespace pliant {

/// A seeded colour for every point of a material, by its coordinates at rest (mm): smooth random noise of
/// several scales between the corners of grids, the same wherever the material goes. The coloured pixels of
/// an image are made on the device; the plain C++ beside it is the reference.
class SurfaceColor {
 public:
  enum class Kind {
    rich,  ///< strong and independent in all channels: features everywhere
    skin,  ///< one tone of low contrast with a few freckles: hardly any
  };

  SurfaceColor(Kind kind, std::uint64_t seed, std::vector<ColorPatch> patches = {});

  /// Colours what a view shows, r g b in turn; `rest` are the points' coordinates at rest, x y z a pixel.
  /// Black where nothing is seen.
  Array<cl_uchar> paint(Device& device, const MeshView& view, const Array<float>& rest) const;

  /// The colour of one point. The device differs by rounding: by 1 of 255 at most.
  Rgb color_of(const Eigen::Vector3f& rest) const;

 private:
  static constexpr std::size_t scales = 3;
  struct Noise {
    float spacing;    ///< mm between the corners of its grid
    float amplitude;  ///< of 255, from the middle either way
    std::uint32_t key;
  };

  void paint_patches(Device& device, const MeshView& view, const Array<float>& rest,
                     Array<cl_uchar>& colors) const;

  std::array<Noise, scales> noises_;
  Noise freckles_;
  Eigen::Vector3f base_;  ///< r g b of the middle, of 255
  bool is_toned_;         ///< noise makes all channels brighter alike
  std::vector<ColorPatch> patches_;
};

/// Colours from the device, which this waits for.
ColorImage read_colors(const Array<cl_uchar>& colors, const Camera& camera);

}  // namespace pliant
