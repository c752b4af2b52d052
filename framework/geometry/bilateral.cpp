#include "framework/geometry/bilateral.h"

#include <cmath>
#include <memory>
#include <numbers>

#include "framework/geometry/depth_kernel.h"

namespace pliant {
namespace {

class NoFilter : public DepthFilter {
 public:
  std::optional<DepthMap> filter(Device&, const DepthMap&) const override { return std::nullopt; }
};

}  // namespace

BilateralFilter::BilateralFilter(double sigma_space, double sigma_depth, int radius)
    : sigma_space_(sigma_space), sigma_depth_(sigma_depth), radius_(radius) {}

std::optional<DepthMap> BilateralFilter::filter(Device& device, const DepthMap& map) const {
  // The kernel works with powers of two.
  const auto exponent = [](double distance, double sigma) {
    return static_cast<float>(distance * distance / (2 * sigma * sigma) * std::numbers::log2e);
  };
  std::vector<float> steps;
  for (int dv = -radius_; dv <= radius_; ++dv)
    for (int du = -radius_; du <= radius_; ++du) steps.push_back(exponent(std::hypot(du, dv), sigma_space_));
  const Array<float> window(std::move(steps));

  DepthMap filtered(map.width, map.height);
  auto kernel = depth_kernel(device, "bilateral");
  const auto width = static_cast<std::size_t>(device.width());
  device.run("filter", kernel, map.depth.size() / width, 64, map.depth.device(device),
             static_cast<cl_int>(map.stride), cl_int2{{map.width, map.height}}, static_cast<cl_int>(radius_),
             window.device(device), exponent(1, sigma_depth_), filtered.depth.write_device(device));
  return filtered;
}

DepthImage BilateralFilter::filter_reference(const DepthImage& depth) const {
  DepthImage filtered(depth.width(), depth.height());
  const auto has_depth = [&](int u, int v) { return depth.contains(u, v) && is_depth(depth(u, v)); };
  const auto gauss = [](double distance, double sigma) {
    return std::exp(-distance * distance / (2 * sigma * sigma));
  };
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
}

}  // namespace pliant
