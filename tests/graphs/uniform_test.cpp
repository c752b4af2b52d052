#include "graphs/uniform/uniform.h"

#include <gmock/gmock.h>

#include <cstdint>

#include "framework/core/error.h"
#include "framework/deformation/graph_builder.h"
#include "framework/geometry/pixel_index.h"
#include "tests/geometry/holey_surface.h"
#include "tests/geometry/viewed_surface.h"

namespace pliant {
namespace {

std::unique_ptr<GraphBuilder> make_uniform(std::vector<Parameters::Value> values) {
  Registry registry;
  register_uniform_graph(registry);
  return registry.make<GraphBuilder>(Parameters("uniform", std::move(values)));
}

class UniformGraphTest : public testing::Test {
 protected:
  std::unique_ptr<NodeSelection> select(std::vector<Parameters::Value> values) {
    return make_uniform(std::move(values))->select_nodes(device_, ViewedSurface(surface_));
  }

  Device device_;
  const Surface surface_ = holey_surface(200, 160, 1);
};

TEST_F(UniformGraphTest, HasThePointAtTheCentreOfEachCell) {
  EXPECT_EQ(select({{"spacing", std::int64_t{9}}})->points(), points_on_grid(index_pixels(surface_), 9));
}

TEST_F(UniformGraphTest, IsTwelvePixelsWideIfNothingIsSaid) {
  EXPECT_EQ(select({})->points(), select({{"spacing", std::int64_t{12}}})->points());
}

TEST_F(UniformGraphTest, HasAboutAsManyNodesAsAreWishedFor) {
  for (const int wished : {16, 64, 256, 1024}) {
    const auto nodes = select({{"nodes", std::int64_t{wished}}});
    EXPECT_NEAR(static_cast<double>(nodes->points().size()), wished, 0.2 * wished);
  }
}

TEST_F(UniformGraphTest, HasNoMoreNodesThanPoints) {
  EXPECT_EQ(select({{"nodes", std::int64_t{1000000}}})->points().size(), surface_.size());
}

TEST_F(UniformGraphTest, NeverAdaptsAndHasNoCells) {
  const auto nodes = select({});
  const auto at_first = nodes->points();
  EXPECT_FALSE(nodes->adapt(device_, Array<float>(patchy_residuals(surface_, 1))));
  EXPECT_EQ(nodes->points(), at_first);
  EXPECT_TRUE(nodes->cells().empty());
}

TEST_F(UniformGraphTest, ASpacingSaysMoreThanANumber) {
  EXPECT_EQ(select({{"spacing", std::int64_t{9}}, {"nodes", std::int64_t{64}}})->points(),
            select({{"spacing", std::int64_t{9}}})->points());
}

}  // namespace
}  // namespace pliant
