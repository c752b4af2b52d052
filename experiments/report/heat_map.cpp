#include "experiments/report/heat_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "experiments/report/sheet.h"

namespace pliant {
namespace {

constexpr int bar_width = 22;

cv::Vec3b bgr(const Rgb& color) { return {color.b, color.g, color.r}; }

cv::Mat colorize(const Image<float>& values, const ColorScale& scale) {
  const auto colors = colors_of(scale.map);
  cv::Mat picture(values.height(), values.width(), CV_8UC3, cv::Scalar(bgr(no_color)));
  for (int v = 0; v < values.height(); ++v) {
    for (int u = 0; u < values.width(); ++u) {
      if (!std::isfinite(values(u, v))) continue;
      picture.at<cv::Vec3b>(v, u) = bgr(colors[color_index(scale, values(u, v))]);
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
  std::string number = fmt::format("{:.6g}", tick);
  if (above && tick > scale.highest - near) return "> " + number;
  if (below && tick < scale.lowest + near) return "< " + number;
  return number;
}

void draw_bar(cv::Mat& canvas, const cv::Rect& legend, const ColorScale& scale, const Image<float>& values) {
  const cv::Rect place(legend.x, legend.y, bar_width, legend.height);
  const auto colors = colors_of(scale.map);
  for (int row = 0; row < place.height; ++row) {
    const auto index = static_cast<std::size_t>(255 - row * 255 / (place.height - 1));
    canvas(cv::Rect(place.x, place.y + row, place.width, 1)).setTo(cv::Scalar(bgr(colors[index])));
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

std::array<Rgb, 256> colors_of(ColorScale::Map map) {
  cv::Mat ramp(256, 1, CV_8U);
  for (int i = 0; i < 256; ++i) ramp.at<std::uint8_t>(i) = static_cast<std::uint8_t>(i);
  cv::Mat mapped;
  cv::applyColorMap(ramp, mapped,
                    map == ColorScale::Map::depth ? cv::COLORMAP_VIRIDIS : cv::COLORMAP_INFERNO);
  std::array<Rgb, 256> colors;
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const auto color = mapped.at<cv::Vec3b>(static_cast<int>(i));
    colors[i] = {color[2], color[1], color[0]};
  }
  return colors;
}

double round_up(double value) {
  const double decade = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0}) {
    if (step * decade >= value * (1 - 1e-9)) return step * decade;
  }
  return 10 * decade;
}

std::vector<std::uint8_t> draw_heat_map(const Image<float>& values, const ColorScale& scale,
                                        const std::string& title, const std::string& subtitle) {
  Sheet sheet(colorize(values, scale), title, subtitle);
  draw_bar(sheet.canvas(), sheet.legend(), scale, values);
  return sheet.png();
}

}  // namespace pliant
