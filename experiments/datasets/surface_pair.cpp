#include "experiments/datasets/surface_pair.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "experiments/datasets/mesh_size.h"
#include "experiments/datasets/stored_pair.h"
#include "experiments/datasets/virtual_camera.h"
#include "framework/core/angle.h"
#include "framework/core/error.h"
#include "framework/geometry/bounding_box.h"
#include "framework/geometry/render.h"
#include "framework/geometry/rig.h"
#include "framework/io/surface_mesh.h"

namespace pliant {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// A surface of a file, and where its vertices are for the camera.
struct PlacedSurface {
  std::string path;
  SurfaceMesh mesh;
  Points points;  // mm

  Eigen::AlignedBox3d box() const { return box_around(points); }
};

PlacedSurface read_surface(const std::string& path, double unit) {
  PlacedSurface surface{path, read_surface_mesh(path, unit), {}};
  for (const Eigen::Vector3f& vertex : surface.mesh.vertices) surface.points.push_back(vertex.cast<double>());
  return surface;
}

std::string place_and_size(const PlacedSurface& surface, double unit) {
  return fmt::format("{}: {}", surface.path, described_size(surface.box(), unit, "unit"));
}

std::vector<std::string> doubts_about_size(const PlacedSurface& source, const PlacedSurface& target,
                                           double unit) {
  constexpr double most_unlike = 3;
  std::vector<std::string> doubts;
  for (const PlacedSurface* surface : {&source, &target})
    if (is_odd_size(surface->box())) doubts.push_back(place_and_size(*surface, unit));
  const double ratio = source.box().diagonal().norm() / target.box().diagonal().norm();
  if (ratio > most_unlike || ratio < 1 / most_unlike)
    doubts.push_back(fmt::format("{} is {:.3g} times as large as {}; do both count in one unit?",
                                 ratio > 1 ? source.path : target.path, std::max(ratio, 1 / ratio),
                                 ratio > 1 ? target.path : source.path));
  return doubts;
}

void move(const Eigen::Isometry3d& motion, Points& points) {
  for (Eigen::Vector3d& point : points) point = motion * point;
}

/// How far away points around the optical axis, mm, fill the image up to a margin.
double fitting_distance(const Points& points, const Camera& camera) {
  constexpr double share = 0.9;
  const double half_width = share * std::min(camera.cx, camera.width - 1 - camera.cx);
  const double half_height = share * std::min(camera.cy, camera.height - 1 - camera.cy);
  if (!(half_width > 0 && half_height > 0))
    throw ConfigError(
        "surface_pair: the principal point is not inside the image; say by 'camera_from_surface' where the "
        "camera is");
  double distance = 0;
  for (const Eigen::Vector3d& point : points)
    distance = std::max({distance, camera.fx * std::abs(point.x()) / half_width - point.z(),
                         camera.fy * std::abs(point.y()) / half_height - point.z()});
  return distance;
}

/// Puts both before the camera, and their common middle on its axis.
void place(const SurfacePair::Settings& settings, PlacedSurface& source, PlacedSurface& target) {
  if (settings.camera_from_surface) {
    move(*settings.camera_from_surface, source.points);
    move(*settings.camera_from_surface, target.points);
    return;
  }
  const Eigen::Vector3d middle = source.box().merged(target.box()).center();
  Eigen::Isometry3d turned = Eigen::Isometry3d::Identity();
  turned.rotate(settings.turn * Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()));
  turned.translate(-middle);
  move(turned, source.points);
  move(turned, target.points);
  const double distance = settings.distance.value_or(std::max(
      fitting_distance(source.points, settings.camera), fitting_distance(target.points, settings.camera)));
  const Eigen::Isometry3d away(Eigen::Translation3d(0, 0, distance));
  move(away, source.points);
  move(away, target.points);
  for (const PlacedSurface* surface : {&source, &target})
    if (surface->box().min().z() <= 0)
      throw DataError(fmt::format("the camera is inside {:g} mm before the middle; {}", distance,
                                  place_and_size(*surface, settings.unit)));
}

void check_correspondence(const PlacedSurface& source, const PlacedSurface& target) {
  const std::size_t vertices = source.points.size();
  if (target.points.size() != vertices)
    throw DataError(
        fmt::format("{}: {} vertices, but {} has {}; 'corresponding' surfaces have the same vertices",
                    target.path, target.points.size(), source.path, vertices));
  const auto& triangles = source.mesh.triangles;
  const auto& others = target.mesh.triangles;
  const auto [differing, other] =
      std::mismatch(triangles.begin(), triangles.end(), others.begin(), others.end());
  if (differing != triangles.end() || other != others.end())
    throw DataError(
        fmt::format("{}: triangle {} is not that of {}; 'corresponding' surfaces have the same faces",
                    target.path, differing - triangles.begin(), source.path));
}

ColorImage colors_of(const Image<Fragment>& seen, const SurfaceMesh& mesh) {
  Points colors;
  for (const Rgb& color : mesh.colors) colors.emplace_back(color.r, color.g, color.b);
  ColorImage image(seen.width(), seen.height());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Fragment& fragment = seen.data()[i];
    if (fragment.triangle < 0) continue;
    const Eigen::Vector3d color = interpolate(fragment, mesh.triangles, colors);
    const auto byte = [](double value) { return static_cast<std::uint8_t>(std::lround(value)); };
    image.data()[i] = {byte(color.x()), byte(color.y()), byte(color.z())};
  }
  return image;
}

Image<Fragment> render(const PlacedSurface& surface, const SurfacePair::Settings& settings) {
  Image<Fragment> seen = render_mesh(surface.points, surface.mesh.triangles, settings.camera);
  const auto shows = [](const Fragment& fragment) { return fragment.triangle >= 0; };
  if (std::none_of(seen.pixels().begin(), seen.pixels().end(), shows))
    throw DataError("no pixel of the camera sees " + place_and_size(surface, settings.unit));
  return seen;
}

Eigen::Isometry3d pose_of(const Parameters& section) {
  const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> matrix(section.reals("camera_from_surface").data());
  if (!is_rigid(matrix))
    throw ConfigError(
        fmt::format("{}: 'camera_from_surface' is no rigid motion; expected a 4x4 matrix row by row: [R, "
                    "t; 0 0 0 1] with a rotation R and t in mm",
                    section.place()));
  return Eigen::Isometry3d(matrix);
}

SurfacePair::Settings settings_of(const Parameters& section) {
  const auto turn = [&](const char* name, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(section.real(name) * degree, axis);
  };
  SurfacePair::Settings settings;
  settings.source = section.text("source");
  settings.target = section.text("target");
  settings.unit = section.real("unit");
  settings.corresponding = section.boolean("corresponding");
  settings.camera = virtual_camera(section);
  settings.turn =
      (turn("rotation_x", Eigen::Vector3d::UnitX()) * turn("rotation_y", Eigen::Vector3d::UnitY()))
          .toRotationMatrix();
  if (section.has("distance")) settings.distance = section.real("distance");
  if (section.has("camera_from_surface")) settings.camera_from_surface = pose_of(section);
  return settings;
}

}  // namespace

std::unique_ptr<DataStream> SurfacePair::open(Device& /*device*/, std::uint64_t /*seed*/) const {
  PlacedSurface source = read_surface(settings_.source, settings_.unit);
  PlacedSurface target = read_surface(settings_.target, settings_.unit);
  StoredPair pair;
  const auto stem = [](const std::string& path) { return std::filesystem::path(path).stem().string(); };
  pair.name = stem(settings_.source) + " to " + stem(settings_.target);
  pair.warnings = doubts_about_size(source, target, settings_.unit);
  place(settings_, source, target);
  const Image<Fragment> seen_source = render(source, settings_);
  const Image<Fragment> seen_target = render(target, settings_);
  pair.rig.depth = settings_.camera;
  pair.source.depth = depth_of(seen_source);
  pair.target.depth = depth_of(seen_target);
  if (!source.mesh.colors.empty() && !target.mesh.colors.empty()) {
    pair.source.color = colors_of(seen_source, source.mesh);
    pair.target.color = colors_of(seen_target, target.mesh);
  }
  if (settings_.corresponding) {
    check_correspondence(source, target);
    pair.truth = PairTruth{scene_flow(seen_source, source.mesh.triangles, source.points, target.points)};
  }
  return std::make_unique<StoredPairStream>(std::move(pair));
}

void register_surface_pair(Registry& registry) {
  registry.add<FrameSource>(
      "surface_pair", "Two surfaces from PLY or OBJ files, seen by a virtual depth camera",
      with_camera({
          path("source").doc("PLY or OBJ file with faces: the surface that is deformed"),
          path("target").doc("likewise: the surface it is deformed to, in the same frame"),
          real("unit", 1).unit("mm").above(0).doc(
              "what a unit of the files is; 1000 where they count metres"),
          boolean("corresponding", false)
              .doc("both have the same vertices and faces, so that the motion is known"),
          reals("camera_from_surface", 16)
              .unit("mm")
              .optional()
              .doc("4x4 matrix, row by row, from the surfaces' frame to the camera's; by default it looks at "
                   "them"),
          real("rotation_x", 0)
              .unit("degree")
              .range(-180, 180)
              .doc("turn about the camera's x axis, without such"),
          real("rotation_y", 0)
              .unit("degree")
              .range(-180, 180)
              .doc("turn about its y axis, before, likewise"),
          real("distance")
              .unit("mm")
              .above(0)
              .optional()
              .doc("to their middle, likewise; they fill the image by default"),
      }),
      [](const Parameters& section, const Registry&) -> std::unique_ptr<FrameSource> {
        return std::make_unique<SurfacePair>(settings_of(section));
      });
}

}  // namespace pliant
