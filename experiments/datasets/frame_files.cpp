#include "experiments/datasets/frame_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "framework/core/error.h"
#include "framework/geometry/has_point.h"
#include "framework/io/images.h"
#include "framework/io/scene_flow.h"

namespace pliant {
namespace {

void scale(DepthImage& depth, double factor) {
  std::transform(depth.data(), depth.data() + depth.size(), depth.data(),
                 [factor](float value) { return static_cast<float>(value * factor); });
}

void drop_farther(DepthImage& depth, double limit) {
  std::replace_if(
      depth.data(), depth.data() + depth.size(), [limit](float value) { return value > limit; }, 0.0f);
}

}  // namespace

Frame read_frame(const FrameFiles& files, const DepthUnits& units, bool color_has_own_camera) {
  Frame frame;
  frame.depth = read_depth(files.depth);
  scale(frame.depth, units.scale);
  if (!files.color.empty()) {
    frame.color = read_color(files.color);
    if (!color_has_own_camera) check_size(frame.color, files.color, frame.depth, depth_named(files.depth));
  }
  if (!files.mask.empty()) {
    frame.mask = read_mask(files.mask);
    check_size(frame.mask, files.mask, frame.depth, depth_named(files.depth));
  }
  if (units.max_depth) drop_farther(frame.depth, *units.max_depth);
  return frame;
}

void check_sees_something(const Frame& frame, const FrameFiles& files, const DepthUnits& units) {
  if (sees_something(frame)) return;
  const auto is_object = [](std::uint8_t value) { return value != 0; };
  if (!frame.mask.empty() && std::none_of(frame.mask.pixels().begin(), frame.mask.pixels().end(), is_object))
    throw DataError(fmt::format("{}: the mask is empty", files.mask));
  throw DataError(fmt::format("{}: no valid depth{}{}", files.depth,
                              units.max_depth ? fmt::format(" up to {} mm", *units.max_depth) : "",
                              frame.mask.empty() ? "" : " inside the mask " + files.mask));
}

PairTruth read_truth(const TruthFiles& files, const Frame& source, const std::string& depth) {
  PairTruth truth{read_scene_flow(files.scene_flow)};
  check_size(truth.scene_flow, files.scene_flow, source.depth, depth_named(depth));
  if (!files.optical_flow.empty()) {
    truth.optical_flow = read_optical_flow(files.optical_flow);
    check_size(truth.optical_flow, files.optical_flow, source.depth, depth_named(depth));
  }
  if (!files.visible.empty()) {
    truth.visible = read_mask(files.visible);
    check_size(truth.visible, files.visible, source.depth, depth_named(depth));
  }
  for (std::size_t i = 0; i < truth.scene_flow.size(); ++i) {
    if (has_point(source, i) && truth.scene_flow.pixels()[i].allFinite()) return truth;
  }
  // It belongs to another image.
  throw DataError(fmt::format("{}: no ground truth on any point of the source", files.scene_flow));
}

std::string depth_named(const std::string& path) { return "the depth image " + path; }

void refuse_size(const std::string& path, int width, int height, const std::string& which, int other_width,
                 int other_height) {
  throw DataError(fmt::format("{}: {}x{} pixels, but {} has {}x{}", path, width, height, which, other_width,
                              other_height));
}

void add(std::vector<std::string> more, std::vector<std::string>& warnings) {
  std::move(more.begin(), more.end(), std::back_inserter(warnings));
}

}  // namespace pliant
