#include "experiments/tasks/thinned_surface.h"

#include <algorithm>

#include "experiments/report/surfaces.h"

namespace pliant {
namespace {

constexpr int none = -1;
constexpr float depth_step = 20;  // mm between neighbouring pixels; wider apart there is air between them

bool is_on_grid(const Eigen::Vector2i& pixel, int step) {
  return pixel.x() % step == 0 && pixel.y() % step == 0;
}

int finest_step(const Surface& surface, std::size_t most) {
  for (int step = 1;; ++step) {
    const auto left = std::count_if(surface.pixels.begin(), surface.pixels.end(),
                                    [&](const Eigen::Vector2i& pixel) { return is_on_grid(pixel, step); });
    if (static_cast<std::size_t>(left) <= most) return step;
  }
}

}  // namespace

ThinnedSurface::ThinnedSurface(const Surface& surface, std::size_t most) : step_(finest_step(surface, most)) {
  Surface left;
  Eigen::Vector2i last(-1, -1);
  for (std::size_t i = 0; i < surface.size(); ++i) {
    if (!is_on_grid(surface.pixels[i], step_)) continue;
    kept_.push_back(i);
    left.points.push_back(surface.points[i]);
    left.pixels.emplace_back(surface.pixels[i] / step_);
    last = last.cwiseMax(left.pixels.back());
  }
  // Neighbours are further apart in depth, too, by how much is left out; not without end.
  triangles_ = triangulate(left, depth_step * static_cast<float>(std::min(step_, 4)) / 2);
  indices_ = Image<int>(last.x() + 1, last.y() + 1, none);
  for (std::size_t i = 0; i < left.size(); ++i)
    indices_(left.pixels[i].x(), left.pixels[i].y()) = static_cast<int>(i);
}

ViewData::Outline ThinnedSurface::outline(const GraphCell& cell) const {
  ViewData::Outline outline{cell.level, {}};
  int before = none;
  const auto visit = [&](int u, int v) {
    const int here = indices_.contains(u, v) ? indices_(u, v) : none;
    if (here != none && before != none && here != before) outline.lines.emplace_back(before, here);
    before = here;
  };
  const Eigen::Vector2i low(cell.left / step_, cell.top / step_);
  const Eigen::Vector2i high(cell.right / step_, cell.bottom / step_);
  for (int u = low.x(); u < high.x(); ++u) visit(u, low.y());
  for (int v = low.y(); v < high.y(); ++v) visit(high.x(), v);
  for (int u = high.x(); u > low.x(); --u) visit(u, high.y());
  for (int v = high.y(); v >= low.y(); --v) visit(low.x(), v);
  return outline;
}

}  // namespace pliant
