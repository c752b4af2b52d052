#include "framework/evaluation/truth.h"

#include <fmt/format.h>

#include "framework/core/error.h"

namespace pliant {

namespace {

template <class T>
void check_size(const Image<T>& image, const char* what, const FramePair& pair) {
  if (image.width() == pair.camera.width && image.height() == pair.camera.height) return;
  throw DataError(fmt::format("{}: the {} is {} x {} pixels; expected the camera's {} x {}", pair.name, what,
                              image.width(), image.height(), pair.camera.width, pair.camera.height));
}

}  // namespace

void check(const PairTruth& truth, const FramePair& pair) {
  check_size(truth.scene_flow, "scene flow", pair);
  if (!truth.optical_flow.empty()) check_size(truth.optical_flow, "optical flow", pair);
  if (!truth.visible.empty()) check_size(truth.visible, "visibility", pair);
}

}  // namespace pliant
