#include "framework/io/gltf.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "framework/io/file.h"
#include "framework/io/gltf_animation.h"
#include "framework/io/gltf_color.h"
#include "framework/io/gltf_document.h"
#include "framework/io/gltf_nodes.h"
#include "framework/io/gltf_skin.h"

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

/// Reads the meshes of nodes, placed by them or, where there are joints, in the frames that joints carry.
class SceneReader {
 public:
  SceneReader(const GltfDocument& document, const std::vector<GltfNode>& nodes, double unit,
              GltfJoints* joints)
      : document_(document), nodes_(nodes), unit_(unit), joints_(joints) {}

  Mesh read() {
    for (std::size_t i = 0; i < nodes_.size(); ++i) add_mesh(i);
    if (mesh_.triangles.empty()) document_.fail("its scene shows no triangle");
    for (MorphTarget& target : mesh_.targets) pad(target);
    if (joints_ != nullptr) mesh_.joints = joints_->joints();
    return std::move(mesh_);
  }

  /// The same with `colors` of the vertices that were read; empty where none has one.
  Mesh read(std::vector<Rgb>& colors) {
    colors_ = &colors;
    Mesh mesh = read();
    if (!is_colored_) colors.clear();
    return mesh;
  }

  /// Which morph targets of the mesh those of a node of the file's list are.
  const std::map<std::size_t, std::vector<std::size_t>>& targets() const { return targets_; }

 private:
  void add_mesh(std::size_t index) {
    const GltfNode& node = nodes_[index];
    const Json& description = document_.element("nodes", node.number);
    if (document_.find(description, "mesh") == nullptr) return;
    const Json& mesh = document_.element("meshes", document_.integer(description, "mesh"));
    for (const Json& part : document_.list(mesh, "primitives")) {
      const std::size_t mode = document_.integer(part, "mode", kTriangleList);
      if (mode > kTriangleFan) document_.fail(fmt::format("a primitive of mode {}, expected 0 to 6", mode));
      if (mode < kTriangleList) continue;  // points or lines
      const Primitive primitive = read_primitive(part);
      const std::vector<std::string> names = target_names(mesh, primitive.displacements.size());
      add_primitive(primitive, names, joints_ != nullptr ? Eigen::Affine3d::Identity() : node.placed);
      if (colors_ != nullptr) add_colors(read_vertex_colors(document_, part, primitive.positions.size()));
      note_targets(node.number, names);
      if (joints_ != nullptr) add_skin(index, description, part, primitive.positions.size());
    }
  }

  void add_colors(const std::vector<Rgb>& colors) {
    is_colored_ |= !colors.empty();
    colors_->insert(colors_->end(), colors.begin(), colors.end());
    colors_->resize(mesh_.vertices.size(), Rgb{255, 255, 255});  // what glTF shows without any
  }

  void note_targets(std::size_t node, const std::vector<std::string>& names) {
    std::vector<std::size_t>& targets = targets_[node];
    targets.clear();
    for (const std::string& name : names)
      targets.push_back(static_cast<std::size_t>(&target_named(name) - mesh_.targets.data()));
  }

  void add_skin(std::size_t index, const Json& node, const Json& primitive, std::size_t vertices) {
    if (document_.find(node, "skin") == nullptr) {
      mesh_.skin.insert(mesh_.skin.end(), vertices, joints_->carried_by(index));
      return;
    }
    const auto weights = joints_->read_weights(primitive, document_.integer(node, "skin"), vertices);
    mesh_.skin.insert(mesh_.skin.end(), weights.begin(), weights.end());
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
  const std::vector<GltfNode>& nodes_;
  double unit_;         ///< mm
  GltfJoints* joints_;  ///< null: nodes place their meshes
  Mesh mesh_;
  std::vector<Rgb>* colors_ = nullptr;  ///< null: nobody wants them
  bool is_colored_ = false;
  std::map<std::size_t, std::vector<std::size_t>> targets_;
};

bool shows_skin(const GltfDocument& document, const std::vector<GltfNode>& nodes) {
  return std::any_of(nodes.begin(), nodes.end(), [&](const GltfNode& node) {
    const Json& description = document.element("nodes", node.number);
    return document.find(description, "skin") != nullptr && document.find(description, "mesh") != nullptr;
  });
}

bool is_mirror(const Eigen::Affine3d& transform) { return transform.linear().determinant() < 0; }

/// Turns the triangles that the joints mirror at rest, so that their corners run as a mesh has it.
void turn_mirrored(Mesh& mesh) {
  std::vector<bool> mirrors;       // from each joint's frame to the mesh's
  std::vector<bool> mirrors_mesh;  // and what it carries
  for (const Joint& joint : mesh.joints) {
    const bool above = joint.parent >= 0 && mirrors[static_cast<std::size_t>(joint.parent)];
    mirrors.push_back(above != is_mirror(joint.rest));
    mirrors_mesh.push_back(mirrors.back() != is_mirror(joint.joint_from_mesh));
  }
  for (Eigen::Vector3i& triangle : mesh.triangles) {
    const int strongest = mesh.skin[static_cast<std::size_t>(triangle[0])].joints[0];
    if (mirrors_mesh[static_cast<std::size_t>(strongest)]) std::swap(triangle[1], triangle[2]);
  }
}

std::vector<Eigen::Vector3f> to_floats(const std::vector<Eigen::Vector3d>& vectors,
                                       const GltfDocument& document) {
  std::vector<Eigen::Vector3f> floats;
  floats.reserve(vectors.size());
  for (const Eigen::Vector3d& vector : vectors) {
    floats.emplace_back(vector.cast<float>());
    if (!floats.back().allFinite()) document.fail("the transforms of its nodes carry a vertex to infinity");
  }
  return floats;
}

/// The mesh as its joints carry it at rest. Skinning is linear, so that targets displace what they did.
Mesh without_joints(const Mesh& mesh, const GltfDocument& document) {
  MeshPose pose = mesh.rest();
  const std::vector<Eigen::Vector3d> at_rest = mesh.deform(pose);
  Mesh still{to_floats(at_rest, document), mesh.triangles, {}};
  for (std::size_t t = 0; t < mesh.targets.size(); ++t) {
    pose.weights[t] = 1;
    std::vector<Eigen::Vector3d> displacements = mesh.deform(pose);
    for (std::size_t i = 0; i < displacements.size(); ++i) displacements[i] -= at_rest[i];
    still.targets.push_back({mesh.targets[t].name, to_floats(displacements, document)});
    pose.weights[t] = 0;
  }
  return still;
}

/// Chains the nodes if that is wanted, and says what is odd about it.
std::vector<std::string> chain(const GltfDocument& document, const std::vector<bool>& moved, bool is_wanted,
                               const std::string& path, std::vector<GltfNode>& nodes) {
  std::vector<bool> may_move = moved;
  may_move.flip();
  if (is_wanted) {
    if (chain_nodes(document, may_move, nodes) > 0) return {};
    return {
        fmt::format("{}: no names of its {} nodes make chains of joints, so that chain_joints does nothing",
                    path, nodes.size())};
  }
  std::vector<GltfNode> chained = nodes;
  const int count = chain_nodes(document, may_move, chained);
  if (2 * static_cast<std::size_t>(count) < nodes.size()) return {};
  return {fmt::format(
      "{}: the names of {} of its {} nodes make chains, though they are children of one node, so that joints "
      "bend alone; chain_joints builds the chains",
      path, count, nodes.size())};
}

}  // namespace

GltfScene read_gltf_scene(const std::string& path, const GltfOptions& options) {
  const GltfDocument document(read_file(path), path);
  std::vector<GltfNode> nodes = read_nodes(document);
  const std::vector<bool> moved = moved_nodes(document, nodes);
  const bool has_joints =
      shows_skin(document, nodes) || std::find(moved.begin(), moved.end(), true) != moved.end();
  GltfScene scene;
  if (has_joints) scene.warnings = chain(document, moved, options.chain_joints, path, nodes);
  GltfJoints joints(document, nodes, options.unit);
  SceneReader reader(document, nodes, options.unit, has_joints ? &joints : nullptr);
  scene.mesh = options.colors ? reader.read(scene.colors) : reader.read();
  if (has_joints) {
    turn_mirrored(scene.mesh);
    to_floats(scene.mesh.deform(scene.mesh.rest()), document);  // so that it can be shown
  }
  scene.animations = read_animations(document, nodes, reader.targets(), options.unit);
  return scene;
}

Mesh read_gltf(const std::string& path, double unit) {
  const GltfDocument document(read_file(path), path);
  const std::vector<GltfNode> nodes = read_nodes(document);
  if (!shows_skin(document, nodes)) return SceneReader(document, nodes, unit, nullptr).read();
  GltfJoints joints(document, nodes, unit);
  Mesh mesh = SceneReader(document, nodes, unit, &joints).read();
  turn_mirrored(mesh);
  return without_joints(mesh, document);
}

}  // namespace pliant
