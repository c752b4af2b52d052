#include "samplers/adaptive/adaptive.h"

#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>

#include "framework/device/compact.h"
#include "framework/geometry/pixel_index.h"
#include "samplers/adaptive/adaptive.cl.embed.h"

namespace pliant {
namespace {

constexpr const char* stage = "acs";

/// Squared length of the shortest vector between points of the lattice {(i, slope i mod period)} on the
/// torus.
int closest_in_lattice(int slope, int period) {
  int closest = 2 * period * period;
  for (int i = 1; i < period; ++i) {
    const int across = std::min(i, period - i);
    const int down = std::min(slope * i % period, period - slope * i % period);
    closest = std::min(closest, across * across + down * down);
  }
  return closest;
}

/// The lattice of period n + 1 whose points lie furthest apart: without (0, 0) it has one point in each of
/// the n columns and rows.
int best_slope(int step) {
  const int period = step + 1;
  int best = 1;
  for (int slope = 2; slope < period; ++slope)
    if (std::gcd(slope, period) == 1 && closest_in_lattice(slope, period) > closest_in_lattice(best, period))
      best = slope;
  return best;
}

class AdaptiveSelection : public PointSelection {
 public:
  AdaptiveSelection(int step, float threshold, const Surface& source)
      : AdaptiveSelection(step, threshold, source, index_pixels(source)) {}

  const std::vector<int>& points() const override { return points_; }

  bool adapt(Device& device, const Array<float>& residuals) override {
    auto choose = device.kernel(embedded::samplers_adaptive_adaptive_cl, "choose");
    const auto mask_count = static_cast<std::size_t>(masks_.s[0]) * static_cast<std::size_t>(masks_.s[1]);
    device.run(stage, choose, mask_count, 64, masks_, step_, slope_, threshold_, corner_, size_,
               map_.device(device), residuals.device(device), flags_.write_device(device));
    const std::vector<int> before = std::exchange(points_, compact(device, stage, flags_).host());
    return points_ != before;
  }

 private:
  AdaptiveSelection(int step, float threshold, const Surface& source, const PixelIndex& index)
      : step_(step),
        slope_(best_slope(step)),
        threshold_(threshold),
        corner_{{index.left, index.top}},
        size_{{index.points.width(), index.points.height()}},
        masks_{{masks_over(index.left, index.points.width()), masks_over(index.top, index.points.height())}},
        map_(index.points.pixels()),
        flags_(source.size()),
        points_(points_on_grid(source, step)) {}

  int masks_over(int first, int count) const { return (first + count - 1) / step_ - first / step_ + 1; }

  cl_int step_;
  cl_int slope_;  ///< of the lattice of points spread evenly
  cl_float threshold_;
  cl_int2 corner_;    ///< pixel of the map's corner
  cl_int2 size_;      ///< of the map
  cl_int2 masks_;     ///< how many touch the map, across and down
  Array<int> map_;    ///< point at each pixel
  Array<int> flags_;  ///< per point: is it constrained?
  std::vector<int> points_;
};

}  // namespace

AdaptiveSampler::AdaptiveSampler(int step, double threshold)
    : step_(step), threshold_(static_cast<float>(threshold)) {}

std::unique_ptr<PointSelection> AdaptiveSampler::select(Device&, const Surface& source, const Camera&) const {
  return std::make_unique<AdaptiveSelection>(step_, threshold_, source);
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
      },
      [](const Parameters& parameters, const Registry&) {
        return std::make_unique<AdaptiveSampler>(static_cast<int>(parameters.integer("step")),
                                                 parameters.real("threshold"));
      });
}

}  // namespace pliant
