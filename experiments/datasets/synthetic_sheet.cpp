#include "experiments/datasets/synthetic_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "experiments/datasets/kinect_noise.h"
#include "experiments/datasets/texture.h"
#include "experiments/datasets/virtual_camera.h"
#include "framework/core/error.h"

namespace pliant {
namespace {

Eigen::Vector2d ray(const Camera& camera, int u, int v) { return camera.unproject(u, v, 1).head<2>(); }

/// What the camera sees of the sheet where `see` tells which material a ray meets and `place` where it is.
template <class See, class Place>
RgbdFrame render(const Camera& camera, See see, Place place) {
  RgbdFrame frame{DepthImage(camera.width, camera.height), ColorImage(camera.width, camera.height), {}};
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector2d slope = ray(camera, u, v);
      if (const auto st = see(slope.x(), slope.y())) {
        frame.depth(u, v) = static_cast<float>(place(st->x(), st->y()).z());
        frame.color(u, v) = texture_color({st->x(), st->y(), 0});
      }
    }
  }
  return frame;
}

Image<Eigen::Vector3f> true_motion(const Camera& camera, const BendingSheet& sheet) {
  const auto unknown = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
  Image<Eigen::Vector3f> flow(camera.width, camera.height, unknown);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector2d slope = ray(camera, u, v);
      if (const auto st = sheet.see_flat(slope.x(), slope.y())) {
        flow(u, v) = (sheet.bent(st->x(), st->y()) - sheet.flat(st->x(), st->y())).cast<float>();
      }
    }
  }
  return flow;
}

void check_is_seen(const DepthImage& depth, const char* which) {
  const auto& pixels = depth.pixels();
  if (std::any_of(pixels.begin(), pixels.end(), [](float value) { return value > 0; })) return;
  throw DataError(fmt::format("synthetic_sheet: no pixel of the camera sees the {} sheet", which));
}

}  // namespace

BendingSheet::BendingSheet(const Shape& shape)
    : shape_(shape), w_(2 * std::numbers::pi * shape.frequency / shape.width), k_(shape.amplitude * w_) {
  check();
}

void BendingSheet::check() const {
  const double nearest = shape_.distance - shape_.approach - shape_.amplitude;
  if (nearest <= 0) {
    throw ConfigError(fmt::format(
        "synthetic_sheet: the sheet reaches the camera; expected approach + amplitude < distance ({} mm)",
        shape_.distance));
  }
  // No ray that meets the sheet leans more than `steepest_ray` from the optical axis. While the sheet is
  // nowhere as steep as such a ray, each ray meets it once and nothing is hidden.
  const double steepest_ray = shape_.width / 2 / nearest;
  const double limit = 1 / std::hypot(1, steepest_ray);
  if (k_ >= limit) {
    throw ConfigError(fmt::format(
        "synthetic_sheet: the sheet hides a part of itself; expected amplitude < {:.1f} mm at this "
        "frequency and width, or a lower frequency",
        limit / w_));
  }
}

double BendingSheet::x(double s) const { return std::ellint_2(k_, w_ * s) / w_; }

double BendingSheet::z(double s) const {
  return shape_.distance - shape_.approach + shape_.amplitude * std::cos(w_ * s);
}

std::optional<Eigen::Vector2d> BendingSheet::inside(double s, double t) const {
  if (std::abs(s) > shape_.width / 2 || std::abs(t) > shape_.height / 2) return std::nullopt;
  return Eigen::Vector2d(s, t);
}

std::optional<Eigen::Vector2d> BendingSheet::see_flat(double a, double b) const {
  return inside(a * shape_.distance, b * shape_.distance);
}

std::optional<Eigen::Vector2d> BendingSheet::see_bent(double a, double b) const {
  const auto s = solve(a);
  if (!s) return std::nullopt;
  return inside(*s, b * z(*s));
}

/// The s at which x(s) = a z(s). The difference rises everywhere (see check()), so there is at most one;
/// Newton's steps are kept inside the interval that is known to hold it.
std::optional<double> BendingSheet::solve(double a) const {
  constexpr double kTolerance = 1e-9;  // mm
  double low = -shape_.width / 2;
  double high = shape_.width / 2;
  if (x(low) > a * z(low) || x(high) < a * z(high)) return std::nullopt;
  double s = std::clamp(a * shape_.distance, low, high);
  while (high - low > kTolerance) {
    const double difference = x(s) - a * z(s);
    if (std::abs(difference) < kTolerance) break;
    (difference < 0 ? low : high) = s;
    const double sine = k_ * std::sin(w_ * s);
    s -= difference / (std::sqrt(1 - sine * sine) + a * sine);
    if (s <= low || s >= high) s = (low + high) / 2;
  }
  return s;
}

FramePair SyntheticSheet::load(std::uint64_t seed) const {
  FramePair pair;
  pair.name = "synthetic sheet";
  pair.camera = camera_;
  pair.source = render(
      camera_, [&](double a, double b) { return sheet_.see_flat(a, b); },
      [&](double s, double t) { return sheet_.flat(s, t); });
  pair.target = render(
      camera_, [&](double a, double b) { return sheet_.see_bent(a, b); },
      [&](double s, double t) { return sheet_.bent(s, t); });
  check_is_seen(pair.source.depth, "flat");
  check_is_seen(pair.target.depth, "bent");
  pair.scene_flow = true_motion(camera_, sheet_);
  KinectNoise noise(noise_, camera_.fx, seed);
  noise.disturb(pair.source.depth);
  noise.disturb(pair.target.depth);
  return pair;
}

void register_synthetic_sheet(Registry& registry) {
  const BendingSheet::Shape shape;
  registry.add<DataSource>(
      "synthetic_sheet",
      "A flat sheet that bends without stretching, with its true motion [thesis data set I]",
      with_camera({
          real("amplitude", shape.amplitude).unit("mm").at_least(0).doc("height of the wave over its middle"),
          real("frequency", shape.frequency).above(0).doc("waves over the width of the sheet"),
          real("approach", shape.approach)
              .unit("mm")
              .doc("how far the whole sheet comes nearer while bending"),
          real("noise", 0).range(0, 10).doc("strength of Kinect-like depth noise: 0 none, 1 as the camera"),
          real("sheet_width", shape.width).unit("mm").above(0).doc("size of the sheet in x, where it bends"),
          real("sheet_height", shape.height).unit("mm").above(0).doc("size of the sheet in y"),
          real("distance", shape.distance).unit("mm").above(0).doc("of the flat sheet from the camera"),
      }),
      [](const Parameters& parameters, const Registry&) -> std::unique_ptr<DataSource> {
        const BendingSheet sheet({parameters.real("sheet_width"), parameters.real("sheet_height"),
                                  parameters.real("distance"), parameters.real("amplitude"),
                                  parameters.real("frequency"), parameters.real("approach")});
        return std::make_unique<SyntheticSheet>(sheet, virtual_camera(parameters), parameters.real("noise"));
      });
}

}  // namespace pliant
