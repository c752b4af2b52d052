#pragma once

#include <string>
#include <vector>

#include "framework/geometry/animation.h"
#include "framework/geometry/image.h"
#include "framework/geometry/mesh.h"

namespace pliant {

inline constexpr double millimetres_per_metre = 1000;

/// What a glTF file shows, so that it can be posed.
struct GltfScene {
  /// Where it has a skin or an animation moves a node, every node of the scene is a joint, named as the node
  /// is
  /// (`node7` without a name, `NAME#7` where another has it): vertices of a skin are carried by the skin's
  /// joints, all others by their node, and `mesh.deform(mesh.rest())` is what the file shows. Otherwise there
  /// are no joints and the nodes have placed their vertices.
  Mesh mesh;
  /// sRGB, of every vertex: base colours of materials times colours of vertices, white where one has neither;
  /// textures play no part. Empty where the file has none.
  std::vector<Rgb> colors;
  std::vector<Animation> animations;  ///< of `mesh`, named as in the file, else `animation0`, ...
  std::vector<std::string> warnings;  ///< what is odd though it can be used, a line each that names the file
};

struct GltfOptions {
  double unit =
      millimetres_per_metre;  ///< mm a unit of the file; glTF's is the metre, though not everybody's
  /// Build chains of joints that are children of one node by what they are called (chained_parents), as hands
  /// of WebXR need it; joints that an animation moves stay where they are. The mesh at rest is the same.
  bool chain_joints = false;
  bool colors = false;  ///< read them; else they may be anything
};

/// Reads the default scene of a glTF 2.0 file, binary or JSON with its buffers in files beside it or within,
/// or all its nodes where it has no scene: all triangles, strips and fans together, in mm, in glTF's frame (x
/// right and y up for who looks along -z). Points and lines have no surface and are passed over. The vertices
/// are those of the file without any morph target; default weights in the file play no part. Targets take
/// their names from the mesh's `extras.targetNames`, else `target0`, `target1`, ...; the same name in several
/// meshes is one target. A vertex keeps the four largest of its weights, brought to the sum of 1. The
/// transform of a node that has a skin plays no part, as glTF wants it.
///
/// Throws DataError naming the file and what is wrong with it. An error, too: required extensions, such as
/// Draco compression, except quantised numbers and those of materials.
GltfScene read_gltf_scene(const std::string& path, const GltfOptions& options = {});

/// The same as a mesh without joints: what the file shows while nothing moves, with its morph targets.
Mesh read_gltf(const std::string& path, double unit = millimetres_per_metre);

}  // namespace pliant
