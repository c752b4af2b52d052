#include "framework/registration/correspondence.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "framework/core/angle.h"
#include "framework/registration/matching.h"
#include "framework/registration/projective.h"

namespace pliant {

namespace {

using Vector = Eigen::Map<const Eigen::Vector3f>;

Vector at(const Array<float>& vectors, std::size_t index) {
  return Vector(vectors.host().data() + 3 * index);
}

constexpr float steepest_slope = 10;  // STEEPEST_SLOPE in matching.cl

Eigen::Vector3f mean_normal(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  const Eigen::Vector3f sum = a + b;
  return sum.squaredNorm() > 1e-6F ? Eigen::Vector3f(sum.normalized()) : Eigen::Vector3f::Zero();
}

}  // namespace

bool any_in_force(Device& device, const Constraints& constraints) {
  auto kernel = matching_kernel(device, "find_in_force");
  Array<int> found(1);
  device.run("match", kernel, 1, 1, static_cast<cl_int>(constraints.size()),
             constraints.confidence.device(device), found.write_device(device));
  return found.host().front() != 0;
}

void weigh(Device& device, const Array<float>& weights, Constraints& constraints) {
  auto kernel = matching_kernel(device, "weigh");
  device.run("match", kernel, constraints.size(), 64, static_cast<cl_int>(constraints.size()),
             weights.device(device), constraints.confidence.write_device(device));
}

ProjectiveCorrespondence::ProjectiveCorrespondence(const ProjectiveOptions& options)
    : options_(options),
      max_distance_(static_cast<float>(options.max_distance)),
      least_cosine_(static_cast<float>(std::cos(options.max_angle))),
      least_facing_(static_cast<float>(std::cos(options.max_view_angle))) {}

void ProjectiveCorrespondence::match(Device& device, const PointSet& moved, const Array<int>& selected,
                                     const SurfaceMap& target, Constraints& constraints) const {
  auto kernel = matching_kernel(device, "match");
  const auto width = static_cast<std::size_t>(device.width());
  device.run("match", kernel, (selected.size() + width - 1) / width, 4, static_cast<cl_int>(selected.size()),
             selected.device(device), constraints.points.device(device), moved.points.device(device),
             moved.normals.device(device), pinhole(target.camera), frame_of(target),
             target.points().device(device), target.normals().device(device), max_distance_, least_cosine_,
             least_facing_, cl_int{hole_radius()}, cl_int{options_.search_radius}, cl_int{options_.steps},
             cl_int{options_.rim}, cl_int{options_.symmetric}, constraints.data.write_device(device),
             constraints.confidence.write_device(device));
}

void ProjectiveCorrespondence::measure(Device& device, const PointSet& moved, const SurfaceMap& target,
                                       Array<float>& distances) const {
  auto kernel = matching_kernel(device, "measure");
  const auto width = static_cast<std::size_t>(device.width());
  device.run("residual", kernel, (distances.size() + width - 1) / width, 16,
             static_cast<cl_int>(distances.size()), moved.points.device(device), moved.normals.device(device),
             pinhole(target.camera), frame_of(target), target.points().device(device),
             target.normals().device(device), max_distance_, least_cosine_, least_facing_,
             cl_int{hole_radius()}, distances.write_device(device));
}

void ProjectiveCorrespondence::measure_reference(const PointSet& moved, const SurfaceMap& target,
                                                 std::vector<float>& distances) const {
  distances.assign(moved.points.size() / 3, -1);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const Eigen::Vector3f point = at(moved.points, i);
    const Eigen::Vector3f normal = at(moved.normals, i);
    Pixel pixel = seen_pixel_reference(target, point);
    if (!pixel) pixel = search(target, point, normal, hole_radius());
    if (pixel && is_facing(point, normal) && accepts(target, *pixel, point, normal))
      distances[i] = (point - at(target.points(), *pixel)).norm();
  }
}

bool ProjectiveCorrespondence::accepts(const SurfaceMap& target, std::size_t pixel,
                                       const Eigen::Vector3f& point, const Eigen::Vector3f& normal) const {
  const Eigen::Vector3f target_normal = finite_or_none(target.normals(), pixel);
  const bool has_normals = normal.squaredNorm() > 0 && target_normal.squaredNorm() > 0;
  return (point - at(target.points(), pixel)).norm() <= max_distance_ &&
         (!has_normals || normal.dot(target_normal) >= least_cosine_);
}

bool ProjectiveCorrespondence::is_facing(const Eigen::Vector3f& point, const Eigen::Vector3f& normal) const {
  return !(normal.squaredNorm() > 0) || -normal.dot(point) >= least_facing_ * point.norm();
}

bool ProjectiveCorrespondence::is_rim(const SurfaceMap& target, std::size_t pixel) const {
  const int width = target.window.width;
  const int u = static_cast<int>(pixel) % width;
  const int v = static_cast<int>(pixel) / width;
  const int rim = options_.rim;
  if (u < rim || v < rim || u + rim >= width || v + rim >= target.window.height) return true;
  const float z = at(target.points(), pixel).z();
  const float jump = steepest_slope * static_cast<float>(rim) * z /
                     static_cast<float>(std::max(target.camera.fx, target.camera.fy));
  for (const int dv : {-rim, 0, rim})
    for (const int du : {-rim, 0, rim}) {
      const float other =
          finite_or_none(target.points(), static_cast<std::size_t>((v + dv) * width + u + du)).z();
      if (!(other > 0 && std::abs(other - z) <= jump)) return true;
    }
  return false;
}

std::size_t ProjectiveCorrespondence::walk(const SurfaceMap& target, const Eigen::Vector3f& point,
                                           std::size_t pixel) const {
  const auto distance = [&](std::size_t to) { return (point - at(target.points(), to)).norm(); };
  for (int step = 0; step < options_.steps; ++step) {
    const Eigen::Vector3f n = finite_or_none(target.normals(), pixel);
    const Eigen::Vector3f foot = point - (point - at(target.points(), pixel)).dot(n) * n;
    const Pixel next = seen_pixel_reference(target, foot);
    if (next == pixel) return pixel;
    if (!next || !(distance(*next) < distance(pixel))) break;
    pixel = *next;
  }
  const int width = target.window.width;
  for (int step = 0; step < options_.steps; ++step) {
    const std::size_t before = pixel;
    const int u = static_cast<int>(pixel) % width;
    const int v = static_cast<int>(pixel) / width;
    for (int y = std::max(v - 1, 0); y <= std::min(v + 1, target.window.height - 1); ++y)
      for (int x = std::max(u - 1, 0); x <= std::min(u + 1, width - 1); ++x) {
        const auto next = static_cast<std::size_t>(y * width + x);
        if (finite_or_none(target.points(), next).z() > 0 && distance(next) < distance(pixel)) pixel = next;
      }
    if (pixel == before) break;
  }
  return pixel;
}

ProjectiveCorrespondence::Pixel ProjectiveCorrespondence::search(const SurfaceMap& target,
                                                                 const Eigen::Vector3f& point,
                                                                 const Eigen::Vector3f& normal,
                                                                 int radius) const {
  if (radius == 0 || !(point.z() > 0)) return std::nullopt;
  const Eigen::Vector2d centre = target.camera.project(point.cast<double>()).array().round();
  Pixel best;
  const PixelWindow& window = target.window;
  for (int v = window.top; v < window.top + window.height; ++v)
    for (int u = window.left; u < window.left + window.width; ++u) {
      if (std::abs(u - centre.x()) > radius || std::abs(v - centre.y()) > radius) continue;
      const std::size_t pixel = window.offset(u, v);
      if (!(finite_or_none(target.points(), pixel).z() > 0) || !accepts(target, pixel, point, normal))
        continue;
      const auto distance = [&](std::size_t offset) { return (point - at(target.points(), offset)).norm(); };
      if (!best || distance(pixel) < distance(*best)) best = pixel;
    }
  return best;
}

ProjectiveCorrespondence::Pixel ProjectiveCorrespondence::match_point(const SurfaceMap& target,
                                                                      const Eigen::Vector3f& point,
                                                                      const Eigen::Vector3f& normal) const {
  if (!is_facing(point, normal)) return std::nullopt;
  Pixel pixel = seen_pixel_reference(target, point);
  if (!pixel) pixel = search(target, point, normal, hole_radius());
  if (pixel) pixel = walk(target, point, *pixel);
  if (!pixel || !accepts(target, *pixel, point, normal))
    pixel = search(target, point, normal, options_.search_radius);
  if (pixel && options_.rim > 0 && is_rim(target, *pixel)) return std::nullopt;
  return pixel;
}

void ProjectiveCorrespondence::match_reference(const PointSet& moved, const Array<int>& selected,
                                               const SurfaceMap& target, Constraints& constraints) const {
  auto& data = constraints.data.write_host();
  auto& confidence = constraints.confidence.write_host();
  std::fill(data.begin(), data.end(), 0.0F);
  for (std::size_t i = 0; i < selected.size(); ++i) {
    const auto point = static_cast<std::size_t>(selected.host()[i]);
    const Eigen::Vector3f normal = at(moved.normals, point);
    const Pixel pixel = match_point(target, at(moved.points, point), normal);
    confidence[i] = pixel ? 1.0F : 0.0F;
    if (!pixel) continue;
    Eigen::Vector3f plane = finite_or_none(target.normals(), *pixel);
    if (options_.symmetric && plane.squaredNorm() > 0) plane = mean_normal(plane, normal);
    Eigen::Map<Eigen::Vector3f>(data.data() + 6 * i) =
        at(target.points(), *pixel) - at(constraints.points, i);
    Eigen::Map<Eigen::Vector3f>(data.data() + 6 * i + 3) = plane;
  }
}

namespace {

/// Rows that all correspondences share, with defaults of their own.
std::vector<Parameter> match_rows(const ProjectiveOptions& defaults) {
  return {
      real("max_distance", defaults.max_distance).unit("mm").above(0).doc("A match further away is rejected"),
      real("max_angle", whole_degrees(defaults.max_angle))
          .unit("degree")
          .range(0, 180)
          .doc("A match whose normals differ by more is rejected; without normals distance alone decides"),
      real("max_view_angle", whole_degrees(defaults.max_view_angle))
          .unit("degree")
          .range(0, 180)
          .doc("A point whose normal turns further away from the camera cannot be seen and has no match"),
      integer("rim", defaults.rim)
          .unit("pixel")
          .range(0, 64)
          .doc(
              "A match so near to where the target ends or jumps in depth is rejected: what is hidden behind "
              "would be drawn there; 0: none is"),
  };
}

ProjectiveOptions read_match(const Parameters& parameters) {
  ProjectiveOptions options;
  options.max_distance = parameters.real("max_distance");
  options.max_angle = parameters.real("max_angle") * degree;
  options.max_view_angle = parameters.real("max_view_angle") * degree;
  options.rim = static_cast<int>(parameters.integer("rim"));
  return options;
}

void register_projective(Registry& registry) {
  std::vector<Parameter> rows = match_rows({});
  rows.push_back(
      integer("search_radius", 0)
          .unit("pixel")
          .range(0, 512)
          .doc("Where the match is rejected, the nearest acceptable target point within this is taken"));
  registry.add<Correspondence>(
      "projective", "The target point at the pixel that a source point projects to [thesis 4.2]",
      ParameterTable(std::move(rows)), [](const Parameters& parameters, const Registry&) {
        ProjectiveOptions options = read_match(parameters);
        options.search_radius = static_cast<int>(parameters.integer("search_radius"));
        return std::make_unique<ProjectiveCorrespondence>(options);
      });
}

void register_closest(Registry& registry) {
  ProjectiveOptions defaults;
  defaults.max_distance = 40;
  defaults.max_angle = 60 * degree;
  defaults.max_view_angle = 80 * degree;
  defaults.rim = 2;
  std::vector<Parameter> rows = match_rows(defaults);
  rows.push_back(integer("steps", 4)
                     .range(1, 64)
                     .doc("Longest walk, from tangent plane to tangent plane and then from pixel to pixel"));
  rows.push_back(
      choice("planes", {"symmetric", "target"}, "symmetric")
          .doc("Tangent planes that energies get: half-way between both normals of a match, or the "
               "target's"));
  registry.add<Correspondence>(
      "closest", "The target point closest in space, found from the pixel that a source point projects to",
      ParameterTable(std::move(rows)), [](const Parameters& parameters, const Registry&) {
        ProjectiveOptions options = read_match(parameters);
        options.steps = static_cast<int>(parameters.integer("steps"));
        options.symmetric = parameters.text("planes") == "symmetric";
        return std::make_unique<ProjectiveCorrespondence>(options);
      });
}

}  // namespace

void register_correspondences(Registry& registry) {
  register_projective(registry);
  register_closest(registry);
}

}  // namespace pliant
