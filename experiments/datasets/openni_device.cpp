#include "experiments/datasets/openni_device.h"

#include <OpenNI.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <sstream>
#include <thread>
#include <tuple>

#include "experiments/datasets/sequence.h"
#include "framework/core/error.h"

namespace pliant {
namespace {

using openni::OpenNI;
using openni::VideoMode;
using openni::VideoStream;

constexpr int patience = 5000;  // ms without an image

/// What OpenNI2 says of its last error, on one line.
std::string reason() {
  std::istringstream text(OpenNI::getExtendedError());
  std::vector<std::string> words;
  for (std::string word; text >> word;) words.push_back(word);
  return words.empty() ? "no reason is given" : fmt::format("{}", fmt::join(words, " "));
}

/// The library, from here on; it counts who uses it.
class Session {
 public:
  Session() {
    if (OpenNI::initialize() == openni::STATUS_OK) return;
    const std::string why = reason();
    OpenNI::shutdown();
    throw DataError(
        "OpenNI2 has no driver: it takes lib*.so.0 from the folder OpenNI2/Drivers beside its library; "
        "install Debian's libopenni2-0 (" +
        why + ")");
  }
  ~Session() { OpenNI::shutdown(); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
};

/// Notices that a device is unplugged. OpenNI2 tells it on a thread of its own.
class Watch : public OpenNI::DeviceDisconnectedListener {
 public:
  explicit Watch(std::string uri) : uri_(std::move(uri)) { OpenNI::addDeviceDisconnectedListener(this); }
  ~Watch() override { OpenNI::removeDeviceDisconnectedListener(this); }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  bool is_lost() const { return is_lost_; }

 private:
  void onDeviceDisconnected(const openni::DeviceInfo* device) override {
    if (uri_ == device->getUri()) is_lost_ = true;
  }

  const std::string uri_;  // OpenNI2's thread reads it
  std::atomic<bool> is_lost_ = false;
};

std::string described_cameras() {
  openni::Array<openni::DeviceInfo> devices;
  OpenNI::enumerateDevices(&devices);
  std::vector<std::string> found;
  for (int i = 0; i < devices.getSize(); ++i)
    found.push_back(fmt::format("'{}' ({})", devices[i].getUri(), devices[i].getName()));
  if (!found.empty()) return fmt::format("there is {}", fmt::join(found, ", "));
  return "OpenNI2 finds none: plug one in that it drives (the drivers of Debian's libopenni2-0 know "
         "PrimeSense's sensors and their kin, as Asus Xtion; those of others belong into the folder "
         "OpenNI2/Drivers beside the library, named lib*.so.0) and that you may use (plug it in again after "
         "installing)";
}

void open_camera(openni::Device& device, const std::string& uri) {
  const auto status = device.open(uri.empty() ? openni::ANY_DEVICE : uri.c_str());
  if (status == openni::STATUS_OK) return;
  const std::string why = reason();
  throw DataError(fmt::format("the camera{} cannot be opened; {} ({})", uri.empty() ? "" : " '" + uri + "'",
                              described_cameras(), why));
}

void open_recording(openni::Device& device, const std::string& path) {
  if (!std::filesystem::is_regular_file(path)) throw DataError(path + ": it is no file");
  if (path.size() >= ONI_MAX_STR)
    throw DataError(fmt::format("{}: the path has {} letters; OpenNI2 takes {} at most", path, path.size(),
                                ONI_MAX_STR - 1));
  if (device.open(path.c_str()) != openni::STATUS_OK || !device.isFile())
    throw DataError(fmt::format("{}: OpenNI2 cannot play it; expected a recording of its own, .oni ({})",
                                path, reason()));
}

bool is_depth_format(openni::PixelFormat format) {
  return format == openni::PIXEL_FORMAT_DEPTH_1_MM || format == openni::PIXEL_FORMAT_DEPTH_100_UM;
}

bool is_color_format(openni::PixelFormat format) { return format == openni::PIXEL_FORMAT_RGB888; }

bool has_size_of(const VideoMode& a, const VideoMode& b) {
  return a.getResolutionX() == b.getResolutionX() && a.getResolutionY() == b.getResolutionY();
}

/// Sets the mode that `worth` likes best among those of a format that is read; keeps what is set without one.
template <class Worth>
void choose_mode(VideoStream& stream, bool (*is_read)(openni::PixelFormat), const Worth& worth) {
  const auto& modes = stream.getSensorInfo().getSupportedVideoModes();
  const VideoMode* best = nullptr;
  for (int i = 0; i < modes.getSize(); ++i)
    if (is_read(modes[i].getPixelFormat()) && (best == nullptr || worth(modes[i]) > worth(*best)))
      best = &modes[i];
  if (best != nullptr) stream.setVideoMode(*best);
}

/// Smooth motion first, then detail; more images a second than that are left to the camera.
auto depth_worth(const VideoMode& mode) {
  constexpr int smooth = 30;  // images a second
  return std::tuple(mode.getFps() >= smooth, mode.getResolutionX() * mode.getResolutionY(), -mode.getFps(),
                    mode.getPixelFormat() == openni::PIXEL_FORMAT_DEPTH_1_MM);
}

Camera camera_of(const VideoStream& view, const VideoMode& mode) {
  const int width = mode.getResolutionX();
  const int height = mode.getResolutionY();
  const auto focal_length = [](int pixels, float angle) {
    return angle > 0 ? pixels / (2 * std::tan(angle / 2.0)) : 0;
  };
  return {focal_length(width, view.getHorizontalFieldOfView()),
          focal_length(height, view.getVerticalFieldOfView()),
          (width - 1) / 2.0,
          (height - 1) / 2.0,
          width,
          height};
}

/// The pixels of an image as OpenNI2 has them, each made a T by `convert`; mirrored images are turned round.
template <class T, class Raw, class Convert>
Image<T> image_of(const openni::VideoFrameRef& frame, bool is_mirrored, const Convert& convert) {
  Image<T> image(frame.getWidth(), frame.getHeight());
  for (int v = 0; v < image.height(); ++v) {
    const auto* row = reinterpret_cast<const Raw*>(static_cast<const std::uint8_t*>(frame.getData()) +
                                                   static_cast<std::size_t>(v) * frame.getStrideInBytes());
    for (int u = 0; u < image.width(); ++u)
      image(is_mirrored ? image.width() - 1 - u : u, v) = convert(row[u]);
  }
  return image;
}

}  // namespace

struct OpenNiDevice::State {
  explicit State(const Settings& settings);
  ~State();
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void open_streams(bool color);
  void choose_modes();
  void register_images(std::optional<bool> wanted);
  void begin_playback();
  void start(VideoStream& stream);
  int wait();
  VideoStream& stream(int index) { return index == 0 ? depth : color; }

  bool is_recording;
  Session session;
  std::optional<Watch> watch;
  openni::Device device;
  VideoStream depth;
  VideoStream color;
  std::string name;
  std::vector<std::string> warnings;
  bool has_color = false;
  bool is_registered = false;
  int left = 0;  // of a recording's images
};

OpenNiDevice::State::State(const Settings& settings) : is_recording(!settings.recording.empty()) {
  if (is_recording)
    open_recording(device, settings.recording);
  else
    open_camera(device, settings.uri);
  const openni::DeviceInfo& info = device.getDeviceInfo();
  watch.emplace(info.getUri());
  name = is_recording ? std::filesystem::path(settings.recording).stem().string()
                      : fmt::format("{} ({})", info.getName(), info.getUri());
  open_streams(settings.color);
  if (!is_recording) choose_modes();
  register_images(settings.registered);
  if (is_recording) begin_playback();
  start(depth);
  if (has_color) start(color);
}

OpenNiDevice::State::~State() {
  // The player's thread goes through its streams without a lock until it waits to be asked for the next
  // image.
  if (is_recording) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  color.destroy();
  depth.destroy();
  device.close();
}

void OpenNiDevice::State::open_streams(bool color_is_wanted) {
  if (!device.hasSensor(openni::SENSOR_DEPTH)) throw DataError(name + ": it has no depth sensor");
  if (depth.create(device, openni::SENSOR_DEPTH) != openni::STATUS_OK)
    throw DataError(fmt::format("{}: its depth cannot be had ({})", name, reason()));
  if (!color_is_wanted || !device.hasSensor(openni::SENSOR_COLOR)) return;
  has_color = color.create(device, openni::SENSOR_COLOR) == openni::STATUS_OK;
  if (!has_color) warnings.push_back(fmt::format("{}: its colour cannot be had ({})", name, reason()));
}

void OpenNiDevice::State::choose_modes() {
  choose_mode(depth, is_depth_format, depth_worth);
  depth.setMirroringEnabled(false);
  if (!has_color) return;
  const VideoMode beside = depth.getVideoMode();
  choose_mode(color, is_color_format, [&](const VideoMode& mode) {
    return std::tuple(has_size_of(mode, beside), mode.getFps() >= beside.getFps(),
                      mode.getResolutionX() * mode.getResolutionY(), -mode.getFps());
  });
  color.setMirroringEnabled(false);
}

void OpenNiDevice::State::register_images(std::optional<bool> wanted) {
  if (!is_depth_format(depth.getVideoMode().getPixelFormat()))
    throw DataError(name + ": its depth does not count millimetres or tenths of them");
  if (has_color && !is_color_format(color.getVideoMode().getPixelFormat())) {
    warnings.push_back(name + ": its colour is left out: it is not RGB of 8 bits");
    color.destroy();
    has_color = false;
  }
  if (!has_color) return;
  const bool is_one_size = has_size_of(depth.getVideoMode(), color.getVideoMode());
  if (is_recording) {
    is_registered = wanted.value_or(false) && is_one_size;
    if (!wanted)
      warnings.push_back(
          name +
          ": a recording does not tell whether its depth was registered to the colour; it is taken "
          "for not registered; say by 'registered' which it is");
  } else {
    const auto mode = openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR;
    is_registered = wanted.value_or(true) && is_one_size && device.isImageRegistrationModeSupported(mode) &&
                    device.setImageRegistrationMode(mode) == openni::STATUS_OK;
    if (!is_registered) device.setImageRegistrationMode(openni::IMAGE_REGISTRATION_OFF);
  }
  if (wanted.value_or(false) && !is_registered)
    throw DataError(fmt::format("{}: 'registered', but {}", name,
                                is_one_size ? "the camera cannot register depth to colour"
                                            : "its depth and its colour differ in size"));
}

void OpenNiDevice::State::begin_playback() {
  openni::PlaybackControl& control = *device.getPlaybackControl();
  const int depths = control.getNumberOfFrames(depth);
  const int colors = has_color ? control.getNumberOfFrames(color) : 0;
  if (depths < 0 || colors < 0)
    throw DataError(name + ": the recording was not finished: it does not tell how many images it has");
  left = depths + colors;
  control.setSpeed(-1);  // an image whenever one is waited for
  // Without it the player's thread, once at the end, goes through its streams over and over, without a lock,
  // while they are closed.
  control.setRepeatEnabled(true);
}

void OpenNiDevice::State::start(VideoStream& stream) {
  if (stream.start() != openni::STATUS_OK)
    throw DataError(fmt::format("{}: its {} does not start ({})", name,
                                &stream == &depth ? "depth" : "colour", reason()));
}

/// Which sensor has an image: 0 for depth, 1 for colour.
int OpenNiDevice::State::wait() {
  std::array<VideoStream*, 2> streams{&depth, &color};
  // Waiting anew makes a player go on: it would overwrite an image that it has just played.
  const int slice = is_recording ? patience : 100;
  for (int waited = 0; waited < patience && !watch->is_lost(); waited += slice) {
    int ready = -1;
    if (OpenNI::waitForAnyStream(streams.data(), has_color ? 2 : 1, &ready, slice) == openni::STATUS_OK)
      return ready;
  }
  if (is_recording) throw DataError(fmt::format("{}: it ends {} images before its last one", name, left));
  throw SourceLost(name + (watch->is_lost() ? ": the camera was unplugged"
                                            : ": no image for 5 s; is the camera still plugged in?"));
}

OpenNiDevice::OpenNiDevice(const Settings& settings) : state_(std::make_unique<State>(settings)) {}
OpenNiDevice::~OpenNiDevice() = default;

const std::string& OpenNiDevice::name() const { return state_->name; }
bool OpenNiDevice::has_color() const { return state_->has_color; }
bool OpenNiDevice::is_registered() const { return state_->is_registered; }
int OpenNiDevice::rate() const { return state_->depth.getVideoMode().getFps(); }
std::vector<std::string> OpenNiDevice::warnings() const { return state_->warnings; }

Camera OpenNiDevice::depth_camera() const {
  // What is registered is seen through the colour camera.
  return camera_of(state_->is_registered ? state_->color : state_->depth, state_->depth.getVideoMode());
}

Camera OpenNiDevice::color_camera() const { return camera_of(state_->color, state_->color.getVideoMode()); }

std::optional<SensorImage> OpenNiDevice::next() {
  if (state_->is_recording && state_->left == 0) return std::nullopt;
  VideoStream& stream = state_->stream(state_->wait());
  openni::VideoFrameRef frame;
  if (stream.readFrame(&frame) != openni::STATUS_OK)
    throw SourceLost(fmt::format("{}: an image cannot be read ({})", state_->name, reason()));
  if (state_->is_recording) --state_->left;
  SensorImage image;
  image.time = static_cast<std::int64_t>(frame.getTimestamp());
  const bool is_mirrored = stream.getMirroringEnabled();
  if (&stream == &state_->color) {
    image.color =
        image_of<Rgb, openni::RGB888Pixel>(frame, is_mirrored, [](const openni::RGB888Pixel& pixel) {
          return Rgb{pixel.r, pixel.g, pixel.b};
        });
  } else {
    const bool is_fine = frame.getVideoMode().getPixelFormat() == openni::PIXEL_FORMAT_DEPTH_100_UM;
    const float unit = is_fine ? 0.1F : 1.0F;
    image.depth = image_of<float, openni::DepthPixel>(
        frame, is_mirrored, [unit](openni::DepthPixel pixel) { return static_cast<float>(pixel) * unit; });
  }
  return image;
}

}  // namespace pliant
