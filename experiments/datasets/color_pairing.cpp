#include "experiments/datasets/color_pairing.h"

#include <utility>

namespace pliant {

namespace {

constexpr double farthest_color = 0.02;  // s
constexpr double color_patience = 0.2;   // s

}  // namespace

/// Colour that no depth has come to for so long is dropped: a sensor that is silent must not fill the memory.
void ColorPairing::add_color(ColorImage image, double time) {
  while (depth_.empty() && !color_.empty() && color_.front().time < time - color_patience) color_.pop_front();
  color_.push_back({std::move(image), time});
}

std::optional<Frame> ColorPairing::next() {
  if (depth_.empty()) return std::nullopt;
  const double time = depth_.front().time;
  while (!color_.empty() && color_.front().time < time - farthest_color) color_.pop_front();
  if (color_.empty() && !has_ended_ && depth_.back().time < time + color_patience) return std::nullopt;
  Frame frame = std::move(depth_.front());
  depth_.pop_front();
  if (!color_.empty() && color_.front().time <= time + farthest_color) {
    frame.color = std::move(color_.front().image);
    color_.pop_front();
  }
  return frame;
}

}  // namespace pliant
