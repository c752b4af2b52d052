#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pliant {

/// A row-major image; pixel (u, v) is column u of row v, the pixel's centre at integer coordinates.
template <class T>
class Image {
 public:
  Image() = default;
  /// Zeros; uninitialised where T() is, as vectors of Eigen are.
  Image(int width, int height)
      : width_(width), height_(height), pixels_(static_cast<std::size_t>(width) * height) {}
  Image(int width, int height, T value)
      : width_(width), height_(height), pixels_(static_cast<std::size_t>(width) * height, value) {}

  int width() const { return width_; }
  int height() const { return height_; }
  bool empty() const { return pixels_.empty(); }
  std::size_t size() const { return pixels_.size(); }
  bool contains(int u, int v) const { return u >= 0 && v >= 0 && u < width_ && v < height_; }

  T& operator()(int u, int v) { return pixels_[static_cast<std::size_t>(v) * width_ + u]; }
  const T& operator()(int u, int v) const { return pixels_[static_cast<std::size_t>(v) * width_ + u]; }
  T* data() { return pixels_.data(); }
  const T* data() const { return pixels_.data(); }
  const std::vector<T>& pixels() const { return pixels_; }

 private:
  int width_ = 0;
  int height_ = 0;
  std::vector<T> pixels_;
};

struct Rgb {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;
  bool operator==(const Rgb&) const = default;
};

using DepthImage = Image<float>;        ///< millimetres along the optical axis; see is_depth
using ColorImage = Image<Rgb>;          ///< aligned with the depth image
using MaskImage = Image<std::uint8_t>;  ///< non-zero on the object

/// Further than any camera sees, and near enough that squares of distances are finite.
inline constexpr float farthest_depth = 1e18F;

/// Whether a pixel of a depth image saw something: all other values (0, negative, NaN, infinite) are holes.
inline bool is_depth(float depth) { return depth > 0 && depth < farthest_depth; }

}  // namespace pliant
