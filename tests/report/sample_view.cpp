#include "tests/report/sample_view.h"

#include <cmath>

#include "experiments/report/heat_map.h"

namespace pliant {
namespace {

ViewData::Mesh square(int side, float depth) {
  ViewData::Mesh mesh;
  const auto index = [&](int u, int v) { return v * side + u; };
  for (int v = 0; v < side; ++v)
    for (int u = 0; u < side; ++u) {
      const Eigen::Vector2f place = Eigen::Vector2f(u, v) * 100.0F / static_cast<float>(side - 1);
      mesh.points.emplace_back(place.x() - 50, place.y() - 50, depth + 10 * std::sin(place.x() / 15));
      if (u + 1 == side || v + 1 == side) continue;
      mesh.triangles.emplace_back(index(u, v), index(u, v + 1), index(u + 1, v));
      mesh.triangles.emplace_back(index(u + 1, v), index(u, v + 1), index(u + 1, v + 1));
    }
  return mesh;
}

ViewData::Step step_of(const ViewData& view, int number, int last) {
  ViewData::Step step;
  step.number = number;
  for (const Eigen::Vector3f& point : view.source.points) {
    step.points.emplace_back(point - Eigen::Vector3f(0, 0, 3.0F * static_cast<float>(number)));
    step.nearest.push_back(3.0F * static_cast<float>(last - number) + std::abs(point.x()) / 25);
    step.truth.push_back(step.nearest.back() + 2);
  }
  step.truth.front() = std::nanf("");
  step.nodes = {step.points[0], step.points[step.points.size() / 2], step.points.back()};
  step.constraints = {{step.points[0], view.target.points[0]},
                      {step.points.back(), view.target.points.back()}};
  step.constraint_count = number == 0 ? 0 : 2000;
  return step;
}

ViewData::Step frame_of(const ViewData::Mesh& square, int side, int number) {
  ViewData::Step step;
  step.number = number;
  step.state = "tracked";
  for (int cell = 0; cell < side * side; ++cell) {
    if (cell % side < side / 2 && cell / side < side / 2) continue;
    step.points.push_back(square.points[static_cast<std::size_t>(cell)]);
    step.nearest.push_back(static_cast<float>(number));
    step.cells.push_back(cell);
  }
  const Eigen::Vector3f place(20.0F * static_cast<float>(number - 1), 0, 0);
  step.camera = {place};
  for (const auto& corner : {Eigen::Vector3f(-30, -20, 50), {30, -20, 50}, {30, 20, 50}, {-30, 20, 50}})
    step.camera.emplace_back(place + corner);
  return step;
}

}  // namespace

ViewData sample_frames(int side, int steps) {
  ViewData view;
  view.target = square(side, 600);
  view.frames = ViewData::Frames{side, 400.0F / static_cast<float>(side), {}};
  for (int number = 1; number <= steps; ++number) {
    view.steps.push_back(frame_of(view.target, side, number));
    view.frames->path.push_back(view.steps.back().camera.front());
  }
  view.result = view.steps.size() - 1;
  view.scale = static_cast<float>(steps);
  view.picture = draw_heat_map(Image<float>(40, 30, 1), {}, "A strip", "that stands in");
  return view;
}

ViewData sample_view(int side, int steps) {
  ViewData view;
  view.source = square(side, 600);
  view.target = square(side, 600 - 3 * static_cast<float>(steps - 1));
  view.matched.assign(view.source.points.size(), 1);
  for (std::size_t i = 0; i < view.matched.size(); i += 7) view.matched[i] = 0;
  ViewData::Graph graph{{{0, 1}, {1, 0}, {1, 2}, {2, 1}}, {}};
  for (int level = 1; level <= 3; ++level) {
    graph.cells.push_back({level, {}});
    for (int u = 0; u + 1 < side; ++u)
      graph.cells.back().lines.emplace_back(level * side + u, level * side + u + 1);
  }
  view.graphs = {graph};
  for (int number = 0; number < steps; ++number) view.steps.push_back(step_of(view, number, steps - 1));
  view.result = view.steps.size() - 1;
  view.scale = 8;
  view.picture = draw_heat_map(Image<float>(40, 30, 1), {}, "A picture", "that stands in");
  return view;
}

}  // namespace pliant
