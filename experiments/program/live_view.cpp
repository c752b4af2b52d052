#include "experiments/program/live_view.h"

#include <chrono>
#include <thread>

namespace pliant {
namespace {

constexpr int panel_width = 640;
constexpr std::chrono::milliseconds pause(30);

}  // namespace

void LiveView::begin(const Rig& rig) {
  picture_.emplace(rig, panel_width);
  rate_ = {};
}

bool LiveView::show(const TrackedFrame& tracked) {
  const ColorImage& picture = picture_->draw(tracked, rate_.at(tracked.record.number));
  window_.show(picture);
  window_.take_events();
  while (window_.is_paused() && !window_.is_closed() && !is_ended_()) {
    std::this_thread::sleep_for(pause);
    window_.show(picture);
    window_.take_events();
  }
  return !window_.is_closed();
}

}  // namespace pliant
