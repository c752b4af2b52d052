#include "framework/io/gltf.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "framework/io/file.h"
#include "framework/io/gltf_document.h"

namespace pliant {
namespace {

using Json = GltfDocument::Json;

// Modes of primitives.
constexpr std::size_t kTriangleList = 4;
constexpr std::size_t kTriangleStrip = 5;
constexpr std::size_t kTriangleFan = 6;

/// One primitive as it is in the file: in its unit, in the frame of its node.
struct Primitive {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3i> triangles;
  std::vector<std::vector<Eigen::Vector3f>> displacements;  ///< per target
};

class SceneReader {
 public:
  SceneReader(const GltfDocument& document, double unit) : document_(document), unit_(unit) {}

  Mesh read() {
    collect_nodes();
    if (mesh_.triangles.empty()) document_.fail("its scene shows no triangle");
    for (MorphTarget& target : mesh_.targets) pad(target);
    return std::move(mesh_);
  }

 private:
  struct PlacedNode {
    std::size_t node;
    Eigen::Affine3d parent;
  };

  // A list of nodes still to visit rather than recursion: a file may be deeper than the stack.
  void collect_nodes() {
    std::vector<bool> visited(document_.list(document_.root(), "nodes").size());
    std::vector<PlacedNode> pending;
    const auto add_all = [&](const std::vector<Json>& indices, const Eigen::Affine3d& parent) {
      for (const Json& index : indices) pending.push_back({document_.index(index, "node"), parent});
    };
    for (const std::size_t node : roots()) pending.push_back({node, Eigen::Affine3d::Identity()});
    while (!pending.empty()) {
      const PlacedNode placed = pending.back();
      pending.pop_back();
      const Json& node = document_.element("nodes", placed.node);
      if (visited[placed.node]) document_.fail(fmt::format("node {} has two parents", placed.node));
      visited[placed.node] = true;
      const Eigen::Affine3d placement = placed.parent * local_transform(node);
      if (document_.find(node, "mesh") != nullptr) add_mesh(node, placement);
      add_all(document_.list(node, "children"), placement);
    }
  }

  /// The nodes of the default scene; where there is no scene, those that are nobody's children.
  std::vector<std::size_t> roots() const {
    std::vector<std::size_t> roots;
    if (document_.find(document_.root(), "scenes") != nullptr) {
      const Json& scene = document_.element("scenes", document_.integer(document_.root(), "scene", 0));
      for (const Json& index : document_.list(scene, "nodes"))
        roots.push_back(document_.index(index, "node"));
      return roots;
    }
    const auto& nodes = document_.list(document_.root(), "nodes");
    std::vector<bool> is_child(nodes.size());
    for (const Json& node : nodes)
      for (const Json& index : document_.list(node, "children")) {
        const std::size_t child = document_.index(index, "node");
        document_.element("nodes", child);
        is_child[child] = true;
      }
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (!is_child[i]) roots.push_back(i);
    return roots;
  }

  Eigen::Affine3d local_transform(const Json& node) const {
    Eigen::Affine3d transform = Eigen::Affine3d::Identity();
    if (const auto matrix = document_.numbers(node, "matrix", 16)) {
      transform.matrix() = Eigen::Map<const Eigen::Matrix4d>(matrix->data());
      if (transform.matrix().row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
        document_.fail("the matrix of a node is not affine");
      }
      return transform;
    }
    if (const auto t = document_.numbers(node, "translation", 3)) {
      transform.translate(Eigen::Vector3d(t->data()));
    }
    if (const auto r = document_.numbers(node, "rotation", 4)) {
      const Eigen::Quaterniond rotation(Eigen::Vector4d(r->data()));  // x y z w, as in the file
      constexpr double kTolerance = 1e-3;
      if (!(std::abs(rotation.norm() - 1) < kTolerance)) {
        document_.fail("the rotation of a node is not a unit quaternion");
      }
      transform.rotate(rotation.normalized());
    }
    if (const auto s = document_.numbers(node, "scale", 3)) transform.scale(Eigen::Vector3d(s->data()));
    return transform;
  }

  void add_mesh(const Json& node, const Eigen::Affine3d& placement) {
    if (document_.find(node, "skin") != nullptr) document_.fail("a skinned mesh, which is not supported");
    const Json& mesh = document_.element("meshes", document_.integer(node, "mesh"));
    for (const Json& description : document_.list(mesh, "primitives")) {
      const std::size_t mode = document_.integer(description, "mode", kTriangleList);
      if (mode > kTriangleFan) document_.fail(fmt::format("a primitive of mode {}, expected 0 to 6", mode));
      if (mode < kTriangleList) continue;  // points or lines
      const Primitive primitive = read_primitive(description);
      add_primitive(primitive, target_names(mesh, primitive.displacements.size()), placement);
    }
  }

  Primitive read_primitive(const Json& description) const {
    Primitive primitive;
    primitive.positions =
        document_.vectors(document_.integer(document_.at(description, "attributes"), "POSITION"));
    check_amount(primitive.positions.size(), document_.list(description, "targets").size());
    primitive.triangles = read_triangles(description, primitive.positions.size());
    for (const Json& target : document_.list(description, "targets")) {
      primitive.displacements.push_back(read_displacements(target, primitive.positions.size()));
    }
    return primitive;
  }

  // A small file can name large data many times.
  void check_amount(std::size_t vertices, std::size_t targets) const {
    constexpr std::size_t kMostVectors = 20'000'000;
    const std::size_t all_vertices = mesh_.vertices.size() + vertices;
    const std::size_t all_targets = mesh_.targets.size() + targets;
    if (all_vertices * (1 + all_targets) <= kMostVectors) return;
    document_.fail(fmt::format("{} vertices with {} morph targets are more than can be held", all_vertices,
                               all_targets));
  }

  std::vector<Eigen::Vector3i> read_triangles(const Json& description, std::size_t vertex_count) const {
    std::vector<std::uint32_t> corners;
    if (document_.find(description, "indices") != nullptr) {
      corners = document_.indices(document_.integer(description, "indices"));
    } else {
      for (std::uint32_t i = 0; i < vertex_count; ++i) corners.push_back(i);
    }
    for (const std::uint32_t corner : corners) {
      if (corner >= vertex_count)
        document_.fail(fmt::format("a triangle names vertex {} of {}", corner, vertex_count));
    }
    return assemble(corners, document_.integer(description, "mode", kTriangleList));
  }

  std::vector<Eigen::Vector3i> assemble(const std::vector<std::uint32_t>& corners, std::size_t mode) const {
    const std::size_t step = mode == kTriangleList ? 3 : 1;
    if (mode == kTriangleList && corners.size() % 3 != 0)
      document_.fail(fmt::format("{} corners do not make whole triangles", corners.size()));
    std::vector<Eigen::Vector3i> triangles;
    for (std::size_t i = 0; i + 2 < corners.size(); i += step) {
      // In a strip every second triangle runs the other way round.
      const std::size_t turn = mode == kTriangleStrip ? i % 2 : 0;
      triangles.emplace_back(static_cast<int>(corners[mode == kTriangleFan ? 0 : i]),
                             static_cast<int>(corners[i + 1 + turn]),
                             static_cast<int>(corners[i + 2 - turn]));
    }
    return triangles;
  }

  // A target may move something else than positions, such as normals.
  std::vector<Eigen::Vector3f> read_displacements(const Json& target, std::size_t vertex_count) const {
    if (document_.find(target, "POSITION") == nullptr) {
      return {vertex_count, Eigen::Vector3f::Zero()};
    }
    const std::size_t accessor = document_.integer(target, "POSITION");
    if (document_.count(accessor) != vertex_count) {
      document_.fail(
          fmt::format("a morph target moves {} vertices of {}", document_.count(accessor), vertex_count));
    }
    return document_.vectors(accessor);
  }

  std::vector<std::string> target_names(const Json& mesh, std::size_t count) const {
    std::vector<std::string> names;
    const Json* extras = document_.find(mesh, "extras");
    if (extras != nullptr && extras->is_object() && extras->contains("targetNames")) {
      for (const Json& name : document_.list(*extras, "targetNames")) {
        if (!name.is_string()) document_.fail("a name of a morph target is not a text");
        names.push_back(name.get<std::string>());
      }
      if (names.size() != count) {
        document_.fail(fmt::format("{} names for {} morph targets", names.size(), count));
      }
    } else {
      for (std::size_t i = 0; i < count; ++i) names.push_back(fmt::format("target{}", i));
    }
    check_distinct(names);
    return names;
  }

  void check_distinct(std::vector<std::string> names) const {
    std::sort(names.begin(), names.end());
    const auto twin = std::adjacent_find(names.begin(), names.end());
    if (twin != names.end()) {
      document_.fail(fmt::format("two morph targets are named {}", Json(*twin).dump()));
    }
  }

  void add_primitive(const Primitive& primitive, const std::vector<std::string>& names,
                     const Eigen::Affine3d& placement) {
    const std::size_t first = mesh_.vertices.size();
    for (const Eigen::Vector3f& position : primitive.positions) {
      mesh_.vertices.push_back(to_millimetres(placement * position.cast<double>()));
    }
    // Indices were checked, and the amount that can be held keeps them far below what an int holds.
    const bool is_mirrored = placement.linear().determinant() < 0;
    for (Eigen::Vector3i triangle : primitive.triangles) {
      if (is_mirrored) std::swap(triangle[1], triangle[2]);
      mesh_.triangles.emplace_back(triangle.array() + static_cast<int>(first));
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
      MorphTarget& target = target_named(names[i]);
      target.displacements.resize(first, Eigen::Vector3f::Zero());
      for (const Eigen::Vector3f& displacement : primitive.displacements[i]) {
        target.displacements.push_back(to_millimetres(placement.linear() * displacement.cast<double>()));
      }
    }
  }

  Eigen::Vector3f to_millimetres(const Eigen::Vector3d& vector) const {
    Eigen::Vector3f millimetres = (vector * unit_).cast<float>();
    if (!millimetres.allFinite()) document_.fail("the transforms of its nodes carry a vertex to infinity");
    return millimetres;
  }

  MorphTarget& target_named(const std::string& name) {
    auto& targets = mesh_.targets;
    const auto found = std::find_if(targets.begin(), targets.end(),
                                    [&](const MorphTarget& target) { return target.name == name; });
    if (found != targets.end()) return *found;
    targets.push_back({name, {}});
    return targets.back();
  }

  void pad(MorphTarget& target) const {
    target.displacements.resize(mesh_.vertices.size(), Eigen::Vector3f::Zero());
  }

  const GltfDocument& document_;
  double unit_;  ///< mm
  Mesh mesh_;
};

}  // namespace

Mesh read_gltf(const std::string& path, double unit) {
  const GltfDocument document(read_file(path), path);
  return SceneReader(document, unit).read();
}

}  // namespace pliant
