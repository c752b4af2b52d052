#include "framework/geometry/frame.h"

#include <gmock/gmock.h>

#include <functional>
#include <limits>

#include "framework/core/error.h"

namespace pliant {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

Frame whole_frame() { return {DepthImage(8, 6, 500), ColorImage(8, 6), MaskImage(8, 6, 1)}; }

FramePair whole_pair() { return {"pair", {100, 100, 3.5, 2.5, 8, 6}, whole_frame(), whole_frame()}; }

/// One of the functions of that name.
struct Check {
  void operator()(const FramePair& pair) const { check(pair); }
};

/// What checking the pair says once it is spoilt; empty: nothing.
std::string complaint(const std::function<void(FramePair&)>& spoil,
                      const std::function<void(const FramePair&)>& check_pair = Check{}) {
  FramePair pair = whole_pair();
  spoil(pair);
  try {
    check_pair(pair);
  } catch (const DataError& error) {
    return error.what();
  }
  return "";
}

TEST(FramePairCheck, TakesWhatFitsTogether) {
  EXPECT_EQ(complaint([](FramePair&) {}), "");
  EXPECT_EQ(complaint([](FramePair& pair) {
              pair.source.color = pair.target.color = {};
              pair.source.mask = pair.target.mask = {};
            }),
            "")
      << "only depth has to be there";
  EXPECT_EQ(complaint([](FramePair& pair) {
              pair.source.depth(1, 1) = static_cast<float>(nan);
              pair.target.depth(2, 1) = static_cast<float>(-infinity);
            }),
            "")
      << "depth that is none is a hole";
  EXPECT_EQ(complaint([](FramePair& pair) { pair.camera.cx = -20; }), "") << "a part cut out of an image";
}

TEST(FramePairCheck, NamesThePairAndBothSizes) {
  EXPECT_EQ(complaint([](FramePair& pair) { pair.camera.width = 9; }),
            "pair: the source's depth image is 8 x 6 pixels; expected the camera's 9 x 6");
  EXPECT_EQ(complaint([](FramePair& pair) { pair.camera.height = 5; }),
            "pair: the source's depth image is 8 x 6 pixels; expected the camera's 8 x 5");
  EXPECT_EQ(complaint([](FramePair& pair) { pair.target.depth = DepthImage(6, 8); }),
            "pair: the target's depth image is 6 x 8 pixels; expected the camera's 8 x 6");
  EXPECT_EQ(complaint([](FramePair& pair) { pair.source.color = ColorImage(16, 12); }),
            "pair: the source's colour image is 16 x 12 pixels; expected the camera's 8 x 6");
  EXPECT_EQ(complaint([](FramePair& pair) { pair.target.color = ColorImage(8, 7); }),
            "pair: the target's colour image is 8 x 7 pixels; expected the camera's 8 x 6");
  EXPECT_EQ(complaint([](FramePair& pair) { pair.source.mask = MaskImage(7, 6); }),
            "pair: the source's mask is 7 x 6 pixels; expected the camera's 8 x 6");
  EXPECT_EQ(complaint([](FramePair& pair) { pair.target.mask = MaskImage(1, 1); }),
            "pair: the target's mask is 1 x 1 pixels; expected the camera's 8 x 6");
}

TEST(FramePairCheck, NeedsDepth) {
  EXPECT_EQ(complaint([](FramePair& pair) { pair.source.depth = {}; }),
            "pair: the source's depth image is empty");
  EXPECT_EQ(complaint([](FramePair& pair) { pair.target.depth = {}; }),
            "pair: the target's depth image is empty");
}

TEST(FramePairCheck, NeedsACameraThatProjects) {
  for (const double wrong : {0.0, -100.0, nan, infinity}) {
    EXPECT_THAT(complaint([&](FramePair& pair) { pair.camera.fx = wrong; }),
                testing::StartsWith("pair: the camera's focal lengths are "));
    EXPECT_THAT(complaint([&](FramePair& pair) { pair.camera.fy = wrong; }),
                testing::StartsWith("pair: the camera's focal lengths are 100 and "));
  }
  for (const double wrong : {nan, infinity, -infinity}) {
    EXPECT_THAT(complaint([&](FramePair& pair) { pair.camera.cx = wrong; }),
                testing::StartsWith("pair: the camera's principal point is "));
    EXPECT_THAT(complaint([&](FramePair& pair) { pair.camera.cy = wrong; }),
                testing::StartsWith("pair: the camera's principal point is (3.5, "));
  }
}

TEST(FramePairCheck, OfTheSourceLeavesTheTargetOut) {
  const auto without_target = [](FramePair& pair) { pair.target = {}; };
  EXPECT_EQ(complaint(without_target, check_source), "");
  EXPECT_NE(complaint(without_target), "");
  EXPECT_NE(complaint([](FramePair& pair) { pair.source.mask = MaskImage(7, 6); }, check_source), "");
}

}  // namespace
}  // namespace pliant
