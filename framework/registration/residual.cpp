#include "framework/registration/residual.h"

#include <algorithm>
#include <cmath>

#include "framework/registration/matching.h"

namespace pliant {
namespace {

constexpr std::size_t chunk = 256;  // CHUNK in matching.cl

/// From the mean of squares and the mean.
double deviation_of(double squares, double mean) { return std::sqrt(std::max(0.0, squares - mean * mean)); }

}  // namespace

ResidualSum::ResidualSum(Device& device, std::size_t point_count, double cut)
    : device_(&device),
      count_(point_count),
      chunks_((point_count + chunk - 1) / chunk),
      cut_(static_cast<float>(cut)),
      partials_(device.allocate(chunks_ * sizeof(cl_float8))),
      total_(std::size_t{8}) {}

void ResidualSum::add_up(const Array<float>& residuals, const PointSet& moved, const SurfaceMap& target) {
  auto sum = matching_kernel(*device_, "sum_residuals");
  auto total = matching_kernel(*device_, "total_residual");
  device_->run("residual", sum, chunks_, 1, static_cast<cl_int>(count_), moved.points.device(*device_),
               pinhole(target.camera), frame_of(target), target.points().device(*device_),
               residuals.device(*device_), cut_, partials_);
  device_->run("residual", total, 1, 1, static_cast<cl_int>(chunks_), partials_,
               total_.write_device(*device_));
  total_.fetch();
}

Residual ResidualSum::read() const {
  const std::vector<float>& record = total_.host();
  const auto mean = [](float sum, auto count) {
    return count > 0 ? double{sum} / static_cast<double>(count) : 0.0;
  };
  const double average = mean(record[0], record[1]);
  return {average,
          static_cast<int>(record[1]),
          static_cast<int>(record[2]),
          static_cast<int>(record[3]),
          std::sqrt(mean(record[4], count_)),
          deviation_of(mean(record[5], record[1]), average)};
}

Residual sum_residuals_reference(const SurfaceMap& target, const Array<float>& moved,
                                 const std::vector<float>& per_point, double cut) {
  Residual residual;
  double sum = 0;
  double robust = 0;
  double squares = 0;
  for (std::size_t i = 0; i < per_point.size(); ++i) {
    const Eigen::Map<const Eigen::Vector3f> point(moved.host().data() + 3 * i);
    if (!(point.array().abs() < farthest_depth).all()) ++residual.lost;
    robust +=
        per_point[i] >= 0 ? std::min<double>(double{per_point[i]} * per_point[i], cut * cut) : cut * cut;
    if (per_point[i] >= 0) {
      sum += per_point[i];
      squares += double{per_point[i]} * per_point[i];
      ++residual.matched;
    }
    if (per_point[i] >= 0 || seen_pixel_reference(target, point)) ++residual.landed;
  }
  if (residual.matched > 0) {
    residual.mean = sum / residual.matched;
    residual.deviation = deviation_of(squares / residual.matched, residual.mean);
  }
  if (!per_point.empty()) residual.robust = std::sqrt(robust / static_cast<double>(per_point.size()));
  return residual;
}

}  // namespace pliant
