#include "experiments/view/moment.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "experiments/report/sheet.h"
#include "experiments/view/model_distance.h"
#include "experiments/view/panel.h"

namespace pliant {
namespace {

constexpr int panel_width = 150;
constexpr int most_panel_height = 220;
constexpr int pair_gap = 4;
constexpr int margin = 14;
constexpr int caption_height = 22;
const cv::Scalar white(255, 255, 255);

cv::Size panel_size(const PixelWindow& window) {
  return {panel_width,
          std::clamp(panel_width * window.height / std::max(window.width, 1), 1, most_panel_height)};
}

/// As the thesis measures it, where that is asked for; else as rigid tracking does.
double error_of(const FrameRecord& record) {
  return record.error.matched > 0 ? record.error.mean : record.pose.mean_error;
}

std::string caption_of(const FrameRecord& record) {
  const std::string frame = fmt::format("frame {}: ", record.number);
  return frame + (record.state == FrameState::tracked ? fmt::format("error {:.2f} mm", error_of(record))
                                                      : to_string(record.state));
}

/// Caption, model and distances of a moment.
cv::Mat draw(const Moment& moment, const ColorScale& scale) {
  const cv::Size size = moment.model.size();
  cv::Mat pair(caption_height + size.height, 2 * size.width + pair_gap, CV_8UC3, white);
  draw_text(pair, moment.caption, {0, caption_height - 8}, 0.4, 4, ink);
  moment.model.copyTo(pair(cv::Rect({0, caption_height}, size)));
  const PixelWindow window{0, 0, moment.distances.width(), moment.distances.height()};
  paint_distances(pair(cv::Rect({size.width + pair_gap, caption_height}, size)), PanelPixels(size, window),
                  moment.distances, window, scale);
  return pair;
}

}  // namespace

Moment moment_of(const TrackedFrame& tracked) {
  const cv::Size size = panel_size(tracked.model->window);
  cv::Mat model(size, CV_8UC3);
  paint_surface(model, PanelPixels(size, tracked.model->window), *tracked.model);
  return {caption_of(tracked.record), model, model_distances(*tracked.seen, *tracked.model)};
}

std::vector<std::uint8_t> draw_moments(const std::vector<Moment>& moments, const ColorScale& scale,
                                       int a_row) {
  const int count = static_cast<int>(moments.size());
  const cv::Size cell(2 * panel_width + pair_gap + margin, moments[0].model.rows + caption_height + margin);
  const int rows = (count + a_row - 1) / a_row;
  cv::Mat canvas(rows * cell.height + caption_height + 2 * margin,
                 std::min(count, a_row) * cell.width + margin, CV_8UC3, white);
  draw_scale(canvas, {0, margin}, scale);
  for (int i = 0; i < count; ++i) {
    const cv::Mat pair = draw(moments[static_cast<std::size_t>(i)], scale);
    const cv::Point corner(margin + i % a_row * cell.width,
                           margin + caption_height + i / a_row * cell.height);
    pair.copyTo(canvas(cv::Rect(corner, pair.size())));
  }
  cv::cvtColor(canvas, canvas, cv::COLOR_RGB2BGR);
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", canvas, bytes);
  return bytes;
}

}  // namespace pliant
