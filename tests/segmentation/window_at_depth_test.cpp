#include "framework/segmentation/window_at_depth.h"

#include <gtest/gtest.h>

#include "tests/segmentation/rendered_face.h"

namespace pliant {
namespace {

using test::difference;
using test::rendered_face;
using test::RenderedFace;
using test::true_window;

constexpr double band = 150;  // mm
constexpr int speck = 100;    // pixels
constexpr int most = 3;       // pixels that a border may be off

// One whose borders all cut the face, and one that reaches beyond both ears.
const PixelWindow cheek{370, 290, 70, 60};
const PixelWindow wide{290, 270, 230, 120};

TEST(WindowAtDepth, ShowsWhatTheColourWindowShows) {
  const RenderedFace face = rendered_face();
  for (const PixelWindow& window : {cheek, wide}) {
    const auto found = window_at_depth(window, face.frame, face.rig, band, speck);
    ASSERT_TRUE(found);
    EXPECT_LE(difference(*found, true_window(window, face)), most);
    EXPECT_GT(difference(*found, window), 20) << "the cameras stand apart";
  }
}

TEST(WindowAtDepth, BearsTheNoiseOfADepthCamera) {
  const RenderedFace face =
      rendered_face(", sensor: {axial: 1, quantisation: 1, lateral: 1, grazing: 80, shadow: 75}");
  const auto found = window_at_depth(cheek, face.frame, face.rig, band, speck);
  ASSERT_TRUE(found);
  EXPECT_LE(difference(*found, true_window(cheek, face)), most);
}

// Beside the head the depth camera sees parts of the wall that the head hides from the colour camera.
TEST(WindowAtDepth, LeavesOutWhatIsBehind) {
  RenderedFace face = rendered_face();
  const PixelWindow expected = window_at_depth(wide, face.frame, face.rig, band, speck).value();
  for (float* depth = face.frame.depth.data(); depth != face.frame.depth.data() + face.frame.depth.size();
       ++depth)
    if (*depth == 0) *depth = 1200;
  EXPECT_EQ(window_at_depth(wide, face.frame, face.rig, band, speck), expected);
  EXPECT_GT(difference(window_at_depth(wide, face.frame, face.rig, 1000, speck).value(), expected), 20)
      << "a band that reaches the wall";
}

TEST(WindowAtDepth, WithoutACameraOfItsOwnIsTheWindow) {
  const Rig rig{{500, 500, 79.5, 59.5, 160, 120}};
  Frame frame{DepthImage(160, 120, 800), {}, {}};
  const PixelWindow window{31, 22, 40, 51};
  EXPECT_EQ(window_at_depth(window, frame, rig, band, speck), window);
  frame.mask = MaskImage(160, 120);
  EXPECT_FALSE(window_at_depth(window, frame, rig, band, speck)) << "no depth on the mask";
}

}  // namespace
}  // namespace pliant
