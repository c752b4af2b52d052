#include "experiments/training/head_views.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "experiments/datasets/depth_sensor.h"
#include "experiments/training/head_sitter.h"
#include "framework/core/angle.h"
#include "framework/geometry/bounding_box.h"
#include "framework/geometry/render.h"
#include "framework/pose/head_forest.h"

namespace pliant {
namespace {

using Point = Eigen::Vector3d;

constexpr double chin = -115;  // y of the head's frame, mm: what is below belongs to the neck

/// Triangles in the camera's frame, with what each is.
struct Scene {
  std::vector<Point> vertices;
  std::vector<Eigen::Vector3i> triangles;
  std::vector<Shown> what;

  void add(const std::vector<Point>& points, const std::vector<Eigen::Vector3i>& faces, Shown shown) {
    const int first = static_cast<int>(vertices.size());
    vertices.insert(vertices.end(), points.begin(), points.end());
    for (const auto& face : faces) triangles.push_back(face.array() + first);
    what.resize(triangles.size(), shown);
  }

  void add_ellipsoid(const Eigen::Isometry3d& pose, const Point& radii) {
    constexpr int rings = 14;
    constexpr int around = 2 * rings;
    std::vector<Point> points;
    std::vector<Eigen::Vector3i> faces;
    for (int j = 0; j <= rings; ++j) {
      for (int i = 0; i < around; ++i) {
        const double turn = std::numbers::pi * j / rings;
        const double angle = std::numbers::pi * i / rings;
        const Point unit(std::sin(turn) * std::cos(angle), std::cos(turn), std::sin(turn) * std::sin(angle));
        points.emplace_back(pose * unit.cwiseProduct(radii));
        if (j == rings) continue;
        const int a = j * around + i;
        const int b = j * around + (i + 1) % around;
        faces.emplace_back(a, b, a + around);
        faces.emplace_back(b, b + around, a + around);
      }
    }
    add(points, faces, Shown::other);
  }
};

Eigen::Isometry3d placed(const Point& place, const Point& angles) {
  return Eigen::Translation3d(place) * Eigen::Isometry3d(head_rotation(angles));
}

Point random_angles(const Point& greatest_degrees, Draw& draw) {
  Point angles;
  for (int i = 0; i < 3; ++i) angles[i] = greatest_degrees[i] * degree * draw.uniform(-1, 1);
  return angles;
}

/// A place whose projection is in the image, some pixels from its border.
Point random_place(const HeadViewOptions& options, Draw& draw) {
  const Camera camera = head_camera();
  constexpr double border = 60;
  const double depth = draw.uniform(options.nearest, options.farthest);
  const double u = draw.uniform(border, camera.width - border);
  const double v = draw.uniform(border, camera.height - border);
  return camera.unproject(u, v, depth);
}

void add_shoulders(Scene& scene, const Eigen::Isometry3d& camera_from_shoulders, Draw& draw) {
  const double width = draw.uniform(180, 230);
  const double drop = draw.uniform(-280, -240);
  const auto part = [&](const Point& centre, const Point& radii) {
    scene.add_ellipsoid(camera_from_shoulders * Eigen::Translation3d(centre), radii);
  };
  part({0, drop, -40}, {width, 75, 85});
  part({0, drop - 150, -30}, {0.75 * width, 190, 110});
}

/// Something before the head, beside it, or behind.
void add_clutter(Scene& scene, const Point& head, Draw& draw) {
  const bool is_before = draw.chance(0.5);
  const Point away = is_before
                         ? Point(draw.uniform(-160, 160), draw.uniform(-60, 200), draw.uniform(-260, -150))
                         : Point(draw.uniform(-500, 500), draw.uniform(-300, 300), draw.uniform(150, 700));
  const double size = is_before ? draw.uniform(20, 60) : draw.uniform(60, 400);
  const Point radii(size * draw.uniform(0.5, 1.5), size * draw.uniform(0.5, 1.5),
                    size * draw.uniform(0.3, 1));
  scene.add_ellipsoid(placed(head + away, random_angles({180, 90, 180}, draw)), radii);
}

HeadView seen_view(const Scene& scene, const HeadViewOptions& options, Draw& draw) {
  const Image<Fragment> seen = render_mesh(scene.vertices, scene.triangles, head_camera());
  HeadView view;
  view.shown = Image<Shown>(seen.width(), seen.height(), Shown::nothing);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const int triangle = seen.data()[i].triangle;
    if (triangle >= 0) view.shown.data()[i] = scene.what[static_cast<std::size_t>(triangle)];
  }
  view.depth = depth_of(seen);
  if (options.noise > 0) {
    const DepthSensorSettings kinect{options.noise, options.noise, options.noise, 80, 75};
    const DepthSensor sensor(kinect, head_camera(), draw.index(std::size_t{1} << 32));
    view.depth = sensor.sense_reference(view.depth, 1);
  }
  return view;
}

}  // namespace

Camera head_camera() { return {525, 525, 319.5, 239.5, 640, 480}; }

HeadViews::HeadViews(std::vector<Figure> heads, const HeadViewOptions& options)
    : heads_(std::move(heads)), options_(options) {}

HeadView HeadViews::draw(Draw& draw) const {
  const Figure& head = heads_[draw.index(heads_.size())];
  const Point place = random_place(options_, draw);
  const Point angles = random_angles(options_.greatest_angles, draw);
  const Eigen::Isometry3d camera_from_head = placed(place, angles);
  const Eigen::Isometry3d camera_from_shoulders =
      placed(place, angles.cwiseProduct(Point(0.4, 0.3, 0.2)) + random_angles({20, 10, 8}, draw));
  std::vector<Point> vertices = random_form(head, draw);
  vary_head(vertices, options_.variety, draw);
  std::vector<Shown> above_neck;
  for (const auto& face : head.mesh.triangles)
    above_neck.push_back(vertices[static_cast<std::size_t>(face[0])].y() > chin ? Shown::head : Shown::other);
  const bool has_shoulders = draw.chance(options_.company);
  if (has_shoulders)
    bend_neck(vertices, camera_from_head, camera_from_shoulders);
  else
    for (Point& vertex : vertices) vertex = camera_from_head * vertex;
  Scene scene;
  scene.add(vertices, head.mesh.triangles, Shown::head);
  scene.what = std::move(above_neck);
  if (has_shoulders) add_shoulders(scene, camera_from_shoulders, draw);
  if (draw.chance(options_.company)) add_clutter(scene, place, draw);
  HeadView view = seen_view(scene, options_, draw);
  view.camera_from_head = camera_from_head;
  return view;
}

HeadView draw_figure(const Figure& figure, const HeadViewOptions& options, Draw& draw) {
  std::vector<Point> vertices = random_form(figure, draw);
  const Point middle = box_around(vertices).center();
  const Eigen::Isometry3d pose =
      placed(random_place(options, draw), random_angles(options.greatest_angles, draw));
  for (Point& vertex : vertices) vertex = pose * (vertex - middle);
  Scene scene;
  scene.add(vertices, figure.mesh.triangles, Shown::other);
  return seen_view(scene, options, draw);
}

}  // namespace pliant
