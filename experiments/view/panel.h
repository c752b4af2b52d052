#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "experiments/report/heat_map.h"
#include "framework/geometry/image.h"
#include "framework/geometry/pixel_window.h"
#include "framework/geometry/surface_map.h"

namespace pliant {

/// Which pixels of an image a panel shows: a part of it, as large as the panel takes it whole, in the middle.
class PanelPixels {
 public:
  static constexpr int outside = -1;

  PanelPixels(cv::Size panel, const PixelWindow& part);

  /// The column of the image that a column of the panel shows, and likewise for rows; or `outside`.
  int column(int x) const { return columns_[static_cast<std::size_t>(x)]; }
  int row(int y) const { return rows_[static_cast<std::size_t>(y)]; }

 private:
  std::vector<int> columns_;
  std::vector<int> rows_;
};

// Each paints all of a panel, whose pixels are Rgb; what shows nothing has `no_color`.

void paint_color(cv::Mat panel, const PanelPixels& pixels, const ColorImage& color);
void paint_depth(cv::Mat panel, const PanelPixels& pixels, const DepthImage& depth, const ColorScale& scale);
/// A surface by the light of a lamp at its camera.
void paint_surface(cv::Mat panel, const PanelPixels& pixels, const SurfaceMap& surface);
/// `distances`: mm, over a window of the image; NaN: none.
void paint_distances(cv::Mat panel, const PanelPixels& pixels, const Image<float>& distances,
                     const PixelWindow& window, const ColorScale& scale);

/// The colours of a scale and what they stand for, in 10 rows of `scale_width` pixels from a corner on.
void draw_scale(cv::Mat& canvas, cv::Point corner, const ColorScale& scale);
inline constexpr int scale_width = 200;

}  // namespace pliant
