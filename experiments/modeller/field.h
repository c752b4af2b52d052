#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "framework/geometry/mesh.h"

namespace pliant {

/// A number for every point of a figure at rest, mostly 0 to 1: how much of something the point takes.
using ScalarField = std::function<double(const Eigen::Vector3d&)>;
/// A displacement in mm for every point of a figure at rest.
using VectorField = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

// Fields are put together like formulas: a smile is
//   both_sides(bump(corner, 16) * shift({5, 6, -4}) + bump(cheek, 20) * shift({1, 3, 2})).

/// exp(-|(p - centre) / radius|^2): 1 at the centre, about a third one radius away from it.
ScalarField bump(const Eigen::Vector3d& centre, double radius);
ScalarField bump(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii);
/// From 0 to 1, smoothly, where the value rises from `low` to `high`.
ScalarField rise(ScalarField value, double low, double high);
/// A coordinate of the point, in mm: 0 is x.
ScalarField coordinate(int axis);

/// The same everywhere.
VectorField shift(const Eigen::Vector3d& displacement);
/// A turn about an axis through a point, in degrees.
VectorField turn(const Eigen::Vector3d& centre, const Eigen::Vector3d& axis, double degrees);
/// Away from a point, by that many mm.
VectorField away_from(const Eigen::Vector3d& centre, double distance);
/// Stretches about a point: along each axis by that factor, less 1.
VectorField stretch(const Eigen::Vector3d& centre, const Eigen::Vector3d& gains);

ScalarField operator*(ScalarField a, ScalarField b);
VectorField operator*(ScalarField a, VectorField b);
VectorField operator+(VectorField a, VectorField b);

ScalarField inverse(ScalarField field);  ///< 1 - field
/// The field and its mirror image in the plane x = 0.
VectorField both_sides(const VectorField& field);
VectorField mirrored(VectorField field);

/// The field at these points.
MorphTarget target(const std::string& name, const VectorField& field,
                   const std::vector<Eigen::Vector3d>& points);

}  // namespace pliant
