#include "framework/geometry/frame.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "framework/core/error.h"

namespace pliant {
namespace {

void check_camera(const FramePair& pair) {
  const Camera& camera = pair.camera;
  if (!std::isfinite(camera.fx) || !std::isfinite(camera.fy) || camera.fx <= 0 || camera.fy <= 0)
    throw DataError(
        fmt::format("{}: the camera's focal lengths are {} and {} pixels; expected finite positive numbers",
                    pair.name, camera.fx, camera.fy));
  if (!std::isfinite(camera.cx) || !std::isfinite(camera.cy))
    throw DataError(fmt::format("{}: the camera's principal point is ({}, {}); expected finite numbers",
                                pair.name, camera.cx, camera.cy));
}

template <class T>
void check_size(const FramePair& pair, const std::string& what, const Image<T>& image) {
  if (image.width() == pair.camera.width && image.height() == pair.camera.height) return;
  throw DataError(fmt::format("{}: {} is {} x {} pixels; expected the camera's {} x {}", pair.name, what,
                              image.width(), image.height(), pair.camera.width, pair.camera.height));
}

void check_frame(const FramePair& pair, const std::string& whose, const RgbdFrame& frame) {
  if (frame.depth.empty()) throw DataError(fmt::format("{}: {} depth image is empty", pair.name, whose));
  check_size(pair, whose + " depth image", frame.depth);
  if (!frame.color.empty()) check_size(pair, whose + " colour image", frame.color);
  if (!frame.mask.empty()) check_size(pair, whose + " mask", frame.mask);
}

}  // namespace

void check_source(const FramePair& pair) {
  check_camera(pair);
  check_frame(pair, "the source's", pair.source);
  if (!pair.scene_flow.empty()) check_size(pair, "the scene flow", pair.scene_flow);
}

void check(const FramePair& pair) {
  check_source(pair);
  check_frame(pair, "the target's", pair.target);
}

}  // namespace pliant
