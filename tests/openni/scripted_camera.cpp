// A driver of OpenNI2 with one device, which plays what the file named by PLIANT_SCRIPTED_CAMERA says, one
// image whenever someone waits for one, so that no test depends on time. Lines of the file:
//   view SENSOR HORIZONTAL VERTICAL        radians; SENSOR is depth or color
//   mode SENSOR WIDTH HEIGHT RATE          the first is the one that is set; a sensor without modes is not
//   there registers | mirrored                   has image registration; has mirroring, which is on SENSOR
//   MICROSECONDS FILE [HEIGHT]      an image, as numbers in their bytes; HEIGHT: the first rows alone unplug
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

// What the header takes from a library that Debian does not ship.
#define XN_NEW(type, argument) new type(argument)
#define XN_DELETE(pointer) delete pointer
#include <Driver/OniDriverAPI.h>

namespace {

struct Sensor {
  std::vector<OniVideoMode> modes;
  float horizontal = 0;
  float vertical = 0;
};

struct Event {
  std::string what;  // depth, color or unplug
  std::uint64_t time = 0;
  std::string file;
  int height = 0;  // 0: that of the mode
};

struct Script {
  Sensor depth;
  Sensor color;
  bool registers = false;
  bool mirrored = false;
  std::vector<Event> events;

  Sensor& sensor(const std::string& name) { return name == "depth" ? depth : color; }

  explicit Script(const char* path) {
    std::ifstream file(path);
    std::string line;
    while (std::getline(file, line)) {
      std::istringstream words(line);
      std::string word;
      std::string name;
      words >> word;
      if (word == "view") {
        words >> name;
        words >> sensor(name).horizontal >> sensor(name).vertical;
      } else if (word == "mode") {
        words >> name;
        OniVideoMode mode{name == "depth" ? ONI_PIXEL_FORMAT_DEPTH_1_MM : ONI_PIXEL_FORMAT_RGB888, 0, 0, 0};
        words >> mode.resolutionX >> mode.resolutionY >> mode.fps;
        sensor(name).modes.push_back(mode);
      } else if (word == "registers") {
        registers = true;
      } else if (word == "mirrored") {
        mirrored = true;
      } else {
        Event event{word, 0, "", 0};
        words >> event.time >> event.file >> event.height;
        events.push_back(event);
      }
    }
  }
};

template <class T>
OniStatus answer(const T& value, void* data, int* size) {
  if (*size != static_cast<int>(sizeof(T))) return ONI_STATUS_BAD_PARAMETER;
  std::memcpy(data, &value, sizeof(T));
  return ONI_STATUS_OK;
}

class Stream : public oni::driver::StreamBase {
 public:
  Stream(OniSensorType type, const Sensor& sensor, bool mirrored)
      : type_(type),
        sensor_(sensor),
        mode_(sensor.modes.front()),
        has_mirroring_(mirrored),
        mirrored_(mirrored) {}

  OniStatus start() override {
    is_started_ = true;
    return ONI_STATUS_OK;
  }
  void stop() override { is_started_ = false; }
  bool is_started() const { return is_started_; }

  OniStatus getProperty(int property, void* data, int* size) override {
    // Without an answer for the cropping a recording of this device would play nothing.
    if (property == ONI_STREAM_PROPERTY_CROPPING) return answer(OniCropping{0, 0, 0, 0, 0}, data, size);
    if (property == ONI_STREAM_PROPERTY_VIDEO_MODE) return answer(mode_, data, size);
    if (property == ONI_STREAM_PROPERTY_HORIZONTAL_FOV && sensor_.horizontal > 0)
      return answer(sensor_.horizontal, data, size);
    if (property == ONI_STREAM_PROPERTY_VERTICAL_FOV && sensor_.vertical > 0)
      return answer(sensor_.vertical, data, size);
    if (property == ONI_STREAM_PROPERTY_MAX_VALUE) return answer(65535, data, size);
    if (property == ONI_STREAM_PROPERTY_STRIDE) return answer(stride(), data, size);
    if (property == ONI_STREAM_PROPERTY_MIRRORING && has_mirroring_)
      return answer(static_cast<OniBool>(mirrored_), data, size);
    return ONI_STATUS_NOT_SUPPORTED;
  }

  OniStatus setProperty(int property, const void* data, int /*size*/) override {
    if (property == ONI_STREAM_PROPERTY_VIDEO_MODE) std::memcpy(&mode_, data, sizeof(mode_));
    return property == ONI_STREAM_PROPERTY_VIDEO_MODE ? ONI_STATUS_OK : ONI_STATUS_NOT_SUPPORTED;
  }

  void raise(const Event& event) {
    OniFrame* frame = getServices().acquireFrame();
    frame->videoMode = mode_;
    frame->sensorType = type_;
    frame->timestamp = event.time;
    frame->frameIndex = ++count_;
    frame->width = mode_.resolutionX;
    frame->height = event.height > 0 ? event.height : mode_.resolutionY;
    frame->stride = stride();
    frame->dataSize = frame->height * frame->stride;
    frame->croppingEnabled = FALSE;
    frame->cropOriginX = frame->cropOriginY = 0;
    std::ifstream(event.file, std::ios::binary).read(static_cast<char*>(frame->data), frame->dataSize);
    raiseNewFrame(frame);
    getServices().releaseFrame(frame);
  }

 private:
  int stride() const { return mode_.resolutionX * (type_ == ONI_SENSOR_DEPTH ? 2 : 3); }

  OniSensorType type_;
  const Sensor& sensor_;
  OniVideoMode mode_;
  bool has_mirroring_;
  bool mirrored_;
  bool is_started_ = false;
  int count_ = 0;
};

class Driver;

class Device : public oni::driver::DeviceBase {
 public:
  Device(Script& script, Driver& driver) : script_(script), driver_(driver) {
    if (!script.depth.modes.empty()) list(ONI_SENSOR_DEPTH, script.depth);
    if (!script.color.modes.empty()) list(ONI_SENSOR_COLOR, script.color);
  }

  OniStatus getSensorInfoList(OniSensorInfo** sensors, int* count) override {
    *sensors = sensors_.data();
    *count = static_cast<int>(sensors_.size());
    return ONI_STATUS_OK;
  }

  oni::driver::StreamBase* createStream(OniSensorType type) override {
    auto& stream = type == ONI_SENSOR_DEPTH ? depth_ : color_;
    stream = std::make_unique<Stream>(type, type == ONI_SENSOR_DEPTH ? script_.depth : script_.color,
                                      script_.mirrored);
    return stream.get();
  }
  void destroyStream(oni::driver::StreamBase* stream) override {
    (stream == depth_.get() ? depth_ : color_).reset();
  }

  OniBool isImageRegistrationModeSupported(OniImageRegistrationMode mode) override {
    return mode == ONI_IMAGE_REGISTRATION_OFF || script_.registers;
  }
  OniBool isPropertySupported(int property) override {
    return property == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION && script_.registers;
  }
  OniStatus setProperty(int property, const void* data, int /*size*/) override {
    if (!isPropertySupported(property)) return ONI_STATUS_NOT_SUPPORTED;
    std::memcpy(&registration_, data, sizeof(registration_));
    return ONI_STATUS_OK;
  }
  OniStatus getProperty(int property, void* data, int* size) override {
    return isPropertySupported(property) ? answer(registration_, data, size) : ONI_STATUS_NOT_SUPPORTED;
  }

  OniStatus tryManualTrigger() override;

 private:
  void list(OniSensorType type, Sensor& sensor) {
    sensors_.push_back({type, static_cast<int>(sensor.modes.size()), sensor.modes.data()});
  }

  Script& script_;
  Driver& driver_;
  std::vector<OniSensorInfo> sensors_;
  std::unique_ptr<Stream> depth_;
  std::unique_ptr<Stream> color_;
  OniImageRegistrationMode registration_ = ONI_IMAGE_REGISTRATION_OFF;
  std::size_t played_ = 0;  // events
};

class Driver : public oni::driver::DriverBase {
 public:
  explicit Driver(OniDriverServices* services) : DriverBase(services) {
    std::strcpy(info_.uri, "scripted");
    std::strcpy(info_.vendor, "Pliant");
    std::strcpy(info_.name, "Scripted camera");
  }

  OniStatus initialize(oni::driver::DeviceConnectedCallback connected,
                       oni::driver::DeviceDisconnectedCallback disconnected,
                       oni::driver::DeviceStateChangedCallback changed, void* cookie) override {
    DriverBase::initialize(connected, disconnected, changed, cookie);
    if (const char* path = std::getenv("PLIANT_SCRIPTED_CAMERA")) {
      script_ = std::make_unique<Script>(path);
      deviceConnected(&info_);
    }
    return ONI_STATUS_OK;
  }

  oni::driver::DeviceBase* deviceOpen(const char* /*uri*/, const char* /*mode*/) override {
    return new Device(*script_, *this);
  }
  void deviceClose(oni::driver::DeviceBase* device) override { delete device; }
  void shutdown() override {}
  void unplug() { deviceDisconnected(&info_); }

 private:
  OniDeviceInfo info_{};
  std::unique_ptr<Script> script_;
};

OniStatus Device::tryManualTrigger() {
  while (played_ < script_.events.size()) {
    const Event& event = script_.events[played_++];
    if (event.what == "unplug") {
      driver_.unplug();
      break;
    }
    Stream* stream = (event.what == "depth" ? depth_ : color_).get();
    if (stream == nullptr || !stream->is_started()) continue;
    stream->raise(event);
    break;
  }
  return ONI_STATUS_OK;
}

}  // namespace

ONI_EXPORT_DRIVER(Driver)
