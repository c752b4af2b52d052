#include "framework/deformation/warm_start.h"

#include <algorithm>

#include "framework/deformation/warp.h"

namespace pliant {

AffineForm blended_form(const std::vector<Eigen::Vector3f>& nodes, const Array<float>& affine,
                        const Influences& influences, std::size_t place, const Eigen::Vector3f& point) {
  AffineForm blended = AffineForm::Zero();
  const auto k = static_cast<std::size_t>(influences.per_point);
  for (std::size_t slot = k * place; slot < k * (place + 1); ++slot) {
    const auto node = static_cast<std::size_t>(influences.nodes.host()[slot]);
    const float weight = influences.weights.host()[slot];
    const Eigen::Map<const AffineForm> form(affine.host().data() + affine_size * node);
    const Eigen::Vector3f arm = point - nodes[node];
    blended += weight * form;
    blended.col(3) += weight * (form.leftCols<3>() * arm);
  }
  return blended;
}

Array<float> carry_over(Device& device, const SurfaceDeformation& before, const EmbeddedGraph& next) {
  const std::vector<int>& nodes = before.graph.nodes;
  const Influences influences = pick_influences(device, before.graph.influences, Array<int>(next.nodes));
  std::vector<float> affine(affine_size * next.nodes.size());
  for (std::size_t j = 0; j < next.nodes.size(); ++j) {
    Eigen::Map<AffineForm> form(affine.data() + affine_size * j);
    const auto old = std::lower_bound(nodes.begin(), nodes.end(), next.nodes[j]);
    if (old != nodes.end() && *old == next.nodes[j])
      form = Eigen::Map<const AffineForm>(before.affine.host().data() +
                                          affine_size * static_cast<std::size_t>(old - nodes.begin()));
    else
      form = blended_form(before.graph.positions, before.affine, influences, j, next.positions[j]);
  }
  return Array<float>(std::move(affine));
}

}  // namespace pliant
