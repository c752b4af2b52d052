#include "framework/registration/residual.h"

#include <array>

#include "framework/registration/projection.h"

namespace pliant {
namespace {

constexpr std::size_t chunk = 256;  // CHUNK in projection.cl

}  // namespace

ResidualMeter::ResidualMeter(Device& device, const Target& target, std::size_t point_count)
    : device_(&device),
      target_(&target),
      chunks_((point_count + chunk - 1) / chunk),
      per_point_(point_count),
      partials_(device.allocate(chunks_ * sizeof(cl_float4))),
      total_(device.allocate(sizeof(cl_float4))) {}

Residual ResidualMeter::measure(const Array<float>& moved) {
  auto sum = projection_kernel(*device_, "residuals");
  auto total = projection_kernel(*device_, "total_residual");
  device_->run("residual", sum, chunks_, 1, static_cast<cl_int>(moved.size() / 3), moved.device(*device_),
               pinhole(target_->camera), image_size(target_->camera), target_->points.device(*device_),
               per_point_.write_device(*device_), partials_);
  device_->run("residual", total, 1, 1, static_cast<cl_int>(chunks_), partials_, total_);
  std::array<float, 4> record{};
  device_->read(total_, record.data(), sizeof(record));
  return {record[1] > 0 ? static_cast<double>(record[0]) / static_cast<double>(record[1]) : 0.0,
          static_cast<int>(record[1]), static_cast<int>(record[2])};
}

Residual measure_residual_reference(const Target& target, const Array<float>& moved,
                                    std::vector<float>& per_point) {
  Residual residual;
  double sum = 0;
  const auto& values = moved.host();
  per_point.assign(values.size() / 3, -1);
  for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
    const Eigen::Vector3f point(values[i], values[i + 1], values[i + 2]);
    if (!(point.array().abs() < farthest_depth).all()) ++residual.lost;
    const auto pixel = target_pixel_reference(target, point);
    if (!pixel) continue;
    const float distance =
        (point - Eigen::Map<const Eigen::Vector3f>(target.points.host().data() + 3 * *pixel)).norm();
    per_point[i / 3] = distance;
    sum += distance;
    ++residual.landed;
  }
  if (residual.landed > 0) residual.mean = sum / residual.landed;
  return residual;
}

}  // namespace pliant
