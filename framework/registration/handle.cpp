#include "framework/registration/handle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "framework/core/angle.h"
#include "framework/core/error.h"

namespace pliant {
namespace {

Eigen::Vector3f vector3(const std::vector<double>& numbers) {
  return Eigen::Map<const Eigen::Vector3d>(numbers.data()).cast<float>();
}

[[noreturn]] void refuse(const Handle& handle, const std::string& why) {
  throw ConfigError(handle.place + (handle.place.empty() ? "" : ": ") + why);
}

Eigen::Vector3f centre_of(const Handle& handle, const Surface& surface) {
  if (!handle.pixel) return handle.point;
  const auto seen = std::find(surface.pixels.begin(), surface.pixels.end(), *handle.pixel);
  if (seen == surface.pixels.end())
    refuse(handle, fmt::format("the handle is outside of the surface: there is no point at pixel ({}, {})",
                               handle.pixel->x(), handle.pixel->y()));
  return surface.points[static_cast<std::size_t>(seen - surface.pixels.begin())];
}

Handle make_handle(const Parameters& parameters) {
  Handle handle;
  handle.radius = static_cast<float>(parameters.real("radius"));
  handle.move = vector3(parameters.reals("move"));
  handle.rotation = vector3(parameters.reals("rotate")) * static_cast<float>(degree);
  handle.place = parameters.place();
  return handle;
}

ParameterTable handle_table(Parameter at) {
  return {
      std::move(at),
      real("radius").unit("mm").above(0).doc("The points of the surface this near are held"),
      reals("move", 3, std::vector<double>{0, 0, 0})
          .unit("mm")
          .doc("How far they are moved: x right, y down, z forward; a handle that stays holds them in place"),
      reals("rotate", 3, std::vector<double>{0, 0, 0})
          .unit("degree")
          .doc("How they are turned about the handle: the axis, as long as the angle"),
  };
}

}  // namespace

Grip take_hold(const Handle& handle, const Surface& surface) {
  const Eigen::Vector3f centre = centre_of(handle, surface);
  Grip grip;
  float nearest = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const float distance = (surface.points[i] - centre).norm();
    nearest = std::min(nearest, distance);
    if (distance <= handle.radius) grip.points.push_back(static_cast<int>(i));
  }
  if (grip.points.empty())
    refuse(handle,
           fmt::format("the handle holds nothing: the nearest point of the surface is {:.1f} mm away, "
                       "its radius is {:g} mm",
                       nearest, handle.radius));
  const float angle = handle.rotation.norm();
  const Eigen::Vector3f axis =
      angle > 0 ? Eigen::Vector3f(handle.rotation / angle) : Eigen::Vector3f::UnitX();
  grip.motion = Eigen::Translation3f(centre + handle.move) * Eigen::AngleAxisf(angle, axis) *
                Eigen::Translation3f(-centre);
  return grip;
}

void register_handles(Registry& registry) {
  registry.add<Handle>(
      "pixel", "Holds the surface around the point that is seen at a pixel",
      handle_table(reals("at", 2).unit("pixel").at_least(0).doc("Column and row of the source image")),
      [](const Parameters& parameters, const Registry&) {
        auto handle = std::make_unique<Handle>(make_handle(parameters));
        const auto& at = parameters.reals("at");
        // Further right or below there is no image.
        constexpr double most = 1e6;
        handle->pixel = Eigen::Vector2i(static_cast<int>(std::lround(std::min(at[0], most))),
                                        static_cast<int>(std::lround(std::min(at[1], most))));
        return handle;
      });
  registry.add<Handle>("point", "Holds the surface around a point in space",
                       handle_table(reals("at", 3).unit("mm").doc("x right, y down, z forward")),
                       [](const Parameters& parameters, const Registry&) {
                         auto handle = std::make_unique<Handle>(make_handle(parameters));
                         handle->point = vector3(parameters.reals("at"));
                         return handle;
                       });
}

}  // namespace pliant
