#include "framework/pose/align_centroids.h"

#include <fmt/format.h>

#include <memory>

#include "framework/core/error.h"
#include "framework/pose/alignment.h"

namespace pliant {
namespace {

/// The middle of all points of a map, mm. `whose` map it is, for the error.
Eigen::Vector3d centroid(const SurfaceMap& map, const std::string& whose) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (const Eigen::Vector3f& point : unflatten(map.points())) {
    if (!(point.z() > 0)) continue;
    sum += point.cast<double>();
    ++count;
  }
  if (count == 0) throw DataError(whose + " has no point");
  return sum / count;
}

class CentroidAlignment : public Alignment {
 public:
  explicit CentroidAlignment(double longest) : longest_(longest) {}

  AlignmentResult align(const AlignmentInput& input) const override {
    const std::string& name = input.pair.name;
    const Eigen::Vector3d shift =
        centroid(input.target, name + ": the target") - centroid(input.source, name + ": the source");
    AlignmentResult result;
    result.reason = fmt::format("the centroids are {:.1f} mm apart", shift.norm());
    result.failed = shift.norm() > longest_;
    if (result.failed) return result;
    result.motion = Eigen::Translation3d(shift);
    result.method = "centroids";
    return result;
  }

 private:
  double longest_;
};

std::unique_ptr<Alignment> make_centroids(const Parameters& section, const Registry& /*components*/) {
  return std::make_unique<CentroidAlignment>(section.real("longest"));
}

}  // namespace

void register_centroid_alignment(Registry& registry) {
  registry.add<Alignment>(
      "centroids", "Moves the centroid of the source to that of the target",
      {real("longest", 500).unit("mm").above(0).doc("a longer way is taken for a mistake")}, make_centroids);
}

}  // namespace pliant
