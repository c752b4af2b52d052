#include "framework/imaging/bilateral.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "framework/core/registry.h"
#include "tests/device/shapes.h"
#include "tests/geometry/made_depth.h"

namespace pliant {
namespace {

const Camera kCamera{300, 290, 84.5, 40, 165, 83};

DepthImage filtered(const BilateralFilter& filter, const Frame& frame, const DeviceOptions& shape = {}) {
  Device device("any", shape);
  const Camera camera{1, 1, 0, 0, frame.depth.width(), frame.depth.height()};
  return to_image(*filter.filter(device, DepthMap(frame), camera), camera);
}

/// Largest difference in mm; infinite where only one of both has depth.
double difference(const DepthImage& a, const DepthImage& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if ((a.pixels()[i] > 0) != (b.pixels()[i] > 0)) return std::numeric_limits<double>::infinity();
    worst = std::max<double>(worst, std::abs(a.pixels()[i] - b.pixels()[i]));
  }
  return worst;
}

class BilateralKernel : public testing::TestWithParam<DeviceOptions> {
 protected:
  static void expect_agreement(const BilateralFilter& filter, const Frame& frame) {
    EXPECT_LT(difference(filtered(filter, frame, GetParam()), filter.filter_reference(frame.depth)), 5e-3);
  }
};

TEST_P(BilateralKernel, AgreesWithTheReference) {
  for (const auto& filter :
       {BilateralFilter(4.5, 30, 6), BilateralFilter(1, 3, 2), BilateralFilter(20, 500, max_window_radius)})
    expect_agreement(filter, made_depth(kCamera));
}

TEST_P(BilateralKernel, AgreesWithTheReferenceOnAnImageSmallerThanItsWindow) {
  expect_agreement(BilateralFilter(4.5, 30, 6), made_depth(Camera{300, 290, 2, 1, 5, 3}));
}

INSTANTIATE_TEST_SUITE_P(Shapes, BilateralKernel, testing::ValuesIn(test::device_shapes));

TEST(Bilateral, TakesOutNoiseAndKeepsSteps) {
  const DepthImage smooth = filtered(BilateralFilter(4.5, 30, 6), made_depth(kCamera));
  const DepthImage truth = made_depth(kCamera, 0).depth;
  const DepthImage noisy = made_depth(kCamera).depth;
  const auto mean_error = [&](const DepthImage& image, int first, int last) {
    double sum = 0;
    int count = 0;
    for (int v = 0; v < image.height(); ++v) {
      for (int u = first; u < last; ++u) {
        if (image(u, v) > 0) sum += std::abs(image(u, v) - truth(u, v)), ++count;
      }
    }
    return sum / count;
  };
  EXPECT_LT(mean_error(smooth, 0, kCamera.width), 0.5 * mean_error(noisy, 0, kCamera.width));
  const int step = 2 * kCamera.width / 3;
  EXPECT_LT(mean_error(smooth, step - 2, step + 3), 5) << "a plain mean is out by a third of the 250 mm";
}

TEST(Bilateral, PixelsWithoutDepthTakeNoPart) {
  Frame frame{DepthImage(40, 30, 800), {}, MaskImage(40, 30, 1)};
  frame.depth(10, 10) = 0;
  frame.depth(12, 10) = std::nanf("");
  frame.depth(14, 10) = 790;
  frame.mask(14, 10) = 0;
  const DepthImage smooth = filtered(BilateralFilter(4.5, 30, 6), frame);
  for (int v = 0; v < 30; ++v) {
    for (int u = 0; u < 40; ++u) {
      const bool is_out = v == 10 && (u == 10 || u == 12 || u == 14);
      EXPECT_EQ(smooth(u, v), is_out ? 0.0F : 800.0F) << u << ' ' << v;
    }
  }
}

TEST(Bilateral, GivesTheSameBitsTwice) {
  const Frame frame = made_depth(kCamera);
  const BilateralFilter filter(4.5, 30, 6);
  EXPECT_EQ(filtered(filter, frame).pixels(), filtered(filter, frame).pixels());
}

TEST(Bilateral, IsMadeByName) {
  Registry registry;
  register_filters(registry);
  Device device;
  const DepthMap map(made_depth(kCamera));
  const auto none = registry.make<DepthFilter>(Parameters("none", {}));
  EXPECT_FALSE(none->filter(device, map, kCamera).has_value());
  const Parameters bilateral("bilateral",
                             {{"sigma_space", 4.5}, {"sigma_depth", 30.0}, {"radius", std::int64_t{6}}});
  const auto filter = registry.make<DepthFilter>(bilateral)->filter(device, map, kCamera);
  ASSERT_TRUE(filter.has_value());
  EXPECT_EQ(to_image(*filter, kCamera).pixels(),
            filtered(BilateralFilter(4.5, 30, 6), made_depth(kCamera)).pixels());
}

/// A gently curved wall with white noise.
DepthMap noisy_wall(double sigma, const Camera& camera, double distance = 800) {
  Frame frame;
  frame.depth = DepthImage(camera.width, camera.height);
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0, sigma);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
      frame.depth(u, v) = static_cast<float>(distance + 5 * std::sin(0.03 * u) + (u > 90 ? 60 : 0) +
                                             (sigma > 0 ? noise(random) : 0.0));
  return DepthMap(frame);
}

TEST(Noise, IsEstimatedWhateverTheShape) {
  for (const double sigma : {0.2, 1.0, 4.0})
    EXPECT_NEAR(estimate_noise(noisy_wall(sigma, kCamera)), sigma, 0.06 * sigma);
  EXPECT_LT(estimate_noise(noisy_wall(0, kCamera)), 0.005);
  EXPECT_EQ(estimate_noise(DepthMap(Frame{DepthImage(20, 20), {}, {}})), 0) << "nothing is seen";
}

TEST(Noise, OfCoarseStepsIsTheirRounding) {
  Frame steps{DepthImage(60, 40), {}, {}};
  Frame boxes = steps;
  for (int v = 0; v < 40; ++v)
    for (int u = 0; u < 60; ++u) {
      steps.depth(u, v) = 800.0F + 12.0F * static_cast<float>(u / 5);
      boxes.depth(u, v) = 800.0F + 100.0F * static_cast<float>(u / 30);
    }
  EXPECT_NEAR(estimate_noise(DepthMap(steps)), 12 / std::sqrt(12.0), 1e-4);
  EXPECT_EQ(estimate_noise(DepthMap(boxes)), 0) << "a single edge is no rounding";
}

TEST(BilateralByNoise, WindowsGrowWithTheNoiseInDistancesBetweenPoints) {
  const BilateralByNoise filter(3, 30);
  const double spacing = 800 / kCamera.fx;
  EXPECT_NEAR(filter.sigma_space(noisy_wall(1, kCamera), kCamera), 3 / std::sqrt(spacing), 0.1);
  Camera fine = kCamera;
  fine.fx *= 2;  // half the distance between points: the same noise tilts normals twice as much
  EXPECT_NEAR(filter.sigma_space(noisy_wall(1, fine), fine), 3 * std::sqrt(2 / spacing), 0.1);
  EXPECT_EQ(filter.sigma_space(noisy_wall(50, kCamera), kCamera), 6) << "no wider";
}

TEST(BilateralByNoise, FiltersAsBilateralDoesOrNotAtAll) {
  Device device;
  const BilateralByNoise filter(3, 30);
  const DepthMap noisy = noisy_wall(1, kCamera);
  const double sigma = filter.sigma_space(noisy, kCamera);
  const BilateralFilter same(sigma, 30, static_cast<int>(std::ceil(2 * sigma)));
  EXPECT_EQ(filter.filter(device, noisy, kCamera)->depth.host(),
            same.filter(device, noisy, kCamera)->depth.host());
  EXPECT_FALSE(filter.filter(device, noisy_wall(0.03, kCamera), kCamera));
}

}  // namespace
}  // namespace pliant
