#include "framework/imaging/bilateral.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "framework/imaging/bilateral.cl.embed.h"
#include "framework/imaging/depth_kernel.h"

namespace pliant {
namespace {

class NoFilter : public DepthFilter {
 public:
  std::optional<DepthMap> filter(Device&, const DepthMap&, const Camera&) const override {
    return std::nullopt;
  }
};

constexpr int sampled_rows = 4;      // every so many rows of the image: noise is the same in those between
constexpr double least_sigma = 0.4;  // pixels: with less the neighbours weigh a twentieth of the pixel itself
constexpr double greatest_sigma = 6;  // pixels: what would need more is smoothed beyond recognition

/// Calls `take` with the depths of each three neighbours in the sampled rows that have depth.
template <class Take>
void for_each_triple(const DepthMap& map, Take take) {
  const auto& depth = map.depth.host();
  const int skipped = map.window.top % sampled_rows;
  for (int v = skipped > 0 ? sampled_rows - skipped : 0; v < map.window.height; v += sampled_rows) {
    const float* row = depth.data() + map.offset(0, v);
    for (int u = 1; u + 1 < map.window.width; ++u)
      if (std::max({row[u - 1], row[u], row[u + 1]}) < DepthMap::no_depth)
        take(row[u - 1], row[u], row[u + 1]);
  }
}

/// 0 where there are no values.
double median(std::vector<float> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Of depths in such coarse steps that most neighbours have the same: what rounding to them makes uncertain.
/// 0 where hardly any differ, as at the edges of flat things.
double estimate_rounding(std::vector<float> bends) {
  constexpr std::size_t fewest = 8;  // one in so many
  const auto equal = static_cast<std::size_t>(std::count(bends.begin(), bends.end(), 0.0F));
  const std::size_t different = bends.size() - equal;
  if (different * fewest < bends.size()) return 0;
  std::erase(bends, 0.0F);
  return median(std::move(bends)) / std::sqrt(12.0);
}

double median_depth(const DepthMap& map) {
  std::vector<float> depths;
  for_each_triple(map, [&](float, float centre, float) { depths.push_back(centre); });
  return median(std::move(depths));
}

double gauss(double distance, double sigma) { return std::exp(-distance * distance / (2 * sigma * sigma)); }

// The kernel's Gaussian of depth: a cubic v^3 + linear v + constant, v = top - d^2, that is 0 at d = 1.
constexpr double reach = 7.38705;  // sigma
constexpr double top = 0.648966;
constexpr double linear = 1.025937;
constexpr double constant = (1 - top) * ((1 - top) * (1 - top) + linear);

}  // namespace

BilateralFilter::BilateralFilter(double sigma_space, double sigma_depth, int radius)
    : sigma_space_(sigma_space), sigma_depth_(sigma_depth), radius_(radius) {
  std::vector<float> space;
  for (int dv = -radius_; dv <= radius_; ++dv)
    for (int du = -radius_; du <= radius_; ++du)
      space.push_back(static_cast<float>(gauss(std::hypot(du, dv), sigma_space_)));
  space_ = Array<float>(std::move(space));
}

std::optional<DepthMap> BilateralFilter::filter(Device& device, const DepthMap& map, const Camera&) const {
  static const std::string source = with_depth_map(embedded::framework_imaging_bilateral_cl);
  DepthMap filtered(map.window);
  static const std::string options = fmt::format("{} -DTOP={:.8e}f -DLINEAR={:.8e}f -DCONSTANT={:.8e}f",
                                                 depth_map_options(), top, linear, constant);
  auto kernel = device.kernel(source, "bilateral", options);
  const auto width = static_cast<std::size_t>(device.width());
  device.run("filter", kernel, map.depth.size() / width, 64, map.depth.device(device),
             static_cast<cl_int>(map.stride), cl_int2{{map.window.width, map.window.height}},
             static_cast<cl_int>(radius_), space_.device(device),
             static_cast<float>(1 / (reach * sigma_depth_)), filtered.depth.write_device(device));
  return filtered;
}

DepthImage BilateralFilter::filter_reference(const DepthImage& depth) const {
  DepthImage filtered(depth.width(), depth.height());
  const auto has_depth = [&](int u, int v) { return depth.contains(u, v) && is_depth(depth(u, v)); };
  for (int v = 0; v < depth.height(); ++v) {
    for (int u = 0; u < depth.width(); ++u) {
      if (!has_depth(u, v)) continue;
      double sum = 0;
      double weights = 0;
      for (int y = v - radius_; y <= v + radius_; ++y) {
        for (int x = u - radius_; x <= u + radius_; ++x) {
          if (!has_depth(x, y)) continue;
          const double weight = gauss(std::hypot(x - u, y - v), sigma_space_) *
                                gauss(static_cast<double>(depth(x, y)) - depth(u, v), sigma_depth_);
          sum += weight * depth(x, y);
          weights += weight;
        }
      }
      filtered(u, v) = static_cast<float>(sum / weights);
    }
  }
  return filtered;
}

double estimate_noise(const DepthMap& map) {
  std::vector<float> bends;
  for_each_triple(map, [&](float left, float centre, float right) {
    bends.push_back(std::abs(left - 2 * centre + right));
  });
  const double bend = median(bends);
  if (bend == 0) return estimate_rounding(std::move(bends));
  // The second difference of white noise has 6 times its variance; the median of a normal distribution's
  // magnitude is 0.6745 standard deviations.
  return bend / (0.6745 * std::sqrt(6.0));
}

BilateralByNoise::BilateralByNoise(double gain, double sigma_depth)
    : gain_(gain), sigma_depth_(sigma_depth) {}

double BilateralByNoise::sigma_space(const DepthMap& map, const Camera& camera) const {
  const double spacing = median_depth(map) / camera.fx;
  return spacing > 0 ? std::min(gain_ * std::sqrt(estimate_noise(map) / spacing), greatest_sigma) : 0;
}

std::optional<DepthMap> BilateralByNoise::filter(Device& device, const DepthMap& map,
                                                 const Camera& camera) const {
  const double sigma = sigma_space(map, camera);
  if (sigma < least_sigma) return std::nullopt;
  const int radius = std::min(static_cast<int>(std::ceil(2 * sigma)), max_window_radius);
  return BilateralFilter(sigma, sigma_depth_, radius).filter(device, map, camera);
}

void register_filters(Registry& registry) {
  registry.add<DepthFilter>("none", "Leaves depth as it is", {},
                            [](const Parameters&, const Registry&) { return std::make_unique<NoFilter>(); });
  registry.add<DepthFilter>(
      "bilateral", "Averages over a window, weighted by distance and by difference in depth [Eq. 3.1]",
      {
          real("sigma_space", 4.5).unit("pixel").above(0).doc("sigma_d: how weights fall with distance"),
          real("sigma_depth", 30).unit("mm").above(0).doc("sigma_c: how they fall with difference in depth"),
          integer("radius", 6).unit("pixel").range(1, max_window_radius).doc("Half the side of the window"),
      },
      [](const Parameters& parameters, const Registry&) {
        return std::make_unique<BilateralFilter>(parameters.real("sigma_space"),
                                                 parameters.real("sigma_depth"),
                                                 static_cast<int>(parameters.integer("radius")));
      });
  registry.add<DepthFilter>(
      "bilateral_by_noise",
      "The same with a window as wide as the noise of the image asks for, none where there is hardly any",
      {
          real("gain", 2.2)
              .above(0)
              .doc("sigma_d in pixels where the noise is as large as the distance between neighbouring "
                   "points; it goes "
                   "with its square root"),
          real("sigma_depth", 30)
              .unit("mm")
              .above(0)
              .doc("sigma_c: how weights fall with difference in depth"),
      },
      [](const Parameters& parameters, const Registry&) {
        return std::make_unique<BilateralByNoise>(parameters.real("gain"), parameters.real("sigma_depth"));
      });
}

}  // namespace pliant
