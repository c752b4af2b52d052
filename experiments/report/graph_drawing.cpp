#include "experiments/report/graph_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <set>
#include <utility>

#include "experiments/report/sheet.h"

namespace pliant {
namespace {

constexpr int air = 4;  // pixels
constexpr int deepest_grey = 130;
constexpr int nearest_grey = 235;
const cv::Scalar nothing(255, 255, 255);

/// Neighbouring levels differ in hue and in lightness.
cv::Scalar level_color(int level) {
  static const std::array<cv::Scalar, 6> colors{
      {{180, 119, 31}, {14, 127, 255}, {60, 140, 30}, {189, 70, 200}, {40, 39, 214}, {150, 150, 0}}};
  return colors[static_cast<std::size_t>(level - 1) % colors.size()];
}

/// The square around the pixels that have depth, and a little air.
cv::Rect frame_object(const Image<float>& depth) {
  cv::Rect object;
  for (int v = 0; v < depth.height(); ++v)
    for (int u = 0; u < depth.width(); ++u)
      if (std::isfinite(depth(u, v))) object |= cv::Rect(u, v, 1, 1);
  const int side = std::max(object.width, object.height) + 2 * air;
  const cv::Point centre = (object.tl() + object.br()) / 2;
  return {centre - cv::Point(side, side) / 2, cv::Size(side, side)};
}

/// The values that all but a twentieth at either end lie between: the rim of a mask often bleeds onto the
/// background.
std::pair<float, float> bulk(const Image<float>& depth) {
  std::vector<float> values;
  for (const float value : depth.pixels())
    if (std::isfinite(value)) values.push_back(value);
  if (values.empty()) return {0.0F, 0.0F};
  std::sort(values.begin(), values.end());
  return {values[values.size() / 20], values[values.size() - 1 - values.size() / 20]};
}

/// Depth in pale greys, near ones light, that leave the colours to the graph.
cv::Mat draw_depth(const Image<float>& depth, const cv::Rect& frame) {
  const auto [nearest, deepest] = bulk(depth);
  cv::Mat picture(frame.size(), CV_8UC3, nothing);
  for (int v = 0; v < frame.height; ++v)
    for (int u = 0; u < frame.width; ++u) {
      const cv::Point pixel = frame.tl() + cv::Point(u, v);
      if (!depth.contains(pixel.x, pixel.y) || !std::isfinite(depth(pixel.x, pixel.y))) continue;
      const float part = (deepest - depth(pixel.x, pixel.y)) / std::max(deepest - nearest, 1.0F);
      const float grey = deepest_grey + std::clamp(part, 0.0F, 1.0F) * (nearest_grey - deepest_grey);
      picture.at<cv::Vec3b>(v, u) = cv::Vec3b::all(cv::saturate_cast<std::uint8_t>(grey));
    }
  return picture;
}

void draw_cell(cv::Mat& picture, const cv::Rect& box, int level, bool is_virtual) {
  const cv::Rect inside = box & cv::Rect({0, 0}, picture.size());
  if (inside.empty()) return;
  cv::Mat region = picture(inside);
  const cv::Mat tint(region.size(), region.type(), level_color(level));
  cv::addWeighted(region, 0.6, tint, 0.4, 0, region);
  const cv::Point corner = box.br() - cv::Point(1, 1);
  cv::rectangle(picture, box.tl(), corner, level_color(level));
  if (!is_virtual) return;
  cv::line(picture, box.tl(), corner, level_color(level), 1, cv::LINE_AA);
  cv::line(picture, {corner.x, box.y}, {box.x, corner.y}, level_color(level), 1, cv::LINE_AA);
}

void draw_node(cv::Mat& picture, const cv::Point& place) {
  cv::rectangle(picture, place - cv::Point(1, 1), place + cv::Point(1, 1), ink, cv::FILLED);
}

void draw_legend(Sheet& sheet, const std::vector<GraphCell>& cells) {
  constexpr int row_height = 26;
  constexpr int swatch = 16;
  std::set<std::pair<bool, int>> kinds;  // virtual ones last
  for (const GraphCell& cell : cells) kinds.insert({cell.is_virtual, cell.is_virtual ? 0 : cell.level});
  cv::Rect box(sheet.legend().tl(), cv::Size(swatch, swatch));
  const auto write = [&](const std::string& label) {
    draw_text(sheet.canvas(), label, {box.br().x + 8, box.br().y - 3}, 0.45, 4, ink);
    box.y += row_height;
  };
  for (const auto& [is_virtual, level] : kinds) {
    draw_cell(sheet.canvas(), box, is_virtual ? cells.front().level : level, is_virtual);
    write(is_virtual ? "virtual" : fmt::format("level {}", level));
  }
  draw_node(sheet.canvas(), (box.tl() + box.br()) / 2);
  write("node");
}

}  // namespace

std::vector<std::uint8_t> draw_graph(const GraphDrawing& graph, const std::string& title,
                                     const std::string& subtitle) {
  const cv::Rect frame = frame_object(graph.depth);
  Sheet sheet(draw_depth(graph.depth, frame), title, subtitle, 800);
  cv::Mat picture = sheet.picture();
  const int scale = sheet.enlargement();
  const auto corner = [&](int u, int v) { return (cv::Point(u, v) - frame.tl()) * scale; };
  for (const GraphCell& cell : graph.cells)
    draw_cell(picture, cv::Rect(corner(cell.left, cell.top), corner(cell.right, cell.bottom)), cell.level,
              cell.is_virtual);
  for (const Eigen::Vector2d& node : graph.nodes) {
    const Eigen::Vector2d place =
        (node + Eigen::Vector2d(0.5 - frame.x, 0.5 - frame.y)) * static_cast<double>(scale);
    draw_node(picture, {static_cast<int>(std::floor(place.x())), static_cast<int>(std::floor(place.y()))});
  }
  draw_legend(sheet, graph.cells);
  return sheet.png();
}

}  // namespace pliant
