#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "experiments/datasets/camera_path.h"
#include "experiments/datasets/depth_sensor.h"
#include "experiments/datasets/figure_pose.h"
#include "experiments/datasets/frame_source.h"
#include "experiments/datasets/rigid_motion.h"
#include "experiments/datasets/surface_color.h"
#include "framework/geometry/animation.h"
#include "framework/geometry/mesh.h"
#include "framework/geometry/rig.h"

namespace pliant {

/// How a scene is at one moment.
struct SceneKey {
  double time = 0;  ///< seconds
  FigurePose pose;
  RigidMotion motion;  ///< of the mesh about its middle, in the frame of a camera that has not moved
  CameraPose camera;   ///< of the depth camera
};

/// `share` of the way from one to another.
SceneKey between(const SceneKey& from, const SceneKey& to, double share);

/// A part of an animation that is played at constant speed from the first frame of a scene to its last.
struct PlayedAnimation {
  Animation animation;
  double begin = 0;  ///< s, in the animation's own time, in the first frame
  double end = 0;    ///< in the last
};

/// A mesh that changes its form and moves before a rig that may move, too. The frame of reference is that of
/// a depth camera that has not moved: the middle of the mesh is on its optical axis and looks at it, the
/// mesh's y axis up.
struct MeshScene {
  std::string what;  ///< is seen, as errors begin with it: "head", or the path of a file
  std::string name;  ///< of the stream
  Mesh mesh;
  FigurePose base;  ///< of every frame, beneath what the keys say
  /// Around the mesh in its own frame, before any key has a say and at rest but for its base.
  Eigen::AlignedBox3d box;
  std::optional<PlayedAnimation> animation = std::nullopt;  ///< beneath both
  double distance = 0;  ///< mm, from a depth camera that has not moved to the middle of the mesh
  Rig rig;
  std::vector<SceneKey> keys;  ///< at least one, each later than the one before
  int frames = 0;              ///< 30 a second, from the first key on
  SurfaceColor color;
  DepthSensorSettings sensor;
  std::vector<std::string> warnings;

  /// Seconds of a frame, the first of which is 1.
  double time_of(int frame) const;
  /// Between two keys 3 x^2 - 2 x^3 of the way are gone at the share x of the time: it rests at every key.
  SceneKey state_at(double time) const;
  /// The vertices at some time, mm in the depth camera's frame.
  std::vector<Eigen::Vector3d> vertices_at(double time) const;
  /// From the depth camera's frame to one that goes with the mesh as its rigid motion moves it: the scene's,
  /// where that is none.
  Eigen::Isometry3d followed_from_camera(double time) const;

 private:
  MeshPose beneath_at(double time) const;
};

/// The box that MeshScene has.
Eigen::AlignedBox3d box_around(const Mesh& mesh, const FigurePose& base);

/// Whether a point is inside of a mesh: more than half of all that it sees are back sides, however many holes
/// the mesh has (winding number [Jacobson, Kavan, Sorkine-Hornung 2013] above one half).
bool is_inside(const Eigen::Vector3d& point, const std::vector<Eigen::Vector3d>& vertices,
               const std::vector<Eigen::Vector3i>& triangles);

}  // namespace pliant
