#include "framework/tracking/followed_window.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

Eigen::Vector2d middle_of(const PixelWindow& window) {
  return {window.left + window.width / 2.0, window.top + window.height / 2.0};
}

/// So many pixels, or, where these are not enough, an eighth more than enough.
int grown(int pixels, double needed, int most) {
  if (needed <= pixels) return pixels;
  return std::min(static_cast<int>(std::ceil(needed * 9 / 8)), most);
}

/// The first pixel of `size` ones around a middle, all of them inside of the image.
int first_pixel(double middle, int size, int image) {
  return std::clamp(static_cast<int>(std::lround(middle - size / 2.0)), 0, image - size);
}

}  // namespace

FollowedWindow::FollowedWindow(const Camera& camera, const PixelWindow& window, double depth,
                               const Eigen::Isometry3d& camera_from_model)
    : camera_(camera),
      window_(window),
      size_(window.width * depth / camera.fx, window.height * depth / camera.fy) {
  const Eigen::Vector2d pixel = middle_of(window);
  middle_ = camera_from_model.inverse() * camera.unproject(pixel.x(), pixel.y(), depth);
}

const PixelWindow& FollowedWindow::move_to(const Eigen::Isometry3d& camera_from_model) {
  const Eigen::Vector3d middle = camera_from_model * middle_;
  constexpr double nearest = 50;  // mm
  if (middle.z() > nearest)
    cover(camera_.project(middle), size_.x() * camera_.fx / middle.z(), size_.y() * camera_.fy / middle.z());
  return window_;
}

const PixelWindow& FollowedWindow::move_to(const PixelWindow& found) {
  cover(middle_of(found), found.width, found.height);
  return window_;
}

void FollowedWindow::cover(const Eigen::Vector2d& middle, double width, double height) {
  window_.width = grown(window_.width, width, camera_.width);
  window_.height = grown(window_.height, height, camera_.height);
  window_.left = first_pixel(middle.x(), window_.width, camera_.width);
  window_.top = first_pixel(middle.y(), window_.height, camera_.height);
}

}  // namespace pliant
