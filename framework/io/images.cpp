#include "framework/io/images.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "framework/core/error.h"
#include "framework/io/file.h"
#include "framework/io/image_container.h"

namespace pliant {
namespace {

using Bytes = std::vector<std::uint8_t>;

cv::Mat decode(const Bytes& bytes, int flags, const std::string& path) {
  cv::Mat image;
  try {
    image = cv::imdecode(bytes, flags);
  } catch (const cv::Exception& error) {
    throw DataError(fmt::format("{}: cannot be decoded: {}", path, error.err));
  }
  if (image.empty()) throw DataError(fmt::format("{}: damaged image data", path));
  return image;
}

void write_png(const std::string& path, const cv::Mat& image) {
  if (image.empty()) throw DataError(fmt::format("{}: an empty image cannot be written", path));
  Bytes bytes;
  cv::imencode(".png", image, bytes);
  write_file(path, bytes);
}

/// The image of `SurfaceMap` whose pixels are those of a one- or three-channel matrix of `Pixel`.
template <class SurfaceMap, class Pixel, class Convert>
Image<SurfaceMap> to_image(const cv::Mat& matrix, Convert convert) {
  Image<SurfaceMap> image(matrix.cols, matrix.rows);
  for (int v = 0; v < matrix.rows; ++v) {
    const auto* row = matrix.ptr<Pixel>(v);
    for (int u = 0; u < matrix.cols; ++u) image(u, v) = convert(row[u]);
  }
  return image;
}

template <class Pixel, class Source, class Convert>
cv::Mat to_matrix(const Image<Source>& image, Convert convert) {
  cv::Mat matrix(image.height(), image.width(), cv::traits::Type<Pixel>::value);
  for (int v = 0; v < image.height(); ++v) {
    auto* row = matrix.ptr<Pixel>(v);
    for (int u = 0; u < image.width(); ++u) row[u] = convert(image(u, v));
  }
  return matrix;
}

/// 1 where any of grey or of blue, green, red is not zero, and alpha, where there is any, neither.
template <class Value>
MaskImage to_mask(const cv::Mat& image) {
  const int channels = image.channels();
  const int colors = channels == 4 ? 3 : channels;  // the decoder makes grey with alpha into four
  MaskImage mask(image.cols, image.rows);
  for (int v = 0; v < image.rows; ++v) {
    const auto* row = image.ptr<Value>(v);
    for (int u = 0; u < image.cols; ++u, row += channels) {
      const bool is_coloured = std::any_of(row, row + colors, [](Value value) { return value != 0; });
      mask(u, v) = is_coloured && (channels < 4 || row[3] != 0) ? 1 : 0;
    }
  }
  return mask;
}

std::uint16_t to_millimetres(float depth, const std::string& path) {
  if (!std::isfinite(depth) || depth <= 0) return 0;
  const float rounded = std::round(depth);
  if (rounded > float{std::numeric_limits<std::uint16_t>::max()}) {
    throw DataError(fmt::format("{}: a depth of {} mm does not fit into 16 bits", path, depth));
  }
  return static_cast<std::uint16_t>(rounded);
}

}  // namespace

DepthImage read_depth(const std::string& path) {
  const PngFile file = check_png(read_file(path), path);
  if (!file.header.is_grey() || file.header.bit_depth != 16) {
    throw DataError(fmt::format("{}: {} PNG, expected a 16-bit single-channel PNG of depth", path,
                                file.header.describe()));
  }
  return to_image<float, std::uint16_t>(decode(file.bytes, cv::IMREAD_UNCHANGED, path),
                                        [](std::uint16_t depth) { return static_cast<float>(depth); });
}

ColorImage read_color(const std::string& path) {
  Bytes bytes = read_file(path);
  if (is_png(bytes)) {
    bytes = check_png(bytes, path).bytes;
  } else if (is_jpeg(bytes)) {
    check_jpeg(bytes, path);
  } else {
    throw DataError(fmt::format("{}: neither a PNG nor a JPEG file", path));
  }
  return to_image<Rgb, cv::Vec3b>(decode(bytes, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION, path),
                                  [](const cv::Vec3b& bgr) {
                                    return Rgb{bgr[2], bgr[1], bgr[0]};
                                  });
}

MaskImage read_mask(const std::string& path) {
  const PngFile file = check_png(read_file(path), path);
  const cv::Mat image = decode(file.bytes, cv::IMREAD_UNCHANGED, path);
  return image.depth() == CV_16U ? to_mask<std::uint16_t>(image) : to_mask<std::uint8_t>(image);
}

void write_depth(const std::string& path, const DepthImage& depth) {
  write_png(path, to_matrix<std::uint16_t>(depth, [&](float value) { return to_millimetres(value, path); }));
}

void write_color(const std::string& path, const ColorImage& color) {
  write_png(path, to_matrix<cv::Vec3b>(color, [](const Rgb& rgb) { return cv::Vec3b(rgb.b, rgb.g, rgb.r); }));
}

void write_mask(const std::string& path, const MaskImage& mask) {
  write_png(path, to_matrix<std::uint8_t>(
                      mask, [](std::uint8_t value) -> std::uint8_t { return value != 0 ? 255 : 0; }));
}

}  // namespace pliant
