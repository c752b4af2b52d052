#include "experiments/report/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "experiments/report/graph_drawing.h"
#include "experiments/report/heat_map.h"
#include "experiments/report/surfaces.h"
#include "framework/geometry/render.h"
#include "framework/io/file.h"

namespace pliant {
namespace {

constexpr float nothing = std::numeric_limits<float>::quiet_NaN();

/// The value that `share` of the finite values stay below; 0 when there are none.
float quantile(std::vector<float> values, double share) {
  values.erase(
      std::remove_if(values.begin(), values.end(), [](float value) { return !std::isfinite(value); }),
      values.end());
  if (values.empty()) return 0;
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

std::vector<float> depths(const std::vector<Eigen::Vector3f>& points) {
  std::vector<float> values;
  for (const Eigen::Vector3f& point : points) values.push_back(point.z());
  return values;
}

/// Values per source point, at the pixels that the points came from.
template <class Input>
Image<float> at_source_pixels(const Input& input, const std::vector<float>& values) {
  Image<float> image(input.pair.camera.width, input.pair.camera.height, nothing);
  const std::vector<Eigen::Vector2i>& pixels = input.run.result.source.pixels;
  for (std::size_t i = 0; i < values.size(); ++i) image(pixels[i].x(), pixels[i].y()) = values[i];
  return image;
}

Image<float> target_depth(const SurfaceImage& target) {
  Image<float> image(target.points.width(), target.points.height(), nothing);
  for (std::size_t i = 0; i < image.size(); ++i) {
    const float depth = target.points.data()[i].z();
    if (depth > 0) image.data()[i] = depth;
  }
  return image;
}

/// Fits the registered object, from where it starts to where it ends: a room behind it would otherwise
/// take all the colours.
template <class Result>
ColorScale depth_scale(const Result& result) {
  std::vector<float> values = depths(result.source.points);
  const std::vector<float> moved = depths(result.points);
  values.insert(values.end(), moved.begin(), moved.end());
  // The rim of a mask often bleeds onto the background: a twentieth may lie anywhere.
  const float nearest = quantile(values, 0.05);
  const float furthest = quantile(values, 0.95);
  const float air = std::max(0.25f * (furthest - nearest), 1.0f);
  const auto step = static_cast<float>(round_up((furthest - nearest + 2 * air) / 10));
  return {ColorScale::Map::depth, step * std::floor((nearest - air) / step),
          step * std::ceil((furthest + air) / step)};
}

/// Fits what non-rigid registration starts from: before the alignment errors may be a hundred times as
/// large, and nothing would be seen of the end.
ColorScale error_scale(const std::vector<float>& aligned) {
  const float bulk = std::max(quantile(aligned, 0.95), 0.1f);
  return {ColorScale::Map::error, 0, static_cast<float>(round_up(bulk))};
}

std::string count_points(std::size_t count) { return fmt::format("{} points", count); }

std::string spread(const Metrics& metrics) {
  return fmt::format("to the nearest target point: mean {:.2f} mm, sd {:.2f} mm", metrics.nearest_mean,
                     metrics.nearest_sd);
}

Picture draw(std::string file, std::string caption, const Image<float>& values, const ColorScale& scale,
             const std::string& subtitle) {
  std::vector<std::uint8_t> png = draw_heat_map(values, scale, caption, subtitle);
  return {std::move(file), std::move(caption), std::move(png)};
}

std::vector<Picture> draw_depths(const ReportInput& input) {
  const Surface& source = input.run.result.source;
  const ColorScale scale = depth_scale(input.run.result);
  const Image<float> target = target_depth(input.target);
  const auto target_points =
      std::count_if(target.pixels().begin(), target.pixels().end(), [](float depth) { return depth > 0; });
  return {draw("depth_source.png", "Source depth", at_source_pixels(input, depths(source.points)), scale,
               count_points(source.size())),
          draw("depth_target.png", "SurfaceMap depth", target, scale,
               count_points(static_cast<std::size_t>(target_points)))};
}

std::vector<Picture> draw_errors(const ReportInput& input) {
  const RunRecord& run = input.run;
  const std::vector<float>& aligned = input.nearest.aligned;
  const ColorScale scale = error_scale(aligned);
  std::vector<Picture> pictures;
  const auto add = [&](const char* file, const char* caption, const std::vector<float>& errors,
                       const Metrics& metrics) {
    pictures.push_back(draw(file, caption, at_source_pixels(input, errors), scale, spread(metrics)));
  };
  add("error_initial.png", "Error before registration", input.nearest.initial, run.initial);
  if (run.result.aligned_points != run.result.source.points) {
    add("error_aligned.png", "Error after the initial alignment", aligned, run.aligned);
  }
  add("error_final.png", "Error after registration", input.nearest.final, run.metrics);
  return pictures;
}

/// Where the nodes lie in the source as it was given; they are known as the alignment moved them.
template <class Input>
std::vector<Eigen::Vector2d> node_pixels(const Input& input, const Eigen::Isometry3d& alignment) {
  const Camera& camera = input.pair.camera;
  const Eigen::Isometry3d undo = alignment.inverse();
  std::vector<Eigen::Vector2d> pixels;
  for (const Eigen::Vector3f& node : input.run.result.node_positions)
    pixels.push_back(camera.project(undo * node.cast<double>()));
  return pixels;
}

template <class Result>
std::string count_nodes(const Result& result) {
  std::string nodes = fmt::format("{} nodes", result.node_positions.size());
  if (result.graph_cells.empty()) return nodes;
  const auto virtual_cells = std::count_if(result.graph_cells.begin(), result.graph_cells.end(),
                                           [](const GraphCell& cell) { return cell.is_virtual; });
  return fmt::format("{}, and {} virtual ones without a point at the centre", nodes, virtual_cells);
}

template <class Input>
Picture draw_last_graph(const Input& input, const Eigen::Isometry3d& alignment) {
  const auto& result = input.run.result;
  const GraphDrawing graph{at_source_pixels(input, depths(result.source.points)), result.graph_cells,
                           node_pixels(input, alignment)};
  const char* caption = "Deformation graph at the end, over the source";
  return {"graph.png", caption, draw_graph(graph, caption, count_nodes(result))};
}

/// What the camera would see of the bent surface.
Image<float> see_bent(const EditInput& input) {
  constexpr float depth_step = 20;  // mm, within which neighbouring pixels are one surface
  const EditResult& result = input.run.result;
  std::vector<Eigen::Vector3d> vertices;
  for (const Eigen::Vector3f& point : result.points) vertices.push_back(point.cast<double>());
  Image<float> seen =
      depth_of(render_mesh(vertices, triangulate(result.source, depth_step), input.pair.camera));
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (seen.data()[i] <= 0) seen.data()[i] = nothing;
  return seen;
}

Picture draw_motion(const EditInput& input) {
  const EditResult& result = input.run.result;
  std::vector<float> lengths;
  for (std::size_t i = 0; i < result.points.size(); ++i)
    lengths.push_back((result.points[i] - result.source.points[i]).norm());
  const float longest = lengths.empty() ? 0 : *std::max_element(lengths.begin(), lengths.end());
  const ColorScale scale{ColorScale::Map::error, 0, static_cast<float>(round_up(std::max(longest, 0.1F)))};
  return draw("motion.png", "How far each point went", at_source_pixels(input, lengths), scale,
              fmt::format("at most {:.1f} mm", longest));
}

class PicturesReport : public Report {
 public:
  std::vector<std::string> files() const override {
    return {"depth_source.png",  "depth_target.png", "depth_registered.png", "error_initial.png",
            "error_aligned.png", "error_final.png",  "motion.png",           "graph.png"};
  }
  std::vector<std::filesystem::path> write(const ReportInput& input,
                                           const std::filesystem::path& folder) const override {
    return write(draw_pictures(input), folder);
  }
  std::vector<std::filesystem::path> write(const EditInput& input,
                                           const std::filesystem::path& folder) const override {
    return write(draw_pictures(input), folder);
  }

 private:
  static std::vector<std::filesystem::path> write(const std::vector<Picture>& pictures,
                                                  const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const Picture& picture : pictures) {
      files.push_back(folder / picture.file);
      write_file(files.back().string(), picture.png);
    }
    return files;
  }
};

}  // namespace

std::vector<Picture> draw_pictures(const ReportInput& input) {
  std::vector<Picture> pictures = draw_depths(input);
  for (Picture& picture : draw_errors(input)) pictures.push_back(std::move(picture));
  pictures.push_back(draw_last_graph(input, input.run.result.alignment.motion));
  return pictures;
}

std::vector<Picture> draw_pictures(const EditInput& input) {
  const EditResult& result = input.run.result;
  const ColorScale scale = depth_scale(result);
  return {draw("depth_source.png", "Source depth", at_source_pixels(input, depths(result.source.points)),
               scale, count_points(result.source.size())),
          draw("depth_registered.png", "Depth of the bent surface", see_bent(input), scale,
               "as the same camera would see it"),
          draw_motion(input), draw_last_graph(input, Eigen::Isometry3d::Identity())};
}

void register_pictures_report(Registry& registry) {
  registry.add<Report>("pictures", "Depth, errors and the deformation graph as PNG pictures", {},
                       [](const Parameters&, const Registry&) { return std::make_unique<PicturesReport>(); });
}

}  // namespace pliant
