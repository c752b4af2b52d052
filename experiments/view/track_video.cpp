#include "experiments/view/track_video.h"

#include <cstdint>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace pliant {

bool TrackVideo::show(const TrackedFrame& tracked) {
  if ((tracked.record.number - 1) % every_ != 0) return true;
  const cv::Size size = picture_->size();
  if (!film_) film_ = std::make_unique<FilmFile>(file_, size.width, size.height);
  ColorImage picture = picture_->draw(tracked, rate_.at(tracked.record.number));
  cv::Mat pixels(size, CV_8UC3, picture.data());
  cv::cvtColor(pixels, pixels, cv::COLOR_RGB2BGR);
  std::vector<std::uint8_t> jpeg;
  cv::imencode(".jpg", pixels, jpeg, {cv::IMWRITE_JPEG_QUALITY, 90});
  film_->append(jpeg);
  return true;
}

}  // namespace pliant
