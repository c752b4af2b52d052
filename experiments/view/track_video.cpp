#include "experiments/view/track_video.h"

#include <opencv2/imgproc.hpp>

#include "framework/core/error.h"

namespace pliant {
namespace {

constexpr int panel_width = 320;
constexpr double pictures_a_second = 30;

}  // namespace

void TrackVideo::begin(const Rig& rig) {
  picture_.emplace(rig, panel_width);
  writer_.open(file_.string(), cv::CAP_OPENCV_MJPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
               pictures_a_second, picture_->size());
  if (!writer_.isOpened()) throw DataError(file_.string() + ": the film cannot be written");
}

bool TrackVideo::show(const TrackedFrame& tracked) {
  if ((tracked.record.number - 1) % every_ != 0) return true;
  ColorImage picture = picture_->draw(tracked, rate_.at(tracked.record.number));
  cv::Mat pixels(picture_->size(), CV_8UC3, picture.data());
  cv::cvtColor(pixels, pixels, cv::COLOR_RGB2BGR);
  writer_.write(pixels);
  return true;
}

}  // namespace pliant
