#include "experiments/tasks/point_tracks.h"

#include <fmt/format.h>

#include <map>
#include <string>
#include <system_error>
#include <utility>

#include "framework/core/error.h"
#include "framework/io/mesh_writer.h"

namespace pliant {
namespace {

/// Neighbours are joined that lie up to so many times further apart in depth than across, seen face on.
constexpr double steepest = 4;

/// Which of the points each pixel of a grid has.
class PixelGrid {
 public:
  explicit PixelGrid(const std::vector<Eigen::Vector2i>& pixels) {
    for (const Eigen::Vector2i& pixel : pixels)
      points_.emplace(std::pair(pixel.x(), pixel.y()), static_cast<int>(points_.size()));
  }

  /// -1: none.
  int at(int u, int v) const {
    const auto point = points_.find({u, v});
    return point == points_.end() ? -1 : point->second;
  }

 private:
  std::map<std::pair<int, int>, int> points_;
};

/// Between neighbours of the grid, counter-clockwise for who looks along +z.
std::vector<Eigen::Vector3i> grid_triangles(const std::vector<Eigen::Vector2i>& pixels, int step,
                                            const std::vector<Eigen::Vector3f>& points,
                                            double gap_per_depth) {
  const PixelGrid grid(pixels);
  const auto are_joined = [&](const Eigen::Vector3i& corners) {
    if ((corners.array() < 0).any()) return false;
    Eigen::Vector3d depths;
    for (int i = 0; i < 3; ++i) depths[i] = points[static_cast<std::size_t>(corners[i])].z();
    return depths.maxCoeff() - depths.minCoeff() <= gap_per_depth * depths.minCoeff();
  };
  std::vector<Eigen::Vector3i> triangles;
  for (const Eigen::Vector2i& pixel : pixels) {
    const int u = pixel.x();
    const int v = pixel.y();
    const int own = grid.at(u, v);
    // Each has its right angle at a pixel of its own.
    for (const Eigen::Vector3i& corners : {Eigen::Vector3i(own, grid.at(u, v + step), grid.at(u + step, v)),
                                           Eigen::Vector3i(own, grid.at(u, v - step), grid.at(u - step, v))})
      if (are_joined(corners)) triangles.push_back(corners);
  }
  return triangles;
}

std::string name_of(int number) { return fmt::format("frame_{:04}", number); }

}  // namespace

void PointTracks::add(int number, double time, const std::vector<Eigen::Vector2i>& pixels,
                      const std::vector<Eigen::Vector3f>& points) {
  if (first_ == 0) {
    first_ = number;
    triangles_ = grid_triangles(pixels, options_.step, points, options_.gap_per_depth);
  }
  if ((number - first_) % options_.every != 0) return;
  if (options_.ply) {
    files_.push_back(folder_ / "tracks" / (name_of(number) + ".ply"));
    std::error_code ignored;  // the file cannot be written then
    std::filesystem::create_directories(files_.back().parent_path(), ignored);
    write_mesh_ply(files_.back().string(), {points, triangles_, {}});
  }
  if (options_.gltf && keys_.takes_next()) keys_.keep({number, time, points});
}

std::vector<std::filesystem::path> PointTracks::finish() const {
  auto files = files_;
  if (keys_.kept().empty()) return files;
  files.push_back(folder_ / gltf_name);
  write_gltf(files.back());
  return files;
}

/// The first key is the mesh at rest, and a target holds alone at the time of its own key.
void PointTracks::write_gltf(const std::filesystem::path& file) const {
  const std::vector<Key>& keys = keys_.kept();
  Mesh mesh{keys.front().points, triangles_, {}};
  Track weights{Track::Interpolation::linear, keys.size() - 1, {}, {}};
  for (std::size_t k = 0; k < keys.size(); ++k) {
    weights.times.push_back(keys[k].time - keys.front().time);
    for (std::size_t target = 1; target < keys.size(); ++target)
      weights.values.push_back(target == k ? 1 : 0);
    if (k == 0) continue;
    MorphTarget target{name_of(keys[k].number), keys[k].points};
    for (std::size_t i = 0; i < target.displacements.size(); ++i) target.displacements[i] -= mesh.vertices[i];
    mesh.targets.push_back(std::move(target));
  }
  write_animated_glb(file.string(), mesh, weights);
}

std::unique_ptr<PointTracks> make_point_tracks(const Parameters& experiment,
                                               const std::filesystem::path& folder, const Rig& rig) {
  if (!experiment.has("record")) return nullptr;
  const Parameters& record = experiment.section("record");
  const std::string& format = record.text("tracks");
  if (format == "none") return nullptr;
  const Parameters& followed = experiment.section("followed");
  if (followed.integer("from") == 0)
    throw ConfigError(fmt::format(
        "{}: 'tracks' of points, but none is followed; expected 'followed: {{from: FRAME}}' beside it",
        record.place()));
  const auto step = static_cast<int>(followed.integer("step"));
  return std::make_unique<PointTracks>(
      folder, PointTracks::Options{format != "ply", format != "gltf",
                                   static_cast<int>(record.integer("tracks_every")), step,
                                   steepest * step / rig.depth.fx});
}

}  // namespace pliant
