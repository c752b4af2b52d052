#include "framework/io/gltf_color.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace pliant {
namespace {

using Json = GltfDocument::Json;

/// Linear, 0 to 1, of a primitive's material.
std::optional<Eigen::Array3d> base_color(const GltfDocument& document, const Json& primitive) {
  if (document.find(primitive, "material") == nullptr) return std::nullopt;
  const Json& material = document.element("materials", document.integer(primitive, "material"));
  const Json* model = document.find(material, "pbrMetallicRoughness");
  if (model == nullptr) return std::nullopt;
  const auto factor = document.numbers(*model, "baseColorFactor", 4);
  if (!factor) return std::nullopt;
  return Eigen::Map<const Eigen::Array3d>(factor->data());
}

/// Linear, 0 to 1; empty where vertices have none of their own.
std::vector<Eigen::Array3d> own_colors(const GltfDocument& document, const Json& primitive,
                                       std::size_t count) {
  const Json& attributes = document.at(primitive, "attributes");
  if (document.find(attributes, "COLOR_0") == nullptr) return {};
  const std::size_t accessor = document.integer(attributes, "COLOR_0");
  const bool has_opacity = document.text(document.element("accessors", accessor), "type") == "VEC4";
  const std::size_t width = has_opacity ? 4 : 3;
  const std::vector<float> numbers =
      document.reals(accessor, has_opacity ? "VEC4" : "VEC3", GltfDocument::Numbers::normalised);
  if (numbers.size() != width * count)
    document.fail(fmt::format("{} colours for {} vertices", numbers.size() / width, count));
  std::vector<Eigen::Array3d> colors;
  for (std::size_t i = 0; i < count; ++i)
    colors.emplace_back(Eigen::Map<const Eigen::Array3f>(&numbers[width * i]).cast<double>());
  return colors;
}

/// By the transfer function of sRGB [IEC 61966-2-1].
std::uint8_t encoded(double linear) {
  const double value = std::clamp(linear, 0.0, 1.0);
  const double share = value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * share));
}

}  // namespace

std::vector<Rgb> read_vertex_colors(const GltfDocument& document, const Json& primitive, std::size_t count) {
  const auto factor = base_color(document, primitive);
  const std::vector<Eigen::Array3d> own = own_colors(document, primitive, count);
  if (!factor && own.empty()) return {};
  std::vector<Rgb> colors;
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Array3d color = factor.value_or(Eigen::Array3d::Ones());
    if (!own.empty()) color *= own[i];
    colors.push_back({encoded(color.x()), encoded(color.y()), encoded(color.z())});
  }
  return colors;
}

}  // namespace pliant
