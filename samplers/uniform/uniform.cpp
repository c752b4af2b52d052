#include "samplers/uniform/uniform.h"

#include <memory>
#include <optional>

#include "framework/geometry/pixel_index.h"
#include "framework/registration/sampler.h"

namespace pliant {
namespace {

constexpr int default_step = 4;

class UniformSampler : public ConstraintSampler {
 public:
  UniformSampler(int step, std::optional<int> wished) : step_(step), wished_(wished) {}

  std::unique_ptr<PointSelection> select(Device&, const SurfaceView& source) const override {
    return std::make_unique<FixedSelection<PointSelection>>(
        wished_ ? about_as_many_points_on_grid(source.pixels, *wished_)
                : points_on_grid(source.pixels, step_));
  }

 private:
  int step_;
  std::optional<int> wished_;
};

}  // namespace

void register_uniform_sampler(Registry& registry) {
  registry.add<ConstraintSampler>(
      "uniform", "The point at the centre of each step x step mask over the projection [thesis 4.5]",
      {
          integer("step").unit("pixel").range(1, 256).optional().doc(
              "Side of the mask, and how far it moves, whatever `points` says; 4 where that is not given"),
          integer("points")
              .range(1, 10000000)
              .optional()
              .doc("Wished number of points, from which the step follows"),
      },
      [](const Parameters& parameters, const Registry&) {
        std::optional<int> wished;
        if (parameters.has("points")) wished = static_cast<int>(parameters.integer("points"));
        if (!parameters.has("step")) return std::make_unique<UniformSampler>(default_step, wished);
        return std::make_unique<UniformSampler>(static_cast<int>(parameters.integer("step")), std::nullopt);
      });
}

}  // namespace pliant
