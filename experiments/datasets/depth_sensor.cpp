#include "experiments/datasets/depth_sensor.h"

#include <fmt/format.h>

#include <random>
#include <string>

#include "experiments/datasets/depth_sensor.cl.embed.h"
#include "framework/core/angle.h"
#include "framework/geometry/surface_map.h"

namespace pliant {
namespace {

cl_int2 size_of(const Camera& camera) { return {{camera.width, camera.height}}; }

}  // namespace

ParameterTable depth_sensor_table() {
  return {
      real("axial", 0).range(0, 10).doc("strength of noise along the ray: 0 none, 1 as the camera"),
      real("quantisation", 0)
          .range(0, 10)
          .doc("step of the disparity in eighths of a pixel: 0 none, 1 as the camera"),
      real("lateral", 0)
          .range(0, 10)
          .doc("strength of noise across the ray at steps in depth: 0 none, 1 as the camera"),
      real("grazing", 0)
          .unit("degree")
          .range(0, 90)
          .doc("angle of incidence beyond which there is no depth: 0 any has, 80 as the camera"),
      real("shadow", 0)
          .unit("mm")
          .range(0, 1000)
          .doc("from the camera to its projector, which casts shadows without depth: 0 none, 75 as the "
               "camera"),
  };
}

DepthSensorSettings read_depth_sensor(const Parameters& section) {
  return {section.real("axial"), section.real("quantisation"), section.real("lateral"),
          section.real("grazing"), section.real("shadow")};
}

DepthSensor::DepthSensor(const DepthSensorSettings& settings, const Camera& camera, std::uint64_t seed)
    : settings_(settings),
      camera_(camera),
      seed_(seed),
      grazing_(settings.grazing > 0 ? static_cast<float>(settings.grazing * degree) : half_pi) {}

DepthSensor::Key DepthSensor::key_of(std::uint32_t frame) const {
  std::mt19937_64 generator(seed_ + 0x9e3779b97f4a7c15U * (std::uint64_t{frame} + 1));
  const std::uint64_t bits = generator();
  return {static_cast<std::uint32_t>(bits), static_cast<std::uint32_t>(bits >> 32)};
}

Array<float> DepthSensor::sense(Device& device, const Array<float>& depth, std::uint32_t frame) const {
  static const std::string options =
      fmt::format("-DSTEEPEST={:.9e}f -DSHADOW_MARGIN={:.9e}f -DHALF_PI={:.9e}f -DSTEEPEST_ANGLE={:.9e}f",
                  steepest, shadow_margin, half_pi, steepest_angle);
  const auto kernel = [&](const char* name) {
    return device.kernel(embedded::experiments_datasets_depth_sensor_cl, name, options);
  };
  const std::size_t pixels = depth.size();
  Array<cl_uchar> lit(pixels);
  if (settings_.shadow > 0) {
    const Buffer seen = device.allocate(2 * sizeof(float) * pixels);
    auto light = kernel("light");
    device.run("sense", light, static_cast<std::size_t>(camera_.height), 0, depth.device(device),
               size_of(camera_), pinhole(camera_), static_cast<float>(settings_.shadow), seen,
               lit.write_device(device));
  }
  Array<float> sensed(pixels);
  const Key key = key_of(frame);
  auto sense = kernel("sense");
  device.run("sense", sense, pixels, 64, depth.device(device), size_of(camera_), pinhole(camera_),
             static_cast<float>(settings_.axial), static_cast<float>(settings_.quantisation / 8),
             static_cast<float>(settings_.lateral), grazing_,
             static_cast<float>(camera_.fx) * quantised_baseline, cl_int{settings_.shadow > 0 ? 1 : 0},
             lit.device(device), cl_uint2{{key[0], key[1]}}, sensed.write_device(device));
  return sensed;
}

}  // namespace pliant
