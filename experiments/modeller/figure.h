#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "framework/core/parameters.h"
#include "framework/geometry/mesh.h"

namespace pliant {

/// A form that a figure is known to take, as "smile" or "fist": so much of some morph targets, and joints
/// that turn. Half of a pose is half of every weight and of every angle.
struct NamedPose {
  struct Turn {
    std::string joint;
    Eigen::Vector3d degrees;  ///< about the axes of the joint's own frame: first x, then y, then z
  };
  std::string name;
  std::string doc;                                           ///< one line
  std::vector<std::pair<std::string, double>> weights = {};  ///< of morph targets, by name
  std::vector<Turn> turns = {};
};

/// A soft patch of another colour, as a brow: all of its own in the middle of an ellipsoid, none at its
/// border.
struct ColorPatch {
  Eigen::Vector3f centre;  ///< mm, in the mesh's frame at rest
  Eigen::Vector3f radii;   ///< mm, along the axes
  Eigen::Vector3f color;   ///< r g b, of 255
  float strength = 1;      ///< how much of the colour is in the middle
};

/// A modelled thing that can be seen and deforms: a closed mesh in mm, y up, looking along +z, its triangles
/// counter-clockwise from outside.
struct Figure {
  Mesh mesh;
  std::vector<NamedPose> poses;
  std::vector<ColorPatch> patches = {};  ///< on a plain skin, each over those before
};

/// A figure that experiment files can name.
struct FigureKind {
  std::string name;         ///< as in "head"
  std::string doc;          ///< one line
  ParameterTable identity;  ///< who or which one it is: each row has a default
  std::function<Figure(const Parameters& identity)> make;
};

/// All figures, in the order in which they are listed.
const std::vector<FigureKind>& figure_kinds();

}  // namespace pliant
