#include "samplers/uniform/uniform.h"

#include <memory>

#include "framework/geometry/pixel_index.h"
#include "framework/registration/sampler.h"

namespace pliant {
namespace {

class UniformSampler : public ConstraintSampler {
 public:
  explicit UniformSampler(int step) : step_(step) {}
  std::unique_ptr<PointSelection> select(Device&, const Surface& source, const Camera&) const override {
    return std::make_unique<FixedSelection<PointSelection>>(points_on_grid(source, step_));
  }

 private:
  int step_;
};

}  // namespace

void register_uniform_sampler(Registry& registry) {
  registry.add<ConstraintSampler>(
      "uniform", "The point at the centre of each step x step mask over the projection [thesis 4.5]",
      {integer("step", 4).unit("pixel").range(1, 256).doc("Side of the mask, and how far it moves")},
      [](const Parameters& parameters, const Registry&) {
        return std::make_unique<UniformSampler>(static_cast<int>(parameters.integer("step")));
      });
}

}  // namespace pliant
