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
Frame render(const Camera& camera, See see, Place place) {
  Frame frame{DepthImage(camera.width, camera.height), ColorImage(camera.width, camera.height), {}};
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

/// The share of the whole deformation that frame `number`, from 2 on, shows.
double share_of(int number, int frames) {
  const double way = static_cast<double>(number - 1) / (frames - 1);
  return way * way * (3 - 2 * way);
}

class SheetStream : public DataStream {
 public:
  SheetStream(const BendingSheet& sheet, const SyntheticSheet::Settings& settings, std::uint64_t seed)
      : sheet_(sheet),
        rig_{settings.camera},
        frames_(settings.frames),
        noise_(settings.noise, settings.camera.fx, seed) {}

  std::string name() const override { return "synthetic sheet"; }
  const Rig& rig() const override { return rig_; }

  std::optional<Frame> next() override {
    if (given_ == frames_) return std::nullopt;
    ++given_;
    Frame frame = given_ == 1 ? flat() : bent(sheet_.partly(share_of(given_, frames_)));
    check_is_seen(frame.depth, given_ == 1 ? "flat" : "bent");
    noise_.disturb(frame.depth);
    frame.time = (given_ - 1) / frame_rate;
    return frame;
  }

  bool reads_on_host() const override { return true; }

  std::optional<PairTruth> truth(int number) const override {
    if (number < 2 || number > frames_) return std::nullopt;
    return PairTruth{true_motion(rig_.depth, sheet_.partly(share_of(number, frames_)))};
  }

 private:
  Frame flat() const {
    return render(
        rig_.depth, [&](double a, double b) { return sheet_.see_flat(a, b); },
        [&](double s, double t) { return sheet_.flat(s, t); });
  }

  Frame bent(const BendingSheet& sheet) const {
    return render(
        rig_.depth, [&](double a, double b) { return sheet.see_bent(a, b); },
        [&](double s, double t) { return sheet.bent(s, t); });
  }

  BendingSheet sheet_;
  Rig rig_;
  int frames_;
  KinectNoise noise_;
  int given_ = 0;
};

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

BendingSheet BendingSheet::partly(double share) const {
  Shape shape = shape_;
  shape.amplitude *= share;
  shape.approach *= share;
  return BendingSheet(shape);
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

std::unique_ptr<DataStream> SyntheticSheet::open(Device& /*device*/, std::uint64_t seed) const {
  return std::make_unique<SheetStream>(sheet_, settings_, seed);
}

void register_synthetic_sheet(Registry& registry) {
  const BendingSheet::Shape shape;
  registry.add<FrameSource>(
      "synthetic_sheet",
      "A flat sheet that bends without stretching, with its true motion [thesis data set I]",
      with_camera({
          real("amplitude", shape.amplitude).unit("mm").at_least(0).doc("height of the wave over its middle"),
          real("frequency", shape.frequency).above(0).doc("waves over the width of the sheet"),
          real("approach", shape.approach)
              .unit("mm")
              .doc("how far the whole sheet comes nearer while bending"),
          real("noise", 0).range(0, 10).doc("strength of Kinect-like depth noise: 0 none, 1 as the camera"),
          integer("frames", 2)
              .range(2, 1000000)
              .doc("length of the stream, over which the sheet bends; a pair is its first two"),
          real("sheet_width", shape.width).unit("mm").above(0).doc("size of the sheet in x, where it bends"),
          real("sheet_height", shape.height).unit("mm").above(0).doc("size of the sheet in y"),
          real("distance", shape.distance).unit("mm").above(0).doc("of the flat sheet from the camera"),
      }),
      [](const Parameters& parameters, const Registry&) -> std::unique_ptr<FrameSource> {
        const BendingSheet sheet({parameters.real("sheet_width"), parameters.real("sheet_height"),
                                  parameters.real("distance"), parameters.real("amplitude"),
                                  parameters.real("frequency"), parameters.real("approach")});
        return std::make_unique<SyntheticSheet>(
            sheet, SyntheticSheet::Settings{virtual_camera(parameters), parameters.real("noise"),
                                            static_cast<int>(parameters.integer("frames"))});
      });
}

}  // namespace pliant
