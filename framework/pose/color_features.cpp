#include "framework/pose/color_features.h"

#include <algorithm>
#include <cmath>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "framework/geometry/has_point.h"

namespace pliant {
namespace {

cv::Mat to_grey(const ColorImage& color) {
  const cv::Mat rgb(color.height(), color.width(), CV_8UC3, const_cast<Rgb*>(color.data()));
  cv::Mat grey;
  cv::cvtColor(rgb, grey, cv::COLOR_RGB2GRAY);
  return grey;
}

/// Where features may lie: on the object and with depth to back-project them.
cv::Mat usable_pixels(const Frame& frame) {
  cv::Mat usable(frame.depth.height(), frame.depth.width(), CV_8U);
  for (int v = 0; v < usable.rows; ++v) {
    for (int u = 0; u < usable.cols; ++u) {
      usable.at<std::uint8_t>(v, u) = has_point(frame, u, v) ? 255 : 0;
    }
  }
  return usable;
}

/// The usable part of an image with what descriptors reach beyond it: detection takes as long as the image is
/// large. It begins where the coarse levels of the scale space have their samples.
cv::Rect part_to_search(const cv::Mat& usable) {
  constexpr int margin = 32;
  constexpr int coarsest_sample = 16;
  const cv::Rect used = cv::boundingRect(usable);
  const int left = std::max(0, used.x - margin) / coarsest_sample * coarsest_sample;
  const int top = std::max(0, used.y - margin) / coarsest_sample * coarsest_sample;
  return {left, top, std::min(usable.cols, used.br().x + margin) - left,
          std::min(usable.rows, used.br().y + margin) - top};
}

const cv::Point2d centre(0.5, 0.5);  // of a pixel, from its corner

cv::Mat scaled(const cv::Mat& image, double scale, int interpolation) {
  cv::Mat result;
  cv::resize(image, result, {}, scale, scale, interpolation);
  return result;
}

/// The depth of the plane through the depths around a place in the image, without what lies in front or
/// behind: a single one carries all its noise, which is far greater than what a feature is astray in the
/// image.
double depth_around(const Frame& frame, const cv::Mat& usable, const cv::Point2d& at) {
  constexpr int radius = 2;            // pixels
  constexpr double same_surface = 30;  // mm
  const cv::Point middle(cvRound(at.x), cvRound(at.y));
  const auto depth = [&](const cv::Point& pixel) -> double { return frame.depth(pixel.x, pixel.y); };
  const auto is_near = [&](const cv::Point& pixel) {
    return pixel.inside({{0, 0}, usable.size()}) && usable.at<std::uint8_t>(pixel) != 0 &&
           std::abs(depth(pixel) - depth(middle)) < same_surface;
  };
  double sum = 0;
  int count = 0;
  cv::Point2d rise(0, 0);
  cv::Point2d run(0, 0);
  for (int dv = -radius; dv <= radius; ++dv) {
    for (int du = -radius; du <= radius; ++du) {
      const cv::Point step(du, dv);
      // Only with the pixel across, so that mean and slopes do not depend on each other.
      if (!is_near(middle + step) || !is_near(middle - step)) continue;
      sum += depth(middle + step);
      rise += cv::Point2d(step) * depth(middle + step);
      run += cv::Point2d(du * du, dv * dv);
      ++count;
    }
  }
  const cv::Point2d beside = at - cv::Point2d(middle);
  double result = sum / count;
  if (run.x > 0) result += beside.x * rise.x / run.x;
  if (run.y > 0) result += beside.y * rise.y / run.y;
  return result;
}

}  // namespace

ColorFeatures find_color_features(const Frame& frame, const Camera& camera, double scale) {
  // A quarter of OpenCV's contrast threshold: cloth has little contrast, and the ratio test sorts out.
  const auto sift = cv::SIFT::create(0, 3, 0.01);
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;
  const cv::Mat usable = usable_pixels(frame);
  const cv::Rect part = part_to_search(usable);
  sift->detectAndCompute(scaled(to_grey(frame.color)(part), scale, cv::INTER_AREA),
                         scaled(usable(part), scale, cv::INTER_NEAREST), keypoints, descriptors);
  ColorFeatures features;
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    const cv::Point2d at = (cv::Point2d(keypoints[i].pt) + centre) / scale - centre + cv::Point2d(part.tl());
    const cv::Point pixel(cvRound(at.x), cvRound(at.y));
    if (!pixel.inside({{0, 0}, usable.size()}) || usable.at<std::uint8_t>(pixel) == 0) continue;
    features.points.push_back(camera.unproject(at.x, at.y, depth_around(frame, usable, at)));
    features.radii.push_back(keypoints[i].size / 2 / scale * features.points.back().z() / camera.fx);
    const auto* descriptor = descriptors.ptr<float>(static_cast<int>(i));
    features.descriptors.insert(features.descriptors.end(), descriptor, descriptor + descriptors.cols);
  }
  return features;
}

double scale_of_features(const Frame& frame, double least, double fewest_pixels) {
  const int pixels = cv::countNonZero(usable_pixels(frame));
  return pixels > 0 ? std::clamp(std::sqrt(fewest_pixels / pixels), least, 1.0) : least;
}

}  // namespace pliant
