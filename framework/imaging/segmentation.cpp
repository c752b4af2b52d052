#include "framework/imaging/segmentation.h"

#include <stdexcept>
#include <utility>

namespace pliant {
namespace {

/// Throws std::invalid_argument when a region is not of a depth image.
void check(const Region& region, const DepthImage& depth) {
  const PixelWindow& window = region.window;
  if (window.left < 0 || window.top < 0 || window.left + window.width > depth.width() ||
      window.top + window.height > depth.height())
    throw std::invalid_argument("the region reaches beyond the depth image");
  if (!region.mask.empty() &&
      (region.mask.width() != depth.width() || region.mask.height() != depth.height()))
    throw std::invalid_argument("the region's mask and depth differ in size");
}

bool is_on(const MaskImage& mask, int u, int v) { return mask.empty() || mask(u, v) != 0; }

}  // namespace

void cut_to(const Region& region, Frame& frame) {
  check(region, frame.depth);
  const PixelWindow& window = region.window;
  MaskImage kept(frame.depth.width(), frame.depth.height());
  for (int v = window.top; v < window.top + window.height; ++v)
    for (int u = window.left; u < window.left + window.width; ++u)
      kept(u, v) = is_on(region.mask, u, v) && is_on(frame.mask, u, v) ? 1 : 0;
  frame.mask = std::move(kept);
}

}  // namespace pliant
