#include "experiments/view/model_distance.h"

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace pliant {

Image<float> model_distances(const SurfaceMap& seen, const SurfaceMap& model) {
  if (!(seen.window == model.window))
    throw std::invalid_argument("a frame and a model are compared in one window");
  const float* points = seen.points().host().data();
  const float* places = model.points().host().data();
  const float* normals = model.normals().host().data();
  Image<float> distances(seen.window.width, seen.window.height, std::numeric_limits<float>::quiet_NaN());
  using Vector = Eigen::Map<const Eigen::Vector3f>;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const Vector point(points + 3 * i);
    const Vector place(places + 3 * i);
    const Vector normal(normals + 3 * i);
    if (point.z() > 0 && place.z() > 0 && !normal.isZero(0))
      distances.data()[i] = std::abs(normal.dot(point - place));
  }
  return distances;
}

}  // namespace pliant
