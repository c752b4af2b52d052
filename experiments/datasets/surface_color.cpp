#include "experiments/datasets/surface_color.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>

#include "experiments/datasets/surface_color.cl.embed.h"
#include "framework/device/lanes.h"

namespace pliant {
namespace {

// The noise above which there is a freckle, and from there the noise at which it is darkest.
constexpr float freckle_begin = 0.55F;
constexpr float freckle_edge = 0.35F;
// Of the radius of a patch, on which its colour fades.
constexpr float patch_edge = 0.5F;

using HashedCell = std::array<std::uint32_t, 3>;

/// As corner_bits() of surface_color.cl.
std::uint32_t corner_bits(const HashedCell& corner, std::uint32_t key) {
  std::uint32_t bits = corner[0] * 0x9e3779b1U + corner[1] * 0x85ebca77U + corner[2] * 0xc2b2ae3dU + key;
  bits = (bits ^ (bits >> 16)) * 0x85ebca6bU;
  bits = (bits ^ (bits >> 13)) * 0xc2b2ae35U;
  return bits ^ (bits >> 16);
}

/// Interpolates between the two halves of a cell's corners, axis by axis from the last one.
Eigen::Vector3f blend(HashedCell corner, std::size_t axis, const Eigen::Array3f& share, std::uint32_t key) {
  if (axis == 3) {
    const std::uint32_t bits = corner_bits(corner, key);
    return {static_cast<float>(bits & 1023U), static_cast<float>((bits >> 10) & 1023U),
            static_cast<float>((bits >> 20) & 1023U)};
  }
  const Eigen::Vector3f before = blend(corner, axis + 1, share, key);
  ++corner[axis];
  return before + share[static_cast<Eigen::Index>(axis)] * (blend(corner, axis + 1, share, key) - before);
}

/// From -1 to 1 in each channel.
Eigen::Vector3f noise_at(const Eigen::Vector3f& point, float spacing, std::uint32_t key) {
  const Eigen::Array3f scaled = point.array() / spacing;
  const Eigen::Array3f corner = scaled.floor();
  const Eigen::Array3f inside = scaled - corner;
  const auto bits = [&](int axis) {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(corner[axis]));
  };
  const Eigen::Vector3f value =
      blend({bits(0), bits(1), bits(2)}, 0, inside * inside * (3 - 2 * inside), key);
  return value / 511.5F - Eigen::Vector3f::Ones();
}

float smooth(float share) {
  const float within = std::clamp(share, 0.0F, 1.0F);
  return within * within * (3 - 2 * within);
}

float freckle(float noise) { return smooth((noise - freckle_begin) / freckle_edge); }

std::uint8_t to_byte(float value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 255.0F)));
}

/// A colour under a patch.
Rgb under(const ColorPatch& patch, const Eigen::Vector3f& point, const Rgb& color) {
  const float distance = ((point - patch.centre).array() / patch.radii.array()).matrix().norm();
  const float share = patch.strength * smooth((1 - distance) / patch_edge);
  const Eigen::Vector3f before(color.r, color.g, color.b);
  const Eigen::Vector3f mixed = before + share * (patch.color - before);
  return {to_byte(mixed.x()), to_byte(mixed.y()), to_byte(mixed.z())};
}

/// All numbers of patches, as the kernel reads them.
Array<float> flat(const std::vector<ColorPatch>& patches) {
  std::vector<float> numbers;
  for (const ColorPatch& patch : patches) {
    for (const Eigen::Vector3f* vector : {&patch.centre, &patch.radii, &patch.color})
      numbers.insert(numbers.end(), vector->data(), vector->data() + 3);
    numbers.push_back(patch.strength);
  }
  return Array<float>(std::move(numbers));
}

}  // namespace

SurfaceColor::SurfaceColor(Kind kind, std::uint64_t seed, std::vector<ColorPatch> patches)
    : base_(kind == Kind::rich ? Eigen::Vector3f(127.5F, 127.5F, 127.5F) : Eigen::Vector3f(214, 165, 136)),
      is_toned_(kind == Kind::skin),
      patches_(std::move(patches)) {
  std::mt19937_64 generator(seed);
  const auto key = [&] { return static_cast<std::uint32_t>(generator() >> 32); };
  constexpr float third = 127.5F / 3;
  if (kind == Kind::rich)
    noises_ = {Noise{40, third, key()}, Noise{16, third, key()}, Noise{7, third, key()}};
  else
    noises_ = {Noise{70, 10, key()}, Noise{25, 6, key()}, Noise{8, 3, key()}};
  freckles_ = {5, kind == Kind::skin ? 30.0F : 0.0F, key()};
}

Array<cl_uchar> SurfaceColor::paint(Device& device, const MeshView& view, const Array<float>& rest) const {
  static const std::string source = with_lanes(embedded::experiments_datasets_surface_color_cl);
  static const std::string options =
      fmt::format("-DFRECKLE_BEGIN={:.9e}f -DFRECKLE_EDGE={:.9e}f", freckle_begin, freckle_edge);
  const std::size_t count = view.triangles.size();
  const auto width = static_cast<std::size_t>(device.width());
  Array<cl_uchar> colors(3 * count);
  auto kernel = device.kernel(source, "paint", options);
  const auto& [coarse, middle, fine] = noises_;
  device.run("render", kernel, (count + width - 1) / width, 16, static_cast<cl_int>(count),
             view.triangles.device(device), rest.device(device),
             cl_float4{{coarse.spacing, middle.spacing, fine.spacing, freckles_.spacing}},
             cl_float4{{coarse.amplitude, middle.amplitude, fine.amplitude, freckles_.amplitude}},
             cl_uint4{{coarse.key, middle.key, fine.key, freckles_.key}},
             cl_float4{{base_.x(), base_.y(), base_.z(), 0}}, cl_int{is_toned_ ? 1 : 0},
             colors.write_device(device));
  if (!patches_.empty()) paint_patches(device, view, rest, colors);
  return colors;
}

void SurfaceColor::paint_patches(Device& device, const MeshView& view, const Array<float>& rest,
                                 Array<cl_uchar>& colors) const {
  static const std::string source = with_lanes(embedded::experiments_datasets_surface_color_cl);
  static const std::string options =
      fmt::format("-DFRECKLE_BEGIN={:.9e}f -DFRECKLE_EDGE={:.9e}f", freckle_begin, freckle_edge);
  auto kernel = device.kernel(source, "paint_patches", options);
  device.run("render", kernel, view.triangles.size(), 16, static_cast<cl_int>(view.triangles.size()),
             view.triangles.device(device), rest.device(device), static_cast<cl_int>(patches_.size()),
             flat(patches_).device(device), patch_edge, colors.write_device(device));
}

Rgb SurfaceColor::color_of(const Eigen::Vector3f& rest) const {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (const Noise& noise : noises_) sum += noise.amplitude * noise_at(rest, noise.spacing, noise.key);
  if (is_toned_) {
    float tone = sum.x();
    tone -= freckles_.amplitude * freckle(noise_at(rest, freckles_.spacing, freckles_.key).x());
    sum = tone / 255 * base_;
  }
  const Eigen::Vector3f whole = base_ + sum;
  Rgb color{to_byte(whole.x()), to_byte(whole.y()), to_byte(whole.z())};
  for (const ColorPatch& patch : patches_) color = under(patch, rest, color);
  return color;
}

ColorImage read_colors(const Array<cl_uchar>& colors, const Camera& camera) {
  static_assert(sizeof(Rgb) == 3);
  ColorImage image(camera.width, camera.height);
  colors.copy_to(reinterpret_cast<cl_uchar*>(image.data()));
  return image;
}

}  // namespace pliant
