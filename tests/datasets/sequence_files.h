#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/io/images.h"
#include "tests/datasets/data_of.h"
#include "tests/io/test_files.h"

namespace pliant::test {

/// Small images of a sequence in folders of their own. Frame i is a slope that is 100 i units farther in its
/// files.
class SequenceFiles : public TestFiles {
 protected:
  static constexpr int width = 40;
  static constexpr int height = 30;

  static DepthImage slope(float nearest) {
    DepthImage depth(width, height);
    for (int v = 0; v < height; ++v)
      for (int u = 0; u < width; ++u) depth(u, v) = nearest + static_cast<float>(u);
    return depth;
  }

  void make_folder(const std::string& name) const { std::filesystem::create_directories(file(name)); }

  std::unique_ptr<DataStream> open(const std::string& section) const {
    return data_of(section)->open(shared_device(), 0);
  }

  /// All frames of a stream, read as whoever registers them does.
  static std::vector<Frame> frames_of(DataStream& stream) {
    CheckedStream checked(stream);
    std::vector<Frame> frames;
    while (auto frame = checked.next()) frames.push_back(*std::move(frame));
    return frames;
  }

  /// Of opening and reading.
  std::string error_of(const std::string& section) const {
    return data_error_of([&] { frames_of(*open(section)); });
  }
};

}  // namespace pliant::test
