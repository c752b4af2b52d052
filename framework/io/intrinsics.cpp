#include "framework/io/intrinsics.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <sstream>
#include <vector>

#include "framework/core/error.h"
#include "framework/io/file.h"

namespace pliant {
namespace {

double parse_number(const std::string& word, const std::string& path) {
  double value = 0;
  const char* end = word.data() + word.size();
  // Independent of the locale, unlike streams and strtod.
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) {
    throw DataError(fmt::format("{}: '{}' is not a number", path, word.substr(0, 40)));
  }
  return value;
}

std::vector<double> read_numbers(const std::string& path) {
  const auto bytes = read_file(path);
  std::istringstream stream(std::string(bytes.begin(), bytes.end()));
  std::vector<double> numbers;
  std::string word;
  while (stream >> word) numbers.push_back(parse_number(word, path));
  return numbers;
}

void check_pinhole(const std::vector<double>& k, std::size_t columns, const std::string& path) {
  if (k[0] <= 0 || k[columns + 1] <= 0) {
    throw DataError(fmt::format("{}: focal lengths {} and {} pixels, expected positive ones", path, k[0],
                                k[columns + 1]));
  }
  for (std::size_t i = 0; i < k.size(); ++i) {
    const std::size_t row = i / columns;
    const std::size_t column = i % columns;
    const bool is_free = row < 2 && (column == row || column == 2);
    if (!is_free && k[i] != (row == column ? 1.0 : 0.0)) {
      throw DataError(fmt::format("{}: {} in row {}, column {}: expected fx 0 cx / 0 fy cy / 0 0 1", path,
                                  k[i], row + 1, column + 1));
    }
  }
}

// Cropped images have their principal point anywhere, so only two things are taken as a sign of another
// size: a principal point far outside, and one that is the middle of a clearly larger or smaller image
// of the same proportions.
void check_size(const Camera& camera, const std::string& path) {
  constexpr double kMargin = 0.25;
  constexpr double kSameSize = 1.3;
  constexpr double kSameProportions = 1.15;
  const double across = 2 * camera.cx / camera.width;
  const double down = 2 * camera.cy / camera.height;
  const auto is_outside = [](double twice) { return twice < -2 * kMargin || twice > 2 + 2 * kMargin; };
  const auto differs = [](double ratio, double limit) { return ratio > limit || ratio < 1 / limit; };
  const bool other_size = across > 0 && down > 0 && differs(across, kSameSize) && differs(down, kSameSize) &&
                          !differs(across / down, kSameProportions);
  if (is_outside(across) || is_outside(down) || other_size) {
    throw DataError(fmt::format("{}: principal point ({}, {}) does not fit images of {}x{} pixels", path,
                                camera.cx, camera.cy, camera.width, camera.height));
  }
}

}  // namespace

Camera read_intrinsics(const std::string& path, int width, int height) {
  const std::vector<double> k = read_numbers(path);
  if (k.size() != 9 && k.size() != 16) {
    throw DataError(
        fmt::format("{}: {} numbers, expected a 3x3 or 4x4 camera matrix (9 or 16)", path, k.size()));
  }
  const std::size_t columns = k.size() == 9 ? 3 : 4;
  check_pinhole(k, columns, path);
  const Camera camera{k[0], k[columns + 1], k[2], k[columns + 2], width, height};
  check_size(camera, path);
  return camera;
}

}  // namespace pliant
