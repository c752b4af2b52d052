#include "samplers/adaptive/adaptive.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include "framework/geometry/pixel_index.h"
#include "samplers/adaptive/adaptive.cl.embed.h"

namespace pliant {
namespace {

constexpr const char* stage = "acs";

/// A row for each column of a mask, each once: the ranks of the multiples of the golden ratio, whose
/// fractions keep far apart.
std::vector<int> spread_rows(int step) {
  const double ratio = (std::sqrt(5.0) - 1) / 2;
  const auto fraction = [&](int column) { return std::fmod((column + 1) * ratio, 1.0); };
  std::vector<int> columns(static_cast<std::size_t>(step));
  std::iota(columns.begin(), columns.end(), 0);
  std::sort(columns.begin(), columns.end(), [&](int a, int b) { return fraction(a) < fraction(b); });
  std::vector<int> rows(columns.size());
  for (std::size_t rank = 0; rank < columns.size(); ++rank)
    rows[static_cast<std::size_t>(columns[rank])] = static_cast<int>(rank);
  return rows;
}

class AdaptiveSelection : public PointSelection {
 public:
  AdaptiveSelection(int step, float threshold, bool equal_masks, Device& device, const PixelIndex& index)
      : step_(step),
        spread_rows_(spread_rows(step)),
        threshold_(threshold),
        equal_masks_(equal_masks),
        corner_{{index.window.left, index.window.top}},
        size_{{index.window.width, index.window.height}},
        masks_{{masks_over(index.window.left, index.window.width),
                masks_over(index.window.top, index.window.height)}},
        map_(index.points.device(device)),
        flags_(index.count),
        points_(points_on_grid(index, step)) {
    std::vector<int> is_centre(index.count, 0);
    for (const int point : points_) is_centre[static_cast<std::size_t>(point)] = 1;
    is_centre_ = Array<int>(std::move(is_centre));
  }

  const std::vector<int>& points() const override { return points_; }

  std::vector<float> weights() const override { return weights_; }

  bool adapt(Device& device, const Array<float>& residuals) override {
    auto choose = device.kernel(embedded::samplers_adaptive_adaptive_cl, "choose");
    const auto mask_count = static_cast<std::size_t>(masks_.s[0]) * static_cast<std::size_t>(masks_.s[1]);
    device.run(stage, choose, mask_count, 64, masks_, step_, spread_rows_.device(device), threshold_, corner_,
               size_, map_, is_centre_.device(device), residuals.device(device), flags_.write_device(device));
    return collect();
  }

 private:
  /// Gathers what was chosen; whether it is other points than before. As many constraints as a mask has share
  /// what its one point at first weighs.
  bool collect() {
    const auto& in_mask = flags_.host();
    std::vector<int> points;
    weights_.clear();
    for (std::size_t point = 0; point < in_mask.size(); ++point) {
      if (in_mask[point] == 0) continue;
      points.push_back(static_cast<int>(point));
      if (equal_masks_) weights_.push_back(1.0F / static_cast<float>(in_mask[point]));
    }
    std::swap(points, points_);
    return points_ != points;
  }

  int masks_over(int first, int count) const { return (first + count - 1) / step_ - first / step_ + 1; }

  cl_int step_;
  Array<int> spread_rows_;  ///< per column of a mask: the row of its one point, of n spread evenly
  cl_float threshold_;
  bool equal_masks_;
  cl_int2 corner_;        ///< pixel of the map's corner
  cl_int2 size_;          ///< of the map
  cl_int2 masks_;         ///< how many touch the map, across and down
  Buffer map_;            ///< point at each pixel
  Array<int> is_centre_;  ///< per point: is it the one at the centre of its mask?
  Array<int> flags_;      ///< per point: how many are constrained in its mask, 0 where it is not
  std::vector<int> points_;
  std::vector<float> weights_;
};

}  // namespace

AdaptiveSampler::AdaptiveSampler(int step, double threshold, bool equal_masks)
    : step_(step), threshold_(static_cast<float>(threshold)), equal_masks_(equal_masks) {}

std::unique_ptr<PointSelection> AdaptiveSampler::select(Device& device, const SurfaceView& source) const {
  return std::make_unique<AdaptiveSelection>(step_, threshold_, equal_masks_, device, source.pixels);
}

void register_adaptive_sampler(Registry& registry) {
  registry.add<ConstraintSampler>(
      "adaptive", "All points of a mask, some or its centre, by the residual in it [thesis 4.5]",
      {
          integer("step", 4).unit("pixel").range(1, 256).doc("Side of the mask, and how far it moves"),
          real("threshold", 2)
              .unit("mm")
              .above(0)
              .doc(
                  "Mean residual above which all points of a mask are constrained; below half of it only its "
                  "centre. Half the average RMSE of the data is best"),
          boolean("equal_masks", false)
              .doc("The constraints of a mask weigh 1 together; else each weighs 1 [thesis 4.5], and what is "
                   "constrained densely is pulled harder"),
      },
      [](const Parameters& parameters, const Registry&) {
        return std::make_unique<AdaptiveSampler>(static_cast<int>(parameters.integer("step")),
                                                 parameters.real("threshold"),
                                                 parameters.boolean("equal_masks"));
      });
}

}  // namespace pliant
