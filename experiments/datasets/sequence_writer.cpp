#include "experiments/datasets/sequence_writer.h"

#include <fmt/format.h>

#include <string>
#include <system_error>

#include "framework/core/error.h"
#include "framework/geometry/color_at_depth.h"
#include "framework/geometry/prefetched_stream.h"
#include "framework/io/file.h"
#include "framework/io/images.h"
#include "framework/io/scene_flow.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

constexpr float tum_units = 5;  // a millimetre
constexpr const char* object = "object";

void write_text(const fs::path& path, const std::string& text) {
  write_file(path.string(), {text.begin(), text.end()});
}

DepthImage scaled(DepthImage depth, float units) {
  for (std::size_t i = 0; i < depth.size(); ++i) depth.data()[i] *= units;
  return depth;
}

/// Numbers as they are read again to the same bits.
std::string intrinsics_text(const Camera& camera) {
  return fmt::format("{} 0 {} 0\n0 {} {} 0\n0 0 1 0\n0 0 0 1\n", camera.fx, camera.cx, camera.fy, camera.cy);
}

class SequenceWriter {
 public:
  SequenceWriter(SequenceLayout layout, const fs::path& folder, const Rig& rig)
      : layout_(layout), folder_(folder), rig_(rig) {
    make_folder("");
    write_text(folder_ / "intrinsics.txt", intrinsics_text(rig.depth));
  }

  void add(Frame frame, const std::optional<Eigen::Isometry3d>& camera) {
    if (!frame.color.empty()) frame.color = color_at_depth(frame, rig_);
    if (layout_ == SequenceLayout::tum)
      add_tum(frame, camera);
    else
      add_deepdeform(frame);
    if (!frame.mask.empty())
      write_mask(path("mask", fmt::format("{:06}_{}.png", count_, object)), frame.mask);
    ++count_;
  }

  /// Of the first frame and the one that was added last.
  void add_truth(const PairTruth& truth) {
    const std::string name = fmt::format("{}_{:06}_{:06}", object, 0, count_ - 1);
    if (!truth.scene_flow.empty()) write_scene_flow(path("scene_flow", name + ".sflow"), truth.scene_flow);
    if (!truth.optical_flow.empty())
      write_optical_flow(path("optical_flow", name + ".oflow"), truth.optical_flow);
    if (!truth.visible.empty()) write_mask(path("visible", name + ".png"), truth.visible);
  }

  /// The lists of a layout that has some.
  void finish() const {
    if (layout_ != SequenceLayout::tum) return;
    write_text(folder_ / "depth.txt", "# depth maps\n# timestamp filename\n" + depth_list_);
    if (!color_list_.empty()) {
      write_text(folder_ / "rgb.txt", "# color images\n# timestamp filename\n" + color_list_);
      write_text(folder_ / "associations.txt", associations_);
    }
    if (!poses_.empty())
      write_text(folder_ / "groundtruth.txt",
                 "# the camera in a frame that stays, m\n# timestamp tx ty tz qx qy qz qw\n" + poses_);
  }

  int count() const { return count_; }

 private:
  void add_tum(const Frame& frame, const std::optional<Eigen::Isometry3d>& camera) {
    const std::string time = fmt::format("{:.6f}", frame.time);
    const std::string depth = fmt::format("depth/{}.png", time);
    write_depth(path("depth", time + ".png"), scaled(frame.depth, tum_units));
    depth_list_ += fmt::format("{} {}\n", time, depth);
    if (!frame.color.empty()) {
      const std::string color = fmt::format("rgb/{}.png", time);
      write_color(path("rgb", time + ".png"), frame.color);
      color_list_ += fmt::format("{} {}\n", time, color);
      associations_ += fmt::format("{} {} {} {}\n", time, color, time, depth);
    }
    if (!camera) return;
    const Eigen::Vector3d at = camera->translation() / 1000;
    const Eigen::Quaterniond turn(camera->rotation());
    poses_ += fmt::format("{} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f}\n", time, at.x(), at.y(),
                          at.z(), turn.x(), turn.y(), turn.z(), turn.w());
  }

  void add_deepdeform(const Frame& frame) {
    const std::string name = fmt::format("{:06}.png", count_);
    write_depth(path("depth", name), frame.depth);
    if (!frame.color.empty()) write_color(path("color", name), frame.color);
  }

  /// A file of one of the folders, which is made.
  std::string path(const char* folder, const std::string& name) const {
    make_folder(folder);
    return (folder_ / folder / name).string();
  }

  void make_folder(const char* name) const {
    std::error_code error;
    fs::create_directories(folder_ / name, error);
    if (error)
      throw DataError(
          fmt::format("{}: the folder cannot be made: {}", (folder_ / name).string(), error.message()));
  }

  SequenceLayout layout_;
  fs::path folder_;
  Rig rig_;
  int count_ = 0;  // frames added
  std::string depth_list_;
  std::string color_list_;
  std::string associations_;
  std::string poses_;
};

}  // namespace

WrittenSequence write_sequence(DataStream& stream, SequenceLayout layout, const fs::path& folder,
                               const ProgressSink& progress) {
  constexpr std::size_t frames_ahead = 8;
  PrefetchedStream ahead(stream, frames_ahead);
  CheckedStream frames(ahead);
  SequenceWriter writer(layout, folder, stream.rig());
  std::exception_ptr lost;
  try {
    while (auto frame = frames.next()) {
      const int number = writer.count() + 1;
      writer.add(*std::move(frame), stream.camera_pose(number));
      if (number > 1)
        if (const auto truth = stream.truth(number)) writer.add_truth(*truth);
      if (progress) progress({"writing " + stream.name(), 0, fmt::format("frame {}", number)});
    }
  } catch (const SourceLost&) {
    if (writer.count() == 0) throw;
    lost = std::current_exception();
  }
  writer.finish();
  return {writer.count(), lost};
}

}  // namespace pliant
