#include "tests/graphs/quadtree_reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "framework/geometry/pixel_index.h"

namespace pliant {

struct QuadtreeReference::Cell {
  int level, column, row;
  GraphCell box;
  std::vector<int> region;  ///< points in it
  int node = -1;            ///< the point at its centre, if any
  std::vector<std::unique_ptr<Cell>> children;

  bool is_leaf() const { return children.empty(); }

  /// Calls `visit` for every leaf below.
  template <class Visit>
  void visit_leaves(const Visit& visit) const {
    if (is_leaf()) return visit(*this);
    for (const auto& child : children) child->visit_leaves(visit);
  }
};

namespace {

template <class Cells>
bool has_node(const Cells& cells) {
  return std::any_of(cells.begin(), cells.end(), [](const auto& cell) { return cell->node >= 0; });
}

}  // namespace

QuadtreeReference::QuadtreeReference(const QuadtreeGraph::Settings& settings, const Surface& surface)
    : settings_(settings), surface_(surface), root_(enclose()), whole_(make_cell(0, 0, 0)) {
  whole_->children = make_children(*whole_);
  for (auto& cell : whole_->children) grow(*cell, settings.initial_levels);
}

QuadtreeReference::~QuadtreeReference() = default;

void QuadtreeReference::adapt(const std::vector<float>& residuals) {
  for (auto& cell : whole_->children) refine(*cell, residuals);
  for (auto& cell : whole_->children) collapse(*cell, residuals);
}

std::vector<int> QuadtreeReference::points() const {
  std::vector<int> nodes;
  whole_->visit_leaves([&](const Cell& leaf) {
    if (leaf.node >= 0) nodes.push_back(leaf.node);
  });
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

std::vector<GraphCell> QuadtreeReference::cells() const {
  std::vector<GraphCell> cells;
  // Depth first is Morton order.
  whole_->visit_leaves([&](const Cell& leaf) { cells.push_back(leaf.box); });
  std::stable_sort(cells.begin(), cells.end(),
                   [](const GraphCell& a, const GraphCell& b) { return a.level < b.level; });
  return cells;
}

QuadtreeReference::Root QuadtreeReference::enclose() const {
  Eigen::Vector2i low = surface_.pixels.front();
  Eigen::Vector2i high = low;
  for (const Eigen::Vector2i& pixel : surface_.pixels) {
    low = low.cwiseMin(pixel);
    high = high.cwiseMax(pixel);
  }
  const int width = high.x() - low.x() + 1;
  const int height = high.y() - low.y() + 1;
  const int side = std::max(width, height);
  return {low.x() - (side - width) / 2, low.y() - (side - height) / 2, side};
}

std::unique_ptr<QuadtreeReference::Cell> QuadtreeReference::make_cell(int level, int column, int row) const {
  const auto line = [&](int index) {
    return static_cast<int>(std::floor(root_.side * (index / std::exp2(level))));
  };
  auto cell = std::make_unique<Cell>();
  cell->level = level;
  cell->column = column;
  cell->row = row;
  cell->box = {root_.left + line(column),
               root_.top + line(row),
               root_.left + line(column + 1),
               root_.top + line(row + 1),
               level,
               false};
  const GraphCell& box = cell->box;
  const Eigen::Vector2i centre((box.left + box.right) / 2, (box.top + box.bottom) / 2);
  for (std::size_t i = 0; i < surface_.size(); ++i) {
    const Eigen::Vector2i& pixel = surface_.pixels[i];
    if (pixel.x() < box.left || pixel.x() >= box.right || pixel.y() < box.top || pixel.y() >= box.bottom)
      continue;
    cell->region.push_back(static_cast<int>(i));
  }
  cell->node = point_at(index_pixels(surface_), centre, {box.left, box.top, box.right, box.bottom});
  cell->box.is_virtual = cell->node < 0;
  return cell;
}

/// Those of the four that have points and, where the tree has no virtual leaves, a node.
std::vector<std::unique_ptr<QuadtreeReference::Cell>> QuadtreeReference::make_children(
    const Cell& cell) const {
  std::vector<std::unique_ptr<Cell>> children;
  for (const int row : {0, 1})
    for (const int column : {0, 1}) {
      auto child = make_cell(cell.level + 1, 2 * cell.column + column, 2 * cell.row + row);
      const bool is_leaf = child->node >= 0 || child->level <= settings_.virtual_levels;
      if (!child->region.empty() && is_leaf) children.push_back(std::move(child));
    }
  return children;
}

/// Of the points where it is known; NaN, which is neither above nor below a threshold, where none is.
double QuadtreeReference::mean_residual(const Cell& cell, const std::vector<float>& residuals) const {
  double sum = 0;
  int known = 0;
  for (const int point : cell.region) {
    const float residual = residuals[static_cast<std::size_t>(point)];
    if (residual < 0) continue;
    sum += residual;
    ++known;
  }
  return known == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / known;
}

void QuadtreeReference::grow(Cell& cell, int levels) const {
  if (cell.level >= levels) return;
  auto children = make_children(cell);
  if (children.empty() || (cell.node >= 0 && !has_node(children))) return;
  cell.children = std::move(children);
  for (auto& child : cell.children) grow(*child, levels);
}

void QuadtreeReference::refine(Cell& cell, const std::vector<float>& residuals) const {
  if (!cell.is_leaf())
    for (auto& child : cell.children) refine(*child, residuals);
  else if (mean_residual(cell, residuals) > settings_.refine_threshold)
    grow(cell, std::min(cell.level + 1, settings_.levels));
}

void QuadtreeReference::collapse(Cell& cell, const std::vector<float>& residuals) const {
  for (auto& child : cell.children) collapse(*child, residuals);
  if (cell.is_leaf() || cell.level < settings_.initial_levels) return;
  for (const auto& child : cell.children)
    if (!child->is_leaf() || (cell.node < 0 && child->node >= 0)) return;
  if (mean_residual(cell, residuals) < settings_.collapse_threshold) cell.children.clear();
}

}  // namespace pliant
