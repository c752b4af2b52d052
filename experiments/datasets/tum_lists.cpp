#include "experiments/datasets/tum_lists.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <tuple>

#include "experiments/datasets/tum_poses.h"
#include "framework/core/error.h"
#include "framework/io/text_lines.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

struct TimedFile {
  double time = 0;
  std::string file;
};

std::string in_folder(const std::string& folder, std::string_view name) {
  return (fs::path(folder) / name).lexically_normal().string();
}

/// Refuses a time that is not later than that of the line before.
class RisingTimes {
 public:
  void check(const TextLines& lines, const TextLines::Line& line, double time) {
    if (line_ > 0 && time <= last_)
      lines.fail(line.number,
                 fmt::format("the time {:.6f} is not later than {:.6f} in line {}", time, last_, line_));
    last_ = time;
    line_ = line.number;
  }

 private:
  double last_ = 0;
  int line_ = 0;
};

std::vector<TimedFile> read_list(const std::string& path, const std::string& folder) {
  TextLines lines(path);
  RisingTimes times;
  std::vector<TimedFile> files;
  while (const auto line = lines.next()) {
    if (line->empty()) continue;
    if (line->words.size() != 2)
      lines.fail(line->number, fmt::format("{} words, expected a time and a file", line->words.size()));
    files.push_back({lines.real(*line, 0), in_folder(folder, line->words[1])});
    times.check(lines, *line, files.back().time);
  }
  if (files.empty()) throw DataError(path + ": no frame");
  return files;
}

/// The image of a word like "depth/1305.12.png".
bool is_depth_file(std::string_view word) { return word.find("depth") != std::string_view::npos; }

std::vector<Sequence::Item> read_associations(const std::string& path, const std::string& folder) {
  TextLines lines(path);
  RisingTimes times;
  std::vector<Sequence::Item> frames;
  while (const auto line = lines.next()) {
    if (line->empty()) continue;
    if (line->words.size() != 4)
      lines.fail(line->number, fmt::format("{} words, expected TIME FILE TIME FILE of colour and depth",
                                           line->words.size()));
    const bool depth_is_first = is_depth_file(line->words[1]);
    if (depth_is_first == is_depth_file(line->words[3]))
      lines.fail(line->number, "which file is the depth cannot be told; expected 'depth' in the path of one");
    const std::size_t depth = depth_is_first ? 0 : 2;
    const double time = lines.real(*line, depth);
    times.check(lines, *line, time);
    frames.push_back(
        {{in_folder(folder, line->words[depth + 1]), in_folder(folder, line->words[3 - depth]), ""}, time});
  }
  if (frames.empty()) throw DataError(path + ": no frame");
  return frames;
}

/// Of each depth, which colour is its own; none where there is none.
std::vector<std::optional<std::size_t>> associated(const std::vector<TimedFile>& depth,
                                                   const std::vector<TimedFile>& color) {
  constexpr double farthest = 0.02;  // s
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
  for (std::size_t d = 0; d < depth.size(); ++d) {
    auto near = std::lower_bound(color.begin(), color.end(), depth[d].time - farthest,
                                 [](const TimedFile& file, double time) { return file.time < time; });
    for (; near != color.end() && near->time <= depth[d].time + farthest; ++near)
      pairs.emplace_back(std::abs(near->time - depth[d].time), d,
                         static_cast<std::size_t>(near - color.begin()));
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<std::optional<std::size_t>> color_of(depth.size());
  std::vector<bool> is_used(color.size(), false);
  for (const auto& [distance, d, c] : pairs) {
    if (color_of[d] || is_used[c]) continue;
    color_of[d] = c;
    is_used[c] = true;
  }
  return color_of;
}

TumFrames from_both_lists(const std::string& folder) {
  const std::vector<TimedFile> depth = read_list(in_folder(folder, "depth.txt"), folder);
  const std::string color_list = in_folder(folder, "rgb.txt");
  TumFrames read;
  if (!fs::exists(color_list)) {
    for (const TimedFile& file : depth) read.frames.push_back({{file.file, "", ""}, file.time});
    return read;
  }
  const std::vector<TimedFile> color = read_list(color_list, folder);
  const auto color_of = associated(depth, color);
  for (std::size_t d = 0; d < depth.size(); ++d)
    if (color_of[d]) read.frames.push_back({{depth[d].file, color[*color_of[d]].file, ""}, depth[d].time});
  if (read.frames.empty())
    throw DataError(fmt::format("{}: no depth is within 20 ms of any colour of {}; are both in seconds?",
                                in_folder(folder, "depth.txt"), color_list));
  if (const std::size_t left_out = depth.size() - read.frames.size(); left_out > 0)
    read.warnings.push_back(
        fmt::format("{}: {} of {} depth images have no colour within 20 ms and are left out", folder,
                    left_out, depth.size()));
  return read;
}

void add_poses(const std::string& path, TumFrames& read) {
  if (!fs::exists(path)) return;
  const TumPoses poses(path);
  const auto has_pose = [](const Sequence::Item& frame) { return frame.camera_pose.has_value(); };
  for (Sequence::Item& frame : read.frames) frame.camera_pose = poses.at(frame.time);
  if (std::none_of(read.frames.begin(), read.frames.end(), has_pose))
    read.warnings.push_back(fmt::format(
        "{}: no frame has a pose, because none was taken between two poses at most 100 ms apart; is all "
        "of it in seconds?",
        path));
}

}  // namespace

TumFrames read_tum_lists(const std::string& folder) {
  const std::string associations = in_folder(folder, "associations.txt");
  TumFrames read = fs::exists(associations) ? TumFrames{read_associations(associations, folder), {}}
                                            : from_both_lists(folder);
  add_poses(in_folder(folder, "groundtruth.txt"), read);
  const double start = read.frames.front().time;
  for (Sequence::Item& frame : read.frames) frame.time -= start;
  return read;
}

}  // namespace pliant
