#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "experiments/datasets/depth_sensor.h"

namespace pliant {
namespace {

std::uint32_t mixed(std::uint32_t bits) {
  bits = (bits ^ (bits >> 16)) * 0x85ebca6bU;
  bits = (bits ^ (bits >> 13)) * 0xc2b2ae35U;
  return bits ^ (bits >> 16);
}

/// As normal_pair() of depth_sensor.cl.
Eigen::Vector2f normal_pair(std::uint32_t pixel, std::uint32_t number,
                            const std::array<std::uint32_t, 2>& key) {
  const std::uint32_t first = mixed(mixed(pixel + key[0]) + key[1] + number * 0x9e3779b9U);
  const std::uint32_t second = mixed(first + 0x9e3779b9U);
  const float radius = std::sqrt(-2 * std::log(static_cast<float>((first >> 8) + 1) * 0x1p-24F));
  const float angle = 6.2831853F * (static_cast<float>(second >> 8) * 0x1p-24F);
  return radius * Eigen::Vector2f(std::cos(angle), std::sin(angle));
}

}  // namespace

/// What the sensor makes of one image, pixel by pixel.
class SensorReference {
 public:
  SensorReference(const DepthSensor& sensor, const DepthImage& depth, std::uint32_t frame)
      : sensor_(sensor),
        settings_(sensor.settings_),
        camera_(sensor.camera_),
        depth_(depth),
        key_(sensor.key_of(frame)) {
    if (settings_.shadow > 0) lit_ = lit_pixels();
  }

  float sense(int u, int v) const {
    const auto pixel = static_cast<std::uint32_t>(v * depth_.width() + u);
    if (settings_.lateral > 0 && is_at_step(u, v)) {
      const Eigen::Vector2f shift = lateral_sigma(incidence(u, v)) * normal_pair(pixel, 1, key_);
      u = std::clamp(u + static_cast<int>(std::rint(shift.x())), 0, depth_.width() - 1);
      v = std::clamp(v + static_cast<int>(std::rint(shift.y())), 0, depth_.height() - 1);
    }
    float z = depth_(u, v);
    if (!(z > 0)) return 0;
    const float angle = incidence(u, v);
    if (angle > sensor_.grazing_ || (settings_.shadow > 0 && lit_(u, v) == 0)) return 0;
    if (settings_.axial > 0) z += axial_sigma(z, angle) * normal_pair(pixel, 0, key_).x();
    return std::max(z > 0 && settings_.quantisation > 0 ? quantised(z) : z, 0.0F);
  }

 private:
  float lateral_sigma(float angle) const {
    return static_cast<float>(settings_.lateral) *
           (0.8F + 0.035F * angle / (DepthSensor::half_pi - std::min(angle, DepthSensor::steepest_angle)));
  }

  float axial_sigma(float z, float angle) const {
    const float metres = z * 0.001F;
    const float beyond = metres - 0.4F;
    const float bounded = std::min(angle, DepthSensor::steepest_angle);
    const float ratio = bounded / (DepthSensor::half_pi - bounded);
    return static_cast<float>(settings_.axial) *
           (1.2F + 1.9F * beyond * beyond + 0.1F / std::sqrt(metres) * ratio * ratio);
  }

  float quantised(float z) const {
    const float focal_baseline = static_cast<float>(camera_.fx) * DepthSensor::quantised_baseline;
    const auto step = static_cast<float>(settings_.quantisation / 8);
    const float steps = std::rint(focal_baseline / z / step);
    return steps > 0 ? focal_baseline / (steps * step) : 0;
  }

  float depth_at(int u, int v) const { return depth_.contains(u, v) ? depth_(u, v) : 0; }

  bool is_same_surface(float z, float other) const {
    return z > 0 && other > 0 &&
           std::abs(other - z) <= DepthSensor::steepest * std::min(z, other) / static_cast<float>(camera_.fx);
  }

  Eigen::Vector3f point_at(int u, int v) const {
    return camera_.unproject(u, v, depth_at(u, v)).cast<float>();
  }

  Eigen::Vector3f tangent(int u, int v, int du, int dv) const {
    const float z = depth_at(u, v);
    const int before = is_same_surface(z, depth_at(u - du, v - dv)) ? 1 : 0;
    const int after = is_same_surface(z, depth_at(u + du, v + dv)) ? 1 : 0;
    return point_at(u + after * du, v + after * dv) - point_at(u - before * du, v - before * dv);
  }

  float incidence(int u, int v) const {
    const Eigen::Vector3f normal = tangent(u, v, 1, 0).cross(tangent(u, v, 0, 1));
    const Eigen::Vector3f point = point_at(u, v);
    const float lengths = normal.norm() * point.norm();
    return lengths > 0 ? std::acos(std::min(std::abs(normal.dot(point)) / lengths, 1.0F)) : 0;
  }

  bool is_at_step(int u, int v) const {
    const float z = depth_at(u, v);
    for (int dv = -1; dv <= 1; ++dv) {
      for (int du = -1; du <= 1; ++du) {
        if (!depth_.contains(u + du, v + dv)) continue;
        const float other = depth_at(u + du, v + dv);
        if ((z > 0 || other > 0) && !is_same_surface(z, other)) return true;
      }
    }
    return false;
  }

  MaskImage lit_pixels() const {
    MaskImage lit(depth_.width(), depth_.height(), 0);
    for (int v = 0; v < depth_.height(); ++v) {
      const std::vector<float> nearest = nearest_to_projector(v);
      for (int u = 0; u < depth_.width(); ++u) {
        const float z = depth_(u, v);
        if (z > 0) lit(u, v) = is_lit(static_cast<float>(u), disparity(z), nearest) ? 1 : 0;
      }
    }
    return lit;
  }

  float disparity(float z) const {
    return static_cast<float>(camera_.fx) * static_cast<float>(settings_.shadow) / z;
  }

  /// The disparities of what the projector meets first, by its column + width.
  std::vector<float> nearest_to_projector(int v) const {
    const int width = depth_.width();
    std::vector<float> nearest(static_cast<std::size_t>(2 * width), 0);
    const auto show = [&](int column, float value) {
      if (column < -width || column >= width) return;
      float& there = nearest[static_cast<std::size_t>(column + width)];
      there = std::max(there, value);
    };
    for (int u = 0; u < width; ++u) {
      const float z = depth_(u, v);
      if (!(z > 0)) continue;
      const float d = disparity(z);
      const float x = static_cast<float>(u) - d;
      if (!is_same_surface(z, depth_at(u + 1, v))) {
        show(static_cast<int>(std::rint(x)), d);
        continue;
      }
      const float next_d = disparity(depth_at(u + 1, v));
      const float next_x = static_cast<float>(u + 1) - next_d;
      const int last = std::min(static_cast<int>(std::floor(std::max(x, next_x))), width - 1);
      for (int column = std::max(static_cast<int>(std::ceil(std::min(x, next_x))), -width); column <= last;
           ++column) {
        const float share = (static_cast<float>(column) - x) / (next_x - x);
        show(column, share >= 0 && share <= 1 ? d + share * (next_d - d) : d);
      }
    }
    return nearest;
  }

  bool is_lit(float u, float d, const std::vector<float>& nearest) const {
    const int width = depth_.width();
    const auto column = static_cast<int>(std::floor(u - d));
    if (column < -width || column + 1 >= width) return true;
    const auto at = static_cast<std::size_t>(column + width);
    return d >= std::min(nearest[at], nearest[at + 1]) - DepthSensor::shadow_margin;
  }

  const DepthSensor& sensor_;
  const DepthSensorSettings& settings_;
  const Camera& camera_;
  const DepthImage& depth_;
  DepthSensor::Key key_;
  MaskImage lit_;
};

DepthImage DepthSensor::sense_reference(const DepthImage& depth, std::uint32_t frame) const {
  const SensorReference reference(*this, depth, frame);
  DepthImage sensed(depth.width(), depth.height());
  for (int v = 0; v < depth.height(); ++v)
    for (int u = 0; u < depth.width(); ++u) sensed(u, v) = reference.sense(u, v);
  return sensed;
}

}  // namespace pliant
