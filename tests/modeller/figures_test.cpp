#include "tests/modeller/figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <stdexcept>

#include "experiments/modeller/pose.h"
#include "tests/geometry/mesh_shape.h"
#include "tests/modeller/intersections.h"

namespace pliant {
namespace {

using test::count_intersections;
using test::made;
using test::posed;
using test::shape_of;
using test::vertex_near;

TEST(CountIntersections, FindsTrianglesThatPassThroughEachOther) {
  Mesh mesh;
  mesh.vertices = {{-2, -2, 0}, {2, -2, 0}, {0, 3, 0}, {0, 0, -1}, {0, 0, 1}, {3, 0, 1}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_EQ(count_intersections(mesh), 1U);
  for (int k : {3, 4, 5}) mesh.vertices[static_cast<std::size_t>(k)].z() += 2;
  EXPECT_EQ(count_intersections(mesh), 0U);
  // A triangle that is folded back through its neighbour across a shared corner.
  mesh.vertices = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {2, 1, -1}, {1, 1, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 4}};
  EXPECT_EQ(count_intersections(mesh), 1U);
}

class EachFigure : public ::testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Figures, EachFigure,
                         ::testing::Values("sheet", "hand", "head", "bag", "body", "room"),
                         [](const auto& info) { return info.param; });

TEST(Figures, AreListedAndTested) {
  std::vector<std::string> names;
  for (const FigureKind& kind : figure_kinds()) names.push_back(kind.name);
  EXPECT_EQ(names, (std::vector<std::string>{"sheet", "hand", "head", "bag", "body", "room"}));
}

double farthest(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to) {
  double most = 0;
  for (std::size_t i = 0; i < from.size(); ++i) most = std::max(most, (to[i] - from[i]).norm());
  return most;
}

void expect_posable(const Figure& figure) {
  const std::vector<Eigen::Vector3d> rest = figure.mesh.deform(figure.mesh.rest());
  const double size = figure.mesh.skin.empty() ? 0 : 1e-3;
  for (std::size_t i = 0; i < rest.size(); ++i)
    ASSERT_LE((rest[i] - figure.mesh.vertices[i].cast<double>()).norm(), size);
  ASSERT_FALSE(figure.poses.empty());
  for (const NamedPose& pose : figure.poses) {
    const double whole = farthest(rest, posed(figure, pose.name));
    EXPECT_GT(whole, 4) << pose.name << " in mm";
    const double half = farthest(rest, posed(figure, pose.name, 0.5));
    EXPECT_LT(half, whole) << pose.name;
    EXPECT_GT(half, 0.4 * whole) << pose.name;
  }
}

void expect_same_bits(const Mesh& a, const Mesh& b) {
  ASSERT_EQ(a.vertices.size(), b.vertices.size());
  EXPECT_EQ(std::memcmp(a.vertices.data(), b.vertices.data(), a.vertices.size() * sizeof(a.vertices[0])), 0);
  EXPECT_EQ(a.triangles, b.triangles);
}

/// 2 for each closed surface, less 2 for each of its handles.
int euler_of(const std::string& figure) {
  if (figure == "bag") return 2 - 2 * 2;
  if (figure == "room") return 10 * 2;  // floor, two walls, five pieces of furniture, two balls
  return 2;
}

TEST_P(EachFigure, IsASurfaceAndMovesAsItsPosesSay) {
  const Figure figure = made(GetParam());
  const Mesh& mesh = figure.mesh;
  EXPECT_GE(mesh.triangles.size(), 15000U);
  EXPECT_LE(mesh.triangles.size(), 30000U);
  const auto shape = shape_of(mesh);
  EXPECT_EQ(shape.repeated_edges, 0);
  EXPECT_EQ(shape.unused_vertices, 0);
  EXPECT_GT(shape.least_height, 0.01) << "mm of the flattest triangle";
  if (GetParam() == "sheet") {
    EXPECT_EQ(shape.open_edges, 2 * (116 + 88));
  } else {
    EXPECT_EQ(shape.open_edges, 0);
    EXPECT_EQ(shape.euler, euler_of(GetParam()));
    EXPECT_GT(shape.volume, 0);
  }
  EXPECT_EQ(count_intersections(mesh), 0U);
  for (const JointWeights& skin : mesh.skin) {
    ASSERT_NEAR(skin.weights.sum(), 1, 1e-6);
    ASSERT_GE(skin.weights.minCoeff(), 0);
  }
  expect_posable(figure);
  expect_same_bits(mesh, made(GetParam()).mesh);
}

TEST_P(EachFigure, EveryIdentityIsASurface) {
  const int open_edges = GetParam() == "sheet" ? 2 * (116 + 88) : 0;
  std::map<std::string, double> lowest;
  std::map<std::string, double> highest;
  const Mesh usual = made(GetParam()).mesh;
  for (const Parameter& row : test::kind_of(GetParam()).identity.rows()) {
    lowest[row.name()] = row.lowest().value();
    highest[row.name()] = row.highest().value();
    const Mesh other = made(GetParam(), {{row.name(), row.highest().value()}}).mesh;
    EXPECT_FALSE(other.vertices == usual.vertices) << row.name();
  }
  for (const auto& identity : {lowest, highest}) {
    const Mesh mesh = made(GetParam(), identity).mesh;
    EXPECT_EQ(shape_of(mesh).open_edges, open_edges);
    EXPECT_EQ(shape_of(mesh).repeated_edges, 0);
    EXPECT_EQ(count_intersections(mesh), 0U);
  }
}

TEST(Figures, APoseOfATargetOrJointThatTheMeshLacksIsRefused) {
  const Figure sheet = made("sheet");
  const std::string target = sheet.mesh.targets.front().name;
  FigurePose pose = rest_of(sheet.mesh);
  try {
    add_pose(sheet.mesh, {"odd", "", {{target + "x", 1}}, {}}, 1, pose);
    FAIL() << "a target that is not there";
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(
        std::string(error.what()),
        "the pose odd moves " + target + "x, which the mesh does not have; did you mean '" + target + "'?");
  }
  EXPECT_THROW(add_pose(sheet.mesh, {"odd", "", {}, {{"elbow", {1, 0, 0}}}}, 1, pose), std::invalid_argument);
}

TEST(Figures, AFistBringsFingertipsToThePalm) {
  const Figure hand = made("hand");
  const auto fist = posed(hand, "fist");
  const auto point = posed(hand, "point");
  const std::size_t tip = vertex_near(hand, {7, 193, 8});
  const std::size_t index_tip = vertex_near(hand, {40, 178, 5});
  const std::size_t wrist = vertex_near(hand, {0, -10, 18});
  EXPECT_LT(fist[tip].y(), 85);
  EXPECT_GT(fist[tip].z(), 10);
  EXPECT_LT(fist[index_tip].y(), 85);
  EXPECT_NEAR(point[index_tip].y(), hand.mesh.vertices[index_tip].y(), 2);
  EXPECT_NEAR((fist[wrist] - hand.mesh.vertices[wrist].cast<double>()).norm(), 0, 1e-3);
}

TEST(Figures, APinchBringsThumbAndIndexTogether) {
  const Figure hand = made("hand");
  const auto pinch = posed(hand, "pinch");
  const auto part = [&](const std::string& joint) {
    std::vector<Eigen::Vector3d> points;
    for (std::size_t i = 0; i < pinch.size(); ++i) {
      const JointWeights& skin = hand.mesh.skin[i];
      if (hand.mesh.joints[static_cast<std::size_t>(skin.joints[0])].name == joint && skin.weights[0] > 0.9F)
        points.push_back(pinch[i]);
    }
    return points;
  };
  double least = 1e9;
  for (const Eigen::Vector3d& thumb : part("thumb_3")) {
    for (const Eigen::Vector3d& index : part("index_3")) least = std::min(least, (thumb - index).norm());
  }
  EXPECT_LT(least, 3);
}

TEST(Figures, ArmsGoUpAndForwardWhileTheRestStays) {
  const Figure body = made("body");
  const auto up = posed(body, "arms_up");
  const auto forward = posed(body, "arms_forward");
  const std::size_t hand = vertex_near(body, {700, 870, 0});
  const std::size_t knee = vertex_near(body, {110, 600, 60});
  const std::size_t nose = vertex_near(body, {0, 1592, 120});
  EXPECT_GT(up[hand].y(), 1800);
  EXPECT_GT(forward[hand].z(), 300);
  EXPECT_NEAR((up[knee] - body.mesh.vertices[knee].cast<double>()).norm(), 0, 1e-2);
  EXPECT_NEAR((up[nose] - body.mesh.vertices[nose].cast<double>()).norm(), 0, 1e-2);
}

TEST(Figures, AShearOrStretchOfTheSheetStaysInItsPlane) {
  const Figure sheet = made("sheet");
  for (const char* pose : {"shear", "stretch"}) {
    for (const Eigen::Vector3d& point : posed(sheet, pose)) ASSERT_EQ(point.z(), 0);
  }
  // A bend keeps lengths along it.
  const auto bent = posed(sheet, "bend");
  for (std::size_t i = 1; i < 50; ++i) EXPECT_NEAR((bent[i] - bent[i - 1]).norm(), 320.0 / 116, 0.001);
}

}  // namespace
}  // namespace pliant
