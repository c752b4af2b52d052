#include "experiments/report/surfaces.h"

#include <algorithm>
#include <memory>

#include "experiments/report/report.h"
#include "experiments/report/reports.h"
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

  std::vector<std::string> files(const ArtefactNames& names) const override {
    std::vector<std::string> files;
    for (const std::string& name : names.surfaces) files.push_back(name + ".ply");
    return files;
  }

  std::vector<std::filesystem::path> write(const RunArtefacts& run,
                                           const std::filesystem::path& folder) const override {
    std::vector<std::filesystem::path> files;
    for (const NamedSurface& shown : run.surfaces) {
      const Surface& surface = shown.surface;
      const Surface rest = shown.rest.empty() ? surface : Surface{shown.rest, {}, surface.pixels, {}};
      files.push_back(folder / (shown.name + ".ply"));
      write_ply(files.back().string(),
                {surface, shown.errors, triangulate(rest, depth_step_), shown.matched});
    }
    return files;
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
