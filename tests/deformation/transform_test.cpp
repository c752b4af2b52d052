#include "framework/deformation/node_transform.h"

#include <gtest/gtest.h>

#include "framework/deformation/warp.h"

namespace pliant {
namespace {

TEST(NodeTransform, AffineHasTheTwelveNumbersOfItsForm) {
  Registry registry;
  register_transforms(registry);
  const auto affine = registry.make<NodeTransform>(Parameters("affine", {}));
  EXPECT_EQ(affine->unknowns, affine_size);
}

}  // namespace
}  // namespace pliant
