#include "experiments/datasets/openni_stream.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "framework/core/error.h"

namespace pliant {
namespace {

/// The camera that a field of view makes. Throws DataError where the device does not tell it.
Camera told(const Camera& camera, const std::string& name, const char* keys) {
  if (camera.fx > 0 && camera.fy > 0) return camera;
  throw DataError(fmt::format("{}: it does not tell its field of view; give {}", name, keys));
}

}  // namespace

OpenNiStream::OpenNiStream(const Settings& settings)
    : device_(settings.device), selection_(settings.selection), warnings_(device_.warnings()) {
  set_depth_camera(settings.camera);
  if (device_.has_color() && !device_.is_registered()) set_color_camera(settings);
  if (!device_.has_color()) pairing_.end_color();
}

void OpenNiStream::set_depth_camera(const std::optional<CameraChoice>& choice) {
  const Camera by_view = device_.depth_camera();
  if (!choice) {
    rig_.depth = told(by_view, name(), "'intrinsics', or fx, fy, cx and cy");
    return;
  }
  Intrinsics intrinsics = intrinsics_of(*choice, by_view.width, by_view.height);
  rig_.depth = intrinsics.camera;
  add(std::move(intrinsics.warnings), warnings_);
}

void OpenNiStream::set_color_camera(const Settings& settings) {
  const Camera by_view = device_.color_camera();
  if (settings.color_intrinsics.empty()) {
    rig_.color = told(by_view, name(), "'color_intrinsics'");
  } else {
    Intrinsics intrinsics = read_intrinsics(settings.color_intrinsics, by_view.width, by_view.height);
    rig_.color = intrinsics.camera;
    add(std::move(intrinsics.warnings), warnings_);
  }
  if (settings.color_from_depth) {
    rig_.color_from_depth = *settings.color_from_depth;
    add(doubts_about_distance(rig_.color_from_depth, name()), warnings_);
  } else {
    warnings_.push_back(
        name() +
        ": depth and colour are not registered; the colour camera is taken to stand where the depth "
        "camera does; say by 'color_from_depth' where it is");
  }
}

std::optional<Frame> OpenNiStream::next() {
  if (selection_.count && given_ == *selection_.count) return std::nullopt;
  while (auto frame = read()) {
    const int past = read_ - selection_.first;
    if (past < 0 || past % selection_.step != 0) continue;
    ++given_;
    if (device_.has_color() && frame->color.empty()) ++colorless_;
    return frame;
  }
  if (read_ > 0 && given_ == 0)
    throw DataError(
        fmt::format("{}: frame {} is to be the first, but it has {}", name(), selection_.first, read_));
  return std::nullopt;
}

/// The next frame, selected or not.
std::optional<Frame> OpenNiStream::read() {
  std::optional<Frame> frame;
  while (!(frame = pairing_.next())) {
    auto image = device_.next();
    if (!image) {
      pairing_.end_color();
      frame = pairing_.next();
      break;
    }
    take(*std::move(image));
  }
  if (frame) ++read_;
  return frame;
}

void OpenNiStream::take(SensorImage image) {
  if (!start_) start_ = image.time;
  const double time = static_cast<double>(image.time - *start_) * 1e-6;
  if (image.color.empty())
    take_depth(std::move(image.depth), time);
  else
    pairing_.add_color(std::move(image.color), time);
}

void OpenNiStream::take_depth(DepthImage depth, double time) {
  if (depths_ > 0 && time <= time_) {
    ++late_;
    return;
  }
  const long between = depths_ > 0 ? std::lround((time - time_) * device_.rate()) - 1 : 0;
  if (between > 0 && missing_ == 0) first_missing_ = depths_;
  if (between > 0) missing_ += static_cast<int>(between);
  ++depths_;
  time_ = time;
  pairing_.add_depth({std::move(depth), {}, {}, time});
}

std::vector<std::string> OpenNiStream::warnings() const {
  std::vector<std::string> all = warnings_;
  if (missing_ > 0)
    all.push_back(
        fmt::format("{}: {} frames were dropped, by the times of {} that came; the first after frame {}",
                    name(), missing_, depths_, first_missing_));
  if (late_ > 0)
    all.push_back(fmt::format(
        "{}: {} frames are left out whose time is not later than that of the one before", name(), late_));
  if (colorless_ > 0)
    all.push_back(fmt::format("{}: {} of {} frames have no colour within 20 ms", name(), colorless_, given_));
  return all;
}

}  // namespace pliant
