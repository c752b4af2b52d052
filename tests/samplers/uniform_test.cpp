#include "samplers/uniform/uniform.h"

#include <gmock/gmock.h>

#include <cstdint>

#include "framework/geometry/pixel_index.h"
#include "framework/registration/sampler.h"
#include "tests/geometry/holey_surface.h"
#include "tests/geometry/viewed_surface.h"

namespace pliant {
namespace {

TEST(UniformSampler, TakesTheCentreOfEachMaskAndKeepsIt) {
  Registry registry;
  register_uniform_sampler(registry);
  const auto sampler = registry.make<ConstraintSampler>(Parameters("uniform", {{"step", std::int64_t{5}}}));
  const Surface surface = holey_surface(96, 70, 1);
  Device device;
  const auto samples = sampler->select(device, ViewedSurface(surface));
  const std::vector<int> expected = points_on_grid(index_pixels(surface), 5);
  EXPECT_FALSE(expected.empty());
  EXPECT_EQ(samples->points(), expected);
  EXPECT_FALSE(samples->adapt(device, Array<float>(patchy_residuals(surface, 1))));
  EXPECT_EQ(samples->points(), expected);
}

TEST(UniformSampler, ComesNearAWishedNumberWhateverTheResolution) {
  Registry registry;
  register_uniform_sampler(registry);
  const auto sampler =
      registry.make<ConstraintSampler>(Parameters("uniform", {{"points", std::int64_t{150}}}));
  Device device;
  for (const int scale : {1, 2, 3}) {
    const Surface surface = holey_surface(96 * scale, 70 * scale, 1);
    const auto count = sampler->select(device, ViewedSurface(surface))->points().size();
    EXPECT_GT(count, 110U) << scale;
    EXPECT_LT(count, 200U) << scale;
  }
  const auto by_step = registry.make<ConstraintSampler>(
      Parameters("uniform", {{"step", std::int64_t{5}}, {"points", std::int64_t{150}}}));
  const Surface surface = holey_surface(96, 70, 1);
  EXPECT_EQ(by_step->select(device, ViewedSurface(surface))->points(),
            points_on_grid(index_pixels(surface), 5));
}

}  // namespace
}  // namespace pliant
