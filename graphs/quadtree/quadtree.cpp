#include "graphs/quadtree/quadtree.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "framework/core/error.h"
#include "framework/geometry/pixel_index.h"
#include "graphs/quadtree/quadtree.cl.embed.h"

namespace pliant {
namespace {

// As in quadtree.cl.
constexpr int leaf = 1;
constexpr int cell_count(int level) { return 1 << (2 * level); }
constexpr int first_cell(int level) { return (cell_count(level) - 4) / 3; }

constexpr const char* stage = "ans";

int side_around(const PixelIndex& index) { return std::max(index.window.width, index.window.height); }

/// As many levels as are wished for and as pixels allow.
int possible_levels(int wished, int side) {
  int levels = wished;
  while (levels > 1 && 1 << levels > side) --levels;
  return levels;
}

class QuadtreeNodes : public NodeSelection {
 public:
  QuadtreeNodes(const QuadtreeGraph::Settings& settings, Device& device, const PixelIndex& index)
      : settings_(settings),
        levels_(possible_levels(settings.levels, side_around(index))),
        initial_levels_(std::min(settings.initial_levels, levels_)),
        side_(side_around(index)),
        left_((index.window.width - side_) / 2),
        top_((index.window.height - side_) / 2),
        map_left_(index.window.left),
        map_top_(index.window.top),
        size_{{index.window.width, index.window.height}},
        map_(index.points.device(device)),
        centre_(static_cast<std::size_t>(first_cell(levels_ + 1))),
        state_(static_cast<std::size_t>(first_cell(levels_ + 1))),
        totals_(device.allocate(state_.size() * sizeof(cl_float2))) {
    build(device, index.count);
  }

  const std::vector<int>& points() const override { return nodes_; }

  bool adapt(Device& device, const Array<float>& residuals) override {
    sum(device, residuals);
    // Deepest first, so that no child is judged by a residual that was measured without it.
    for (int level = levels_ - 1; level >= 1; --level) refine(device, level, settings_.refine_threshold);
    for (int level = levels_ - 1; level >= initial_levels_; --level) collapse(device, level);
    return collect();
  }

  std::vector<GraphCell> cells() const override {
    std::vector<GraphCell> cells;
    for (int level = 1; level <= levels_; ++level)
      for (int cell = 0; cell < cell_count(level); ++cell) {
        const auto at = static_cast<std::size_t>(first_cell(level) + cell);
        if (state_.host()[at] == leaf) cells.push_back(box(level, cell, centre_.host()[at] < 0));
      }
    return cells;
  }

 private:
  /// [Alg. 1]: it is [Alg. 2] with a threshold that every cell exceeds.
  void build(Device& device, std::size_t point_count) {
    sum(device, Array<float>(std::vector<float>(point_count, 0.0F)));
    auto find = kernel(device, "find_centres");
    for (int level = 1; level <= levels_; ++level)
      run(device, find, level, level, root(), size_, map_, totals_, centre_.write_device(device),
          state_.write_device(device));
    for (int level = 1; level < initial_levels_; ++level) refine(device, level, -1);
    collect();
  }

  /// The sums of residuals over the region of every cell, from the deepest level up.
  void sum(Device& device, const Array<float>& residuals) {
    auto points = kernel(device, "sum_points");
    auto children = kernel(device, "sum_children");
    run(device, points, levels_, levels_, root(), size_, map_, residuals.device(device), totals_);
    for (int level = levels_ - 1; level >= 1; --level) run(device, children, level, level, totals_);
  }

  void refine(Device& device, int level, double threshold) {
    auto step = kernel(device, "refine");
    const auto children_may_be_virtual = static_cast<cl_int>(level < settings_.virtual_levels);
    run(device, step, level, level, static_cast<cl_float>(threshold), children_may_be_virtual, totals_,
        centre_.device(device), state_.write_device(device));
  }

  void collapse(Device& device, int level) {
    auto step = kernel(device, "collapse");
    run(device, step, level, level, static_cast<cl_float>(settings_.collapse_threshold), totals_,
        centre_.device(device), state_.write_device(device));
  }

  /// Gathers the nodes, on the host, as cells are few; whether they are others than before.
  bool collect() {
    const auto& centre = centre_.host();
    const auto& state = state_.host();
    std::vector<int> nodes;
    for (std::size_t cell = 0; cell < state.size(); ++cell)
      if (state[cell] == leaf && centre[cell] >= 0) nodes.push_back(centre[cell]);
    std::sort(nodes.begin(), nodes.end());
    std::swap(nodes, nodes_);
    return nodes_ != nodes;
  }

  static cl::Kernel kernel(Device& device, const char* name) {
    return device.kernel(embedded::graphs_quadtree_quadtree_cl, name);
  }

  /// One work-item for each cell of a level.
  template <class... Arguments>
  static void run(Device& device, cl::Kernel& kernel, int level, const Arguments&... arguments) {
    device.run(stage, kernel, static_cast<std::size_t>(cell_count(level)), group, arguments...);
  }

  cl_int4 root() const { return {{left_, top_, side_, 0}}; }

  GraphCell box(int level, int cell, bool is_virtual) const {
    int column = 0;
    int row = 0;
    for (int bit = 0; bit < level; ++bit) {
      column |= (cell >> (2 * bit) & 1) << bit;
      row |= (cell >> (2 * bit + 1) & 1) << bit;
    }
    const auto line = [&](int index) { return (side_ * index) >> level; };
    const int left = map_left_ + left_;
    const int top = map_top_ + top_;
    return {left + line(column), top + line(row), left + line(column + 1),
            top + line(row + 1), level,           is_virtual};
  }

  static constexpr std::size_t group = 64;

  QuadtreeGraph::Settings settings_;
  int levels_;
  int initial_levels_;
  int side_;  ///< of the root, whose corner lies at (left_, top_) in the map
  int left_;
  int top_;
  int map_left_;
  int map_top_;
  cl_int2 size_;       ///< of the map
  Buffer map_;         ///< point at each pixel
  Array<int> centre_;  ///< per cell; see quadtree.cl
  Array<int> state_;   ///< per cell; see quadtree.cl
  Buffer totals_;      ///< per cell: sum and number of its known residuals
  std::vector<int> nodes_;
};

}  // namespace

QuadtreeGraph::QuadtreeGraph(const Settings& settings) : settings_(settings) {
  if (settings.collapse_threshold >= settings.refine_threshold)
    throw ConfigError(fmt::format(
        "graph quadtree: collapse_threshold is {:g} mm; expected less than refine_threshold, {:g} mm",
        settings.collapse_threshold, settings.refine_threshold));
  if (settings.initial_levels > settings.levels)
    throw ConfigError(fmt::format("graph quadtree: initial_levels is {}; expected at most levels, {}",
                                  settings.initial_levels, settings.levels));
}

std::unique_ptr<NodeSelection> QuadtreeGraph::select_nodes(Device& device, const SurfaceView& source) const {
  return std::make_unique<QuadtreeNodes>(settings_, device, source.pixels);
}

void register_quadtree_graph(Registry& registry) {
  const QuadtreeGraph::Settings settings;
  registry.add<GraphBuilder>(
      "quadtree",
      "The leaves of a quadtree over the source's projection that follows the residual [thesis 4.3]",
      {
          integer("levels", settings.levels).range(1, 10).doc("Deepest level; level l has 4^l cells"),
          integer("initial_levels", settings.initial_levels)
              .range(1, 10)
              .doc("Levels of the tree to begin with, above which it never collapses"),
          integer("virtual_levels", settings.virtual_levels)
              .range(1, 10)
              .doc(
                  "Levels on which a cell without a point at its centre stays in the tree; the thesis has 2"),
          real("refine_threshold", settings.refine_threshold)
              .unit("mm")
              .at_least(0)
              .doc("A leaf whose mean residual lies above is divided"),
          real("collapse_threshold", settings.collapse_threshold)
              .unit("mm")
              .at_least(0)
              .doc("Leaves are joined where the mean residual lies below; less than refine_threshold"),
      },
      [](const Parameters& parameters, const Registry&) {
        return std::make_unique<QuadtreeGraph>(QuadtreeGraph::Settings{
            static_cast<int>(parameters.integer("levels")),
            static_cast<int>(parameters.integer("initial_levels")),
            static_cast<int>(parameters.integer("virtual_levels")), parameters.real("refine_threshold"),
            parameters.real("collapse_threshold")});
      });
}

}  // namespace pliant
