#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "experiments/report/heat_map.h"
#include "experiments/view/panel.h"
#include "experiments/view/tracked_frame.h"
#include "framework/geometry/image.h"
#include "framework/geometry/rig.h"

namespace pliant {

/// What a frame is told in: its number, what became of it, its error.
std::string describe(const FrameRecord& record);

/// A scale for errors (mm; NaN: none) that 19 of 20 of these lie within.
ColorScale error_scale(std::vector<float> distances);

/// One picture of each frame that is tracked: colour (the frame's surface where there is none), depth, the
/// model as the camera sees it and, point by point, how far the frame's surface is from it; below, a line
/// about the frame. The colours of depths are fitted to the first frame with depth, those of errors to the
/// first one that is tracked, and stay, so that pictures can be compared.
class FramePicture {
 public:
  /// Each of the four panels is so many pixels wide.
  FramePicture(const Rig& rig, int panel_width);

  cv::Size size() const { return {canvas_.width(), canvas_.height()}; }
  /// Valid until the next call.
  const ColorImage& draw(const TrackedFrame& tracked, double frames_per_second);

 private:
  enum Place { color_panel, depth_panel, model_panel, error_panel };

  cv::Mat canvas();
  cv::Mat panel(Place place);
  void draw_header(Place place, const std::string& caption, const ColorScale* scale);
  void draw_color(const TrackedFrame& tracked);
  void draw_depth(const DepthImage& depth);
  void draw_model(const TrackedFrame& tracked);
  void draw_error(const TrackedFrame& tracked);
  void draw_line(const FrameRecord& record, double frames_per_second);

  cv::Size panel_;
  PanelPixels depth_pixels_;
  PanelPixels color_pixels_;
  ColorImage canvas_;
  std::string color_caption_;
  ColorScale depth_scale_{ColorScale::Map::depth, 0, 0};
  ColorScale error_scale_{ColorScale::Map::error, 0, 5};
  bool errors_are_known_ = false;
};

}  // namespace pliant
