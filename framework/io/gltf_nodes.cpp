#include "framework/io/gltf_nodes.h"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <utility>

#include "framework/geometry/joint_chain.h"

namespace pliant {
namespace {

using Json = GltfDocument::Json;

/// The nodes of the default scene; where there is no scene, those that are nobody's children.
std::vector<std::size_t> roots_of(const GltfDocument& document) {
  std::vector<std::size_t> roots;
  if (document.find(document.root(), "scenes") != nullptr) {
    const Json& scene = document.element("scenes", document.integer(document.root(), "scene", 0));
    for (const Json& index : document.list(scene, "nodes")) roots.push_back(document.index(index, "node"));
    return roots;
  }
  const auto& nodes = document.list(document.root(), "nodes");
  std::vector<bool> is_child(nodes.size());
  for (const Json& node : nodes)
    for (const Json& index : document.list(node, "children")) {
      const std::size_t child = document.index(index, "node");
      document.element("nodes", child);
      is_child[child] = true;
    }
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (!is_child[i]) roots.push_back(i);
  if (roots.empty() && !nodes.empty()) document.fail("its nodes form cycles: each is the child of another");
  return roots;
}

JointMotion parts_of(const GltfDocument& document, const Json& node) {
  JointMotion parts;
  if (const auto t = document.numbers(node, "translation", 3)) parts.translation = Eigen::Vector3d(t->data());
  if (const auto r = document.numbers(node, "rotation", 4)) {
    const Eigen::Quaterniond rotation(Eigen::Vector4d(r->data()));  // x y z w, as in the file
    constexpr double kTolerance = 1e-3;
    if (!(std::abs(rotation.norm() - 1) < kTolerance)) {
      document.fail("the rotation of a node is not a unit quaternion");
    }
    parts.rotation = rotation.normalized();
  }
  if (const auto s = document.numbers(node, "scale", 3)) parts.scale = Eigen::Vector3d(s->data());
  return parts;
}

Eigen::Affine3d local_transform(const GltfDocument& document, const Json& node) {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  if (const auto matrix = document.numbers(node, "matrix", 16)) {
    transform.matrix() = Eigen::Map<const Eigen::Matrix4d>(matrix->data());
    if (transform.matrix().row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
      document.fail("the matrix of a node is not affine");
    }
    return transform;
  }
  const JointMotion parts = parts_of(document, node);
  return transform.translate(parts.translation).rotate(parts.rotation).scale(parts.scale);
}

/// Walks the nodes of the scene from its roots.
class Walk {
 public:
  explicit Walk(const GltfDocument& document)
      : document_(document), visited_(document.list(document.root(), "nodes").size()) {}

  std::vector<GltfNode> nodes() {
    // A list of nodes still to visit rather than recursion: a file may be deeper than the stack.
    for (const std::size_t root : roots_of(document_)) pending_.push_back({root, -1});
    while (!pending_.empty()) {
      const auto [number, parent] = pending_.back();
      pending_.pop_back();
      visit(number, parent);
    }
    return std::move(nodes_);
  }

 private:
  void visit(std::size_t number, int parent) {
    const Json& description = document_.element("nodes", number);
    if (visited_[number]) refuse(number, parent);
    visited_[number] = true;
    GltfNode node{number, parent, free_name(description, number), local_transform(document_, description)};
    node.placed = parent < 0 ? node.local : nodes_[static_cast<std::size_t>(parent)].placed * node.local;
    nodes_.push_back(std::move(node));
    for (const Json& index : document_.list(description, "children"))
      pending_.emplace_back(document_.index(index, "node"), static_cast<int>(nodes_.size()) - 1);
  }

  [[noreturn]] void refuse(std::size_t number, int parent) const {
    for (int above = parent; above >= 0; above = nodes_[static_cast<std::size_t>(above)].parent)
      if (nodes_[static_cast<std::size_t>(above)].number == number)
        document_.fail(fmt::format("node {} is below itself: its nodes form a cycle", number));
    document_.fail(fmt::format("node {} has two parents", number));
  }

  std::string free_name(const Json& description, std::size_t number) {
    std::string name =
        document_.find(description, "name") != nullptr ? document_.text(description, "name") : "";
    if (name.empty()) name = fmt::format("node{}", number);
    if (!names_.insert(name).second) {
      name += fmt::format("#{}", number);
      while (!names_.insert(name).second) name += '#';
    }
    return name;
  }

  const GltfDocument& document_;
  std::vector<bool> visited_;
  std::vector<std::pair<std::size_t, int>> pending_;  // number, parent in `nodes_`
  std::vector<GltfNode> nodes_;
  std::set<std::string> names_;
};

/// Parents before their children, otherwise in the order in which they were.
std::vector<GltfNode> sorted(const std::vector<GltfNode>& nodes) {
  std::vector<std::vector<int>> children(nodes.size() + 1);  // of the node before; of none at first
  for (std::size_t i = 0; i < nodes.size(); ++i)
    children[static_cast<std::size_t>(nodes[i].parent + 1)].push_back(static_cast<int>(i));
  std::vector<std::pair<int, int>> order{{-1, -1}};  // which node, its parent in the new list
  std::vector<GltfNode> sorted;
  for (std::size_t next = 0; next < order.size(); ++next) {
    const auto [index, parent] = order[next];
    if (index >= 0) {
      sorted.push_back(nodes[static_cast<std::size_t>(index)]);
      sorted.back().parent = parent;
    }
    for (const int child : children[static_cast<std::size_t>(index + 1)])
      order.emplace_back(child, static_cast<int>(sorted.size()) - 1);
  }
  return sorted;
}

}  // namespace

std::vector<GltfNode> read_nodes(const GltfDocument& document) { return Walk(document).nodes(); }

JointMotion resting_motion(const GltfDocument& document, const GltfNode& node) {
  const Json& description = document.element("nodes", node.number);
  if (document.find(description, "matrix") != nullptr)
    document.fail(fmt::format("an animation moves node {}, which has a matrix", node.number));
  return parts_of(document, description);
}

int chain_nodes(const GltfDocument& document, const std::vector<bool>& may_move,
                std::vector<GltfNode>& nodes) {
  std::vector<std::string> names;
  std::vector<int> parents;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    names.push_back(nodes[i].name);
    parents.push_back(nodes[i].parent);
  }
  const std::vector<int> chained = chained_parents(names, parents);
  int count = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (chained[i] == parents[i] || !may_move[i]) continue;
    const Eigen::Affine3d& parent = nodes[static_cast<std::size_t>(chained[i])].placed;
    if (!(std::abs(parent.linear().determinant()) > 0))
      document.fail(
          fmt::format("the transform of node {} cannot be inverted, so that no joint can hang on it",
                      nodes[static_cast<std::size_t>(chained[i])].number));
    nodes[i].parent = chained[i];
    nodes[i].local = parent.inverse() * nodes[i].placed;
    ++count;
  }
  nodes = sorted(nodes);
  return count;
}

}  // namespace pliant
