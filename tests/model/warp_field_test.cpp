#include "framework/model/warp_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "framework/core/angle.h"
#include "framework/core/error.h"
#include "framework/deformation/warp.h"
#include "tests/model/ball.h"
#include "tests/model/bending_wall.h"

namespace pliant {
namespace {

using test::Ball;
using test::BendingWall;
using Points = std::vector<Eigen::Vector3f>;
using Form = Eigen::Matrix<float, 3, 4>;

const Camera kCamera{100, 100, 43, 30, 87, 61};
const TsdfGrid kGrid{{96, 64, 64}, {-190, -126, 500}, 4, 20};
constexpr double kSpacing = 20;
constexpr double kWall = 620;
const Ball kFlat{.radius = 0, .wall = kWall};
/// Turned and away from the model's frame.
const Eigen::Isometry3d kPose = Eigen::Translation3d(12, -9, 25) *
                                Eigen::AngleAxisd(0.12, Eigen::Vector3d(0.4, 1, -0.3).normalized()) *
                                Eigen::Isometry3d::Identity();

std::unique_ptr<WarpField> make_field(Device& device, double spacing = kSpacing) {
  return std::make_unique<WarpField>(device, std::make_unique<Tsdf>(device, kGrid, 64), spacing);
}

/// One that knows the wall as it is at rest.
std::unique_ptr<WarpField> flat_field(Device& device, double spacing = kSpacing) {
  auto field = make_field(device, spacing);
  field->integrate(DepthMap(kFlat.frame(kCamera, kPose)), kCamera, kPose);
  field->view(kCamera, whole_image(kCamera), kPose);
  return field;
}

template <class FormOf>
Array<float> forms_of(const Points& nodes, const FormOf& form_of) {
  std::vector<float> values;
  for (const Eigen::Vector3f& node : nodes) {
    const Form form = form_of(node);
    values.insert(values.end(), form.data(), form.data() + form.size());
  }
  return Array<float>(std::move(values));
}

/// The form of a node in the model's frame as the camera at kPose has it.
Form seen_form(const Form& form) {
  const Eigen::Matrix3f turn = kPose.linear().cast<float>();
  Form seen;
  seen << turn * form.leftCols<3>() * turn.transpose(), turn * form.col(3);
  return seen;
}

Eigen::Vector3f in_model(const Eigen::Vector3f& point) {
  return (kPose.inverse() * point.cast<double>()).cast<float>();
}

/// Deforms the field as registration from its last view at kPose would, if it were exact. `after`: where the
/// model is then.
template <class FormOf>
void deform(WarpField& field, const FormOf& form_of, const Eigen::Isometry3d& after = kPose) {
  const DeformationStart start = field.start();
  EmbeddedGraph graph;
  graph.positions = start.nodes;
  const Array<float> affine =
      forms_of(start.nodes, [&](const Eigen::Vector3f& node) { return seen_form(form_of(in_model(node))); });
  field.deform({graph, affine, start.rest, 4, kPose, after});
}

void bend(WarpField& field, const BendingWall& wall = {}) {
  deform(field, [&](const Eigen::Vector3f& node) { return wall.form(node); });
}

Points points_of(const SurfaceMap& map) {
  Points points = unflatten(map.points());
  std::erase_if(points, [](const Eigen::Vector3f& point) { return !(point.z() > 0); });
  return points;
}

/// Whether a point is not at the rim, where truncated distances along the axis are of one side alone.
bool is_within(const Eigen::Vector3d& p) { return std::abs(p.x()) < 140 && std::abs(p.y()) < 100; }

TEST(WarpField, IsItsSignedDistanceFieldUntilItIsDeformed) {
  Device device;
  Tsdf plain(device, kGrid, 64);
  plain.integrate(DepthMap(kFlat.frame(kCamera, kPose)), kCamera, kPose);
  const std::vector<float> expected = plain.raycast(kCamera, whole_image(kCamera), kPose).points().host();
  const auto field = flat_field(device);
  const SurfaceMap& view = field->view(kCamera, whole_image(kCamera), kPose);
  EXPECT_EQ(view.points().host(), expected);
  field->start();
  EXPECT_FALSE(field->field().empty());
  EXPECT_EQ(field->view(kCamera, whole_image(kCamera), kPose).points().host(), expected);
  EXPECT_EQ(field->mesh().vertices, plain.mesh().vertices);
}

TEST(WarpField, ShowsTheBentSurface) {
  Device device;
  const auto field = flat_field(device);
  bend(*field);
  const BendingWall wall;
  const SurfaceMap& view = field->view(kCamera, whole_image(kCamera), kPose);
  const Points points = unflatten(view.points());
  const Points normals = unflatten(view.normals());
  int seen = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(points[i].z() > 0)) {
      EXPECT_EQ(points[i], Eigen::Vector3f::Zero()) << "what is nothing stays nothing";
      EXPECT_EQ(normals[i], Eigen::Vector3f::Zero());
      continue;
    }
    const Eigen::Vector3d p = in_model(points[i]).cast<double>();
    if (!is_within(p)) continue;
    ++seen;
    EXPECT_LT(wall.error(p), 0.5);
    const Eigen::Vector3d normal = kPose.linear().transpose() * normals[i].cast<double>();
    const Eigen::Vector3d expected = Eigen::Vector3d(-wall.slope(p.x()), 0, -1).normalized();
    EXPECT_GT(normal.dot(expected), std::cos(4 * degree));
  }
  EXPECT_GT(seen, 1000);
}

/// Greatest error of the canonical wall once bent frames were fused into it.
double canonical_error(const Tsdf& tsdf) {
  double worst = 0;
  for (const Eigen::Vector3f& vertex : tsdf.mesh().vertices)
    if (is_within(vertex.cast<double>())) worst = std::max(worst, std::abs(vertex.z() - kWall));
  return worst;
}

TEST(WarpField, FusesBentFramesIntoTheFlatWall) {
  Device device;
  const auto field = flat_field(device);
  bend(*field);
  Tsdf plain(device, kGrid, 64);
  const BendingWall wall;
  for (int frame = 0; frame < 10; ++frame) {
    const Eigen::Isometry3d pose = kPose * Eigen::AngleAxisd(0.02 * frame, Eigen::Vector3d::UnitY());
    const DepthMap map(wall.frame(kCamera, pose));
    field->integrate(map, kCamera, pose);
    plain.integrate(map, kCamera, pose);
  }
  EXPECT_GT(points_of(field->view(kCamera, whole_image(kCamera), kPose)).size(), 1500U);
  EXPECT_LT(canonical_error(field->canonical()), 0.5);
  EXPECT_GT(canonical_error(plain), 5) << "without a field the frames show something else";
  for (const Eigen::Vector3f& vertex : field->mesh().vertices)
    if (const Eigen::Vector3d p = vertex.cast<double>(); is_within(p)) {
      EXPECT_LT(wall.error(p), 0.7);
    }
}

TEST(WarpField, GivesBackTheFormsThatItTook) {
  Device device;
  const auto field = flat_field(device);
  bend(*field);
  const BendingWall wall;
  const Points& nodes = field->field().positions();
  const std::vector<float> expected =
      forms_of(nodes, [&](const Eigen::Vector3f& node) { return wall.form(node); }).host();
  const std::vector<float>& forms = field->field().affine().host();
  ASSERT_EQ(forms.size(), expected.size());
  for (std::size_t i = 0; i < forms.size(); ++i) EXPECT_NEAR(forms[i], expected[i], 2e-4);
  const DeformationStart start = field->start();
  ASSERT_EQ(start.nodes.size(), nodes.size());
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    EXPECT_LT((in_model(start.nodes[j]) - nodes[j]).norm(), 1e-3);
    const Eigen::Map<const Form> form(start.affine.host().data() + affine_size * j);
    EXPECT_LT((form - seen_form(wall.form(nodes[j]))).norm(), 1e-3);
  }
}

TEST(WarpField, HasNodesOverAllThatWasSeen) {
  Device device;
  const auto field = flat_field(device);
  const DeformationStart start = field->start();
  for (std::size_t i = 0; i < start.nodes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GT((start.nodes[i] - start.nodes[j]).norm(), 0.7 * kSpacing - 1e-3);
  for (const Eigen::Vector3f& point : points_of(start.rest)) {
    const bool is_covered = std::any_of(start.nodes.begin(), start.nodes.end(),
                                        [&](const auto& node) { return (node - point).norm() < kSpacing; });
    EXPECT_TRUE(is_covered) << point.transpose();
  }
  EXPECT_EQ(field->start().nodes.size(), start.nodes.size()) << "nothing new is in view";
}

/// The part of a frame that is left of a column.
Frame left_of(Frame frame, int column) {
  for (int v = 0; v < frame.depth.height(); ++v)
    for (int u = column; u < frame.depth.width(); ++u) frame.depth(u, v) = 0;
  return frame;
}

TEST(WarpField, GrowsByNodesThatMoveAsTheirNeighboursDo) {
  Device device;
  const auto field = make_field(device);
  const Frame flat = kFlat.frame(kCamera, kPose);
  field->integrate(DepthMap(left_of(flat, 50)), kCamera, kPose);
  field->view(kCamera, whole_image(kCamera), kPose);
  const Eigen::Isometry3f motion =
      Eigen::Translation3f(3, -2, 4) * Eigen::AngleAxisf(0.05F, Eigen::Vector3f(1, 2, 0).normalized());
  const auto rigid = [&](const Eigen::Vector3f& node) {
    Form form;
    form << motion.linear() - Eigen::Matrix3f::Identity(), motion * node - node;
    return form;
  };
  deform(*field, rigid);
  const std::size_t before = field->field().positions().size();
  const Points old_nodes = field->field().positions();
  const Eigen::Isometry3d pose = kPose * motion.cast<double>().inverse();
  field->integrate(DepthMap(flat), kCamera, pose);
  field->view(kCamera, whole_image(kCamera), pose);
  field->start();
  const Points& nodes = field->field().positions();
  ASSERT_GT(nodes.size(), before + 20);
  EXPECT_TRUE(std::equal(old_nodes.begin(), old_nodes.end(), nodes.begin())) << "what is there stays";
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    const Eigen::Map<const Form> form(field->field().affine().host().data() + affine_size * j);
    EXPECT_LT((form - rigid(nodes[j])).norm(), 2e-3);
    EXPECT_NEAR(nodes[j].z(), kWall, 1.5) << "what was new was fused where it is at rest";
  }
}

TEST(WarpField, CarriesThePointsThatAreFollowed) {
  Device device;
  const auto field = flat_field(device);
  const Points points{{-80, 10, kWall}, {5, -40, kWall}, {90, 33, kWall}, {60, 0, kWall - 5}};
  EXPECT_TRUE(field->followed().empty());
  field->follow(flatten(points));
  EXPECT_EQ(unflatten(field->followed()), points);
  const BendingWall wall;
  bend(*field, wall);
  const Points moved = unflatten(field->followed());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f expected =
        points[i] - Eigen::Vector3f(0, 0, static_cast<float>(wall.bend(points[i].x())));
    EXPECT_LT((moved[i] - expected).norm(), 0.5);
  }
  field->view(kCamera, whole_image(kCamera), kPose);
  bend(*field, BendingWall{.height = 0});
  const Points back = unflatten(field->followed());
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_LT((back[i] - points[i]).norm(), 1e-3);
}

TEST(WarpField, LeavesAMotionOfAllToThePose) {
  Device device;
  const BendingWall wall;
  const Points points{{-80, 10, 620}, {5, -40, 620}, {90, 33, 620}};
  const Eigen::Isometry3d after = Eigen::Translation3d(4, 9, -15) *
                                  Eigen::AngleAxisd(0.2, Eigen::Vector3d(1, 0.3, 0.5).normalized()) * kPose;
  std::vector<Points> in_camera;
  for (const Eigen::Isometry3d& pose : {kPose, after}) {
    const auto field = flat_field(device);
    field->follow(flatten(points));
    deform(
        *field, [&](const Eigen::Vector3f& node) { return wall.form(node); }, pose);
    in_camera.push_back(unflatten(field->followed()));
    for (Eigen::Vector3f& point : in_camera.back()) point = (pose * point.cast<double>()).cast<float>();
  }
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_LT((in_camera[0][i] - in_camera[1][i]).norm(), 2e-3);
}

TEST(WarpField, FindsWhereFollowedPointsWereAtRest) {
  Device device;
  const auto field = flat_field(device);
  const Points rest{{-80, 10, kWall}, {5, -40, kWall}, {90, 33, kWall}, {60, 0, kWall - 5}};
  field->follow(flatten(rest));
  bend(*field, BendingWall{.height = 40});
  const Points moved = unflatten(field->followed());
  const Points found = unflatten(points_at_rest(device, field->field(), flatten(moved)));
  for (std::size_t i = 0; i < rest.size(); ++i) EXPECT_LT((found[i] - rest[i]).norm(), 0.01);
  field->follow(flatten(moved));
  const Points again = unflatten(field->followed());
  for (std::size_t i = 0; i < rest.size(); ++i) EXPECT_LT((again[i] - moved[i]).norm(), 0.01);
}

TEST(WarpField, GivesTheSameBitsEveryTime) {
  const auto run = [] {
    Device device;
    const auto field = flat_field(device);
    bend(*field);
    field->integrate(DepthMap(BendingWall{}.frame(kCamera, kPose)), kCamera, kPose);
    const SurfaceMap& view = field->view(kCamera, whole_image(kCamera), kPose);
    return std::pair(field->canonical().read().distances, view.points().host());
  };
  EXPECT_TRUE(run() == run());
}

TEST(WarpField, AsksForNoMemoryAfterTheFirstFrames) {
  Device device;
  const auto field = flat_field(device);
  const DepthMap map(BendingWall{}.frame(kCamera, kPose));
  const auto frame = [&] {
    bend(*field);
    field->integrate(map, kCamera, kPose);
    field->view(kCamera, whole_image(kCamera), kPose);
  };
  for (int i = 0; i < 3; ++i) frame();
  const auto before = device.counts().allocated_bytes;
  for (int i = 0; i < 10; ++i) frame();
  EXPECT_EQ(device.counts().allocated_bytes, before);
}

// The simulator runs this one.
TEST(WarpField, MovesFewPixelsAndVoxels) {
  const Camera camera{20, 20, 9.5, 7.5, 19, 15};
  const PixelWindow window{3, 2, 13, 11};
  const Ball wall{.radius = 0, .wall = 600};
  const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  Device device;
  auto tsdf = std::make_unique<Tsdf>(device, TsdfGrid{{16, 16, 16}, {-150, -150, 490}, 20, 80}, 64);
  WarpField field(device, std::move(tsdf), 100);
  const DepthMap map(wall.frame(camera, pose));
  field.integrate(map, camera, pose);
  field.view(camera, window, pose);
  const DeformationStart start = field.start();
  EmbeddedGraph graph;
  graph.positions = start.nodes;
  const Array<float> affine = forms_of(start.nodes, [](const Eigen::Vector3f&) {
    Form form = Form::Zero();
    form(2, 3) = -30;
    return form;
  });
  field.deform({graph, affine, start.rest, 4, pose});
  field.follow(flatten(Points{{0, 0, 570}}));
  field.integrate(DepthMap(Ball{.radius = 0, .wall = 570}.frame(camera, pose)), camera, pose);
  const Points points = points_of(field.view(camera, window, pose));
  EXPECT_GT(points.size(), 15U);
  for (const Eigen::Vector3f& point : points) EXPECT_NEAR(point.z(), 570, 0.5);
  EXPECT_NEAR(field.followed().host()[2], 570, 0.01);
}

TEST(WarpField, LivesWithoutAnythingToSee) {
  Device device;
  const auto field = make_field(device);
  EXPECT_THROW(field->start(), std::logic_error);
  field->view(kCamera, whole_image(kCamera), kPose);
  EXPECT_TRUE(field->start().nodes.empty());
  field->view(kCamera, {}, kPose);
  EXPECT_TRUE(field->start().nodes.empty());
  EXPECT_TRUE(field->mesh().vertices.empty());
  field->follow({});
  EXPECT_TRUE(field->followed().empty());
}

TEST(WarpField, RefusesDeformationsOfOtherNodesAndPosesThatAreNotFinite) {
  Device device;
  const auto field = flat_field(device);
  const DeformationStart start = field->start();
  EmbeddedGraph graph;
  graph.positions = start.nodes;
  Eigen::Isometry3d pose = kPose;
  pose.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(field->deform({graph, start.affine, start.rest, 4, pose}), NumericalError);
  graph.positions.pop_back();
  EXPECT_THROW(field->deform({graph, start.affine, start.rest, 4, kPose}), std::invalid_argument);
  EXPECT_THROW(field->view(kCamera, whole_image(kCamera), pose), NumericalError);
}

}  // namespace
}  // namespace pliant
