#include "experiments/view/frame_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "experiments/report/sheet.h"
#include "experiments/view/model_distance.h"

namespace pliant {
namespace {

constexpr int gap = 6;
constexpr int header = 24;
constexpr int line = 28;
const cv::Scalar paper(250, 250, 250);
const cv::Scalar alarm(190, 30, 30);

cv::Size panel_size(const Camera& camera, int width) {
  return {
      width,
      std::max(static_cast<int>(std::lround(static_cast<double>(width) * camera.height / camera.width)), 1)};
}

/// The value that `share` of them stay below; they are not empty.
float quantile(std::vector<float>& values, double share) {
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

/// Where most of the depths lie.
ColorScale depth_scale(std::vector<float>& depths) {
  const float nearest = quantile(depths, 0.02);
  const float farthest = quantile(depths, 0.98);
  const auto step = static_cast<float>(round_up(std::max(farthest - nearest, 10.0F) / 10));
  return {ColorScale::Map::depth, step * std::floor(nearest / step),
          step * (std::floor(farthest / step) + 1)};
}

}  // namespace

std::string describe(const FrameRecord& record) {
  std::string text = fmt::format("frame {}   {}", record.number, to_string(record.state));
  if (!record.reason.empty()) text += ": " + record.reason;
  if (record.state == FrameState::tracked)
    text += fmt::format("   mean error {:.2f} mm   {} of {} points match", record.pose.mean_error,
                        record.pose.inliers, record.pose.samples);
  return text;
}

ColorScale error_scale(std::vector<float> distances) {
  std::erase_if(distances, [](float distance) { return !std::isfinite(distance); });
  const float bulk = distances.empty() ? 0 : quantile(distances, 0.95);
  return {ColorScale::Map::error, 0, static_cast<float>(round_up(std::max(bulk, 1.0F)))};
}

FramePicture::FramePicture(const Rig& rig, int panel_width)
    : panel_(panel_size(rig.depth, panel_width)),
      depth_pixels_(panel_, whole_image(rig.depth)),
      color_pixels_(panel_, whole_image(rig.color.value_or(rig.depth))),
      canvas_(2 * panel_.width + 3 * gap, 2 * (panel_.height + header) + gap + line) {
  canvas().setTo(paper);
  for (const Place place : {color_panel, depth_panel, model_panel, error_panel})
    panel(place).setTo(cv::Scalar(no_color.r, no_color.g, no_color.b));
  draw_header(model_panel, "model", nullptr);
  draw_header(error_panel, "error to model", &error_scale_);
}

const ColorImage& FramePicture::draw(const TrackedFrame& tracked, double frames_per_second) {
  draw_color(tracked);
  draw_depth(tracked.frame.depth);
  if (tracked.model != nullptr) {
    draw_model(tracked);
    draw_error(tracked);
  }
  draw_line(tracked.record, frames_per_second);
  return canvas_;
}

cv::Mat FramePicture::canvas() { return {canvas_.height(), canvas_.width(), CV_8UC3, canvas_.data()}; }

cv::Mat FramePicture::panel(Place place) {
  const cv::Point corner(gap + (place % 2) * (panel_.width + gap),
                         header + (place / 2) * (panel_.height + header));
  return canvas()(cv::Rect(corner, panel_));
}

/// Above a panel: what it shows, and in which colours.
void FramePicture::draw_header(Place place, const std::string& caption, const ColorScale* scale) {
  cv::Mat all = canvas();
  const int left = gap + (place % 2) * (panel_.width + gap);
  const int top = (place / 2) * (panel_.height + header);
  all(cv::Rect(left, top, panel_.width, header)).setTo(paper);
  draw_text(all, caption, {left + 2, top + 17}, 0.45, 4, ink);
  if (scale != nullptr) draw_scale(all, {left + panel_.width - scale_width, top + 7}, *scale);
}

void FramePicture::draw_color(const TrackedFrame& tracked) {
  const bool has_color = !tracked.color.empty();
  if (has_color) paint_color(panel(color_panel), color_pixels_, tracked.color);
  if (!has_color && tracked.seen != nullptr) paint_surface(panel(color_panel), depth_pixels_, *tracked.seen);
  const std::string caption = has_color ? "colour" : "surface";
  if (caption == color_caption_) return;
  color_caption_ = caption;
  draw_header(color_panel, caption, nullptr);
}

void FramePicture::draw_depth(const DepthImage& depth) {
  if (depth_scale_.highest == 0) {
    std::vector<float> depths;
    for (const float z : depth.pixels())
      if (is_depth(z)) depths.push_back(z);
    if (depths.empty()) return;
    depth_scale_ = depth_scale(depths);
    draw_header(depth_panel, "depth", &depth_scale_);
  }
  paint_depth(panel(depth_panel), depth_pixels_, depth, depth_scale_);
}

void FramePicture::draw_model(const TrackedFrame& tracked) {
  paint_surface(panel(model_panel), depth_pixels_, *tracked.model);
}

void FramePicture::draw_error(const TrackedFrame& tracked) {
  const Image<float> distances = model_distances(*tracked.seen, *tracked.model);
  if (!errors_are_known_ && tracked.record.state == FrameState::tracked) {
    errors_are_known_ = true;
    error_scale_ = error_scale(distances.pixels());
    draw_header(error_panel, "error to model", &error_scale_);
  }
  paint_distances(panel(error_panel), depth_pixels_, distances, tracked.model->window, error_scale_);
}

void FramePicture::draw_line(const FrameRecord& record, double frames_per_second) {
  cv::Mat all = canvas();
  const int top = all.rows - line;
  all(cv::Rect(0, top, all.cols, line)).setTo(paper);
  const std::string text = fmt::format("{:.1f} frames/s   {}", frames_per_second, describe(record));
  draw_text(all, text, {gap + 2, top + 19}, 0.45, 4, record.state == FrameState::lost ? alarm : ink);
}

}  // namespace pliant
