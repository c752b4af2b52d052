#include "framework/model/node_field.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "framework/deformation/warm_start.h"
#include "framework/deformation/warp.h"
#include "framework/geometry/point_set.h"
#include "framework/model/node_field.cl.embed.h"

namespace pliant {
namespace {

constexpr double packing = 0.7;         // of the spacing: how near new nodes may be to one another
constexpr int fixed_point_rounds = 20;  // a motion by three quarters of what is left, to a part in 300

/// Whether any of some points is within a radius; those asked one after another mostly have the same one.
class Neighbourhood {
 public:
  Neighbourhood(const std::vector<Eigen::Vector3f>& points, double radius)
      : points_(points), squared_(static_cast<float>(radius * radius)) {}

  bool holds(const Eigen::Vector3f& point) {
    const auto is_near = [&](const Eigen::Vector3f& other) {
      return (other - point).squaredNorm() <= squared_;
    };
    if (last_ < points_.size() && is_near(points_[last_])) return true;
    last_ = static_cast<std::size_t>(std::find_if(points_.begin(), points_.end(), is_near) - points_.begin());
    return last_ < points_.size();
  }

 private:
  const std::vector<Eigen::Vector3f>& points_;
  float squared_;
  std::size_t last_ = 0;
};

std::vector<Eigen::Vector3f> new_nodes(const std::vector<Eigen::Vector3f>& nodes,
                                       const std::vector<Eigen::Vector3f>& surface, double spacing) {
  std::vector<Eigen::Vector3f> added;
  Neighbourhood around_nodes(nodes, spacing);
  Neighbourhood around_added(added, packing * spacing);
  for (const Eigen::Vector3f& point : surface)
    if (!around_nodes.holds(point) && !around_added.holds(point)) added.push_back(point);
  return added;
}

cl_float4 row_of(const Eigen::Matrix3d& rotation, int row) {
  const Eigen::Vector3f values = rotation.row(row).cast<float>();
  return {{values[0], values[1], values[2], 0}};
}

}  // namespace

void NodeField::grow(Device& device, const std::vector<Eigen::Vector3f>& surface, double spacing) {
  const std::vector<Eigen::Vector3f> added = new_nodes(positions_, surface, spacing);
  if (added.empty()) return;
  std::vector<float> affine(affine_size * (positions_.size() + added.size()), 0);
  if (!empty()) {
    std::copy(affine_.host().begin(), affine_.host().end(), affine.begin());
    const Influences there = influences(device, flatten(added));
    for (std::size_t i = 0; i < added.size(); ++i)
      Eigen::Map<AffineForm>(affine.data() + affine_size * (positions_.size() + i)) =
          blended_form(positions_, affine_, there, i, added[i]);
  }
  positions_.insert(positions_.end(), added.begin(), added.end());
  points_ = flatten(positions_);
  affine_ = Array<float>(std::move(affine));
}

void NodeField::take(const Array<float>& affine, int nearest_nodes) {
  if (affine.size() != affine_size * positions_.size())
    throw std::invalid_argument("a field takes one affine form for each of its nodes");
  affine_ = affine.clone();
  nearest_nodes_ = nearest_nodes;
}

NodeField NodeField::seen_from(Device& device, const Eigen::Isometry3d& other_from_this) const {
  NodeField seen;
  seen.positions_.reserve(positions_.size());
  for (const Eigen::Vector3f& position : positions_)
    seen.positions_.emplace_back((other_from_this * position.cast<double>()).cast<float>());
  seen.points_ = flatten(seen.positions_);
  seen.affine_ = turned_forms(device, affine_, other_from_this.linear());
  seen.nearest_nodes_ = nearest_nodes_;
  return seen;
}

Array<float> turned_forms(Device& device, const Array<float>& affine,
                          const Eigen::Matrix3d& other_from_this) {
  const std::size_t count = affine.size() / affine_size;
  Array<float> turned(affine.size());
  if (count == 0) return turned;
  auto kernel = device.kernel(embedded::framework_model_node_field_cl, "turn_forms");
  device.run("warp", kernel, count, 64, static_cast<cl_int>(count), row_of(other_from_this, 0),
             row_of(other_from_this, 1), row_of(other_from_this, 2), affine.device(device),
             turned.write_device(device));
  return turned;
}

Array<float> moved_forms(const Array<float>& affine, const std::vector<Eigen::Vector3f>& nodes,
                         const Eigen::Isometry3d& motion) {
  std::vector<float> moved(affine.size());
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    const Eigen::Map<const Eigen::Matrix<float, 3, 4>> from(affine.host().data() + affine_size * j);
    Eigen::Map<Eigen::Matrix<float, 3, 4>> to(moved.data() + affine_size * j);
    const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
    const Eigen::Vector3d node = nodes[j].cast<double>();
    const Eigen::Matrix3d turned = motion.linear() * (from.leftCols<3>().cast<double>() + identity);
    to.leftCols<3>() = (turned - identity).cast<float>();
    to.col(3) = (motion * (node + from.col(3).cast<double>()) - node).cast<float>();
  }
  return Array<float>(std::move(moved));
}

void CarriedPoints::move(Device& device, const NodeField& field) {
  if (rest_.empty()) return;
  if (nodes_ != field.positions().size() || nearest_nodes_ != field.nearest_nodes()) {
    influences_ = field.influences(device, rest_);
    nodes_ = field.positions().size();
    nearest_nodes_ = field.nearest_nodes();
  }
  warp_points(device, rest_, influences_, field.points(), field.affine(), moved_);
}

Array<float> points_at_rest(Device& device, const NodeField& field, const Array<float>& moved) {
  Array<float> rest = moved.clone();
  if (moved.empty()) return rest;
  auto kernel = device.kernel(embedded::framework_model_node_field_cl, "step_back");
  for (int round = 0; round < fixed_point_rounds; ++round) {
    CarriedPoints points(rest.clone());
    points.move(device, field);
    device.run("warp", kernel, rest.size(), 64, static_cast<cl_int>(rest.size()), moved.device(device),
               points.now().device(device), rest.write_device(device));
  }
  return rest;
}

}  // namespace pliant
