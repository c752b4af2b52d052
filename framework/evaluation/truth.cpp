#include "framework/evaluation/truth.h"

#include <fmt/format.h>

#include "framework/core/error.h"

namespace pliant {

void check(const PairTruth& truth, const FramePair& pair) {
  const auto& flow = truth.scene_flow;
  if (flow.width() == pair.camera.width && flow.height() == pair.camera.height) return;
  throw DataError(fmt::format("{}: the scene flow is {} x {} pixels; expected the camera's {} x {}",
                              pair.name, flow.width(), flow.height(), pair.camera.width, pair.camera.height));
}

}  // namespace pliant
