#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <vector>

#include "experiments/modeller/shape.h"
#include "framework/geometry/mesh.h"

namespace pliant {

/// A solid that is built up step by step, like clay: each step works on all that was built before it. Blends
/// are the widths, in mm of distance, over which the edge that a step makes is rounded.
class Solid {
 public:
  Solid& add(const Shape& shape, double blend);
  Solid& cut(const Shape& shape, double blend);
  /// The same on both sides of the plane x = 0.
  Solid& add_pair(const Shape& shape, double blend);
  Solid& cut_pair(const Shape& shape, double blend);
  /// Moves the surface outwards by height * exp(-|(p - centre) / radii|^2), or inwards by a negative one
  /// (mm).
  Solid& raise(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii, double height);
  Solid& raise_pair(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii, double height);

  /// Moves the surface inwards by `depth` mm where it is inside the shape; the rim is a slope `rim` mm wide.
  Solid& press(const Shape& shape, double depth, double rim);
  Solid& press_pair(const Shape& shape, double depth, double rim);

  /// As of a Shape, and not more than some times as steep: see `polygonise`.
  double distance(const Eigen::Vector3d& point) const;
  /// Of all that was added.
  Eigen::AlignedBox3d box() const { return box_; }
  /// To be a step of another.
  Shape shape() const;

 private:
  enum class Kind { add, cut, raise, press };
  struct Step {
    Kind kind;
    Shape shape;  // of a `raise`: its exponential
    double blend;
    double depth = 0;  // of a `press`
  };
  std::vector<Step> steps_;
  Eigen::AlignedBox3d box_;
};

/// Where samples are closer to each other: 1 - gain times as far apart at the centre, as they are elsewhere
/// beyond about 2 `radius` mm.
struct Focus {
  Eigen::Vector3d centre;
  double radius;
  double gain;  ///< at most 0.6
};

/// How finely a solid is cut into triangles: samples are `spacing` mm apart at `centre`, and farther the
/// farther they are from it: the n-th one is reach * sinh(n * spacing / reach) mm away.
struct Sampling {
  double spacing = 2;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double reach = std::numeric_limits<double>::infinity();
  std::vector<Focus> foci = {};
};

/// The surface of a solid: a closed mesh with even triangles whose vertices lie on it. What is thinner than
/// the samples are apart may be lost. Samples are taken from the surface only, found by halving boxes that
/// may have some; a solid whose distance is more than twice as steep as a true one may come with holes.
Mesh polygonise(const Solid& solid, const Sampling& sampling);

}  // namespace pliant
