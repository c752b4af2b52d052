#include "framework/imaging/normals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "framework/imaging/cross_product.h"
#include "framework/imaging/integral_images.h"
#include "framework/imaging/plane_fit.h"
#include "tests/device/shapes.h"
#include "tests/geometry/degrees_between.h"
#include "tests/geometry/made_depth.h"

namespace pliant {
namespace {

using test::degrees_between;

/// Width and height are no multiples of a vector, nor of a tile.
const Camera kCamera{300, 290, 84.5, 40, 165, 83};

using NormalImage = Image<Eigen::Vector3f>;

Frame curved(double noise = 0) {
  Frame frame = made_depth(kCamera, noise);
  for (int v = 0; v < kCamera.height; ++v)
    for (int u = 0; u < kCamera.width; ++u)
      if (frame.depth(u, v) == 0) frame.depth(u, v) = u > 0 ? frame.depth(u - 1, v) : 940.0F;
  return frame;
}

NormalImage made(const Normals& normals, const Frame& frame, const DeviceOptions& shape = {}) {
  Device device("any", shape);
  const DepthMap map(frame);
  SurfaceMap surface = unwritten_surface(kCamera, map.window);
  normals.write(device, map, surface);
  NormalImage image(kCamera.width, kCamera.height, Eigen::Vector3f::Zero());
  for (int v = 0; v < kCamera.height; ++v)
    for (int u = 0; u < kCamera.width; ++u) image(u, v) = finite_or_none(surface, surface.normals(), {u, v});
  return image;
}

struct Difference {
  double angle =
      0;  ///< degrees, the largest but for one pixel in a hundred, where points hardly lie in a plane
  int validity = 0;  ///< pixels where only one of both has a normal
  int normals = 0;   ///< pixels where both have one
};

Difference difference(const NormalImage& a, const NormalImage& b) {
  Difference worst;
  std::vector<double> angles;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Eigen::Vector3f& one = a.pixels()[i];
    const Eigen::Vector3f& other = b.pixels()[i];
    if (one.isZero(0) != other.isZero(0)) ++worst.validity;
    if (one.isZero(0) || other.isZero(0)) continue;
    EXPECT_NEAR(one.norm(), 1, 1e-5);
    ++worst.normals;
    angles.push_back(degrees_between(one, other));
  }
  std::sort(angles.begin(), angles.end());
  worst.angle = angles.empty() ? 180 : angles[angles.size() * 99 / 100];
  return worst;
}

class NormalsKernel : public testing::TestWithParam<DeviceOptions> {
 protected:
  template <class Kind>
  static Difference compare(const Kind& kind, const Frame& frame) {
    return difference(made(kind, frame, GetParam()), kind.reference(frame.depth, kCamera));
  }
};

INSTANTIATE_TEST_SUITE_P(Shapes, NormalsKernel, testing::ValuesIn(test::device_shapes));

TEST_P(NormalsKernel, OfIntegralImagesAgreeWithTheReference) {
  for (const int radius : {1, 3, IntegralImages::max_radius}) {
    const Difference worst = compare(IntegralImages(radius, 0.02), curved());
    EXPECT_LT(worst.angle, 0.05) << radius;
    EXPECT_EQ(worst.validity, 0) << radius;
    EXPECT_GT(worst.normals, 12500) << radius;
  }
}

TEST_P(NormalsKernel, OfIntegralImagesAgreeWithTheReferenceUnderNoiseAndHoles) {
  const Difference noisy = compare(IntegralImages(4, 0.02), curved(2));
  EXPECT_LT(noisy.angle, 0.1);
  EXPECT_EQ(noisy.validity, 0);
  const Difference holey = compare(IntegralImages(4, 0.02), made_depth(kCamera));
  EXPECT_LT(holey.angle, 0.3) << "windows of few pixels";
  EXPECT_EQ(holey.validity, 0);
  EXPECT_GT(holey.normals, 3500);
}

TEST_P(NormalsKernel, OfIntegralImagesAgreeWithTheReferenceNearAndFar) {
  for (const double scale : {0.15, 0.4, 4.0}) {
    Frame frame = curved();
    for (int v = 0; v < kCamera.height; ++v)
      for (int u = 0; u < kCamera.width; ++u) frame.depth(u, v) *= static_cast<float>(scale);
    const Difference worst = compare(IntegralImages(3, 0.02), frame);
    EXPECT_LT(worst.angle, 0.1) << scale;
    EXPECT_EQ(worst.validity, 0) << scale;
    EXPECT_GT(worst.normals, 12500) << scale;
  }
}

TEST_P(NormalsKernel, OfCrossProductsAgreeWithTheReference) {
  for (const int reach : {1, 3}) {
    const Difference worst = compare(CrossProduct(reach, 0.02), made_depth(kCamera));
    EXPECT_LT(worst.angle, 0.1) << reach;
    EXPECT_EQ(worst.validity, 0) << reach;
    EXPECT_GT(worst.normals, 11000) << reach;
  }
}

}  // namespace
}  // namespace pliant
