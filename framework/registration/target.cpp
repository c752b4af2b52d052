#include "framework/registration/target.h"

namespace pliant {
namespace {

Array<float> flatten(const Image<Eigen::Vector3f>& image) {
  std::vector<float> values;
  values.reserve(3 * image.size());
  for (const auto& vector : image.pixels()) values.insert(values.end(), vector.data(), vector.data() + 3);
  return Array<float>(std::move(values));
}

}  // namespace

Target::Target(const Camera& camera, const SurfaceMap& map)
    : camera(camera), points(flatten(map.points)), normals(flatten(map.normals)) {}

}  // namespace pliant
