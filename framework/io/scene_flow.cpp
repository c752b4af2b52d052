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

/// What a file of so many channels holds.
const char* kind_of(std::uint32_t channels) { return channels == 3 ? "scene flow" : "optical flow"; }

Header check_header(const std::vector<std::uint8_t>& bytes, std::uint32_t wanted, const std::string& path) {
  Header header{};
  if (bytes.size() < sizeof(header)) {
    throw DataError(fmt::format("{}: truncated: {} bytes are less than a header", path, bytes.size()));
  }
  std::memcpy(header.data(), bytes.data(), sizeof(header));
  const auto [width, height, channels] = header;
  if (channels != wanted)
    throw DataError(
        fmt::format("{}: {} channels, expected {} of {}", path, channels, wanted, kind_of(wanted)));
  constexpr std::uint32_t kLargest = 1u << 16;
  if (width == 0 || height == 0 || width > kLargest || height > kLargest) {
    throw DataError(fmt::format("{}: a size of {}x{} pixels is no {}", path, width, height, kind_of(wanted)));
  }
  const std::uint64_t expected = sizeof(header) + std::uint64_t{width} * height * channels * sizeof(float);
  if (bytes.size() != expected) {
    throw DataError(fmt::format("{}: {}: {} bytes, expected {} for {}x{} pixels", path,
                                bytes.size() < expected ? "truncated" : "too long", bytes.size(), expected,
                                width, height));
  }
  return header;
}

/// One vector of a file in the unit that it counts in; NaN where a component says that nothing is known.
template <int channels>
Eigen::Matrix<float, channels, 1> checked(const Eigen::Matrix<float, channels, 1>& motion, int u, int v,
                                          const std::string& path) {
  if (motion.hasNaN()) throw DataError(fmt::format("{}: NaN in ground truth at pixel ({}, {})", path, u, v));
  if ((motion.array() == std::numeric_limits<float>::infinity()).any())
    throw DataError(fmt::format("{}: infinite motion in ground truth at pixel ({}, {})", path, u, v));
  if (motion.allFinite()) return motion;
  return Eigen::Matrix<float, channels, 1>::Constant(std::numeric_limits<float>::quiet_NaN());
}

template <int channels>
Image<Eigen::Matrix<float, channels, 1>> read_flow(const std::string& path, float unit) {
  using Motion = Eigen::Matrix<float, channels, 1>;
  const auto bytes = read_file(path);
  const auto header = check_header(bytes, channels, path);
  Image<Motion> flow(static_cast<int>(header[0]), static_cast<int>(header[1]), Motion::Zero());
  std::vector<float> values(channels * flow.size());
  std::memcpy(values.data(), bytes.data() + sizeof(header), values.size() * sizeof(float));
  for (std::size_t i = 0; i < flow.size(); ++i) {
    Motion motion = Motion::Zero();
    for (int c = 0; c < channels; ++c)
      motion[c] = values[static_cast<std::size_t>(c) * flow.size() + i] * unit;
    const int u = static_cast<int>(i % header[0]);
    const int v = static_cast<int>(i / header[0]);
    flow(u, v) = checked<channels>(motion, u, v, path);
  }
  return flow;
}

template <int channels>
void write_flow(const std::string& path, const Image<Eigen::Matrix<float, channels, 1>>& flow, float unit) {
  const Header header = {static_cast<std::uint32_t>(flow.width()), static_cast<std::uint32_t>(flow.height()),
                         channels};
  std::vector<float> values(channels * flow.size());
  for (std::size_t i = 0; i < flow.size(); ++i) {
    const auto& motion = flow.pixels()[i];
    for (int c = 0; c < channels; ++c)
      values[static_cast<std::size_t>(c) * flow.size() + i] =
          motion.allFinite() ? motion[c] / unit : kNoMotion;
  }
  std::vector<std::uint8_t> bytes(sizeof(header) + values.size() * sizeof(float));
  std::memcpy(bytes.data(), header.data(), sizeof(header));
  if (!values.empty())
    std::memcpy(bytes.data() + sizeof(header), values.data(), values.size() * sizeof(float));
  write_file(path, bytes);
}

}  // namespace

Image<Eigen::Vector3f> read_scene_flow(const std::string& path) {
  return read_flow<3>(path, kMillimetresPerMetre);
}

void write_scene_flow(const std::string& path, const Image<Eigen::Vector3f>& flow) {
  write_flow<3>(path, flow, kMillimetresPerMetre);
}

Image<Eigen::Vector2f> read_optical_flow(const std::string& path) { return read_flow<2>(path, 1); }

void write_optical_flow(const std::string& path, const Image<Eigen::Vector2f>& flow) {
  write_flow<2>(path, flow, 1);
}

}  // namespace pliant
