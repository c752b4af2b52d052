#include "framework/geometry/frame.h"

#include <fmt/format.h>

#include "framework/core/error.h"

namespace pliant {
namespace {

template <class T>
void check_size(const Image<T>& image, const Camera& camera, const std::string& what, const char* whose) {
  if (image.width() == camera.width && image.height() == camera.height) return;
  throw DataError(fmt::format("{} is {} x {} pixels; expected {} {} x {}", what, image.width(),
                              image.height(), whose, camera.width, camera.height));
}

}  // namespace

void check(const Frame& frame, const Rig& rig, const std::string& whose) {
  if (frame.depth.empty()) throw DataError(whose + " depth image is empty");
  check_size(frame.depth, rig.depth, whose + " depth image", "the camera's");
  if (!frame.mask.empty()) check_size(frame.mask, rig.depth, whose + " mask", "the camera's");
  if (!frame.color.empty())
    check_size(frame.color, rig.color.value_or(rig.depth), whose + " colour image",
               rig.color ? "the colour camera's" : "the camera's");
}

void check_source(const FramePair& pair) {
  const Rig rig{pair.camera};
  check(rig, pair.name);
  check(pair.source, rig, pair.name + ": the source's");
}

void check(const FramePair& pair) {
  check_source(pair);
  check(pair.target, Rig{pair.camera}, pair.name + ": the target's");
}

}  // namespace pliant
