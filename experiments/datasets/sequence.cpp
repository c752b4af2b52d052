#include "experiments/datasets/sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

#include "experiments/datasets/depth_doubts.h"
#include "framework/core/error.h"
#include "framework/geometry/has_point.h"

namespace pliant {
namespace {

/// Where much more time passes than usual between two frames.
std::vector<std::string> doubts_about_gaps(const Sequence& sequence) {
  const auto& frames = sequence.frames;
  std::vector<double> steps;
  for (std::size_t i = 1; i < frames.size(); ++i) steps.push_back(frames[i].time - frames[i - 1].time);
  if (steps.empty()) return {};
  std::vector<double> sorted = steps;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  constexpr double longest = 5;  // median steps
  std::vector<std::string> doubts;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (!(steps[i] > longest * *middle)) continue;
    doubts.push_back(fmt::format(
        "{}: {:.3g} s pass between frame {} ({}) and frame {} ({}), {:.0f} times as much as usual",
        sequence.name, steps[i], i + 1, frames[i].files.depth, i + 2, frames[i + 1].files.depth,
        steps[i] / *middle));
  }
  return doubts;
}

class SequenceStream : public DataStream {
 public:
  explicit SequenceStream(Sequence sequence) : sequence_(std::move(sequence)) {
    const FrameFiles& files = sequence_.frames.front().files;
    first_ = read_frame(files, sequence_.units);
    Intrinsics intrinsics = intrinsics_of(sequence_.camera, first_->depth.width(), first_->depth.height());
    rig_.depth = intrinsics.camera;
    warnings_ = sequence_.warnings;
    add(std::move(intrinsics.warnings), warnings_);
    add(doubts_about_depth(*first_, sequence_.units.scale, files.depth), warnings_);
    add(doubts_about_gaps(sequence_), warnings_);
  }

  std::string name() const override { return sequence_.name; }
  const Rig& rig() const override { return rig_; }
  bool reads_on_host() const override { return true; }

  std::vector<std::string> warnings() const override {
    std::vector<std::string> all = warnings_;
    if (blind_ > 0)
      all.push_back(fmt::format("{}: {} of {} frames see nothing, the first is {}", sequence_.name, blind_,
                                given_, sequence_.frames[first_blind_].files.depth));
    return all;
  }

  std::optional<Frame> next() override {
    if (given_ == sequence_.frames.size()) return std::nullopt;
    const Sequence::Item& item = sequence_.frames[given_];
    Frame frame =
        given_ == 0 ? *std::exchange(first_, std::nullopt) : read_frame(item.files, sequence_.units);
    check_size(frame.depth, item.files.depth, Size{rig_.depth},
               depth_named(sequence_.frames.front().files.depth));
    frame.time = item.time;
    if (!sees_something(frame) && blind_++ == 0) first_blind_ = given_;
    ++given_;
    return frame;
  }

  std::optional<Eigen::Isometry3d> camera_pose(int number) const override {
    const auto index = static_cast<std::size_t>(number - 1);
    return index < sequence_.frames.size() ? sequence_.frames[index].camera_pose : std::nullopt;
  }

  std::optional<PairTruth> truth(int number) const override {
    const auto index = static_cast<std::size_t>(number - 1);
    if (index >= sequence_.frames.size() || sequence_.frames[index].truth.scene_flow.empty())
      return std::nullopt;
    const FrameFiles& files = sequence_.frames.front().files;
    return read_truth(sequence_.frames[index].truth, read_frame(files, sequence_.units), files.depth);
  }

 private:
  struct Size {
    const Camera& camera;
    int width() const { return camera.width; }
    int height() const { return camera.height; }
  };

  Sequence sequence_;
  Rig rig_;
  std::vector<std::string> warnings_;
  std::optional<Frame> first_;
  std::size_t given_ = 0;
  std::size_t blind_ = 0;  // frames that see nothing
  std::size_t first_blind_ = 0;
};

}  // namespace

void add_selection(std::vector<Parameter>& rows) {
  rows.push_back(
      integer("first", 1).range(1, 10'000'000).doc("the first frame that is taken, counted from 1"));
  rows.push_back(
      integer("frames").range(1, 10'000'000).optional().doc("how many frames are taken; all by default"));
  rows.push_back(integer("step", 1).range(1, 1'000'000).doc("of so many frames one is taken"));
}

ParameterTable with_sequence(std::vector<Parameter> rows, double depth_scale) {
  add_selection(rows);
  rows.push_back(real("depth_scale", depth_scale)
                     .unit("mm")
                     .above(0)
                     .doc("what a unit of the depth images is; 0.2 where they count 5000 a metre"));
  rows.push_back(
      real("max_depth").unit("mm").above(0).optional().doc("farther depth is dropped; nothing by default"));
  return with_intrinsics(std::move(rows));
}

Selection selection_of(const Parameters& section) {
  Selection selection{static_cast<int>(section.integer("first")), std::nullopt,
                      static_cast<int>(section.integer("step"))};
  if (section.has("frames")) selection.count = static_cast<int>(section.integer("frames"));
  return selection;
}

DepthUnits depth_units_of(const Parameters& section) {
  DepthUnits units{section.real("depth_scale")};
  if (section.has("max_depth")) units.max_depth = section.real("max_depth");
  return units;
}

SequenceSettings sequence_settings(const Parameters& section, CameraChoice camera) {
  return {section.text("folder"), selection_of(section), depth_units_of(section), std::move(camera)};
}

Sequence sequence_of(const SequenceSettings& settings, const std::vector<Sequence::Item>& frames,
                     const std::string& where) {
  return {name_of_folder(settings.folder),
          selected(frames, settings.selection, where),
          settings.camera,
          settings.units,
          {}};
}

std::string name_of_folder(const std::string& path) {
  const std::filesystem::path folder(path);
  return (folder.has_filename() ? folder : folder.parent_path()).filename().string();
}

std::vector<Sequence::Item> selected(const std::vector<Sequence::Item>& frames, const Selection& selection,
                                     const std::string& where) {
  if (frames.empty()) throw DataError(where + ": no frame");
  std::vector<Sequence::Item> taken;
  for (auto i = static_cast<std::size_t>(selection.first - 1); i < frames.size();
       i += static_cast<std::size_t>(selection.step)) {
    if (selection.count && static_cast<int>(taken.size()) == *selection.count) break;
    taken.push_back(frames[i]);
  }
  if (taken.empty())
    throw DataError(
        fmt::format("{}: frame {} is to be the first, but it has {}", where, selection.first, frames.size()));
  return taken;
}

std::unique_ptr<DataStream> open_sequence(Sequence sequence) {
  if (sequence.frames.empty()) throw DataError(sequence.name + ": no frame");
  return std::make_unique<SequenceStream>(std::move(sequence));
}

}  // namespace pliant
