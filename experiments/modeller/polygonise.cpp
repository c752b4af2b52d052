#include <algorithm>
#include <cmath>
#include <vector>

#include "experiments/modeller/implicit.h"
#include "framework/geometry/marching_cubes.h"

namespace pliant {
namespace {

/// Samples are even in a space of their own, which this spreads out around a centre and draws together around
/// the foci.
class Lens {
 public:
  explicit Lens(const Sampling& sampling) : sampling_(sampling) {}

  Eigen::Vector3d point_of(const Eigen::Vector3d& place) const {
    const Eigen::Vector3d offset = place - sampling_.centre;
    const double scaled = offset.norm() / sampling_.reach;
    Eigen::Vector3d point = sampling_.centre + offset * (scaled < 1e-6 ? 1 : std::sinh(scaled) / scaled);
    for (const Focus& focus : sampling_.foci) {
      const Eigen::Vector3d from_focus = point - focus.centre;
      const double squared = from_focus.squaredNorm() / (focus.radius * focus.radius);
      if (squared < negligible) point -= focus.gain * std::exp(-squared) * from_focus;
    }
    return point;
  }

  /// Of all places whose points lie in the box.
  Eigen::AlignedBox3d places_of(const Eigen::AlignedBox3d& box) const {
    const auto contracted = [reach = sampling_.reach](double r) {
      return std::isinf(reach) ? r : reach * std::asinh(r / reach);
    };
    Eigen::AlignedBox3d places(sampling_.centre, sampling_.centre);
    for (const Eigen::Vector3d& corner : {pushed_out(box).min(), pushed_out(box).max()})
      places.extend(sampling_.centre + (corner - sampling_.centre).unaryExpr(contracted));
    return places;
  }

 private:
  static constexpr double negligible = 20;  // exp(-20) of a radius is far below what a float tells apart

  /// The box and what foci may draw into it.
  Eigen::AlignedBox3d pushed_out(const Eigen::AlignedBox3d& box) const {
    constexpr double farthest = 0.43;  // r exp(-r^2) is never more
    double most = 0;
    for (const Focus& focus : sampling_.foci) most += farthest * focus.gain * focus.radius;
    return {box.min().array() - most, box.max().array() + most};
  }

  Sampling sampling_;
};

/// The samples of a solid near its surface; elsewhere only their sign is right.
class Samples {
 public:
  Samples(const Solid& solid, const Sampling& sampling)
      : solid_(solid), spacing_(sampling.spacing), lens_(sampling) {
    const Eigen::AlignedBox3d box = lens_.places_of(solid.box());
    const Eigen::Vector3d blocks = (box.sizes() / (block * spacing_)).array().ceil() + 1;
    size_ = (blocks.cast<int>() * block).array() + 1;
    origin_ = box.center() - spacing_ * (size_.array() - 1).matrix().cast<double>() / 2;
    values_.resize(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()) *
                   static_cast<std::size_t>(size_.z()));
    for (int k = 0; k + 1 < size_.z(); k += block) {
      for (int j = 0; j + 1 < size_.y(); j += block) {
        for (int i = 0; i + 1 < size_.x(); i += block) sample({i, j, k}, block);
      }
    }
  }

  Mesh surface() const {
    Mesh mesh = marching_cubes({{size_, origin_, spacing_}, values_});
    for (Eigen::Vector3f& vertex : mesh.vertices)
      vertex = lens_.point_of(vertex.cast<double>()).cast<float>();
    return mesh;
  }

 private:
  static constexpr int block = 16;  // cells along an edge of the largest boxes

  Eigen::Vector3d point_of(const Eigen::Vector3d& sample) const {
    return lens_.point_of(origin_ + spacing_ * sample);
  }
  float& value(int i, int j, int k) {
    const auto x = static_cast<std::size_t>(size_.x());
    const auto y = static_cast<std::size_t>(size_.y());
    return values_[static_cast<std::size_t>(i) +
                   x * (static_cast<std::size_t>(j) + y * static_cast<std::size_t>(k))];
  }

  /// Takes the samples of a box of `cells` cells along each edge, which begins at `first`.
  void sample(const Eigen::Vector3i& first, int cells) {
    constexpr double steepness = 2;
    const Eigen::Vector3d from = first.cast<double>();
    const Eigen::Vector3d middle = point_of(from.array() + cells / 2.0);
    const double distance = solid_.distance(middle);
    double radius = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d offset(corner & 1, (corner >> 1) & 1, corner >> 2);
      radius = std::max(radius, (point_of(from + cells * offset) - middle).norm());
    }
    if (std::abs(distance) > steepness * radius) {
      fill(first, cells, [&](const Eigen::Vector3d&) { return distance; });
    } else if (cells == 2) {
      fill(first, cells, [this](const Eigen::Vector3d& at) { return solid_.distance(point_of(at)); });
    } else {
      for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3i offset(corner & 1, (corner >> 1) & 1, corner >> 2);
        sample(first + cells / 2 * offset, cells / 2);
      }
    }
  }

  /// Sets the samples at which the box begins but not those at which it ends: they are the next box's.
  template <class Value>
  void fill(const Eigen::Vector3i& first, int cells, const Value& value_at) {
    for (int k = first.z(); k < first.z() + cells; ++k) {
      for (int j = first.y(); j < first.y() + cells; ++j) {
        for (int i = first.x(); i < first.x() + cells; ++i)
          value(i, j, k) = static_cast<float>(value_at(Eigen::Vector3d(i, j, k)));
      }
    }
  }

  const Solid& solid_;
  double spacing_;
  Lens lens_;
  Eigen::Vector3i size_;
  Eigen::Vector3d origin_;
  std::vector<float> values_;
};

std::vector<Eigen::Vector3d> normals_of(const std::vector<Eigen::Vector3d>& vertices,
                                        const std::vector<Eigen::Vector3i>& triangles) {
  std::vector<Eigen::Vector3d> normals(vertices.size(), Eigen::Vector3d::Zero());
  for (const Eigen::Vector3i& t : triangles) {
    const Eigen::Vector3d& a = vertices[static_cast<std::size_t>(t[0])];
    const Eigen::Vector3d doubled =
        (vertices[static_cast<std::size_t>(t[1])] - a).cross(vertices[static_cast<std::size_t>(t[2])] - a);
    for (const int corner : t) normals[static_cast<std::size_t>(corner)] += doubled;
  }
  for (Eigen::Vector3d& normal : normals) normal.normalize();
  return normals;
}

/// Moves vertices along the surface towards the mean of their neighbours, which evens the triangles out, and
/// along its normals back to the surface, as far as distances are true.
void relax(const Solid& solid, std::vector<Eigen::Vector3d>& vertices,
           const std::vector<Eigen::Vector3i>& triangles) {
  const std::vector<Eigen::Vector3d> normals = normals_of(vertices, triangles);
  std::vector<Eigen::Vector3d> sums(vertices.size(), Eigen::Vector3d::Zero());
  std::vector<int> counts(vertices.size(), 0);
  for (const Eigen::Vector3i& t : triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      // Around a vertex of a closed mesh each neighbour is the next corner of one triangle.
      sums[static_cast<std::size_t>(t[corner])] += vertices[static_cast<std::size_t>(t[(corner + 1) % 3])];
      ++counts[static_cast<std::size_t>(t[corner])];
    }
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Eigen::Vector3d offset = sums[i] / std::max(counts[i], 1) - vertices[i];
    vertices[i] += offset - normals[i] * normals[i].dot(offset);
    vertices[i] -= normals[i] * solid.distance(vertices[i]);
  }
}

/// Steps of Newton's method towards the surface, none of more than `limit` mm.
Eigen::Vector3d on_surface(const Solid& solid, Eigen::Vector3d point, double limit) {
  constexpr int steps = 2;
  constexpr double h = 0.05;  // mm
  static const Eigen::Matrix<double, 3, 4> corners{{1, -1, -1, 1}, {1, -1, 1, -1}, {1, 1, -1, -1}};
  for (int step = 0; step < steps; ++step) {
    double distance = 0;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    for (int i = 0; i < 4; ++i) {
      const double value = solid.distance(point + h * corners.col(i));
      distance += value / 4;
      gradient += corners.col(i) * value / (4 * h);
    }
    const Eigen::Vector3d way = gradient * (distance / std::max(gradient.squaredNorm(), 0.1));
    point -= way * std::min(1.0, limit / std::max(way.norm(), limit));
  }
  return point;
}

}  // namespace

Mesh polygonise(const Solid& solid, const Sampling& sampling) {
  constexpr int rounds = 3;
  Mesh mesh = Samples(solid, sampling).surface();
  std::vector<Eigen::Vector3d> vertices;
  for (const Eigen::Vector3f& vertex : mesh.vertices) vertices.push_back(vertex.cast<double>());
  for (int round = 0; round < rounds; ++round) relax(solid, vertices, mesh.triangles);
  for (std::size_t i = 0; i < vertices.size(); ++i)
    mesh.vertices[i] = on_surface(solid, vertices[i], sampling.spacing / 4).cast<float>();
  return mesh;
}

}  // namespace pliant
