#include "framework/deformation/warm_start.h"

#include <algorithm>

#include "framework/deformation/warp.h"

namespace pliant {
namespace {

using Affine = Eigen::Matrix<float, 3, 4>;  // columns of R - I, then t

/// The blended deformation [Eq. 4.1] about one point of the surface, as an affine form centred there;
/// `influences`: of points among which it is number `place`.
Affine blend(const SurfaceDeformation& before, int point, const Influences& influences, std::size_t place,
             const std::vector<Eigen::Vector3f>& points) {
  Affine blended = Affine::Zero();
  const auto k = static_cast<std::size_t>(influences.per_point);
  for (std::size_t slot = k * place; slot < k * (place + 1); ++slot) {
    const auto node = static_cast<std::size_t>(influences.nodes.host()[slot]);
    const float weight = influences.weights.host()[slot];
    const Eigen::Map<const Affine> form(before.affine.host().data() + affine_size * node);
    const Eigen::Vector3f arm =
        points[static_cast<std::size_t>(point)] - points[static_cast<std::size_t>(before.nodes[node])];
    blended += weight * form;
    blended.col(3) += weight * (form.leftCols<3>() * arm);
  }
  return blended;
}

}  // namespace

Array<float> carry_over(Device& device, const SurfaceDeformation& before, const std::vector<int>& nodes,
                        const std::vector<Eigen::Vector3f>& points) {
  const Influences influences = pick_influences(device, before.influences, Array<int>(nodes));
  std::vector<float> affine(affine_size * nodes.size());
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    Eigen::Map<Affine> form(affine.data() + affine_size * j);
    const auto old = std::lower_bound(before.nodes.begin(), before.nodes.end(), nodes[j]);
    if (old != before.nodes.end() && *old == nodes[j])
      form = Eigen::Map<const Affine>(before.affine.host().data() +
                                      affine_size * static_cast<std::size_t>(old - before.nodes.begin()));
    else
      form = blend(before, nodes[j], influences, j, points);
  }
  return Array<float>(std::move(affine));
}

}  // namespace pliant
