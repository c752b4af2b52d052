#include "framework/tracking/frame_record.h"

namespace pliant {

std::string to_string(FrameState state) {
  switch (state) {
    case FrameState::waiting:
      return "waiting";
    case FrameState::started:
      return "started";
    case FrameState::tracked:
      return "tracked";
    case FrameState::lost:
      return "lost";
  }
  return "";
}

bool has_pose(FrameState state) { return state == FrameState::started || state == FrameState::tracked; }

bool is_registered(const FrameRecord& record) {
  return record.registration && !record.registration->is_rejected;
}

bool is_rejected(const FrameRecord& record) {
  return record.registration && record.registration->is_rejected;
}

}  // namespace pliant
