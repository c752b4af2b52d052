#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "experiments/modeller/figure.h"
#include "framework/geometry/mesh.h"

namespace pliant {

/// A form that a figure takes, so that there is one half-way between any two: how much of every morph target,
/// and how far every joint turns.
struct FigurePose {
  std::vector<double> weights;  ///< of every morph target
  std::vector<Eigen::Vector3d>
      degrees;  ///< of every joint, about the axes of its own frame: x, then y, then z
};

/// The form in which nothing is displaced or turned.
FigurePose rest_of(const Mesh& mesh);

/// What words "name=value" ask for, added up: so much of a named pose (smile=1), the weight of a morph target
/// (jawOpen=0.5), or an angle of a joint in degrees (index_1.x=40). Throws ConfigError that begins with
/// `place`, as in "a.yaml:3:5: 'target'", for what is no such word, for a name that the figure does not have
/// (the nearest is named) and for one that is given twice.
FigurePose read_pose(const Figure& figure, const std::vector<std::string>& words, const std::string& place);

/// `share` of the way from one pose to another.
FigurePose between(const FigurePose& from, const FigurePose& to, double share);

/// A form of the mesh with a pose on top: weights are added, and joints turn after what they do already.
MeshPose on_top(MeshPose beneath, const FigurePose& pose);

}  // namespace pliant
