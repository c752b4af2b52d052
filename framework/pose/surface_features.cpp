#include "framework/pose/surface_features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace pliant {
namespace {

constexpr double spacing = 9;                   // mm
constexpr std::array<double, 2> radii{25, 50};  // mm
constexpr int bins = 11;
constexpr int histogram = 3 * bins;
constexpr int fewest_neighbours = 8;

using Histogram = Eigen::Array<float, histogram, 1>;

/// Some points of a map, on a grid of its pixels.
struct Samples {
  int columns = 0;
  int rows = 0;
  std::vector<Eigen::Vector3f> points;   // mm; (0, 0, 0) where there is none
  std::vector<Eigen::Vector3f> normals;  // likewise

  std::size_t offset(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
  bool is_point(std::size_t i) const { return !points[i].isZero(0) && !normals[i].isZero(0); }
};

/// Depth of the middle of all points, mm; 0 without any.
double middle_depth(const SurfaceMap& seen) {
  std::vector<float> depths;
  for (std::size_t i = 0; i < seen.window.size(); i += 7) {
    const float z = finite_or_none(seen.points(), i).z();
    if (z > 0) depths.push_back(z);
  }
  if (depths.empty()) return 0;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return *middle;
}

Samples sample(const SurfaceMap& seen) {
  const double depth = middle_depth(seen);
  if (depth == 0) return {};
  const int step = std::max(1, static_cast<int>(std::lround(spacing * seen.camera.fx / depth)));
  const PixelWindow& window = seen.window;
  Samples samples{(window.width + step - 1) / step, (window.height + step - 1) / step, {}, {}};
  for (int v = 0; v < window.height; v += step) {
    for (int u = 0; u < window.width; u += step) {
      const std::size_t i = window.offset(window.left + u, window.top + v);
      samples.points.push_back(finite_or_none(seen.points(), i));
      samples.normals.push_back(finite_or_none(seen.normals(), i));
    }
  }
  return samples;
}

/// Calls `take` with each other point within `radius` mm, and its distance.
template <class Take>
void for_each_near(const Samples& samples, int column, int row, double radius, Take take) {
  const int reach = static_cast<int>(std::ceil(1.5 * radius / spacing));  // of near points pixels are close
  const Eigen::Vector3f& point = samples.points[samples.offset(column, row)];
  for (int y = std::max(0, row - reach); y <= std::min(samples.rows - 1, row + reach); ++y) {
    for (int x = std::max(0, column - reach); x <= std::min(samples.columns - 1, column + reach); ++x) {
      const std::size_t other = samples.offset(x, y);
      if ((x == column && y == row) || !samples.is_point(other)) continue;
      const float distance = (samples.points[other] - point).norm();
      if (distance <= radius) take(other, distance);
    }
  }
}

int bin_of(float value, float least, float greatest) {
  const int bin = static_cast<int>(bins * (value - least) / (greatest - least));
  return std::clamp(bin, 0, bins - 1);
}

/// How the normals of a point and of one near it lie to each other: the three angles of Rusu's pairs.
void count_pair(const Samples& samples, std::size_t point, std::size_t other, float distance,
                Histogram& counts) {
  constexpr float pi = std::numbers::pi_v<float>;
  const Eigen::Vector3f way = (samples.points[other] - samples.points[point]) / distance;
  const Eigen::Vector3f& u = samples.normals[point];
  const Eigen::Vector3f& normal = samples.normals[other];
  const Eigen::Vector3f v = way.cross(u).stableNormalized();
  const Eigen::Vector3f w = u.cross(v);
  counts[bin_of(v.dot(normal), -1, 1)] += 1;
  counts[bins + bin_of(u.dot(way), -1, 1)] += 1;
  counts[2 * bins + bin_of(std::atan2(w.dot(normal), u.dot(normal)), -pi, pi)] += 1;
}

/// The simplified histogram of every point, each of its thirds summing up to 1; 0 where there is none.
std::vector<Histogram> simple_histograms(const Samples& samples, double radius) {
  std::vector<Histogram> histograms(samples.points.size(), Histogram::Zero());
  for (int row = 0; row < samples.rows; ++row) {
    for (int column = 0; column < samples.columns; ++column) {
      const std::size_t i = samples.offset(column, row);
      if (!samples.is_point(i)) continue;
      int count = 0;
      for_each_near(samples, column, row, radius, [&](std::size_t other, float distance) {
        count_pair(samples, i, other, distance, histograms[i]);
        ++count;
      });
      histograms[i] = count < fewest_neighbours ? Histogram::Zero().eval() : (histograms[i] / count).eval();
    }
  }
  return histograms;
}

/// That of a point and those of its neighbours, the nearer the more.
Histogram fast_histogram(const Samples& samples, const std::vector<Histogram>& simple, int column, int row,
                         double radius) {
  Histogram sum = Histogram::Zero();
  float weights = 0;
  for_each_near(samples, column, row, radius, [&](std::size_t other, float distance) {
    if (simple[other].isZero(0)) return;
    sum += simple[other] / distance;
    weights += 1 / distance;
  });
  const Histogram own = simple[samples.offset(column, row)];
  return weights > 0 ? Histogram((own + sum / weights) / 2) : own;
}

}  // namespace

SurfaceFeatures find_surface_features(const SurfaceMap& seen) {
  const Samples samples = sample(seen);
  std::array<std::vector<Histogram>, radii.size()> simple;
  for (std::size_t i = 0; i < radii.size(); ++i) simple[i] = simple_histograms(samples, radii[i]);
  SurfaceFeatures features;
  for (int row = 0; row < samples.rows; ++row) {
    for (int column = 0; column < samples.columns; ++column) {
      const std::size_t i = samples.offset(column, row);
      if (!samples.is_point(i) || simple[0][i].isZero(0)) continue;
      features.points.push_back(samples.points[i].cast<double>());
      for (std::size_t scale = 0; scale < radii.size(); ++scale) {
        const Histogram values = fast_histogram(samples, simple[scale], column, row, radii[scale]).sqrt();
        features.descriptors.insert(features.descriptors.end(), values.data(), values.data() + histogram);
      }
    }
  }
  return features;
}

}  // namespace pliant
