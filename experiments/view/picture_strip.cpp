#include "experiments/view/picture_strip.h"

#include "experiments/view/frame_picture.h"

namespace pliant {

bool PictureStrip::show(const TrackedFrame& tracked) {
  if (tracked.model != nullptr && moments_.takes_next()) moments_.keep(moment_of(tracked));
  return true;
}

std::vector<std::uint8_t> PictureStrip::png() const {
  const auto& moments = moments_.kept();
  return draw_moments(moments, error_scale(moments[moments.size() / 2].distances.pixels()), 4);
}

}  // namespace pliant
