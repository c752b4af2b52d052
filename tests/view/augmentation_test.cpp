#include "experiments/view/augmentation.h"

#include <gmock/gmock.h>

#include <cmath>
#include <stdexcept>

#include "framework/core/error.h"
#include "framework/geometry/render.h"

namespace pliant {
namespace {

constexpr Rgb background{10, 20, 30};
constexpr double tolerance = 5;  // mm

const Camera depth_camera{150, 150, 79.5, 59.5, 160, 120};
const Rig one_camera{depth_camera};

/// A colour camera of another size that stands and looks aside.
Rig rig_apart() {
  Rig rig{depth_camera, Camera{260, 255, 101.5, 77, 200, 150}};
  rig.color_from_depth = Eigen::Translation3d(-60, 15, 10) *
                         Eigen::AngleAxisd(0.06, Eigen::Vector3d::UnitY()) *
                         Eigen::AngleAxisd(-0.15, Eigen::Vector3d::UnitZ());
  return rig;
}

/// Two triangles around the origin that face along z, in one colour.
Augmentation::Object square(float side, const Eigen::Affine3d& model_from_object) {
  const float half = side / 2;
  SurfaceMesh mesh{{{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}},
                   {{0, 1, 2}, {0, 2, 3}},
                   std::vector<Rgb>(4, Rgb{200, 100, 50})};
  return {std::move(mesh), model_from_object};
}

Eigen::Affine3d at(double x, double y, double z) { return Eigen::Affine3d(Eigen::Translation3d(x, y, z)); }

const Camera& color_camera(const Rig& rig) { return rig.color ? *rig.color : rig.depth; }

Frame frame_of(const Rig& rig, float depth) {
  return {DepthImage(rig.depth.width, rig.depth.height, depth),
          ColorImage(color_camera(rig).width, color_camera(rig).height, background),
          {}};
}

Device& shared_device() {
  static Device& device = *new Device;  // never closed: OpenCL drivers end before what is static here does
  return device;
}

ColorImage drawn(const Augmentation::Object& object, const Rig& rig, const Frame& frame,
                 const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity()) {
  return Augmentation(shared_device(), object, rig, tolerance).draw(frame, pose);
}

bool is_drawn(const ColorImage& image, int u, int v) { return image(u, v) != background; }

int count_drawn(const ColorImage& image) {
  int count = 0;
  for (const Rgb& pixel : image.pixels()) count += pixel == background ? 0 : 1;
  return count;
}

/// The middle of what is drawn.
Eigen::Vector2d middle(const ColorImage& image) {
  Eigen::Vector2d sum(0, 0);
  for (int v = 0; v < image.height(); ++v)
    for (int u = 0; u < image.width(); ++u)
      if (is_drawn(image, u, v)) sum += Eigen::Vector2d(u, v);
  return sum / count_drawn(image);
}

const Augmentation::Object object = square(200, at(0, 0, 600));  // 50 x 50 pixels

TEST(Augmentation, IsDrawnBeforeWhatIsFartherAndHiddenByWhatIsNearer) {
  EXPECT_EQ(count_drawn(drawn(object, one_camera, frame_of(one_camera, 700))), 2500);
  EXPECT_EQ(count_drawn(drawn(object, one_camera, frame_of(one_camera, 500))), 0);
  Frame half = frame_of(one_camera, 700);
  for (int v = 0; v < half.depth.height(); ++v)
    for (int u = 0; u < 80; ++u) half.depth(u, v) = 500;
  const ColorImage image = drawn(object, one_camera, half);
  EXPECT_EQ(count_drawn(image), 1250);
  EXPECT_FALSE(is_drawn(image, 79, 60));
  EXPECT_TRUE(is_drawn(image, 80, 60));
}

TEST(Augmentation, BearsNoiseUpToTheTolerance) {
  EXPECT_EQ(count_drawn(drawn(object, one_camera, frame_of(one_camera, 596))), 2500);
  EXPECT_EQ(count_drawn(drawn(object, one_camera, frame_of(one_camera, 594))), 0);
}

TEST(Augmentation, IsDrawnWhereNoDepthWasMeasured) {
  Frame frame = frame_of(one_camera, 500);
  frame.depth(80, 60) = 0;
  frame.depth(81, 60) = std::nanf("");
  frame.mask = MaskImage(depth_camera.width, depth_camera.height);  // of no consequence
  const ColorImage image = drawn(object, one_camera, frame);
  EXPECT_EQ(count_drawn(image), 2);
  EXPECT_TRUE(is_drawn(image, 80, 60) && is_drawn(image, 81, 60));
}

TEST(Augmentation, GoesWhereTheModelGoes) {
  const Augmentation::Object small = square(12, at(40, -20, 600));
  for (const Rig& rig : {one_camera, rig_apart()}) {
    for (int i = 0; i < 5; ++i) {
      const Eigen::Isometry3d pose = Eigen::Translation3d(12 * i - 20, 5 * i, -30 * i) *
                                     Eigen::AngleAxisd(0.05 * i, Eigen::Vector3d::UnitZ()) *
                                     Eigen::AngleAxisd(0.04 * i, Eigen::Vector3d::UnitY());
      Eigen::Vector3d point = pose * Eigen::Vector3d(40, -20, 600);
      if (rig.color) point = rig.color_from_depth * point;
      const ColorImage image = drawn(small, rig, frame_of(rig, 0), pose);
      ASSERT_GT(count_drawn(image), 4);
      EXPECT_LT((middle(image) - color_camera(rig).project(point)).norm(), 1) << i;
    }
  }
}

/// Depth of a square in the frame of the depth camera, as a camera sees it.
DepthImage seen(const Eigen::Vector3d& middle, double side, const Camera& camera,
                const Eigen::Isometry3d& camera_from_depth) {
  std::vector<Eigen::Vector3d> corners;
  for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
    corners.push_back(camera_from_depth * (middle + side / 2 * Eigen::Vector3d(x, y, 0)));
  return depth_of(render_mesh(corners, {{0, 1, 2}, {0, 2, 3}}, camera));
}

// A board stands before the object: where the colour camera sees it is not where the depth camera does.
TEST(Augmentation, IsHiddenAsTheColourCameraSeesIt) {
  const Rig rig = rig_apart();
  const Eigen::Vector3d board(20, 10, 400);
  Frame frame = frame_of(rig, 0);
  frame.depth = seen(board, 60, rig.depth, Eigen::Isometry3d::Identity());
  const DepthImage hiding = seen(board, 60, *rig.color, rig.color_from_depth);
  const DepthImage whole = seen({0, 0, 600}, 200, *rig.color, rig.color_from_depth);
  const ColorImage image = drawn(object, rig, frame);
  int hidden = 0;
  int wrong = 0;
  for (int v = 0; v < image.height(); ++v)
    for (int u = 0; u < image.width(); ++u) {
      const bool is_hidden = hiding(u, v) > 0;
      hidden += whole(u, v) > 0 && is_hidden ? 1 : 0;
      wrong += is_drawn(image, u, v) != (whole(u, v) > 0 && !is_hidden) ? 1 : 0;
    }
  EXPECT_GT(hidden, 1000);
  EXPECT_LT(wrong, 160) << "one pixel of the colour camera around the board, which is 40 pixels wide";
}

TEST(Augmentation, IsLitFromTheCamera) {
  const Frame frame = frame_of(one_camera, 0);
  const Rgb facing = drawn(object, one_camera, frame)(80, 60);
  EXPECT_NEAR(facing.r, 200, 4);
  EXPECT_NEAR(facing.g, 100, 2);
  EXPECT_NEAR(facing.b, 50, 1);
  Augmentation::Object steep = object;
  steep.model_from_object.rotate(Eigen::AngleAxisd(1.2, Eigen::Vector3d::UnitX()));
  const Rgb turned = drawn(steep, one_camera, frame)(80, 60);
  EXPECT_LT(turned.r, 0.7 * facing.r);
  EXPECT_GT(turned.r, 0.3 * facing.r);
}

TEST(Augmentation, BehindTheCameraLeavesThePicture) {
  const Frame frame = frame_of(one_camera, 700);
  const Eigen::Isometry3d behind(Eigen::Translation3d(0, 0, -1500));
  EXPECT_EQ(drawn(object, one_camera, frame, behind).pixels(), frame.color.pixels());
}

TEST(Augmentation, WithoutColourIsAnError) {
  Frame frame = frame_of(one_camera, 700);
  frame.color = {};
  EXPECT_THROW(drawn(object, one_camera, frame), DataError);
  Augmentation::Object pale = object;
  pale.mesh.colors.pop_back();
  EXPECT_THROW(drawn(pale, one_camera, frame), std::invalid_argument);
}

}  // namespace
}  // namespace pliant
