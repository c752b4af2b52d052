#include "framework/imaging/preprocessor.h"

#include <algorithm>
#include <stdexcept>

#include "framework/imaging/back_project.cl.embed.h"
#include "framework/imaging/depth_kernel.h"

namespace pliant {
namespace {

PixelWindow checked(const PixelWindow& region, const Camera& camera) {
  const bool is_inside = region.left >= 0 && region.top >= 0 && region.width > 0 && region.height > 0 &&
                         region.left + region.width <= camera.width &&
                         region.top + region.height <= camera.height;
  if (!is_inside) throw std::invalid_argument("the region is not inside of the image");
  return region;
}

/// Replaces the points of a surface by those of a depth map.
void back_project(Device& device, const DepthMap& map, SurfaceMap& surface) {
  static const std::string source = with_depth_map(embedded::framework_imaging_back_project_cl);
  auto kernel = device.kernel(source, "back_project", depth_map_options());
  const PixelWindow& window = map.window;
  device.run("surface", kernel, row_vectors(device, window), 64, map.depth.device(device),
             static_cast<cl_int>(map.stride), cl_int2{{window.width, window.height}},
             cl_int2{{window.left, window.top}}, pinhole(surface.camera),
             surface.map.points.write_device(device));
}

}  // namespace

float Acquisition::farthest() const {
  return depth_cut > 0 ? static_cast<float>(depth_cut) : DepthMap::no_depth;
}

std::vector<Parameter> acquisition_rows() {
  return {
      real("depth_cut", 0)
          .unit("mm")
          .at_least(0)
          .doc("Depth beyond which everything is background; 0: nothing is [thesis 3.1 has 1300]"),
      component("filter", "filter", "bilateral").doc("Noise reduction of depth before normals are found"),
      component("normals", "normals", "integral_images").doc("How normals are found"),
      boolean("filter_points", false)
          .doc("Whether points, too, are those of the filtered depth, as in the thesis: the filter flattens "
               "what bends, and poses drift"),
  };
}

Acquisition make_acquisition(const Parameters& experiment, const Registry& registry) {
  return {experiment.real("depth_cut"), registry.make<DepthFilter>(experiment.section("filter")),
          registry.make<Normals>(experiment.section("normals")), experiment.boolean("filter_points")};
}

DepthImage cut_depth(const DepthImage& depth, float farthest) {
  DepthImage cut = depth;
  std::replace_if(
      cut.data(), cut.data() + cut.size(), [=](float z) { return !(z <= farthest); }, 0.0F);
  return cut;
}

Preprocessor::Preprocessor(Device& device, const Rig& rig, const Acquisition& acquisition,
                           const std::optional<PixelWindow>& region)
    : device_(device),
      rig_(rig),
      acquisition_(acquisition),
      depth_(region ? checked(*region, rig.depth) : whole_image(rig.depth)),
      surface_(unwritten_surface(rig.depth, depth_.window)) {}

void Preprocessor::move_to(const PixelWindow& region) {
  const PixelWindow window = checked(region, rig_.depth);
  if (window.width != depth_.window.width || window.height != depth_.window.height) {
    depth_ = DepthMap(window);
    surface_ = unwritten_surface(rig_.depth, window);
  }
  depth_.window = window;
  surface_.window = window;
}

void Preprocessor::process(const Frame& frame) {
  check(frame, rig_, "the frame's");
  depth_.take(frame, acquisition_.farthest());
  const auto filtered = acquisition_.filter->filter(device_, depth_, rig_.depth);
  acquisition_.normals->write(device_, filtered ? *filtered : depth_, surface_);
  if (filtered && !acquisition_.filters_points) back_project(device_, depth_, surface_);
}

}  // namespace pliant
