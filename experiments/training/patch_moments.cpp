#include <algorithm>
#include <cmath>

#include "experiments/training/tree_growth.h"
#include "framework/core/angle.h"

namespace pliant {
namespace {

constexpr double least_offset_variance = 1;  // mm^2
constexpr double least_angle = 0.5 * degree;

Eigen::Matrix<double, 6, 1> products(const Eigen::Vector3d& a) {
  Eigen::Matrix<double, 6, 1> result;
  result << a.x() * a.x(), a.x() * a.y(), a.x() * a.z(), a.y() * a.y(), a.y() * a.z(), a.z() * a.z();
  return result;
}

/// Half the logarithm of the determinant of a covariance.
double half_log_determinant(const Eigen::Matrix<double, 6, 1>& covariance, double least_variance) {
  const double xx = covariance[0] + least_variance;
  const double yy = covariance[3] + least_variance;
  const double zz = covariance[5] + least_variance;
  const double xy = covariance[1];
  const double xz = covariance[2];
  const double yz = covariance[4];
  const double determinant = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
  return 0.5 * std::log(std::max(determinant, least_variance * least_variance * least_variance));
}

double spread(const Eigen::Matrix<double, 6, 1>& covariance) {
  return std::sqrt(std::max(covariance[0] + covariance[3] + covariance[5], 0.0));
}

double plogp(double p) { return p > 0 ? p * std::log(p) : 0; }

}  // namespace

void PatchMoments::add(const TrainingPatch& patch) {
  if (!patch.is_head) {
    ++others_;
    return;
  }
  ++heads_;
  const Eigen::Vector3d offset = patch.offset.cast<double>();
  const Eigen::Vector3d angles = patch.angles.cast<double>();
  offset_ += offset;
  angles_ += angles;
  offset_products_ += products(offset);
  angle_products_ += products(angles);
}

void PatchMoments::add(const PatchMoments& other) {
  heads_ += other.heads_;
  others_ += other.others_;
  offset_ += other.offset_;
  angles_ += other.angles_;
  offset_products_ += other.offset_products_;
  angle_products_ += other.angle_products_;
}

void PatchMoments::subtract(const PatchMoments& other) {
  heads_ -= other.heads_;
  others_ -= other.others_;
  offset_ -= other.offset_;
  angles_ -= other.angles_;
  offset_products_ -= other.offset_products_;
  angle_products_ -= other.angle_products_;
}

double PatchMoments::class_entropy() const {
  if (count() == 0) return 0;
  const double share = static_cast<double>(heads_) / count();
  return -plogp(share) - plogp(1 - share);
}

double PatchMoments::pose_entropy() const {
  if (heads_ == 0) return 0;
  const Symmetric offset = offset_products_ / heads_ - products(offset_ / heads_);
  const Symmetric angles = angle_products_ / heads_ - products(angles_ / heads_);
  return half_log_determinant(offset, least_offset_variance) +
         half_log_determinant(angles, least_angle * least_angle);
}

HeadLeaf PatchMoments::leaf() const {
  HeadLeaf leaf;
  if (heads_ == 0) return leaf;
  leaf.head_share = static_cast<float>(heads_) / static_cast<float>(count());
  leaf.offset = (offset_ / heads_).cast<float>();
  leaf.angles = (angles_ / heads_).cast<float>();
  leaf.offset_spread = static_cast<float>(spread(offset_products_ / heads_ - products(offset_ / heads_)));
  leaf.angle_spread = static_cast<float>(spread(angle_products_ / heads_ - products(angles_ / heads_)));
  return leaf;
}

}  // namespace pliant
