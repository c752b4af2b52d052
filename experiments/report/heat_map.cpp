#include "experiments/report/heat_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace pliant {
namespace {

constexpr int margin = 20;
constexpr int header = 72;
constexpr int bar_width = 22;
constexpr int label_width = 78;
constexpr int least_width = 480;
const cv::Scalar paper(255, 255, 255);
const cv::Scalar ink(40, 34, 30);
const cv::Scalar quiet_ink(105, 96, 90);
const cv::Scalar nothing(236, 233, 231);

void blend(cv::Vec3b& pixel, const cv::Scalar& color, double part) {
  for (int i = 0; i < 3; ++i)
    pixel[i] = cv::saturate_cast<std::uint8_t>(pixel[i] + part * (color[i] - pixel[i]));
}

/// OpenCV's stroke fonts are ragged at small sizes, so text is drawn large and averaged down.
void draw_text(cv::Mat& canvas, const std::string& text, cv::Point baseline, double size, int stroke,
               const cv::Scalar& color) {
  constexpr int enlarged = 4;
  int below = 0;
  const cv::Size extent = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, size, 2, &below);
  below += 4;
  const cv::Rect whole(baseline.x, baseline.y - extent.height - 4, extent.width + 8,
                       extent.height + 4 + below);
  const cv::Rect place = whole & cv::Rect({0, 0}, canvas.size());
  cv::Mat coverage(place.height * enlarged, place.width * enlarged, CV_8U, cv::Scalar(0));
  cv::putText(coverage, text, (baseline - place.tl()) * enlarged, cv::FONT_HERSHEY_SIMPLEX, size * enlarged,
              255, stroke, cv::LINE_AA);
  cv::resize(coverage, coverage, place.size(), 0, 0, cv::INTER_AREA);
  for (int v = 0; v < place.height; ++v) {
    for (int u = 0; u < place.width; ++u) {
      blend(canvas.at<cv::Vec3b>(place.y + v, place.x + u), color, coverage.at<std::uint8_t>(v, u) / 255.0);
    }
  }
}

/// The 256 colours of a perceptually uniform map, lowest first.
cv::Mat palette(ColorScale::Map map) {
  cv::Mat ramp(256, 1, CV_8U);
  for (int i = 0; i < 256; ++i) ramp.at<std::uint8_t>(i) = static_cast<std::uint8_t>(i);
  cv::Mat colors;
  cv::applyColorMap(ramp, colors,
                    map == ColorScale::Map::depth ? cv::COLORMAP_VIRIDIS : cv::COLORMAP_INFERNO);
  return colors;
}

cv::Mat colorize(const Image<float>& values, const ColorScale& scale) {
  const cv::Mat colors = palette(scale.map);
  cv::Mat picture(values.height(), values.width(), CV_8UC3, nothing);
  for (int v = 0; v < values.height(); ++v) {
    for (int u = 0; u < values.width(); ++u) {
      if (!std::isfinite(values(u, v))) continue;
      const float part = (values(u, v) - scale.lowest) / (scale.highest - scale.lowest);
      const int index = static_cast<int>(std::lround(255 * std::clamp(part, 0.0f, 1.0f)));
      picture.at<cv::Vec3b>(v, u) = colors.at<cv::Vec3b>(index);
    }
  }
  return picture;
}

std::vector<double> ticks(const ColorScale& scale) {
  const double step = round_up((scale.highest - scale.lowest) / 6.0);
  std::vector<double> at;
  for (double k = std::ceil(scale.lowest / step - 1e-6); k * step <= scale.highest + 1e-6 * step; ++k) {
    at.push_back(k * step + 0.0);  // no "-0"
  }
  return at;
}

/// "> 25" at an end of the bar that also stands for what lies beyond it.
std::string label(double tick, const ColorScale& scale, const Image<float>& values) {
  const double near = 1e-3 * (scale.highest - scale.lowest);
  const auto& all = values.pixels();
  const bool above = std::any_of(all.begin(), all.end(), [&](float value) { return value > scale.highest; });
  const bool below = std::any_of(all.begin(), all.end(), [&](float value) { return value < scale.lowest; });
  const std::string number = fmt::format("{:.6g}", tick);
  if (above && tick > scale.highest - near) return "> " + number;
  if (below && tick < scale.lowest + near) return "< " + number;
  return number;
}

void draw_bar(cv::Mat& canvas, const cv::Rect& place, const ColorScale& scale, const Image<float>& values) {
  const cv::Mat colors = palette(scale.map);
  for (int row = 0; row < place.height; ++row) {
    const int index = 255 - row * 255 / (place.height - 1);
    canvas(cv::Rect(place.x, place.y + row, place.width, 1)).setTo(cv::Scalar(colors.at<cv::Vec3b>(index)));
  }
  for (const double tick : ticks(scale)) {
    const double part = (tick - scale.lowest) / (scale.highest - scale.lowest);
    const int y = place.y + static_cast<int>(std::lround((1 - part) * (place.height - 1)));
    cv::line(canvas, {place.br().x, y}, {place.br().x + 5, y}, ink);
    draw_text(canvas, label(tick, scale, values), {place.br().x + 10, y + 5}, 0.45, 4, ink);
  }
  draw_text(canvas, "mm", {place.x, place.y - 10}, 0.45, 4, quiet_ink);
}

}  // namespace

double round_up(double value) {
  const double decade = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0}) {
    if (step * decade >= value * (1 - 1e-9)) return step * decade;
  }
  return 10 * decade;
}

std::vector<std::uint8_t> draw_heat_map(const Image<float>& values, const ColorScale& scale,
                                        const std::string& title, const std::string& subtitle) {
  cv::Mat picture = colorize(values, scale);
  const int enlarged = std::max(1, (least_width + picture.cols - 1) / picture.cols);
  cv::resize(picture, picture, {}, enlarged, enlarged, cv::INTER_NEAREST);
  cv::Mat canvas(header + picture.rows + margin, margin + picture.cols + margin + bar_width + label_width,
                 CV_8UC3, paper);
  picture.copyTo(canvas(cv::Rect(margin, header, picture.cols, picture.rows)));
  draw_bar(canvas, cv::Rect(margin + picture.cols + margin, header, bar_width, picture.rows), scale, values);
  draw_text(canvas, title, {margin, 31}, 0.65, 6, ink);
  draw_text(canvas, subtitle, {margin, 56}, 0.48, 4, quiet_ink);
  std::vector<std::uint8_t> png;
  cv::imencode(".png", canvas, png);
  return png;
}

}  // namespace pliant
