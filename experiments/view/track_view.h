#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "experiments/report/view_data.h"
#include "experiments/view/even_choice.h"
#include "experiments/view/track_observer.h"
#include "framework/geometry/mesh.h"

namespace pliant {

/// Gathers a view over the frames of a stream: the surfaces of some of them, thinned, in the model's frame,
/// how far they are from the model (model_distances), and where the camera was.
class TrackView : public TrackObserver {
 public:
  void begin(const Rig& rig) override { camera_ = rig.depth; }
  bool show(const TrackedFrame& tracked) override;

  /// Whether there is anything to show.
  bool empty() const { return steps_.kept().empty(); }
  /// `model`: in the end; `picture`: a PNG that stands in.
  ViewData view(const Mesh& model, std::vector<std::uint8_t> picture) const;

 private:
  void choose_grid(const TrackedFrame& tracked);
  ViewData::Step step_of(const TrackedFrame& tracked) const;

  static constexpr std::size_t most_steps = 24;
  static constexpr std::size_t most_places = 500;  // of the camera
  Camera camera_;
  int spacing_ = 0;  // pixels between those that are kept; 0: not known yet
  ViewData::Frames frames_;
  float picture_distance_ = 0;  // mm before the camera
  EvenChoice<ViewData::Step> steps_{most_steps};
  EvenChoice<Eigen::Vector3f> path_{most_places};
};

}  // namespace pliant
