#include "experiments/runner/run_frames.h"

#include "experiments/tasks/json_file.h"
#include "experiments/tasks/track_log.h"
#include "framework/core/error.h"
#include "framework/tracking/frame_record.h"

namespace pliant {

std::vector<Numbers> read_run_frames(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / TrackLog::files().front();
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return {};
  std::vector<Numbers> frames;
  for (const auto& line : read_json_lines(file.string())) {
    if (!line.is_object() || !line.contains("frame") || !line["frame"].is_number())
      throw DataError(file.string() + ": is no log of frames; expected what pliant track writes");
    const bool is_tracked = line.value("state", "") == to_string(FrameState::tracked);
    frames.push_back(is_tracked ? numbers_of_frame(line) : Numbers{{"frame", line["frame"].get<double>()}});
  }
  return frames;
}

}  // namespace pliant
