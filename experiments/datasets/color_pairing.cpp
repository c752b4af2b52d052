#include "experiments/datasets/color_pairing.h"

#include <utility>

namespace pliant {

std::optional<Frame> ColorPairing::next() {
  constexpr double farthest = 0.02;  // s
  constexpr double patience = 0.2;   // s
  if (depth_.empty()) return std::nullopt;
  const double time = depth_.front().time;
  while (!color_.empty() && color_.front().time < time - farthest) color_.pop_front();
  if (color_.empty() && !has_ended_ && depth_.back().time < time + patience) return std::nullopt;
  Frame frame = std::move(depth_.front());
  depth_.pop_front();
  if (!color_.empty() && color_.front().time <= time + farthest) {
    frame.color = std::move(color_.front().image);
    color_.pop_front();
  }
  return frame;
}

}  // namespace pliant
