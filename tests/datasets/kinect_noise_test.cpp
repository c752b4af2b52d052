#include "experiments/datasets/kinect_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace pliant {
namespace {

constexpr double kFocalLength = 525;

std::vector<float> disturbed(double strength, std::uint64_t seed, float depth = 800, int size = 300) {
  DepthImage image(size, size, depth);
  KinectNoise(strength, kFocalLength, seed).disturb(image);
  return image.pixels();
}

TEST(KinectNoise, OfStrengthZeroChangesNothing) {
  EXPECT_EQ(disturbed(0, 1, 723.25f), DepthImage(300, 300, 723.25f).pixels());
}

TEST(KinectNoise, TheSeedMakesTheBits) {
  EXPECT_EQ(disturbed(1, 5), disturbed(1, 5));
  EXPECT_NE(disturbed(1, 5), disturbed(1, 6));
}

TEST(KinectNoise, DepthIsADisparityInEighthsOfAPixel) {
  for (const float depth : disturbed(1, 2)) {
    const double eighths = kFocalLength * 75 / depth * 8;
    EXPECT_NEAR(eighths, std::round(eighths), 1e-4);
  }
}

TEST(KinectNoise, HasTheSpreadOfTheModel) {
  for (const double strength : {0.5, 1.0, 2.0}) {
    for (const float depth : {600.0f, 800.0f, 1500.0f}) {
      const std::vector<float> values = disturbed(strength, 3, depth);
      double sum = 0;
      double squares = 0;
      for (const float value : values) {
        sum += value - depth;
        squares += (value - depth) * (value - depth);
      }
      const double count = static_cast<double>(values.size());
      const double beyond = (depth - 400) / 1000.0;
      const double axial = strength * (1.2 + 1.9 * beyond * beyond);
      // A step of the disparity, in mm at this depth, is rounded evenly.
      const double step = strength / 8 * depth * depth / (kFocalLength * 75);
      const double expected = std::sqrt(axial * axial + step * step / 12);
      EXPECT_NEAR(sum / count, 0, 0.05 * expected) << strength << " at " << depth;
      EXPECT_NEAR(std::sqrt(squares / count) / expected, 1, 0.02) << strength << " at " << depth;
    }
  }
}

TEST(KinectNoise, LeavesPixelsWithoutDepthAlone) {
  DepthImage image(2, 1, 800);
  image(0, 0) = 0;
  KinectNoise(1, kFocalLength, 1).disturb(image);
  EXPECT_EQ(image(0, 0), 0);
  EXPECT_NE(image(1, 0), 800);
}

TEST(KinectNoise, NeverGivesADepthThatIsNone) {
  for (const float depth : {2.0f, 1e6f, 1e20f}) {
    for (const float value : disturbed(10, 4, depth, 50)) {
      EXPECT_TRUE(std::isfinite(value));
      EXPECT_GE(value, 0);
    }
  }
}

}  // namespace
}  // namespace pliant
