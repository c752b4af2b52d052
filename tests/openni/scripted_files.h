#pragma once

#include <string>
#include <vector>

#include "experiments/datasets/frame_source.h"
#include "tests/program/program_run.h"

namespace pliant::test {

/// A scripted camera (scripted_camera.cpp) of small images. Image i of either sensor differs from all others
/// in every pixel that is not a hole.
class ScriptedFiles : public ProgramTest {
 protected:
  ScriptedFiles();

  static constexpr int width = 40;
  static constexpr int height = 30;

  static DepthImage depth(int i);
  static ColorImage color(int i);

  /// Lines of a script: both sensors with their views, in one mode.
  static std::string both_sensors();
  static std::string depth_sensor();
  /// Such a line; the file is written.
  std::string depth_line(int i, int microseconds, const std::string& rest = "") const;
  std::string color_line(int i, int microseconds) const;
  /// Images 1 to `count`, 30 a second, colour 5 ms after its depth.
  std::string images(int count) const;

  /// Plugs in a camera with this script.
  void plug_in(const std::string& script) const;
  /// What OpenNI2's recorder makes of so many images of the camera that is plugged in, which is unplugged
  /// then. It may miss the first ones.
  std::string record(const std::string& name, int images) const;

  /// What a section with these entries opens, after "type: openni".
  static std::unique_ptr<DataStream> open(const std::string& entries = "");
  /// So many frames, read as whoever uses them does; all by default.
  static std::vector<Frame> frames_of(FrameStream& stream, int count = 1000);
  static std::string error_of(const std::string& entries);
};

}  // namespace pliant::test
