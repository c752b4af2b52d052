#include "experiments/view/panel.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "experiments/report/sheet.h"

namespace pliant {
namespace {

constexpr float dark = 0.2F;  // of the light, on what is seen edge on
constexpr Rgb chalk{226, 221, 208};

/// The pixels of an image, from `first` on, that `length` pixels of a panel show when `scale` of those are
/// one of these.
std::vector<int> shown(int length, int first, int count, double scale) {
  std::vector<int> pixels;
  const double margin = (length - count * scale) / 2;
  for (int x = 0; x < length; ++x) {
    const int pixel = static_cast<int>(std::floor((x + 0.5 - margin) / scale));
    pixels.push_back(pixel >= 0 && pixel < count ? first + pixel : PanelPixels::outside);
  }
  return pixels;
}

/// `color_at(u, v)`: of a pixel of the image.
template <class ColorAt>
void paint(cv::Mat& panel, const PanelPixels& pixels, ColorAt color_at) {
  for (int y = 0; y < panel.rows; ++y) {
    const int v = pixels.row(y);
    Rgb* row = panel.ptr<Rgb>(y);
    for (int x = 0; x < panel.cols; ++x) {
      const int u = pixels.column(x);
      row[x] = u == PanelPixels::outside || v == PanelPixels::outside ? no_color : color_at(u, v);
    }
  }
}

}  // namespace

PanelPixels::PanelPixels(cv::Size panel, const PixelWindow& part) {
  const double scale = std::min(static_cast<double>(panel.width) / std::max(part.width, 1),
                                static_cast<double>(panel.height) / std::max(part.height, 1));
  columns_ = shown(panel.width, part.left, part.width, scale);
  rows_ = shown(panel.height, part.top, part.height, scale);
}

void paint_color(cv::Mat panel, const PanelPixels& pixels, const ColorImage& color) {
  paint(panel, pixels, [&](int u, int v) { return color(u, v); });
}

void paint_depth(cv::Mat panel, const PanelPixels& pixels, const DepthImage& depth, const ColorScale& scale) {
  const auto colors = colors_of(scale.map);
  paint(panel, pixels, [&](int u, int v) {
    const float z = depth(u, v);
    return is_depth(z) ? colors[color_index(scale, z)] : no_color;
  });
}

void paint_surface(cv::Mat panel, const PanelPixels& pixels, const SurfaceMap& surface) {
  const float* points = surface.points().host().data();
  const float* normals = surface.normals().host().data();
  using Vector = Eigen::Map<const Eigen::Vector3f>;
  paint(panel, pixels, [&](int u, int v) {
    if (!surface.window.contains(u, v)) return no_color;
    const std::size_t at = 3 * surface.window.offset(u, v);
    const Vector point(points + at);
    if (!(point.z() > 0)) return no_color;
    const float light = dark + (1 - dark) * std::abs(Vector(normals + at).dot(point)) / point.norm();
    const auto lit = [&](std::uint8_t full) {
      return static_cast<std::uint8_t>(std::min(light, 1.0F) * static_cast<float>(full));
    };
    return Rgb{lit(chalk.r), lit(chalk.g), lit(chalk.b)};
  });
}

void paint_distances(cv::Mat panel, const PanelPixels& pixels, const Image<float>& distances,
                     const PixelWindow& window, const ColorScale& scale) {
  const auto colors = colors_of(scale.map);
  paint(panel, pixels, [&](int u, int v) {
    if (!window.contains(u, v)) return no_color;
    const float distance = distances.data()[window.offset(u, v)];
    return std::isfinite(distance) ? colors[color_index(scale, distance)] : no_color;
  });
}

void draw_scale(cv::Mat& canvas, cv::Point corner, const ColorScale& scale) {
  constexpr int label = 40;
  constexpr int width = 90;
  constexpr int height = 10;
  const auto colors = colors_of(scale.map);
  for (int x = 0; x < width; ++x) {
    const Rgb color = colors[static_cast<std::size_t>(x * 255 / (width - 1))];
    canvas(cv::Rect(corner.x + label + x, corner.y, 1, height)).setTo(cv::Scalar(color.r, color.g, color.b));
  }
  const int base = corner.y + height;
  draw_text(canvas, fmt::format("{:>6g}", scale.lowest), {corner.x, base}, 0.4, 4, quiet_ink);
  draw_text(canvas, fmt::format("{:g} mm", scale.highest), {corner.x + label + width + 5, base}, 0.4, 4,
            quiet_ink);
}

}  // namespace pliant
