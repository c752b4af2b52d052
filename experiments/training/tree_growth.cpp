#include "experiments/training/tree_growth.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pliant {
namespace {

using Patches = std::vector<const TrainingPatch*>;

CellBox random_box(Draw& draw) {
  const auto side = [&](std::uint8_t& first, std::uint8_t& last) {
    const std::size_t a = draw.index(DepthPatch::cells);
    const std::size_t b = draw.index(DepthPatch::cells);
    first = static_cast<std::uint8_t>(std::min(a, b));
    last = static_cast<std::uint8_t>(std::max(a, b) + 1);
  };
  CellBox box;
  side(box.left, box.right);
  side(box.top, box.bottom);
  return box;
}

/// The first so many, when shuffled.
Patches some_of(const Patches& patches, int count, Draw& draw) {
  Patches some = patches;
  const auto wanted = static_cast<std::size_t>(count);
  if (some.size() <= wanted) return some;
  for (std::size_t i = 0; i < wanted; ++i) std::swap(some[i], some[i + draw.index(some.size() - i)]);
  some.resize(wanted);
  return some;
}

/// Thresholds are rounded as a forest file rounds them, so that what is trained is what is read.
float rounded(float threshold) { return std::round(threshold * 32) / 32; }

class Growth {
 public:
  Growth(const GrowthOptions& options, Draw& draw) : options_(options), draw_(draw) {}

  /// Its index, or ~index of a leaf.
  int grow(const Patches& patches, int depth) {
    PatchMoments moments;
    for (const TrainingPatch* patch : patches) moments.add(*patch);
    const bool is_done = moments.heads() == 0 || depth == options_.greatest_depth ||
                         moments.count() < 2 * options_.least_patches;
    const PatchTest test = is_done ? PatchTest() : best_test(patches, depth);
    Patches below;
    Patches above;
    if (!is_done)
      for (const TrainingPatch* patch : patches)
        (test.is_above(patch->patch) ? above : below).push_back(patch);
    if (std::min(below.size(), above.size()) < static_cast<std::size_t>(options_.least_patches)) {
      tree_.leaves.push_back(moments.leaf());
      return ~static_cast<int>(tree_.leaves.size() - 1);
    }
    const std::size_t index = tree_.nodes.size();
    tree_.nodes.push_back({test});
    const int to_below = grow(below, depth + 1);
    const int to_above = grow(above, depth + 1);
    tree_.nodes[index].below = to_below;
    tree_.nodes[index].above = to_above;
    return static_cast<int>(index);
  }

  HeadTree take() { return std::move(tree_); }

 private:
  PatchTest best_test(const Patches& patches, int depth) {
    const Patches some = some_of(patches, options_.looked_at, draw_);
    std::vector<PatchTest> tests(static_cast<std::size_t>(options_.tests));
    for (PatchTest& test : tests) test = {random_box(draw_), random_box(draw_)};
    // Patch by patch, because one fits the cache and all do not.
    std::vector<std::vector<float>> values(tests.size(), std::vector<float>(some.size()));
    for (std::size_t i = 0; i < some.size(); ++i)
      for (std::size_t t = 0; t < tests.size(); ++t) values[t][i] = tests[t].value(some[i]->patch);
    const double pose_weight = 1 - std::exp(-(depth + 1) / options_.steepness);
    PatchTest best;
    double most = 0;
    for (std::size_t t = 0; t < tests.size(); ++t) {
      const BestThreshold found = best_threshold(values[t], some, pose_weight, options_);
      if (found.gain <= most) continue;
      most = found.gain;
      best = tests[t];
      best.threshold = found.threshold;
    }
    return best;
  }

  const GrowthOptions& options_;
  Draw& draw_;
  HeadTree tree_;
};

}  // namespace

double information_gain(const PatchMoments& below, const PatchMoments& above, double pose_weight) {
  PatchMoments all = below;
  all.add(above);
  const auto share = [](int part, int whole) { return whole > 0 ? static_cast<double>(part) / whole : 0; };
  const double of_class = all.class_entropy() - share(below.count(), all.count()) * below.class_entropy() -
                          share(above.count(), all.count()) * above.class_entropy();
  const double of_pose = all.pose_entropy() - share(below.heads(), all.heads()) * below.pose_entropy() -
                         share(above.heads(), all.heads()) * above.pose_entropy();
  return of_class + pose_weight * of_pose;
}

BestThreshold best_threshold(const std::vector<float>& values, const Patches& patches, double pose_weight,
                             const GrowthOptions& options) {
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  const float step = (*greatest - *least) / static_cast<float>(options.thresholds + 1);
  if (!(step > 0)) return {};
  std::vector<float> thresholds;
  for (int i = 1; i <= options.thresholds; ++i)
    thresholds.push_back(rounded(*least + static_cast<float>(i) * step));
  // What lies between two thresholds, and then, summed up, below each.
  std::vector<PatchMoments> bins(thresholds.size() + 1);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto bin = std::lower_bound(thresholds.begin(), thresholds.end(), values[i]) - thresholds.begin();
    bins[static_cast<std::size_t>(bin)].add(*patches[i]);
  }
  PatchMoments above;
  for (const PatchMoments& bin : bins) above.add(bin);
  PatchMoments below;
  BestThreshold best;
  for (std::size_t i = 0; i < thresholds.size(); ++i) {
    below.add(bins[i]);
    above.subtract(bins[i]);
    if (std::min(below.count(), above.count()) == 0) continue;
    const double gain = information_gain(below, above, pose_weight);
    if (gain > best.gain) best = {thresholds[i], gain};
  }
  return best;
}

HeadTree grow_tree(const std::vector<const TrainingPatch*>& patches, const GrowthOptions& options,
                   Draw& draw) {
  Growth growth(options, draw);
  growth.grow(patches, 0);
  return growth.take();
}

}  // namespace pliant
