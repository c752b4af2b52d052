#include "graphs/uniform/uniform.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>

#include "framework/core/error.h"
#include "framework/deformation/graph_builder.h"
#include "framework/geometry/pixel_index.h"

namespace pliant {
namespace {

constexpr int default_spacing = 12;

/// The spacing whose grid comes nearest to the wished number of nodes; the coarser one on a tie.
std::vector<int> grid_of_about(const Surface& source, int wished) {
  const double guess = std::sqrt(static_cast<double>(source.size()) / wished);
  std::vector<int> best;
  const auto miss = [&](const std::vector<int>& nodes) {
    return std::abs(static_cast<int>(nodes.size()) - wished);
  };
  // Holes and ragged rims make the guess inexact, never by as much as a factor of two.
  for (int spacing = static_cast<int>(2 * guess) + 1; spacing >= std::max(1, static_cast<int>(guess / 2));
       --spacing) {
    auto nodes = points_on_grid(source, spacing);
    if (best.empty() || miss(nodes) < miss(best)) best = std::move(nodes);
  }
  return best;
}

class UniformGraph : public GraphBuilder {
 public:
  UniformGraph(int spacing, std::optional<int> wished) : spacing_(spacing), wished_(wished) {}

  std::unique_ptr<NodeSelection> select_nodes(Device&, const Surface& source, const Camera&) const override {
    return std::make_unique<FixedSelection<NodeSelection>>(wished_ ? grid_of_about(source, *wished_)
                                                                   : points_on_grid(source, spacing_));
  }

 private:
  int spacing_;
  std::optional<int> wished_;
};

}  // namespace

void register_uniform_graph(Registry& registry) {
  registry.add<GraphBuilder>(
      "uniform", "A node at the centre of each cell of a square grid over the source's projection",
      {
          integer("spacing").unit("pixel").range(1, 1024).optional().doc(
              "Side of a cell; 12 where `nodes` is not given either"),
          integer("nodes")
              .range(1, 1000000)
              .optional()
              .doc("Wished number of nodes, from which the spacing follows"),
      },
      [](const Parameters& parameters, const Registry&) -> std::unique_ptr<GraphBuilder> {
        const bool has_spacing = parameters.has("spacing");
        if (has_spacing && parameters.has("nodes"))
          throw ConfigError("graph uniform: both `spacing` and `nodes` are given; expected one of them");
        const int spacing = has_spacing ? static_cast<int>(parameters.integer("spacing")) : default_spacing;
        std::optional<int> wished;
        if (parameters.has("nodes")) wished = static_cast<int>(parameters.integer("nodes"));
        return std::make_unique<UniformGraph>(spacing, wished);
      });
}

}  // namespace pliant
