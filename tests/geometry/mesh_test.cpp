#include "framework/geometry/mesh.h"

#include <gmock/gmock.h>

#include <stdexcept>

namespace pliant {
namespace {

Mesh two_targets() {
  return {{{0, 0, 0}, {10, 0, 0}, {0, 10, 0}},
          {{0, 1, 2}},
          {{"lift", {{0, 0, 1}, {0, 0, 2}, {0, 0, 3}}}, {"shift", {{4, 0, 0}, {4, 0, 0}, {0, 0, 0}}}}};
}

TEST(Mesh, IsAtRestWithoutWeights) {
  const Mesh mesh = two_targets();
  const auto deformed = mesh.deform({0, 0});
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(deformed[i], mesh.vertices[i].cast<double>());
}

TEST(Mesh, DisplacementsAddUpByTheirWeights) {
  const auto deformed = two_targets().deform({0.5, -2});
  EXPECT_EQ(deformed[0], Eigen::Vector3d(-8, 0, 0.5));
  EXPECT_EQ(deformed[1], Eigen::Vector3d(2, 0, 1));
  EXPECT_EQ(deformed[2], Eigen::Vector3d(0, 10, 1.5));
}

TEST(Mesh, NamesItsTargetsInOrder) {
  EXPECT_THAT(two_targets().target_names(), testing::ElementsAre("lift", "shift"));
}

TEST(Mesh, RefusesListsThatDoNotFit) {
  Mesh mesh = two_targets();
  EXPECT_THROW(mesh.deform({1}), std::invalid_argument);
  EXPECT_THROW(mesh.deform({1, 2, 3}), std::invalid_argument);
  mesh.targets[1].displacements.pop_back();
  EXPECT_THROW(mesh.deform({1, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace pliant
