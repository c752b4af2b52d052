#pragma once

#include <cstdint>
#include <vector>

#include "experiments/view/even_choice.h"
#include "experiments/view/moment.h"
#include "experiments/view/track_observer.h"

namespace pliant {

/// A few moments of a stream side by side: the model from the camera and how far the frame is from it, with
/// the frame's number and error above. Frames before there is a model are no moments.
class PictureStrip : public TrackObserver {
 public:
  void begin(const Rig&) override {}
  bool show(const TrackedFrame& tracked) override;

  /// Whether there is anything to show.
  bool empty() const { return moments_.kept().empty(); }
  /// All errors share one scale, which fits those of the moment in the middle.
  std::vector<std::uint8_t> png() const;

 private:
  static constexpr std::size_t most_moments = 8;
  EvenChoice<Moment> moments_{most_moments};
};

}  // namespace pliant
