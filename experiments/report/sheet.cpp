#include "experiments/report/sheet.h"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace pliant {
namespace {

constexpr int margin = 20;
constexpr int header = 72;
constexpr int legend_width = 100;
const cv::Scalar paper(255, 255, 255);

void blend(cv::Vec3b& pixel, const cv::Scalar& color, double part) {
  for (int i = 0; i < 3; ++i)
    pixel[i] = cv::saturate_cast<std::uint8_t>(pixel[i] + part * (color[i] - pixel[i]));
}

}  // namespace

/// OpenCV's stroke fonts are ragged at small sizes, so text is drawn large and averaged down.
void draw_text(cv::Mat& canvas, const std::string& text, cv::Point baseline, double size, int stroke,
               const cv::Scalar& color) {
  constexpr int enlarged = 4;
  int below = 0;
  const cv::Size extent = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, size, 2, &below);
  below += 4;
  const cv::Rect whole(baseline.x, baseline.y - extent.height - 4, extent.width + 8,
                       extent.height + 4 + below);
  const cv::Rect place = whole & cv::Rect({0, 0}, canvas.size());
  cv::Mat coverage(place.height * enlarged, place.width * enlarged, CV_8U, cv::Scalar(0));
  cv::putText(coverage, text, (baseline - place.tl()) * enlarged, cv::FONT_HERSHEY_SIMPLEX, size * enlarged,
              255, stroke, cv::LINE_AA);
  cv::resize(coverage, coverage, place.size(), 0, 0, cv::INTER_AREA);
  for (int v = 0; v < place.height; ++v) {
    for (int u = 0; u < place.width; ++u) {
      blend(canvas.at<cv::Vec3b>(place.y + v, place.x + u), color, coverage.at<std::uint8_t>(v, u) / 255.0);
    }
  }
}

Sheet::Sheet(const cv::Mat& picture, const std::string& title, const std::string& subtitle, int least_width)
    : enlargement_(std::max(1, (least_width + picture.cols - 1) / picture.cols)),
      picture_(margin, header, picture.cols * enlargement_, picture.rows * enlargement_),
      legend_(picture_.br().x + margin, header, legend_width, picture_.height),
      canvas_(picture_.br().y + margin, legend_.br().x, CV_8UC3, paper) {
  cv::resize(picture, canvas_(picture_), picture_.size(), 0, 0, cv::INTER_NEAREST);
  draw_text(canvas_, title, {margin, 31}, 0.65, 6, ink);
  draw_text(canvas_, subtitle, {margin, 56}, 0.48, 4, quiet_ink);
}

std::vector<std::uint8_t> Sheet::png() const {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", canvas_, bytes);
  return bytes;
}

}  // namespace pliant
