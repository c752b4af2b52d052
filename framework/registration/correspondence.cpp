#include "framework/registration/correspondence.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "framework/registration/projection.h"
#include "framework/registration/projective.h"

namespace pliant {

namespace {

using Vector = Eigen::Map<const Eigen::Vector3f>;

Vector at(const Array<float>& vectors, std::size_t index) {
  return Vector(vectors.host().data() + 3 * index);
}

}  // namespace

bool any_in_force(Device& device, const Constraints& constraints) {
  auto kernel = projection_kernel(device, "find_in_force");
  Array<int> found(1);
  device.run("match", kernel, 1, 1, static_cast<cl_int>(constraints.size()),
             constraints.confidence.device(device), found.write_device(device));
  return found.host().front() != 0;
}

void weigh(Device& device, const Array<float>& weights, Constraints& constraints) {
  auto kernel = projection_kernel(device, "weigh");
  device.run("match", kernel, constraints.size(), 64, static_cast<cl_int>(constraints.size()),
             weights.device(device), constraints.confidence.write_device(device));
}

ProjectiveCorrespondence::ProjectiveCorrespondence(double max_distance, double max_angle, int search_radius)
    : max_distance_(static_cast<float>(max_distance)),
      least_cosine_(static_cast<float>(std::cos(max_angle))),
      search_radius_(search_radius) {}

void ProjectiveCorrespondence::match(Device& device, const PointSet& moved, const Array<int>& selected,
                                     const Target& target, Constraints& constraints) const {
  auto kernel = projection_kernel(device, "match");
  device.run("match", kernel, selected.size(), 64, static_cast<cl_int>(selected.size()),
             selected.device(device), constraints.points.device(device), moved.points.device(device),
             moved.normals.device(device), pinhole(target.camera), image_size(target.camera),
             target.points.device(device), target.normals.device(device), max_distance_, least_cosine_,
             static_cast<cl_int>(search_radius_), constraints.data.write_device(device),
             constraints.confidence.write_device(device));
}

void ProjectiveCorrespondence::measure(Device& device, const PointSet& moved, const Target& target,
                                       Array<float>& distances) const {
  auto kernel = projection_kernel(device, "measure");
  device.run("residual", kernel, distances.size(), 64, static_cast<cl_int>(distances.size()),
             moved.points.device(device), moved.normals.device(device), pinhole(target.camera),
             image_size(target.camera), target.points.device(device), target.normals.device(device),
             max_distance_, least_cosine_, distances.write_device(device));
}

void ProjectiveCorrespondence::measure_reference(const PointSet& moved, const Target& target,
                                                 std::vector<float>& distances) const {
  distances.assign(moved.points.size() / 3, -1);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const Eigen::Vector3f point = at(moved.points, i);
    const auto pixel = target_pixel_reference(target, point);
    if (pixel && accepts(target, *pixel, point, at(moved.normals, i)))
      distances[i] = (point - at(target.points, *pixel)).norm();
  }
}

bool ProjectiveCorrespondence::accepts(const Target& target, std::size_t pixel, const Eigen::Vector3f& point,
                                       const Eigen::Vector3f& normal) const {
  const Eigen::Vector3f target_normal = finite_or_none(target.normals, pixel);
  const bool has_normals = normal.squaredNorm() > 0 && target_normal.squaredNorm() > 0;
  return (point - at(target.points, pixel)).norm() <= max_distance_ &&
         (!has_normals || normal.dot(target_normal) >= least_cosine_);
}

std::optional<std::size_t> ProjectiveCorrespondence::match_point(const Target& target,
                                                                 const Eigen::Vector3f& point,
                                                                 const Eigen::Vector3f& normal) const {
  const auto projected = target_pixel_reference(target, point);
  if (projected && accepts(target, *projected, point, normal)) return projected;
  if (search_radius_ == 0 || !(point.z() > 0)) return std::nullopt;
  const Eigen::Vector2d centre = target.camera.project(point.cast<double>()).array().round();
  std::optional<std::size_t> best;
  for (int v = 0; v < target.camera.height; ++v)
    for (int u = 0; u < target.camera.width; ++u) {
      if (std::abs(u - centre.x()) > search_radius_ || std::abs(v - centre.y()) > search_radius_) continue;
      const auto pixel = static_cast<std::size_t>(v) * static_cast<std::size_t>(target.camera.width) +
                         static_cast<std::size_t>(u);
      if (!(finite_or_none(target.points, pixel).z() > 0) || !accepts(target, pixel, point, normal)) continue;
      const auto distance = [&](std::size_t offset) { return (point - at(target.points, offset)).norm(); };
      if (!best || distance(pixel) < distance(*best)) best = pixel;
    }
  return best;
}

void ProjectiveCorrespondence::match_reference(const PointSet& moved, const Array<int>& selected,
                                               const Target& target, Constraints& constraints) const {
  auto& data = constraints.data.write_host();
  auto& confidence = constraints.confidence.write_host();
  std::fill(data.begin(), data.end(), 0.0F);
  for (std::size_t i = 0; i < selected.size(); ++i) {
    const auto point = static_cast<std::size_t>(selected.host()[i]);
    const auto pixel = match_point(target, at(moved.points, point), at(moved.normals, point));
    confidence[i] = pixel ? 1.0F : 0.0F;
    if (!pixel) continue;
    Eigen::Map<Eigen::Vector3f>(data.data() + 6 * i) = at(target.points, *pixel) - at(constraints.points, i);
    Eigen::Map<Eigen::Vector3f>(data.data() + 6 * i + 3) = finite_or_none(target.normals, *pixel);
  }
}

void register_correspondences(Registry& registry) {
  registry.add<Correspondence>(
      "projective", "The target point at the pixel that a source point projects to [thesis 4.2]",
      {
          real("max_distance", 100).unit("mm").above(0).doc("A match further away is rejected"),
          real("max_angle", 75)
              .unit("degree")
              .range(0, 180)
              .doc(
                  "A match whose normals differ by more is rejected; without normals distance alone decides"),
          integer("search_radius", 0)
              .unit("pixel")
              .range(0, 512)
              .doc("Where the match is rejected, the nearest acceptable target point within this is taken"),
      },
      [](const Parameters& parameters, const Registry&) {
        return std::make_unique<ProjectiveCorrespondence>(
            parameters.real("max_distance"), parameters.real("max_angle") * std::numbers::pi / 180,
            static_cast<int>(parameters.integer("search_radius")));
      });
}

}  // namespace pliant
