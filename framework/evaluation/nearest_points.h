#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "framework/geometry/camera.h"
#include "framework/geometry/image.h"

namespace pliant {

/// Told about once a second, on the thread that asked for the work, which share of it is done (0 .. 1).
using ShareSink = std::function<void(double)>;

/// Finds the nearest of the points of an image exactly: the least of all distances as single precision
/// computes them, in whatever order it looks at them. Tiles of 4 x 4 pixels are the leaves of a tree of boxes
/// with 16 children a node; queries go down it 64 at a time, on all processors. Where a query projects to is
/// only where its search begins: a point need not lie on the ray of its pixel.
class NearestPoints {
 public:
  /// `map`: points in mm in the frame of `camera`; one that is not finite or has z <= 0 counts as none. The
  /// map must outlive this.
  NearestPoints(const Image<Eigen::Vector3f>& map, const Camera& camera);

  /// Whether there is no point.
  bool empty() const { return leaves_.empty(); }

  /// Per query (mm, frame of the camera) the distance in mm to the nearest point; NaN for one that is not
  /// finite. There must be a point. What `progress` throws ends the work and comes through.
  std::vector<float> distances(const std::vector<Eigen::Vector3f>& queries,
                               const ShareSink& progress = {}) const;

 private:
  static constexpr int side = 4;
  static constexpr int fan = side * side;
  using Row = Eigen::Array<float, fan, 1>;
  using Leaf = std::array<Row, 3>;  ///< x, y, z of its points; infinite where it has fewer
  /// The children of a node: the boxes around their points (lowest above highest where there is none), and
  /// their places among the leaves or in the level below.
  struct Node {
    Leaf lowest;
    Leaf highest;
    std::array<int, fan> child;
  };
  struct Packet;

  Image<int> make_leaves();
  template <class BoxOf>
  Image<int> make_level(const Image<int>& below, BoxOf box_of);
  void search(const Eigen::Vector3f* queries, std::size_t count, float* distances) const;
  void begin(Packet& packet) const;
  void descend(std::size_t level, int node, Packet& packet) const;
  void visit(const Node& node, Packet& packet) const;

  const Image<Eigen::Vector3f>& map_;
  Camera camera_;
  std::vector<Leaf> leaves_;
  std::vector<std::vector<Node>> levels_;  ///< from the parents of leaves up to the root
};

}  // namespace pliant
