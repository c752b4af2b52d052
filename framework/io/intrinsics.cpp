#include "framework/io/intrinsics.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

#include "framework/core/error.h"
#include "framework/io/file.h"

namespace pliant {
namespace {

/// A number of the file, and the line (from 1) that it stands in.
struct Number {
  double value = 0;
  int line = 0;
};

std::string place(const std::string& path, int line) { return fmt::format("{}:{}", path, line); }

Number parse_number(const std::string& word, const std::string& path, int line) {
  double value = 0;
  const char* end = word.data() + word.size();
  // Independent of the locale, unlike streams and strtod.
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value))
    throw DataError(fmt::format("{}: '{}' is not a number", place(path, line), word.substr(0, 40)));
  return {value, line};
}

std::vector<Number> read_numbers(const std::string& path) {
  const auto bytes = read_file(path);
  std::string text(bytes.begin(), bytes.end());
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.starts_with(byte_order_mark)) text.erase(0, byte_order_mark.size());
  std::istringstream stream(text);
  std::vector<Number> numbers;
  int line_number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++line_number;
    std::istringstream words(line);
    for (std::string word; words >> word;) numbers.push_back(parse_number(word, path, line_number));
  }
  return numbers;
}

void check_pinhole(const std::vector<Number>& k, std::size_t columns, const std::string& path) {
  for (const std::size_t i : {std::size_t{0}, columns + 1}) {
    if (k[i].value <= 0)
      throw DataError(fmt::format("{}: a focal length of {} pixels, expected a positive one",
                                  place(path, k[i].line), k[i].value));
  }
  for (std::size_t i = 0; i < k.size(); ++i) {
    const std::size_t row = i / columns;
    const std::size_t column = i % columns;
    const bool is_free = row < 2 && (column == row || column == 2);
    if (!is_free && k[i].value != (row == column ? 1.0 : 0.0)) {
      throw DataError(fmt::format("{}: {} in row {}, column {}: expected fx 0 cx / 0 fy cy / 0 0 1",
                                  place(path, k[i].line), k[i].value, row + 1, column + 1));
    }
  }
}

bool is_near(double value, double expected, double share) {
  return std::abs(value - expected) <= share * expected;
}

/// Whether the principal point is at the middle of an image of this size, give or take a twentieth.
bool is_middle(const Camera& camera, double width, double height) {
  constexpr double tolerance = 0.05;
  return is_near(camera.cx, width / 2, tolerance) && is_near(camera.cy, height / 2, tolerance);
}

/// Another size of images, whose middle the principal point is.
struct OtherSize {
  std::string size;
  bool is_sure = false;  ///< in both directions clearly larger or smaller
};

/// One that is usual, or has the proportions of the camera's images; none where their own size may be right.
std::optional<OtherSize> other_size(const Camera& camera) {
  constexpr std::array<std::array<int, 2>, 14> usual{{{320, 240},
                                                      {424, 240},
                                                      {512, 424},
                                                      {640, 360},
                                                      {640, 480},
                                                      {640, 576},
                                                      {848, 480},
                                                      {960, 540},
                                                      {1024, 1024},
                                                      {1280, 720},
                                                      {1280, 960},
                                                      {1280, 1024},
                                                      {1920, 1080},
                                                      {3840, 2160}}};
  constexpr double same_size = 1.3;
  constexpr double same_proportions = 1.15;
  const double across = 2 * camera.cx / camera.width;
  const double down = 2 * camera.cy / camera.height;
  const auto differs = [](double ratio, double limit) { return ratio > limit || ratio < 1 / limit; };
  if (across <= 0 || down <= 0 || !(differs(across, same_size) || differs(down, same_size)))
    return std::nullopt;
  const bool differs_twice = differs(across, same_size) && differs(down, same_size);
  for (const auto& [width, height] : usual)
    if (is_middle(camera, width, height))
      return OtherSize{fmt::format("{}x{}", width, height), differs_twice};
  if (!differs_twice || differs(across / down, same_proportions)) return std::nullopt;
  return OtherSize{fmt::format("about {:.0f}x{:.0f}", 2 * camera.cx + 1, 2 * camera.cy + 1), true};
}

/// What makes a camera impossible for images of its size, in words; empty where nothing does.
std::string impossible(const Camera& camera) {
  constexpr double widest = 0.05;    // focal length over width: a view of 169 degrees
  constexpr double narrowest = 100;  // half a degree
  constexpr double margin = 0.25;    // of the size, beside the image
  const auto [fx, fy, cx, cy, width, height] = camera;
  const std::string size = fmt::format("images of {}x{} pixels", width, height);
  if (fx < 5 && fy < 5 && std::abs(cx) <= 1 && std::abs(cy) <= 1)
    return fmt::format(
        "focal lengths {} and {} and the principal point ({}, {}) look normalised; expected pixels: multiply "
        "the "
        "first row by the width, {}, and the second by the height, {}",
        fx, fy, cx, cy, width, height);
  if (fx < widest * width || fy < widest * height)
    return fmt::format("focal lengths {} and {} are too short for {}; expected pixels, not mm", fx, fy, size);
  if (fx > narrowest * width || fy > narrowest * height)
    return fmt::format("focal lengths {} and {} are too long for {}", fx, fy, size);
  const bool is_swapped = is_near(fx, width / 2.0, 0.1) && is_near(fy, height / 2.0, 0.1) &&
                          !is_near(cx, width / 2.0, 0.4) && is_near(cx, cy, 0.1);
  if (is_swapped)
    return fmt::format(
        "focal lengths {} and {} with the principal point ({}, {}) look swapped; expected fx 0 cx / 0 fy cy "
        "/ 0 "
        "0 1",
        fx, fy, cx, cy);
  const auto is_outside = [](double at, double length) {
    return at < -margin * length || at > (1 + margin) * length;
  };
  const std::string point = fmt::format("principal point ({}, {}) does not fit {}", cx, cy, size);
  if (const auto other = other_size(camera); other && other->is_sure)
    return fmt::format("{}; it is that of images of {} pixels", point, other->size);
  return is_outside(cx, width) || is_outside(cy, height) ? point : "";
}

/// What cut images may have, and others have not; empty where there is nothing.
std::string doubt(const Camera& camera) {
  constexpr double far = 0.25;           // of the size, from the middle
  constexpr double widest_pixel = 1.25;  // cameras for depth have square ones
  const auto off = [](double at, int length) { return std::abs(at / length - 0.5); };
  const std::string point = fmt::format("the principal point ({}, {})", camera.cx, camera.cy);
  const std::string size = fmt::format("images of {}x{} pixels", camera.width, camera.height);
  const bool is_transposed =
      is_middle(camera, camera.height, camera.width) && !is_middle(camera, camera.width, camera.height);
  if (is_transposed)
    return fmt::format("{} is that of {}x{} pixels; are cx and cy swapped?", point, camera.height,
                       camera.width);
  if (const auto other = other_size(camera))
    return fmt::format("{} is that of images of {} pixels; right for {} only if they were cut out of such",
                       point, other->size, size);
  if (const double aspect = camera.fx / camera.fy; aspect > widest_pixel || aspect < 1 / widest_pixel)
    return fmt::format(
        "the focal lengths {} and {} make pixels {:.2f} times as wide as high; were images scaled in "
        "one direction?",
        camera.fx, camera.fy, camera.fy / camera.fx);
  if (off(camera.cx, camera.width) <= far && off(camera.cy, camera.height) <= far) return "";
  return fmt::format("{} is far from the middle of {}; right only if they were cut out of larger ones", point,
                     size);
}

}  // namespace

Intrinsics check_intrinsics(const Camera& camera, const std::string& place) {
  Intrinsics intrinsics{camera, {}};
  if (const std::string why = impossible(camera); !why.empty()) throw DataError(place + ": " + why);
  if (const std::string why = doubt(camera); !why.empty()) intrinsics.warnings.push_back(place + ": " + why);
  return intrinsics;
}

Intrinsics read_intrinsics(const std::string& path, int width, int height) {
  const std::vector<Number> k = read_numbers(path);
  if (k.size() != 9 && k.size() != 16) {
    throw DataError(
        fmt::format("{}: {} numbers, expected a 3x3 or 4x4 camera matrix (9 or 16)", path, k.size()));
  }
  const std::size_t columns = k.size() == 9 ? 3 : 4;
  check_pinhole(k, columns, path);
  return check_intrinsics({k[0].value, k[columns + 1].value, k[2].value, k[columns + 2].value, width, height},
                          place(path, k[0].line));
}

}  // namespace pliant
