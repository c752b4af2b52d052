#include "framework/io/scene_flow.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "framework/core/error.h"
#include "framework/io/file.h"

namespace pliant {
namespace {

// The file is copied to and from memory as it is.
static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "scene flow files are little-endian");

using Header = std::array<std::uint32_t, 3>;  // width, height, channels
constexpr float kMillimetresPerMetre = 1000;
constexpr float kNoMotion = -std::numeric_limits<float>::infinity();

Header check_header(const std::vector<std::uint8_t>& bytes, const std::string& path) {
  Header header{};
  if (bytes.size() < sizeof(header)) {
    throw DataError(fmt::format("{}: truncated: {} bytes are less than a header", path, bytes.size()));
  }
  std::memcpy(header.data(), bytes.data(), sizeof(header));
  const auto [width, height, channels] = header;
  if (channels != 3)
    throw DataError(fmt::format("{}: {} channels, expected 3 of scene flow", path, channels));
  constexpr std::uint32_t kLargest = 1u << 16;
  if (width == 0 || height == 0 || width > kLargest || height > kLargest) {
    throw DataError(fmt::format("{}: a size of {}x{} pixels is no scene flow", path, width, height));
  }
  const std::uint64_t expected = sizeof(header) + std::uint64_t{width} * height * channels * sizeof(float);
  if (bytes.size() != expected) {
    throw DataError(fmt::format("{}: {}: {} bytes, expected {} for {}x{} pixels", path,
                                bytes.size() < expected ? "truncated" : "too long", bytes.size(), expected,
                                width, height));
  }
  return header;
}

// NaN where one of the components says that nothing is known.
Eigen::Vector3f to_motion(const Eigen::Vector3f& metres, int u, int v, const std::string& path) {
  if (metres.hasNaN()) throw DataError(fmt::format("{}: NaN in ground truth at pixel ({}, {})", path, u, v));
  Eigen::Vector3f motion = metres * kMillimetresPerMetre;
  if ((motion.array() == std::numeric_limits<float>::infinity()).any()) {
    throw DataError(fmt::format("{}: infinite motion in ground truth at pixel ({}, {})", path, u, v));
  }
  if (!motion.allFinite()) return Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
  return motion;
}

}  // namespace

Image<Eigen::Vector3f> read_scene_flow(const std::string& path) {
  const auto bytes = read_file(path);
  const auto header = check_header(bytes, path);
  Image<Eigen::Vector3f> flow(static_cast<int>(header[0]), static_cast<int>(header[1]),
                              Eigen::Vector3f::Zero());
  std::vector<float> values(3 * flow.size());
  std::memcpy(values.data(), bytes.data() + sizeof(header), values.size() * sizeof(float));
  for (std::size_t i = 0; i < flow.size(); ++i) {
    const Eigen::Vector3f metres(values[i], values[flow.size() + i], values[2 * flow.size() + i]);
    const int u = static_cast<int>(i % header[0]);
    const int v = static_cast<int>(i / header[0]);
    flow(u, v) = to_motion(metres, u, v, path);
  }
  return flow;
}

void write_scene_flow(const std::string& path, const Image<Eigen::Vector3f>& flow) {
  const Header header = {static_cast<std::uint32_t>(flow.width()), static_cast<std::uint32_t>(flow.height()),
                         3};
  std::vector<float> values(3 * flow.size());
  for (std::size_t i = 0; i < flow.size(); ++i) {
    const Eigen::Vector3f& motion = flow.pixels()[i];
    for (std::size_t c = 0; c < 3; ++c) {
      values[c * flow.size() + i] = motion.allFinite() ? motion[c] / kMillimetresPerMetre : kNoMotion;
    }
  }
  std::vector<std::uint8_t> bytes(sizeof(header) + values.size() * sizeof(float));
  std::memcpy(bytes.data(), header.data(), sizeof(header));
  if (!values.empty()) {
    std::memcpy(bytes.data() + sizeof(header), values.data(), values.size() * sizeof(float));
  }
  write_file(path, bytes);
}

}  // namespace pliant
