#include "framework/geometry/color_at_depth.h"

#include <gmock/gmock.h>

#include <cmath>

#include "framework/geometry/render.h"

namespace pliant {
namespace {

constexpr int wall_triangles = 2;
constexpr double before_wall = 400;  // mm that the square stands before the wall

/// A wall 1 m away from the depth camera, coloured by place, and a blue square before it.
struct Scene {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
};

Scene make_scene() {
  Scene scene;
  const auto add_square = [&](double side, double depth) {
    const int first = static_cast<int>(scene.vertices.size());
    for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
      scene.vertices.emplace_back(x * side / 2, y * side / 2, depth);
    scene.triangles.emplace_back(first, first + 1, first + 2);
    scene.triangles.emplace_back(first, first + 2, first + 3);
  };
  add_square(2000, 1000);
  add_square(120, 1000 - before_wall);
  return scene;
}

Rgb wall_color(double x, double y) {
  const auto level = [](double value) { return static_cast<std::uint8_t>(std::lround(128 + value / 8)); };
  return {level(x), level(y), 0};
}

constexpr Rgb blue{0, 0, 255};

/// What a camera of the rig sees of the scene.
Image<Fragment> seen_by(const Camera& camera, const Scene& scene,
                        const Eigen::Isometry3d& camera_from_depth) {
  std::vector<Eigen::Vector3d> vertices = scene.vertices;
  for (auto& vertex : vertices) vertex = camera_from_depth * vertex;
  return render_mesh(vertices, scene.triangles, camera);
}

Frame see(const Rig& rig, const Scene& scene) {
  Frame frame;
  frame.depth = depth_of(seen_by(rig.depth, scene, Eigen::Isometry3d::Identity()));
  const Camera& camera = rig.color.value();
  const Image<Fragment> seen = seen_by(camera, scene, rig.color_from_depth);
  frame.color = ColorImage(camera.width, camera.height);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Fragment& fragment = seen.data()[i];
    if (fragment.triangle < 0) continue;
    const Eigen::Vector3d place = interpolate(fragment, scene.triangles, scene.vertices);
    frame.color.data()[i] = fragment.triangle < wall_triangles ? wall_color(place.x(), place.y()) : blue;
  }
  return frame;
}

/// Colour with twice the resolution, from the side, turned and rolled.
Rig rig_apart() {
  Rig rig{{120, 120, 79.5, 59.5, 160, 120}, Camera{250, 240, 160.2, 118.7, 320, 240}};
  rig.color_from_depth = Eigen::Translation3d(-90, 20, 15) *
                         Eigen::AngleAxisd(-0.08, Eigen::Vector3d::UnitY()) *
                         Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ());
  return rig;
}

/// How far the way from a point of the wall to the colour camera goes past the square's border, mm in the
/// square's plane: negative where the square is in the way.
double clearance(const Eigen::Vector3d& point, const Rig& rig) {
  const Eigen::Vector3d eye = rig.color_from_depth.inverse().translation();
  const double share = before_wall / (point.z() - eye.z());
  const Eigen::Vector3d passed = point + share * (eye - point);
  return passed.head<2>().cwiseAbs().maxCoeff() - 60;
}

TEST(ColorAtDepth, TakesTheColourOfEachPointAndNoneThatHidesIt) {
  const Rig rig = rig_apart();
  const Frame frame = see(rig, make_scene());
  check(frame, rig, "scene's");
  const ColorImage color = color_at_depth(frame, rig);
  ASSERT_EQ(color.width(), 160);
  ASSERT_EQ(color.height(), 120);
  // The mesh of the square ends at its last pixels' centres: up to 1 pixel of either camera inside.
  constexpr double unsure = 8;  // mm
  int seen = 0, hidden = 0, outside = 0, on_square = 0;
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 160; ++u) {
      const Eigen::Vector3d point = rig.depth.unproject(u, v, frame.depth(u, v));
      const Eigen::Vector2d pixel = rig.color->project(rig.color_from_depth * point);
      const Rgb found = color(u, v);
      if (pixel.x() < -0.5 || pixel.y() < -0.5 || pixel.x() > 319.5 || pixel.y() > 239.5) {
        ++outside;
        EXPECT_EQ(found, Rgb{}) << u << " " << v;
      } else if (point.z() < 999) {
        if (point.head<2>().cwiseAbs().maxCoeff() > 60 - unsure) continue;
        ++on_square;
        EXPECT_EQ(found, blue) << u << " " << v;
      } else if (const double way = clearance(point, rig); way < -unsure) {
        ++hidden;
        EXPECT_EQ(found, Rgb{}) << u << " " << v;
      } else if (way > unsure) {
        ++seen;
        const Rgb expected = wall_color(point.x(), point.y());
        EXPECT_NEAR(found.r, expected.r, 1) << u << " " << v;
        EXPECT_NEAR(found.g, expected.g, 1) << u << " " << v;
        EXPECT_EQ(found.b, 0) << u << " " << v;
      }
    }
  }
  EXPECT_GT(seen, 8000);
  EXPECT_GT(hidden, 100);
  EXPECT_GT(outside, 100);
  EXPECT_GT(on_square, 300);
}

TEST(ColorAtDepth, IsBlackWithoutDepth) {
  const Rig rig = rig_apart();
  Frame frame = see(rig, make_scene());
  const ColorImage whole = color_at_depth(frame, rig);
  frame.depth(80, 60) = 0;
  frame.depth(82, 60) = std::nanf("");
  const ColorImage color = color_at_depth(frame, rig);
  for (int u = 80; u <= 82; ++u) {
    EXPECT_EQ(whole(u, 60), blue) << u;
    EXPECT_EQ(color(u, 60), u == 81 ? blue : Rgb{}) << u;
  }
}

TEST(ColorAtDepth, WithoutACameraOfItsOwnStaysAsItIs) {
  Rig rig = rig_apart();
  Frame frame = see(rig, make_scene());
  rig.color = rig.depth;
  rig.color_from_depth.setIdentity();
  frame.color = see(rig, make_scene()).color;
  EXPECT_EQ(color_at_depth(frame, rig).pixels(), frame.color.pixels()) << "the same camera twice";
  rig.color.reset();
  frame.depth = DepthImage(160, 120, 0);
  EXPECT_EQ(color_at_depth(frame, rig).pixels(), frame.color.pixels());
  frame.color = {};
  EXPECT_TRUE(color_at_depth(frame, rig).empty());
  EXPECT_TRUE(color_at_depth(frame, rig_apart()).empty());
}

TEST(DepthAtColor, IsWhatTheColourCameraSees) {
  const Rig rig = rig_apart();
  const DepthImage depth = see(rig, make_scene()).depth;
  const DepthImage found = depth_at_color(depth, rig, whole_image(*rig.color));
  const DepthImage exact = depth_of(seen_by(*rig.color, make_scene(), rig.color_from_depth));
  int same = 0;
  int others = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    if (found.data()[i] == 0) continue;
    (std::abs(found.data()[i] - exact.data()[i]) < 0.1 ? same : others) += 1;
  }
  EXPECT_GT(same, 40000);
  EXPECT_LT(others, 600) << "the wall beside the square, where only its pixels' centres count";
  const PixelWindow window{150, 70, 61, 90};
  const DepthImage part = depth_at_color(depth, rig, window);
  for (int v = 0; v < part.height(); ++v)
    for (int u = 0; u < part.width(); ++u)
      ASSERT_NEAR(part(u, v), window.contains(u, v) ? found(u, v) : 0, 0.01) << u << " " << v;
}

TEST(DepthAtColor, WithoutACameraOfItsOwnStaysAsItIs) {
  const DepthImage depth(160, 120, 700);
  EXPECT_EQ(depth_at_color(depth, {rig_apart().depth}, {1, 2, 3, 4}).pixels(), depth.pixels());
}

}  // namespace
}  // namespace pliant
