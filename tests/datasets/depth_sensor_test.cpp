#include "experiments/datasets/depth_sensor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "framework/core/angle.h"
#include "tests/datasets/data_of.h"

namespace pliant {
namespace {

using test::shared_device;

const Camera kCamera{525, 525, 79.5, 59.5, 160, 120};

DepthImage wall(float depth) { return DepthImage(kCamera.width, kCamera.height, depth); }

/// A plane through (0, 0, 800) whose normal is turned by some degrees about y from the optical axis.
DepthImage slope(double degrees) {
  DepthImage depth(kCamera.width, kCamera.height);
  const double tangent = std::tan(degrees * degree);
  for (int v = 0; v < kCamera.height; ++v)
    for (int u = 0; u < kCamera.width; ++u)
      depth(u, v) = static_cast<float>(800 / (1 + tangent * (u - kCamera.cx) / kCamera.fx));
  return depth;
}

/// A wall at 1000 mm with a square of 40 pixels 300 mm before it, and nothing on the right.
DepthImage step_scene() {
  DepthImage depth = wall(1000);
  for (int v = 0; v < kCamera.height; ++v)
    for (int u = 0; u < kCamera.width; ++u) {
      if (u >= 140) depth(u, v) = 0;
      if (std::abs(u - 80) < 20 && std::abs(v - 60) < 20) depth(u, v) = 700;
    }
  return depth;
}

DepthImage sense(const DepthSensorSettings& settings, const DepthImage& depth, std::uint32_t frame = 1,
                 std::uint64_t seed = 1) {
  return DepthSensor(settings, kCamera, seed).sense_reference(depth, frame);
}

struct Spread {
  double mean = 0;
  double sd = 0;
};

Spread spread(const DepthImage& sensed) {
  double sum = 0;
  double squares = 0;
  for (const float value : sensed.pixels()) sum += value;
  const double mean = sum / static_cast<double>(sensed.size());
  for (const float value : sensed.pixels()) squares += (value - mean) * (value - mean);
  return {mean, std::sqrt(squares / static_cast<double>(sensed.size()))};
}

int holes(const DepthImage& depth) {
  int count = 0;
  for (const float value : depth.pixels()) count += value > 0 ? 0 : 1;
  return count;
}

TEST(DepthSensor, ChangesNothingWithAllTermsOff) {
  EXPECT_FALSE(DepthSensorSettings{}.is_on());
  EXPECT_EQ(sense({}, step_scene()).pixels(), step_scene().pixels());
}

TEST(DepthSensor, AxialNoiseGrowsWithTheSquareOfTheDepthAndWithTheAngle) {
  for (const float depth : {700.0F, 2000.0F}) {
    const double beyond = depth / 1000.0 - 0.4;
    const double sigma = 1.2 + 1.9 * beyond * beyond;
    const Spread once = spread(sense({.axial = 1}, wall(depth)));
    EXPECT_NEAR(once.mean, depth, 4 * sigma / std::sqrt(160 * 120));
    EXPECT_NEAR(once.sd, sigma, 0.03 * sigma);
    EXPECT_NEAR(spread(sense({.axial = 2}, wall(depth))).sd, 2 * sigma, 0.06 * sigma);
  }
  const DepthImage steep = slope(75);
  const DepthImage sensed = sense({.axial = 1}, steep);
  double squares = 0;
  int count = 0;
  for (int v = 0; v < kCamera.height; ++v, ++count) {
    const double difference = sensed(80, v) - steep(80, v);
    squares += difference * difference;
  }
  const double ratio = 75.0 / 15.0;
  const double expected = 1.2 + 1.9 * 0.16 + 0.1 / std::sqrt(0.8) * ratio * ratio;
  EXPECT_NEAR(std::sqrt(squares / count), expected, 0.25 * expected);
}

TEST(DepthSensor, DisparityComesInSteps) {
  const DepthImage sensed = sense({.quantisation = 1}, slope(30));
  std::set<float> levels(sensed.pixels().begin(), sensed.pixels().end());
  EXPECT_LT(levels.size(), 80U);
  for (const float depth : levels) {
    const double eighths = 525 * 75 / static_cast<double>(depth) * 8;
    EXPECT_NEAR(eighths, std::round(eighths), 1e-3);
  }
  const DepthImage finer = sense({.quantisation = 0.5}, slope(30));
  EXPECT_GT(std::set<float>(finer.pixels().begin(), finer.pixels().end()).size(), 1.8 * levels.size());
}

TEST(DepthSensor, LateralNoiseIsAtStepsOnly) {
  const DepthImage exact = step_scene();
  const DepthImage sensed = sense({.lateral = 1}, exact);
  int changed = 0;
  for (int v = 0; v < kCamera.height; ++v) {
    for (int u = 0; u < kCamera.width; ++u) {
      if (sensed(u, v) == exact(u, v)) continue;
      ++changed;
      const int side = std::max(std::abs(u - 80), std::abs(v - 60));
      EXPECT_TRUE(std::abs(side - 20) <= 1 || std::abs(u - 140) <= 1) << u << ", " << v;
      EXPECT_TRUE(sensed(u, v) == 700 || sensed(u, v) == 1000 || sensed(u, v) == 0);
    }
  }
  EXPECT_GT(changed, 80);
  EXPECT_EQ(sense({.lateral = 1}, slope(60)).pixels(), slope(60).pixels()) << "a slope is no step";
}

TEST(DepthSensor, GrazingSurfacesReturnNothing) {
  EXPECT_EQ(holes(sense({.grazing = 80}, slope(70))), 0);
  // 82 degrees from the optical axis, and up to 8 more or less from the rays.
  const DepthImage sensed = sense({.grazing = 80}, slope(-82));
  EXPECT_GT(holes(sensed), 160 * 120 / 3);
  EXPECT_LT(holes(sensed), 160 * 120);
}

// The projector is on the right: what is nearer hides from it what is left of it.
TEST(DepthSensor, ShadowIsLeftOfWhatIsNearer) {
  const DepthImage exact = step_scene();
  const DepthImage sensed = sense({.shadow = 75}, exact);
  const double width = 525 * 75 * (1 / 700.0 - 1 / 1000.0);  // difference of disparities, 16.9 pixels
  for (int v = 45; v < 75; ++v) {
    for (int u = 0; u < 140; ++u) {
      const bool is_before = u > 60 && u < 100;
      const bool is_shadow = u <= 60 && u > 60 - width + 1;
      const bool is_lit = is_before || u > 101 || u < 60 - width - 1;
      if (is_shadow || is_lit) {
        EXPECT_EQ(sensed(u, v), is_lit ? exact(u, v) : 0) << u << ", " << v;
      }
    }
  }
  EXPECT_EQ(sensed(50, 20), 1000) << "above it";
  EXPECT_EQ(holes(sense({.shadow = 75}, slope(60))), 0) << "a slope hides nothing of itself";
}

TEST(DepthSensor, NoiseIsOfTheSeedAndTheFrame) {
  const DepthSensorSettings all{1, 1, 1, 80, 75};
  const DepthImage exact = step_scene();
  EXPECT_EQ(sense(all, exact, 1, 1).pixels(), sense(all, exact, 1, 1).pixels());
  EXPECT_NE(sense(all, exact, 1, 1).pixels(), sense(all, exact, 2, 1).pixels());
  EXPECT_NE(sense(all, exact, 1, 1).pixels(), sense(all, exact, 1, 2).pixels());
}

TEST(DepthSensor, TheDeviceSensesWhatTheReferenceDoes) {
  for (const DepthSensorSettings& settings :
       {DepthSensorSettings{.axial = 1}, DepthSensorSettings{.lateral = 1.5},
        DepthSensorSettings{.grazing = 80}, DepthSensorSettings{.shadow = 75},
        DepthSensorSettings{1, 1, 1, 80, 75}}) {
    for (const DepthImage& exact : {step_scene(), slope(-81), slope(40)}) {
      const DepthSensor sensor(settings, kCamera, 7);
      const Array<float> depth(exact.pixels());
      const Array<float> sensed = sensor.sense(shared_device(), depth, 3);
      EXPECT_EQ(sensor.sense(shared_device(), depth, 3).host(), sensed.host()) << "the same bits again";
      const DepthImage reference = sensor.sense_reference(exact, 3);
      int others = 0;
      for (std::size_t i = 0; i < exact.size(); ++i) {
        const float expected = reference.pixels()[i];
        if (std::abs(sensed.host()[i] - expected) > 1e-3F * std::max(expected, 1.0F)) ++others;
      }
      EXPECT_LT(others, 20) << "where rounding decides";
    }
  }
}

}  // namespace
}  // namespace pliant
