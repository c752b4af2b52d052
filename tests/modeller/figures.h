#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "experiments/modeller/figure.h"

namespace pliant::test {

/// The kind of that name.
const FigureKind& kind_of(const std::string& name);

/// A figure with these parameters instead of its defaults.
Figure made(const std::string& name, const std::map<std::string, double>& identity = {});

/// The vertices of a figure in one of its poses, by name.
std::vector<Eigen::Vector3d> posed(const Figure& figure, const std::string& pose, double share = 1);

/// The vertices of a mesh at `share` of a pose.
std::vector<Eigen::Vector3d> posed(const Mesh& mesh, const NamedPose& pose, double share = 1);

/// The vertex nearest to a point (mm) at rest.
std::size_t vertex_near(const Figure& figure, const Eigen::Vector3d& point);

}  // namespace pliant::test
