#include "tests/openni/scripted_files.h"

#include <OpenNI.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "tests/datasets/data_of.h"

namespace pliant::test {

namespace {

/// Has OpenNI2's recorder write the next images of all sensors of the camera that there is.
void play_into_recorder(const std::string& path, int images) {
  openni::Device device;
  ASSERT_EQ(device.open(openni::ANY_DEVICE), openni::STATUS_OK);
  openni::Recorder recorder;
  ASSERT_EQ(recorder.create(path.c_str()), openni::STATUS_OK);
  std::array<openni::VideoStream, 2> sensors;
  std::vector<openni::VideoStream*> streams;
  ASSERT_EQ(sensors[0].create(device, openni::SENSOR_DEPTH), openni::STATUS_OK);
  streams.push_back(sensors.data());
  if (device.hasSensor(openni::SENSOR_COLOR)) {
    ASSERT_EQ(sensors[1].create(device, openni::SENSOR_COLOR), openni::STATUS_OK);
    streams.push_back(&sensors[1]);
  }
  for (auto* stream : streams) recorder.attach(*stream);
  recorder.start();
  for (auto* stream : streams) stream->start();
  for (int i = 0; i < images; ++i) {
    // The recorder has a thread of its own and lets pass what comes before that is ready.
    if (i < 5) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    int ready = 0;
    ASSERT_EQ(openni::OpenNI::waitForAnyStream(streams.data(), static_cast<int>(streams.size()), &ready),
              openni::STATUS_OK);
    openni::VideoFrameRef frame;
    ASSERT_EQ(streams[static_cast<std::size_t>(ready)]->readFrame(&frame), openni::STATUS_OK);
  }
  recorder.stop();
  recorder.destroy();
}

}  // namespace

ScriptedFiles::ScriptedFiles() {
  // What the leak checker finds in a library that has been unloaded has no name (see lsan.supp).
  ::dlopen(WITH_DRIVER "/OpenNI2/Drivers/libOniFile.so.0", RTLD_NOW | RTLD_NODELETE);
}

DepthImage ScriptedFiles::depth(int i) {
  DepthImage image(width, height);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      image(u, v) = u == v ? 0.0F : static_cast<float>(500 + 17 * u + 29 * v + 400 * i);
  return image;
}

ColorImage ScriptedFiles::color(int i) {
  ColorImage image(width, height);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      image(u, v) = {static_cast<std::uint8_t>(7 * u + i), static_cast<std::uint8_t>(5 * v + i),
                     static_cast<std::uint8_t>(u * v + 3 * i)};
  return image;
}

std::string ScriptedFiles::depth_sensor() {
  return fmt::format("view depth 1.0 0.8\nmode depth {} {} 30\n", width, height);
}

std::string ScriptedFiles::both_sensors() {
  return depth_sensor() + fmt::format("view color 1.1 0.9\nmode color {} {} 30\n", width, height);
}

std::string ScriptedFiles::depth_line(int i, int microseconds, const std::string& rest) const {
  const DepthImage image = depth(i);
  std::vector<std::uint8_t> bytes;
  for (const float value : image.pixels()) {
    const auto raw = static_cast<std::uint16_t>(value);
    bytes.push_back(static_cast<std::uint8_t>(raw & 0xFF));
    bytes.push_back(static_cast<std::uint8_t>(raw >> 8));
  }
  return fmt::format("depth {} {} {}\n", microseconds, write(fmt::format("{}.depth", i), bytes), rest);
}

std::string ScriptedFiles::color_line(int i, int microseconds) const {
  const ColorImage image = color(i);
  std::vector<std::uint8_t> bytes;
  for (const Rgb& pixel : image.pixels()) bytes.insert(bytes.end(), {pixel.r, pixel.g, pixel.b});
  return fmt::format("color {} {}\n", microseconds, write(fmt::format("{}.color", i), bytes));
}

std::string ScriptedFiles::images(int count) const {
  std::string lines;
  for (int i = 1; i <= count; ++i)
    lines += depth_line(i, 1'000'000 + i * 33'333) + color_line(i, 1'005'000 + i * 33'333);
  return lines;
}

void ScriptedFiles::plug_in(const std::string& script) const {
  ::setenv("PLIANT_SCRIPTED_CAMERA", write("script.txt", script).c_str(), 1);
}

std::string ScriptedFiles::record(const std::string& name, int images) const {
  const std::string path = file(name);
  openni::OpenNI::initialize();
  play_into_recorder(path, images);
  openni::OpenNI::shutdown();
  ::unsetenv("PLIANT_SCRIPTED_CAMERA");
  return path;
}

std::unique_ptr<DataStream> ScriptedFiles::open(const std::string& entries) {
  return data_of("{type: openni" + (entries.empty() ? "" : ", " + entries) + "}")->open(shared_device(), 0);
}

std::vector<Frame> ScriptedFiles::frames_of(FrameStream& stream, int count) {
  CheckedStream checked(stream);
  std::vector<Frame> frames;
  for (int i = 0; i < count; ++i) {
    auto frame = checked.next();
    if (!frame) break;
    frames.push_back(*std::move(frame));
  }
  return frames;
}

std::string ScriptedFiles::error_of(const std::string& entries) {
  return data_error_of([&] { frames_of(*open(entries)); });
}

}  // namespace pliant::test
