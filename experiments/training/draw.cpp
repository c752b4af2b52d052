#include "experiments/training/draw.h"

#include <cmath>
#include <numbers>

namespace pliant {

Draw::Draw(std::uint64_t seed, std::uint64_t stream)
    : generator_(seed * 0x9e3779b97f4a7c15U + (stream + 1) * 0xd1342543de82ef95U) {}

double Draw::uniform(double lowest, double highest) {
  // The upper 53 bits: all that a double holds.
  return lowest + (highest - lowest) * (static_cast<double>(generator_() >> 11) * 0x1p-53);
}

double Draw::normal() {
  const double radius = std::sqrt(-2 * std::log(1 - uniform(0, 1)));
  return radius * std::cos(2 * std::numbers::pi * uniform(0, 1));
}

std::size_t Draw::index(std::size_t count) {
  return static_cast<std::size_t>(uniform(0, static_cast<double>(count)));
}

}  // namespace pliant
