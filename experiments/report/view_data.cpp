#include "experiments/report/view_data.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "experiments/report/base64.h"

namespace pliant {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t most_points = 12'000;
constexpr int unknown = 255;

/// Little-endian, whatever the machine.
void append(std::vector<std::uint8_t>& bytes, std::size_t value) {
  bytes.push_back(static_cast<std::uint8_t>(value & 0xFF));
  bytes.push_back(static_cast<std::uint8_t>(value >> 8 & 0xFF));
}

/// Positions as integers within a box.
class Grid {
 public:
  explicit Grid(const ViewData& view) {
    add(view.source.points);
    add(view.target.points);
    for (const auto& step : view.steps) {
      add(step.points);
      add(step.nodes);
      add(step.camera);
      for (const auto& [from, to] : step.constraints) add({from, to});
    }
    if (view.frames) add(view.frames->path);
    if (box_.isEmpty()) box_.extend(Eigen::Vector3f::Zero());
    size_ = std::max(box_.sizes().maxCoeff(), 1e-3F);
  }

  ordered_json json() const {
    return {{"low", {box_.min().x(), box_.min().y(), box_.min().z()}},
            {"high", {box_.max().x(), box_.max().y(), box_.max().z()}},
            {"step", size_ / last}};
  }

  void append(std::vector<std::uint8_t>& bytes, const Eigen::Vector3f& point) const {
    for (int i = 0; i < 3; ++i) {
      const float place = (point[i] - box_.min()[i]) / size_ * last;
      pliant::append(bytes, std::isfinite(place) ? static_cast<std::size_t>(std::lround(place)) : 0);
    }
  }

  std::string text(const std::vector<Eigen::Vector3f>& points) const {
    std::vector<std::uint8_t> bytes;
    for (const auto& point : points) append(bytes, point);
    return base64(bytes);
  }

 private:
  static constexpr float last = 65535;

  void add(const std::vector<Eigen::Vector3f>& points) {
    for (const auto& point : points)
      if (point.allFinite()) box_.extend(point);
  }

  Eigen::AlignedBox3f box_;
  float size_ = 1;
};

std::string indices_text(const std::vector<std::pair<int, int>>& pairs) {
  std::vector<std::uint8_t> bytes;
  for (const auto& [from, to] : pairs) {
    append(bytes, static_cast<std::size_t>(from));
    append(bytes, static_cast<std::size_t>(to));
  }
  return base64(bytes);
}

std::string indices_text(const std::vector<int>& indices) {
  std::vector<std::uint8_t> bytes;
  for (const int index : indices) append(bytes, static_cast<std::size_t>(index));
  return base64(bytes);
}

ordered_json mesh_json(const ViewData::Mesh& mesh, const Grid& grid) {
  std::vector<std::uint8_t> corners;
  for (const auto& triangle : mesh.triangles)
    for (int i = 0; i < 3; ++i) append(corners, static_cast<std::size_t>(triangle[i]));
  return {{"points", grid.text(mesh.points)}, {"triangles", base64(corners)}};
}

/// Each connection once, whichever way it leads.
ordered_json graph_json(const ViewData::Graph& graph) {
  std::vector<std::pair<int, int>> edges;
  for (const Edge& edge : graph.edges)
    if (edge.from < edge.to) edges.emplace_back(edge.from, edge.to);
  ordered_json cells = ordered_json::array();
  for (const auto& cell : graph.cells)
    cells.push_back({{"level", cell.level}, {"lines", indices_text(cell.lines)}});
  return {{"edges", indices_text(edges)}, {"cells", cells}};
}

std::string errors_text(const std::vector<float>& errors, float largest) {
  std::vector<std::uint8_t> bytes;
  for (const float error : errors)
    bytes.push_back(static_cast<std::uint8_t>(
        std::isfinite(error) ? std::lround(std::sqrt(std::min(error / largest, 1.0F)) * (unknown - 1))
                             : unknown));
  return base64(bytes);
}

float largest_error(const ViewData& view) {
  float largest = view.scale;
  for (const auto& step : view.steps)
    for (const auto* errors : {&step.nearest, &step.truth})
      for (const float error : *errors)
        if (std::isfinite(error)) largest = std::max(largest, error);
  return largest;
}

std::string constraints_text(const ViewData::Step& step, const Grid& grid) {
  std::vector<std::uint8_t> bytes;
  for (const auto& [from, to] : step.constraints) {
    grid.append(bytes, from);
    grid.append(bytes, to);
  }
  return base64(bytes);
}

ordered_json step_json(const ViewData::Step& step, const Grid& grid, float largest) {
  ordered_json json{{"number", step.number},
                    {"graph", step.graph},
                    {"points", grid.text(step.points)},
                    {"nearest", errors_text(step.nearest, largest)},
                    {"nodes", grid.text(step.nodes)},
                    {"constraints", constraints_text(step, grid)},
                    {"constraint_count", step.constraint_count}};
  if (!step.truth.empty()) json["truth"] = errors_text(step.truth, largest);
  if (!step.state.empty()) json["state"] = step.state;
  if (!step.cells.empty()) json["cells"] = indices_text(step.cells);
  if (!step.camera.empty()) json["camera"] = grid.text(step.camera);
  return json;
}

std::string unmatched_text(const ViewData& view) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < view.matched.size(); ++i)
    if (view.matched[i] == 0) append(bytes, i);
  return base64(bytes);
}

}  // namespace

std::size_t view_points(std::size_t steps, bool has_truth) {
  constexpr double text = 4.0 / 3.0;  // bytes of base64 a byte
  const std::size_t source = 6 * (steps + 1) + (has_truth ? 2 : 1) * steps + 12;
  constexpr std::size_t target = 6 + 12;
  const double most = static_cast<double>(view_bytes) / (text * static_cast<double>(source + target));
  return std::min(static_cast<std::size_t>(most), most_points);
}

ordered_json view_json(const ViewData& view) {
  const Grid grid(view);
  const float largest = largest_error(view);
  ordered_json graphs = ordered_json::array();
  for (const auto& graph : view.graphs) graphs.push_back(graph_json(graph));
  ordered_json steps = ordered_json::array();
  for (const auto& step : view.steps) steps.push_back(step_json(step, grid, largest));
  ordered_json json{{"format", 1},
                    {"box", grid.json()},
                    {"scale", view.scale},
                    {"largest_error", largest},
                    {"has_truth", !view.steps.empty() && !view.steps.front().truth.empty()},
                    {"result", view.result},
                    {"source", mesh_json(view.source, grid)},
                    {"target", mesh_json(view.target, grid)},
                    {"unmatched", unmatched_text(view)},
                    {"graphs", graphs},
                    {"steps", steps},
                    {"picture", base64(view.picture)}};
  if (view.frames)
    json["frames"] = {
        {"columns", view.frames->columns}, {"gap", view.frames->gap}, {"path", grid.text(view.frames->path)}};
  return json;
}

}  // namespace pliant
