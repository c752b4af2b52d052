#include "experiments/tasks/drawings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/report/graph_drawing.h"

namespace pliant {
namespace {

std::string count_nodes(std::size_t count, const std::vector<GraphCell>& cells) {
  std::string nodes = fmt::format("{} nodes", count);
  if (cells.empty()) return nodes;
  const auto virtual_cells =
      std::count_if(cells.begin(), cells.end(), [](const GraphCell& cell) { return cell.is_virtual; });
  return fmt::format("{}, and {} virtual ones without a point at the centre", nodes, virtual_cells);
}

}  // namespace

std::vector<float> depths(const std::vector<Eigen::Vector3f>& points) {
  std::vector<float> values;
  for (const Eigen::Vector3f& point : points) values.push_back(point.z());
  return values;
}

float quantile(std::vector<float> values, double share) {
  std::erase_if(values, [](float value) { return !std::isfinite(value); });
  if (values.empty()) return 0;
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

Image<float> at_pixels(const Surface& surface, const Camera& camera, const std::vector<float>& values) {
  Image<float> image(camera.width, camera.height, std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < values.size(); ++i)
    image(surface.pixels[i].x(), surface.pixels[i].y()) = values[i];
  return image;
}

ColorScale depth_scale(const Surface& source, const std::vector<Eigen::Vector3f>& moved) {
  std::vector<float> values = depths(source.points);
  const std::vector<float> after = depths(moved);
  values.insert(values.end(), after.begin(), after.end());
  // The rim of a mask often bleeds onto the background: a twentieth may lie anywhere.
  const float nearest = quantile(values, 0.05);
  const float furthest = quantile(values, 0.95);
  const float air = std::max(0.25f * (furthest - nearest), 1.0f);
  const auto step = static_cast<float>(round_up((furthest - nearest + 2 * air) / 10));
  return {ColorScale::Map::depth, step * std::floor((nearest - air) / step),
          step * std::ceil((furthest + air) / step)};
}

Picture heat_map(const std::string& name, const std::string& caption, Image<float> values,
                 const ColorScale& scale, const std::string& subtitle) {
  return {name, caption, [values = std::move(values), scale, caption, subtitle] {
            return draw_heat_map(values, scale, caption, subtitle);
          }};
}

Picture draw_source(const Surface& source, const Camera& camera, const ColorScale& scale) {
  return heat_map("depth_source", "Source depth", at_pixels(source, camera, depths(source.points)), scale,
                  fmt::format("{} points", source.size()));
}

Picture draw_last_graph(const Surface& source, const Camera& camera,
                        const std::vector<Eigen::Vector3d>& nodes, const std::vector<GraphCell>& cells) {
  GraphDrawing graph{at_pixels(source, camera, depths(source.points)), cells, {}};
  for (const Eigen::Vector3d& node : nodes) graph.nodes.push_back(camera.project(node));
  const std::string caption = "Deformation graph at the end, over the source";
  return {"graph", caption, [graph = std::move(graph), caption] {
            return draw_graph(graph, caption, count_nodes(graph.nodes.size(), graph.cells));
          }};
}

}  // namespace pliant
