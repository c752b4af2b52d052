#include "experiments/api/depth_pair.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/datasets/depth_doubts.h"
#include "framework/core/error.h"

namespace pliant {
namespace {

/// Reads one view; errors begin with whose it is, as in "the source's".
class ViewReader {
 public:
  ViewReader(const Camera& camera, std::string whose) : camera_(camera), whose_(std::move(whose)) {}

  Frame frame(const DepthView& view) const {
    if (!std::isfinite(view.depth_scale) || view.depth_scale <= 0)
      throw DataError(fmt::format("{} depth_scale is {}; expected a finite positive number of mm a unit",
                                  whose_, view.depth_scale));
    Frame frame;
    frame.depth =
        std::visit([&](const auto& depth) { return depth_image(depth, view.depth_scale); }, view.depth);
    if (!view.rgb.empty()) frame.color = color_image(view.rgb);
    if (!view.mask.empty()) frame.mask = mask_image(view.mask);
    return frame;
  }

 private:
  template <class Value>
  void check_array(std::span<const Value> values, const char* what, int channels) const {
    const std::size_t expected = static_cast<std::size_t>(camera_.width) * camera_.height * channels;
    const std::string size =
        fmt::format("{} x {}{}", camera_.width, camera_.height, channels == 3 ? " x 3" : "");
    if (values.data() == nullptr)
      throw DataError(fmt::format("{} {} is null; expected an array of {} values", whose_, what, size));
    if (values.size() != expected)
      throw DataError(
          fmt::format("{} {} has {} values; expected {} = {}", whose_, what, values.size(), size, expected));
  }

  template <class Value>
  DepthImage depth_image(std::span<const Value> values, double scale) const {
    check_array(values, "depth", 1);
    DepthImage image(camera_.width, camera_.height);
    std::transform(values.begin(), values.end(), image.data(),
                   [&](Value value) { return static_cast<float>(value * scale); });
    return image;
  }

  ColorImage color_image(std::span<const std::uint8_t> values) const {
    check_array(values, "rgb", 3);
    ColorImage image(camera_.width, camera_.height);
    for (std::size_t i = 0; i < image.size(); ++i)
      image.data()[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
    return image;
  }

  MaskImage mask_image(std::span<const std::uint8_t> values) const {
    check_array(values, "mask", 1);
    MaskImage image(camera_.width, camera_.height);
    std::copy(values.begin(), values.end(), image.data());
    return image;
  }

  const Camera& camera_;
  std::string whose_;
};

}  // namespace

FramePair make_depth_pair(const DepthView& source, const DepthView& target, const Camera& camera) {
  if (camera.width < 1 || camera.height < 1)
    throw DataError(
        fmt::format("the camera has {} x {} pixels; expected at least 1 x 1", camera.width, camera.height));
  FramePair pair{"depth images", camera, ViewReader(camera, "the source's").frame(source),
                 ViewReader(camera, "the target's").frame(target)};
  const auto warn = [&](const Frame& frame, double scale, const char* whose) {
    for (auto& doubt : doubts_about_depth(frame, scale, whose)) pair.warnings.push_back(std::move(doubt));
  };
  warn(pair.source, source.depth_scale, "the source");
  warn(pair.target, target.depth_scale, "the target");
  return pair;
}

}  // namespace pliant
