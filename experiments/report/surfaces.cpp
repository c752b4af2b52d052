#include "experiments/report/surfaces.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "experiments/report/report.h"
#include "framework/io/ply.h"

namespace pliant {
namespace {

constexpr int none = -1;

/// The index of the point at each pixel.
Image<int> index_image(const Surface& surface) {
  Eigen::Vector2i last = Eigen::Vector2i::Constant(-1);
  for (const Eigen::Vector2i& pixel : surface.pixels) last = last.cwiseMax(pixel);
  Image<int> indices(last.x() + 1, last.y() + 1, none);
  for (std::size_t i = 0; i < surface.size(); ++i) {
    indices(surface.pixels[i].x(), surface.pixels[i].y()) = static_cast<int>(i);
  }
  return indices;
}

class SurfacesReport : public Report {
 public:
  explicit SurfacesReport(float depth_step) : depth_step_(depth_step) {}

  std::vector<std::string> files() const override { return {"source.ply", "target.ply", "registered.ply"}; }

  std::vector<std::filesystem::path> write(const ReportInput& input,
                                           const std::filesystem::path& folder) const override {
    const RegistrationResult& result = input.run.result;
    const std::vector<Eigen::Vector3i> triangles = triangulate(result.source, depth_step_);
    PlySurface source{result.source, input.nearest.initial, triangles};

    PlySurface registered{result.source, input.nearest.final, triangles};
    registered.surface.points = result.points;
    registered.surface.normals = result.normals;
    registered.matched = result.matched;

    PlySurface target{make_surface(input.target, input.pair.target.color), {}, {}};
    target.errors.assign(target.surface.size(), 0);
    target.triangles = triangulate(target.surface, depth_step_);

    std::vector<std::filesystem::path> files;
    for (const auto& [name, ply] : {std::pair<const char*, const PlySurface&>{"source.ply", source},
                                    {"target.ply", target},
                                    {"registered.ply", registered}}) {
      files.push_back(folder / name);
      write_ply(files.back().string(), ply);
    }
    return files;
  }

  /// The bent surface under the name of a registered one; `error` is how far each point went.
  std::vector<std::filesystem::path> write(const EditInput& input,
                                           const std::filesystem::path& folder) const override {
    const EditResult& result = input.run.result;
    const std::vector<Eigen::Vector3i> triangles = triangulate(result.source, depth_step_);
    const PlySurface source{result.source, std::vector<float>(result.source.size(), 0), triangles};
    PlySurface bent{result.source, {}, triangles};
    for (std::size_t i = 0; i < result.points.size(); ++i)
      bent.errors.push_back((result.points[i] - result.source.points[i]).norm());
    bent.surface.points = result.points;
    bent.surface.normals = result.normals;
    write_ply((folder / "source.ply").string(), source);
    write_ply((folder / "registered.ply").string(), bent);
    return {folder / "source.ply", folder / "registered.ply"};
  }

 private:
  float depth_step_;
};

}  // namespace

std::vector<Eigen::Vector3i> triangulate(const Surface& surface, float depth_step) {
  const Image<int> indices = index_image(surface);
  std::vector<Eigen::Vector3i> triangles;
  const auto add = [&](const Eigen::Vector3i& corners) {
    if (corners.minCoeff() == none) return;
    const auto depth = [&](int corner) { return surface.points[corners[corner]].z(); };
    const auto [nearest, furthest] = std::minmax({depth(0), depth(1), depth(2)});
    if (furthest - nearest <= depth_step) triangles.push_back(corners);
  };
  for (int v = 0; v + 1 < indices.height(); ++v) {
    for (int u = 0; u + 1 < indices.width(); ++u) {
      add({indices(u, v), indices(u, v + 1), indices(u + 1, v)});
      add({indices(u + 1, v), indices(u, v + 1), indices(u + 1, v + 1)});
    }
  }
  return triangles;
}

void register_surfaces_report(Registry& registry) {
  registry.add<Report>(
      "surfaces", "source.ply, registered.ply and, where there is one, target.ply",
      {
          real("depth_step", 20)
              .unit("mm")
              .above(0)
              .doc("Pixels further apart in depth are not joined by a triangle"),
      },
      [](const Parameters& parameters, const Registry&) {
        return std::make_unique<SurfacesReport>(static_cast<float>(parameters.real("depth_step")));
      });
}

}  // namespace pliant
