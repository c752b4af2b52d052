#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace pliant {

const cv::Scalar ink(40, 34, 30);
const cv::Scalar quiet_ink(105, 96, 90);

void draw_text(cv::Mat& canvas, const std::string& text, cv::Point baseline, double size, int stroke,
               const cv::Scalar& color);

/// What the pictures of a report have in common: a title and a line below it, the picture, and room for a
/// legend at its right.
class Sheet {
 public:
  /// Narrower pictures are enlarged, by a whole number, to at least `least_width`.
  Sheet(const cv::Mat& picture, const std::string& title, const std::string& subtitle, int least_width = 480);

  cv::Mat& canvas() { return canvas_; }
  /// The enlarged picture, part of the canvas.
  cv::Mat picture() { return canvas_(picture_); }
  int enlargement() const { return enlargement_; }
  /// As high as the picture.
  cv::Rect legend() const { return legend_; }
  std::vector<std::uint8_t> png() const;

 private:
  int enlargement_;
  cv::Rect picture_;
  cv::Rect legend_;
  cv::Mat canvas_;
};

}  // namespace pliant
