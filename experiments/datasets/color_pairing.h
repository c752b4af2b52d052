#pragma once

#include <deque>
#include <optional>

#include "framework/geometry/frame.h"

namespace pliant {

/// Puts the images of two sensors, each in the order of its times, together to frames. A depth image goes
/// with the first colour that is at most 20 ms earlier or later; each colour is used once, and what none goes
/// with is dropped. A depth image without colour for 200 ms goes alone.
class ColorPairing {
 public:
  /// A frame without colour.
  void add_depth(Frame frame) { depth_.push_back(std::move(frame)); }
  void add_color(ColorImage image, double time);
  /// No further colour comes.
  void end_color() { has_ended_ = true; }
  /// The next frame, once it is known what goes with it.
  std::optional<Frame> next();

 private:
  struct Color {
    ColorImage image;
    double time = 0;  // s
  };

  std::deque<Frame> depth_;
  std::deque<Color> color_;
  bool has_ended_ = false;
};

}  // namespace pliant
