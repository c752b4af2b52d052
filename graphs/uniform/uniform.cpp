#include "graphs/uniform/uniform.h"

#include <memory>
#include <optional>

#include "framework/deformation/graph_builder.h"
#include "framework/geometry/pixel_index.h"

namespace pliant {
namespace {

constexpr int default_spacing = 12;

class UniformGraph : public GraphBuilder {
 public:
  UniformGraph(int spacing, std::optional<int> wished) : spacing_(spacing), wished_(wished) {}

  std::unique_ptr<NodeSelection> select_nodes(Device&, const SurfaceView& source) const override {
    return std::make_unique<FixedSelection<NodeSelection>>(
        wished_ ? about_as_many_points_on_grid(source.pixels, *wished_)
                : points_on_grid(source.pixels, spacing_));
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
              "Side of a cell, whatever `nodes` says; 12 where that is not given"),
          integer("nodes")
              .range(1, 1000000)
              .optional()
              .doc("Wished number of nodes, from which the spacing follows"),
      },
      [](const Parameters& parameters, const Registry&) -> std::unique_ptr<GraphBuilder> {
        std::optional<int> wished;
        if (parameters.has("nodes")) wished = static_cast<int>(parameters.integer("nodes"));
        if (!parameters.has("spacing")) return std::make_unique<UniformGraph>(default_spacing, wished);
        return std::make_unique<UniformGraph>(static_cast<int>(parameters.integer("spacing")), std::nullopt);
      });
}

}  // namespace pliant
