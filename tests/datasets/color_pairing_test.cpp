#include "experiments/datasets/color_pairing.h"

#include <gtest/gtest.h>

namespace pliant {
namespace {

Frame depth_at(double time) { return {DepthImage(2, 1, 500), {}, {}, time}; }
ColorImage red(int value) { return {2, 1, Rgb{static_cast<std::uint8_t>(value), 0, 0}}; }

/// The red of the next frame's colour; -1 without colour, -2 without frame.
int next_red(ColorPairing& pairing) {
  const auto frame = pairing.next();
  if (!frame) return -2;
  return frame->color.empty() ? -1 : frame->color(0, 0).r;
}

TEST(ColorPairing, WaitsForTheColourAndTakesTheFirstWithin20Milliseconds) {
  ColorPairing pairing;
  pairing.add_color(red(1), 0.979);
  pairing.add_depth(depth_at(1));
  EXPECT_EQ(next_red(pairing), -2) << "it may come yet";
  pairing.add_color(red(2), 0.981);
  pairing.add_color(red(3), 1.001);
  EXPECT_EQ(next_red(pairing), 2);
  EXPECT_EQ(next_red(pairing), -2);
  pairing.add_depth(depth_at(1.0205));
  EXPECT_EQ(next_red(pairing), 3) << "each colour is used once";
}

TEST(ColorPairing, DepthWithoutColourGoesAlone) {
  ColorPairing pairing;
  pairing.add_depth(depth_at(1));
  pairing.add_color(red(1), 1.033);
  EXPECT_EQ(next_red(pairing), -1);
  pairing.add_depth(depth_at(1.033));
  EXPECT_EQ(next_red(pairing), 1) << "what came too late for one is kept for the next";
}

TEST(ColorPairing, DoesNotWaitForEver) {
  ColorPairing pairing;
  pairing.add_depth(depth_at(1));
  pairing.add_depth(depth_at(1.19));
  EXPECT_EQ(next_red(pairing), -2);
  pairing.add_depth(depth_at(1.21));
  EXPECT_EQ(next_red(pairing), -1);
  EXPECT_EQ(next_red(pairing), -2);
  pairing.end_color();
  EXPECT_EQ(next_red(pairing), -1);
  EXPECT_EQ(next_red(pairing), -1);
  EXPECT_EQ(next_red(pairing), -2);
}

}  // namespace
}  // namespace pliant
