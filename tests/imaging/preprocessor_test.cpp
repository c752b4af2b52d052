#include "framework/imaging/preprocessor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "framework/core/error.h"
#include "framework/imaging/bilateral.h"
#include "framework/imaging/integral_images.h"
#include "tests/geometry/made_depth.h"

namespace pliant {
namespace {

const Camera kCamera{300, 290, 84.5, 40, 165, 83};
const PixelWindow kRegion{21, 10, 90, 50};

Acquisition usual(double depth_cut = 0) {
  return {depth_cut, std::make_unique<BilateralFilter>(4.5, 30, 6),
          std::make_unique<IntegralImages>(3, 0.02)};
}

TEST(Preprocessor, DropsWhatIsFarOrMaskedOrOutsideTheRegion) {
  Device device;
  Frame frame = made_depth(kCamera);
  frame.mask = MaskImage(kCamera.width, kCamera.height, 1);
  frame.mask(30, 20) = 0;
  const Acquisition acquisition = usual(950);
  Preprocessor preprocessor(device, Rig{kCamera}, acquisition, kRegion);
  preprocessor.process(frame);
  DepthImage expected(kCamera.width, kCamera.height);
  for (int v = 10; v < 60; ++v)
    for (int u = 21; u < 111; ++u)
      if (frame.depth(u, v) <= 950 && frame.mask(u, v) != 0) expected(u, v) = frame.depth(u, v);
  EXPECT_EQ(to_image(preprocessor.depth(), kCamera).pixels(), expected.pixels());
  EXPECT_EQ(preprocessor.surface().window, kRegion);
}

TEST(Preprocessor, MayMakeTheWholeSurfaceOfFilteredDepth) {
  Device device;
  const Frame frame = made_depth(kCamera);
  Acquisition acquisition = usual();
  acquisition.filters_points = true;
  Preprocessor preprocessor(device, Rig{kCamera}, acquisition);
  preprocessor.process(frame);
  DepthMap depth(whole_image(kCamera));
  depth.take(frame);
  SurfaceMap expected = unwritten_surface(kCamera, depth.window);
  acquisition.normals->write(device, *acquisition.filter->filter(device, depth, kCamera), expected);
  EXPECT_EQ(preprocessor.surface().points().host(), expected.points().host());
  EXPECT_EQ(preprocessor.surface().normals().host(), expected.normals().host());
  EXPECT_NE(preprocessor.surface().points().host()[2], frame.depth(0, 0)) << "not filtered";
}

TEST(Preprocessor, PointsAreThoseThatWereMeasured) {
  Device device;
  const Frame frame = made_depth(kCamera);
  const Acquisition acquisition = usual();
  Preprocessor preprocessor(device, Rig{kCamera}, acquisition, kRegion);
  preprocessor.process(frame);
  const SurfaceMap& surface = preprocessor.surface();
  int seen = 0;
  for (int v = kRegion.top; v < kRegion.top + kRegion.height; ++v) {
    for (int u = kRegion.left; u < kRegion.left + kRegion.width; ++u) {
      const Eigen::Vector3f point = finite_or_none(surface, surface.points(), {u, v});
      const float depth = frame.depth(u, v);
      if (!is_depth(depth)) {
        EXPECT_EQ(point.z(), 0) << u << " " << v;
        continue;
      }
      EXPECT_LT((point - kCamera.unproject(u, v, depth).cast<float>()).norm(), 1e-3F) << u << " " << v;
      ++seen;
    }
  }
  EXPECT_GT(seen, 1000);
}

TEST(Preprocessor, AFrameWithoutDepthIsFullOfHoles) {
  Device device;
  const Acquisition acquisition = usual(1300);
  Preprocessor preprocessor(device, Rig{kCamera}, acquisition);
  preprocessor.process(made_depth(kCamera));
  preprocessor.process(Frame{DepthImage(kCamera.width, kCamera.height), {}, {}});
  EXPECT_EQ(preprocessor.depth().window, whole_image(kCamera));
  EXPECT_THAT(preprocessor.surface().points().host(), testing::Each(0.0F));
  EXPECT_THAT(preprocessor.surface().normals().host(), testing::Each(0.0F));
}

TEST(Preprocessor, AsksForNoMemoryAfterTheThirdFrameAndUploadsOnce) {
  Device device;
  const Acquisition acquisition = usual(1300);
  Preprocessor preprocessor(device, Rig{kCamera}, acquisition);
  DeviceCounts before;
  for (int number = 1; number <= 20; ++number) {
    preprocessor.process(made_depth(kCamera, number % 3));
    const DeviceCounts after = device.counts();
    if (number > 3) {
      EXPECT_EQ(after.allocations, before.allocations) << number;
      EXPECT_EQ(after.uploads, before.uploads + 1) << number;
      EXPECT_EQ(after.reads, 0U) << number;
    }
    before = after;
  }
}

TEST(Preprocessor, NamesBothSizesOfAFrameThatDoesNotFit) {
  Device device;
  const Acquisition acquisition = usual();
  Preprocessor preprocessor(device, Rig{kCamera}, acquisition);
  try {
    preprocessor.process(Frame{DepthImage(64, 48, 800), {}, {}});
    FAIL();
  } catch (const DataError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("64 x 48"));
    EXPECT_THAT(error.what(), testing::HasSubstr("165 x 83"));
  }
}

TEST(Preprocessor, RefusesARegionBeyondTheImage) {
  Device device;
  const Acquisition acquisition = usual();
  EXPECT_THROW(Preprocessor(device, Rig{kCamera}, acquisition, PixelWindow{100, 10, 66, 20}),
               std::invalid_argument);
  EXPECT_THROW(Preprocessor(device, Rig{kCamera}, acquisition, PixelWindow{10, 10, 0, 20}),
               std::invalid_argument);
}

TEST(Preprocessor, SeesInAMovedRegionWhatOneMadeThereSees) {
  Device device;
  const Acquisition acquisition = usual();
  const Frame frame = made_depth(kCamera);
  const PixelWindow larger{5, 3, 120, 70};
  Preprocessor moved(device, Rig{kCamera}, acquisition, kRegion);
  for (const PixelWindow& region : {PixelWindow{40, 20, kRegion.width, kRegion.height}, larger}) {
    moved.process(frame);
    moved.move_to(region);
    moved.process(frame);
    Preprocessor made(device, Rig{kCamera}, acquisition, region);
    made.process(frame);
    EXPECT_EQ(moved.surface().window, region);
    EXPECT_EQ(moved.surface().points().host(), made.surface().points().host());
    EXPECT_EQ(moved.surface().normals().host(), made.surface().normals().host());
    EXPECT_EQ(moved.depth().depth.host(), made.depth().depth.host());
  }
  EXPECT_THROW(moved.move_to(PixelWindow{100, 10, 66, 20}), std::invalid_argument);
}

TEST(CutDepth, TakesOutWhatIsFarther) {
  DepthImage depth(3, 1);
  depth(0, 0) = 1300;
  depth(1, 0) = 1300.5F;
  depth(2, 0) = 20;
  EXPECT_THAT(cut_depth(depth, 1300).pixels(), testing::ElementsAre(1300, 0, 20));
}

}  // namespace
}  // namespace pliant
