#include "framework/geometry/point_set.h"

namespace pliant {

static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float), "vectors lie next to each other without gaps");

Array<float> flatten(const std::vector<Eigen::Vector3f>& vectors) {
  if (vectors.empty()) return {};
  const float* values = vectors.front().data();
  return Array<float>(std::vector<float>(values, values + 3 * vectors.size()));
}

std::vector<Eigen::Vector3f> unflatten(const Array<float>& values) {
  std::vector<Eigen::Vector3f> vectors(values.size() / 3);
  if (!vectors.empty()) values.copy_to(vectors.front().data());
  return vectors;
}

}  // namespace pliant
