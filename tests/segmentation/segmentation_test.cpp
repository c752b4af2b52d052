#include "framework/imaging/segmentation.h"

#include <gmock/gmock.h>

#include <stdexcept>

#include "framework/imaging/depth_map.h"
#include "framework/io/images.h"
#include "tests/io/test_files.h"
#include "tests/segmentation/rendered_face.h"

namespace pliant {
namespace {

using test::data_error_of;
using test::segmentation_of;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr int width = 64;
constexpr int height = 48;
const Rig rig{{60, 60, 31.5, 23.5, width, height}};

/// Depth in a window, and nothing else.
Frame frame_of(const PixelWindow& window) {
  Frame frame{DepthImage(width, height), {}, {}};
  for (int v = window.top; v < window.top + window.height; ++v)
    for (int u = window.left; u < window.left + window.width; ++u) frame.depth(u, v) = 700;
  return frame;
}

TEST(Segmentation, NoneTakesTheWholeImage) {
  const auto region = segmentation_of("{type: none}")->find(frame_of({}), rig);
  ASSERT_TRUE(region);
  EXPECT_EQ(region->window, (PixelWindow{0, 0, width, height}));
  EXPECT_TRUE(region->mask.empty());
}

TEST(BoundingBox, IsThatOfTheDepthThatIsLeft) {
  const PixelWindow object{20, 10, 17, 23};
  const auto find = [&](const std::string& keys, const Frame& frame) {
    return segmentation_of("{type: bounding_box" + keys + "}")->find(frame, rig);
  };
  EXPECT_EQ(find("", frame_of(object))->window, object);
  EXPECT_EQ(find(", margin: 3", frame_of(object))->window, (PixelWindow{17, 7, 23, 29}));
  EXPECT_EQ(find(", margin: 30", frame_of(object))->window, (PixelWindow{0, 0, width, height}))
      << "no further than the image";
  EXPECT_FALSE(find("", frame_of({}))) << "empty depth";
  EXPECT_FALSE(find("", frame_of({5, 5, 11, 9}))) << "99 pixels are a speck";
  EXPECT_TRUE(find("", frame_of({5, 5, 10, 10})));
}

TEST(BoundingBox, LeavesSpecksOut) {
  const PixelWindow object{20, 10, 17, 23};
  Frame frame = frame_of(object);
  for (int v = 0; v < 4; ++v)
    for (int u = 0; u < 20; ++u) frame.depth(u, v) = 650;
  for (int u = 1; u < width; u += 2)
    frame.depth(u, 40 + u / 2 % 2) = 900;  // a row that only touches at corners
  const auto found = segmentation_of("{type: bounding_box}")->find(frame, rig);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->window, object);
  const auto all = segmentation_of("{type: bounding_box, speck: 1}")->find(frame, rig);
  EXPECT_EQ(all->window, (PixelWindow{0, 0, width, 42}));
}

TEST(BoundingBox, HeedsTheMask) {
  Frame frame = frame_of({0, 0, width, height});
  frame.mask = MaskImage(width, height);
  for (int v = 4; v < 24; ++v)
    for (int u = 30; u < 40; ++u) frame.mask(u, v) = 1;
  EXPECT_EQ(segmentation_of("{type: bounding_box}")->find(frame, rig)->window, (PixelWindow{30, 4, 10, 20}));
}

class MaskSegmentation : public test::TestFiles {
 protected:
  MaskSegmentation() {
    MaskImage mask(width, height);
    for (int v = 10; v < 20; ++v)
      for (int u = 5; u < 40; ++u) mask(u, v) = (u + v) % 3 == 0 ? 0 : 1;
    write_mask(file("mask.png"), mask);
  }
  std::string section(const std::string& name) const { return "{type: mask, file: " + file(name) + "}"; }
};

TEST_F(MaskSegmentation, CutsWhatIsNotOnIt) {
  Frame frame = frame_of({0, 0, width, 15});
  const auto region = segmentation_of(section("mask.png"))->find(frame, rig);
  ASSERT_TRUE(region);
  EXPECT_EQ(region->window, (PixelWindow{5, 10, 35, 10}));
  cut_to(*region, frame);
  const DepthImage left = to_image(DepthMap(frame), rig.depth);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const bool is_on = v >= 10 && v < 15 && u >= 5 && u < 40 && (u + v) % 3 != 0;
      ASSERT_EQ(left(u, v), is_on ? 700 : 0) << u << " " << v;
    }
  EXPECT_FALSE(segmentation_of(section("mask.png"))->find(frame_of({0, 30, width, 10}), rig))
      << "no depth on it";
}

TEST_F(MaskSegmentation, ThatCannotBeUsedIsAnError) {
  write_mask(file("black.png"), MaskImage(width, height));
  EXPECT_THAT(data_error_of([&] { segmentation_of(section("black.png")); }),
              AllOf(HasSubstr("black.png"), HasSubstr("black all over")));
  write_mask(file("small.png"), MaskImage(width, 5, 1));
  const auto small = segmentation_of(section("small.png"));
  EXPECT_THAT(data_error_of([&] { small->find(frame_of({}), rig); }),
              AllOf(HasSubstr("small.png"), HasSubstr("64 x 5"), HasSubstr("64 x 48")));
}

TEST(CutTo, LeavesOfTheFramesMaskWhatIsInTheRegion) {
  Frame frame = frame_of({0, 0, width, height});
  frame.mask = MaskImage(width, height, 1);
  frame.mask(11, 12) = 0;
  cut_to({{10, 12, 3, 2}}, frame);
  int on = 0;
  for (const std::uint8_t value : frame.mask.pixels()) on += value;
  EXPECT_EQ(on, 5);
  EXPECT_EQ(frame.mask(10, 12), 1);
  EXPECT_EQ(frame.mask(11, 12), 0);
  EXPECT_EQ(frame.depth(0, 0), 700) << "depth stays";
  EXPECT_EQ(DepthMap(frame).window, (PixelWindow{10, 12, 3, 2}));
}

TEST(CutTo, RefusesARegionOfAnotherImage) {
  Frame frame = frame_of({});
  EXPECT_THROW(cut_to({{0, 0, width + 1, height}}, frame), std::invalid_argument);
  EXPECT_THROW(cut_to({{-1, 0, 4, 4}}, frame), std::invalid_argument);
  EXPECT_THROW(cut_to({{0, 0, 4, 4}, MaskImage(4, 4, 1)}, frame), std::invalid_argument);
}

}  // namespace
}  // namespace pliant
