#include "framework/pose/rigid_ransac.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <utility>

namespace pliant {
namespace {

using Triple = std::array<std::size_t, 3>;

/// std::uniform_int_distribution may differ from one standard library to the next; this does not.
std::size_t draw_below(std::size_t count, std::mt19937_64& random) {
  const std::uint64_t whole = std::mt19937_64::max() - std::mt19937_64::max() % count;
  std::uint64_t value = random();
  while (value >= whole) value = random();
  return static_cast<std::size_t>(value % count);
}

Triple draw_triple(std::size_t count, std::mt19937_64& random) {
  Triple triple{draw_below(count, random), draw_below(count - 1, random), draw_below(count - 2, random)};
  // The second and third draws number what the earlier ones left over.
  if (triple[1] >= triple[0]) ++triple[1];
  for (const std::size_t taken : {std::min(triple[0], triple[1]), std::max(triple[0], triple[1])}) {
    if (triple[2] >= taken) ++triple[2];
  }
  return triple;
}

/// A rigid motion keeps lengths, so most wrong triples are seen without fitting one. A thin triangle
/// leaves the rotation about its long side to noise.
bool may_be_rigid(const PointMatches& matches, const Triple& triple, double inlier_distance) {
  double longest = 0;
  for (int i = 0; i < 3; ++i) {
    const std::size_t a = triple[i];
    const std::size_t b = triple[(i + 1) % 3];
    const double before = (matches.from[a] - matches.from[b]).norm();
    const double after = (matches.to[a] - matches.to[b]).norm();
    if (std::abs(before - after) > 2 * inlier_distance) return false;
    longest = std::max(longest, before);
  }
  const Eigen::Vector3d side = matches.from[triple[1]] - matches.from[triple[0]];
  const Eigen::Vector3d other = matches.from[triple[2]] - matches.from[triple[0]];
  return side.cross(other).norm() > 0.1 * longest * longest;
}

Eigen::Isometry3d fit_rigid(const PointMatches& matches, const std::vector<std::size_t>& chosen) {
  Eigen::Matrix3Xd from(3, chosen.size());
  Eigen::Matrix3Xd to(3, chosen.size());
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    from.col(i) = matches.from[chosen[i]];
    to.col(i) = matches.to[chosen[i]];
  }
  return Eigen::Isometry3d(Eigen::umeyama(from, to, false));
}

struct Support {
  double cost = 0;  ///< squared distances, an outlier's cut off: prefers close agreement among equal counts
  std::vector<std::size_t> inliers;
};

Support find_support(const PointMatches& matches, const Eigen::Isometry3d& motion, double inlier_distance) {
  const double limit = inlier_distance * inlier_distance;
  Support support;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const double squared = (motion * matches.from[i] - matches.to[i]).squaredNorm();
    if (squared < limit) support.inliers.push_back(i);
    support.cost += std::min(squared, limit);
  }
  return support;
}

struct Hypothesis {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  Support support;
};

/// Whether one of so many triples was as good as certainly of matches that agree, judged by how many agree
/// with the best motion so far [Fischler and Bolles 1981].
bool is_hardly_missed(const Hypothesis& hypothesis, const PointMatches& matches, int tried) {
  constexpr double chance_of_a_miss = 1e-9;
  const double share =
      static_cast<double>(hypothesis.support.inliers.size()) / static_cast<double>(matches.size());
  return std::pow(1 - share * share * share, tried) < chance_of_a_miss;
}

std::optional<Hypothesis> best_hypothesis(const PointMatches& matches, const RansacOptions& options,
                                          std::mt19937_64& random) {
  std::optional<Hypothesis> best;
  for (int i = 0; i < options.iterations && !(best && is_hardly_missed(*best, matches, i)); ++i) {
    const Triple triple = draw_triple(matches.size(), random);
    if (!may_be_rigid(matches, triple, options.inlier_distance)) continue;
    const Eigen::Isometry3d motion = fit_rigid(matches, {triple.begin(), triple.end()});
    Support support = find_support(matches, motion, options.inlier_distance);
    if (!best || support.cost < best->support.cost) best = Hypothesis{motion, std::move(support)};
  }
  return best;
}

/// Fits to all inliers until that finds no better support: three matches alone carry their own noise.
void refine(const PointMatches& matches, double inlier_distance, Hypothesis& hypothesis) {
  while (hypothesis.support.inliers.size() >= 3) {
    const Eigen::Isometry3d motion = fit_rigid(matches, hypothesis.support.inliers);
    Support support = find_support(matches, motion, inlier_distance);
    if (!(support.cost < hypothesis.support.cost)) return;
    hypothesis = {motion, std::move(support)};
  }
}

}  // namespace

AlignmentResult fit_rigid_ransac(const PointMatches& matches, const RansacOptions& options,
                                 std::uint64_t seed) {
  AlignmentResult result;
  result.matches = static_cast<int>(matches.size());
  if (matches.size() < 3) return result;
  std::mt19937_64 random(seed);
  std::optional<Hypothesis> best = best_hypothesis(matches, options, random);
  if (!best) return result;
  refine(matches, options.inlier_distance, *best);
  result.motion = best->motion;
  result.inliers = static_cast<int>(best->support.inliers.size());
  return result;
}

}  // namespace pliant
