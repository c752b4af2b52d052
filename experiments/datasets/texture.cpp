#include "experiments/datasets/texture.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace pliant {
namespace {

using Cell = std::array<std::int64_t, 3>;

/// A fixed random number in [0, 1) for each corner of a grid (the mixing steps of splitmix64).
double corner_value(const Cell& corner, std::uint64_t layer) {
  std::uint64_t bits = static_cast<std::uint64_t>(corner[0]) * 0x9e3779b97f4a7c15u +
                       static_cast<std::uint64_t>(corner[1]) * 0xc2b2ae3d27d4eb4fu +
                       static_cast<std::uint64_t>(corner[2]) * 0xd6e8feb86659fd93u +
                       layer * 0x165667b19e3779f9u;
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
  bits ^= bits >> 31;
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

/// Interpolates between the two halves of a cell's corners, axis by axis from the last one.
double blend(Cell corner, std::size_t axis, const Eigen::Array3d& share, std::uint64_t layer) {
  if (axis == 3) return corner_value(corner, layer);
  const double before = blend(corner, axis + 1, share, layer);
  ++corner[axis];
  return std::lerp(before, blend(corner, axis + 1, share, layer), share[static_cast<Eigen::Index>(axis)]);
}

/// Value noise: smooth between the corners of a grid of `spacing` mm.
double value_noise(const Eigen::Vector3d& point, double spacing, std::uint64_t layer) {
  const Eigen::Array3d scaled = point.array() / spacing;
  const Eigen::Array3d corner = scaled.floor();
  const Eigen::Array3d inside = scaled - corner;
  const Eigen::Array3d share = inside * inside * (3 - 2 * inside);
  const Cell cell = {static_cast<std::int64_t>(corner.x()), static_cast<std::int64_t>(corner.y()),
                     static_cast<std::int64_t>(corner.z())};
  return blend(cell, 0, share, layer);
}

std::uint8_t channel_value(const Eigen::Vector3d& point, std::uint64_t channel) {
  constexpr std::array<double, 3> kSpacings = {40, 16, 7};  // mm; the finest is several pixels wide
  double sum = 0;
  for (std::size_t i = 0; i < kSpacings.size(); ++i) {
    sum += value_noise(point, kSpacings[i], 3 * i + channel);
  }
  return static_cast<std::uint8_t>(std::lround(sum / kSpacings.size() * 255));
}

}  // namespace

Rgb texture_color(const Eigen::Vector3d& point) {
  return {channel_value(point, 0), channel_value(point, 1), channel_value(point, 2)};
}

}  // namespace pliant
