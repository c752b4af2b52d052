#include "framework/geometry/pixel_index.h"

namespace pliant {

PixelIndex index_pixels(const Surface& surface) {
  if (surface.size() == 0) return {};
  Eigen::Vector2i lowest = surface.pixels.front();
  Eigen::Vector2i highest = lowest;
  for (const Eigen::Vector2i& pixel : surface.pixels) {
    lowest = lowest.cwiseMin(pixel);
    highest = highest.cwiseMax(pixel);
  }
  const Eigen::Vector2i size = highest - lowest + Eigen::Vector2i::Ones();
  PixelIndex index{lowest.x(), lowest.y(), Image<int>(size.x(), size.y(), -1)};
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const Eigen::Vector2i place = surface.pixels[i] - lowest;
    index.points(place.x(), place.y()) = static_cast<int>(i);
  }
  return index;
}

}  // namespace pliant
