#include "framework/registration/correspondence.h"

#include <cmath>
#include <memory>
#include <numbers>

#include "framework/registration/projection.cl.embed.h"
#include "framework/registration/projection.h"
#include "framework/registration/projective.h"

namespace pliant {

ProjectiveCorrespondence::ProjectiveCorrespondence(double max_distance, double max_angle)
    : max_distance_(static_cast<float>(max_distance)),
      least_cosine_(static_cast<float>(std::cos(max_angle))) {}

void ProjectiveCorrespondence::match(Device& device, const PointSet& moved, const Array<int>& selected,
                                     const Target& target, Constraints& constraints) const {
  auto kernel = device.kernel(embedded::framework_registration_projection_cl, "match");
  device.run("match", kernel, selected.size(), 64, static_cast<cl_int>(selected.size()),
             selected.device(device), constraints.points.device(device), moved.points.device(device),
             moved.normals.device(device), pinhole(target.camera), image_size(target.camera),
             target.points.device(device), target.normals.device(device), max_distance_, least_cosine_,
             constraints.data.write_device(device), constraints.confidence.write_device(device));
}

void ProjectiveCorrespondence::match_reference(const PointSet& moved, const Array<int>& selected,
                                               const Target& target, Constraints& constraints) const {
  using Vector = Eigen::Map<const Eigen::Vector3f>;
  auto& data = constraints.data.write_host();
  auto& confidence = constraints.confidence.write_host();
  for (std::size_t i = 0; i < selected.size(); ++i) {
    const auto point = 3 * static_cast<std::size_t>(selected.host()[i]);
    const Vector p(moved.points.host().data() + point);
    const Vector normal(moved.normals.host().data() + point);
    Eigen::Map<Eigen::Vector3f> pull(data.data() + 6 * i);
    Eigen::Map<Eigen::Vector3f> target_normal(data.data() + 6 * i + 3);
    pull.setZero();
    target_normal.setZero();
    confidence[i] = 0;
    const auto pixel = target_pixel_reference(target, p);
    if (!pixel) continue;
    const Vector q(target.points.host().data() + 3 * *pixel);
    target_normal = Vector(target.normals.host().data() + 3 * *pixel);
    const bool has_normals = normal.squaredNorm() > 0 && target_normal.squaredNorm() > 0;
    const bool is_alike = !has_normals || normal.dot(target_normal) >= least_cosine_;
    confidence[i] = is_alike && (p - q).norm() <= max_distance_ ? 1.0F : 0.0F;
    pull = q - Vector(constraints.points.host().data() + 3 * i);
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
      },
      [](const Parameters& parameters, const Registry&) {
        return std::make_unique<ProjectiveCorrespondence>(
            parameters.real("max_distance"), parameters.real("max_angle") * std::numbers::pi / 180);
      });
}

}  // namespace pliant
