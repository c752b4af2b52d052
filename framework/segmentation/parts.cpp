#include "framework/segmentation/parts.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace pliant {
namespace {

/// From the first corner to the one behind the last pixel.
PixelWindow between(int left, int top, int right, int bottom) {
  return {left, top, right - left, bottom - top};
}

PixelWindow around(const PixelWindow& a, const PixelWindow& b) {
  return between(std::min(a.left, b.left), std::min(a.top, b.top),
                 std::max(a.left + a.width, b.left + b.width), std::max(a.top + a.height, b.top + b.height));
}

}  // namespace

Parameter speck_parameter() {
  return integer("speck", 100)
      .unit("pixel")
      .range(1, 1e6)
      .doc("connected parts with fewer pixels than this are noise");
}

Parameter margin_parameter() {
  return integer("margin", 0).unit("pixel").range(0, 1000).doc("added to the window on each side");
}

std::optional<PixelWindow> window_of_parts(const MaskImage& shown, int speck) {
  MaskImage pixels = shown;  // cv::Mat takes no constant data
  const cv::Mat image(pixels.height(), pixels.width(), CV_8U, pixels.data());
  cv::Mat labels, measures, centroids;
  constexpr int by_sides = 4;
  const int count = cv::connectedComponentsWithStats(image, labels, measures, centroids, by_sides);
  std::optional<PixelWindow> window;
  for (int part = 1; part < count; ++part) {  // 0 is the background
    const int* measure = measures.ptr<int>(part);
    if (measure[cv::CC_STAT_AREA] < speck) continue;
    const PixelWindow box{measure[cv::CC_STAT_LEFT], measure[cv::CC_STAT_TOP], measure[cv::CC_STAT_WIDTH],
                          measure[cv::CC_STAT_HEIGHT]};
    window = window ? around(*window, box) : box;
  }
  return window;
}

PixelWindow widened(const PixelWindow& window, int margin, const Camera& camera) {
  return between(std::max(window.left - margin, 0), std::max(window.top - margin, 0),
                 std::min(window.left + window.width + margin, camera.width),
                 std::min(window.top + window.height + margin, camera.height));
}

}  // namespace pliant
