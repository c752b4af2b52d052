#include "framework/model/warp_field.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "framework/core/error.h"
#include "framework/deformation/warp.h"
#include "framework/model/view_gaps.cl.embed.h"

namespace pliant {
namespace {

constexpr std::size_t most_candidates = 16384;  // pixels of a view that are looked at for new nodes
constexpr std::size_t gap_block = 16;           // BLOCK of view_gaps.cl

/// Offsets in a window of pixels on a square grid, few enough.
Array<int> pixels_on_grid(const PixelWindow& window) {
  const double share = static_cast<double>(window.size()) / static_cast<double>(most_candidates);
  const int step = std::max(1, static_cast<int>(std::ceil(std::sqrt(share))));
  std::vector<int> pixels;
  for (int row = 0; row < window.height; row += step)
    for (int column = 0; column < window.width; column += step) pixels.push_back(row * window.width + column);
  return Array<int>(std::move(pixels));
}

}  // namespace

WarpField::WarpField(Device& device, std::unique_ptr<Tsdf> canonical, double node_spacing)
    : device_(device), canonical_(std::move(canonical)), node_spacing_(node_spacing), view_({}, {}, {}) {}

void WarpField::integrate(const DepthMap& depth, const Camera& camera,
                          const Eigen::Isometry3d& camera_from_model) {
  if (!is_deformed_) return canonical_->integrate(depth, camera, camera_from_model);
  if (!lattice_is_current_) update_lattice();
  canonical_->integrate(depth, camera, camera_from_model, *lattice_);
}

void WarpField::update_lattice() {
  if (!lattice_) {
    lattice_.emplace(canonical_->grid());
    lattice_points_ = CarriedPoints(lattice_->points_at_rest(device_));
  }
  lattice_points_.move(device_, field_);
  lattice_->displace(device_, lattice_points_.rest(), lattice_points_.now());
  lattice_is_current_ = true;
}

const SurfaceMap& WarpField::view(const Camera& camera, const PixelWindow& window,
                                  const Eigen::Isometry3d& camera_from_model) {
  rest_ = &canonical_->raycast(camera, window, camera_from_model);
  camera_from_model_ = camera_from_model;
  if (!is_deformed_ || window.size() == 0) return *rest_;
  warp_view();
  return view_;
}

void WarpField::warp_view() {
  const std::size_t count = rest_->window.size();
  view_.camera = rest_->camera;
  view_.window = rest_->window;
  if (view_.points().size() != 3 * count) view_.map = {Array<float>(3 * count), Array<float>(3 * count)};
  auto fill = device_.kernel(embedded::framework_model_view_gaps_cl, "fill_gaps");
  auto empty = device_.kernel(embedded::framework_model_view_gaps_cl, "empty_gaps");
  const NodeField field = field_.seen_from(device_, camera_from_model_);
  Array<float> filled(3 * count);
  const Buffer& points = rest_->points().device(device_);
  device_.run("warp", fill, (count + gap_block - 1) / gap_block, 16, static_cast<cl_int>(count), points,
              field.points().device(device_), filled.write_device(device_));
  warp(device_, rest_->map, field.influences(device_, filled), field.points(), field.affine(), view_.map);
  device_.run("warp", empty, count, 64, static_cast<cl_int>(count), points,
              view_.map.points.write_device(device_), view_.map.normals.write_device(device_));
}

/// Of the last one, at rest, in the model's frame.
std::vector<Eigen::Vector3f> WarpField::points_in_view() const {
  if (rest_->window.size() == 0) return {};
  std::vector<Eigen::Vector3f> points =
      unflatten(pick_points(device_, rest_->map, pixels_on_grid(rest_->window)).points);
  std::erase_if(points, [](const Eigen::Vector3f& point) { return !(point.z() > 0); });
  const Eigen::Isometry3d model_from_camera = camera_from_model_.inverse();
  for (Eigen::Vector3f& point : points) point = (model_from_camera * point.cast<double>()).cast<float>();
  return points;
}

DeformationStart WarpField::start() {
  if (rest_ == nullptr)
    throw std::logic_error("there is no view of the model that a deformation could start from");
  const std::size_t before = field_.positions().size();
  field_.grow(device_, points_in_view(), node_spacing_);
  lattice_is_current_ = lattice_is_current_ && field_.positions().size() == before;
  const NodeField field = field_.seen_from(device_, camera_from_model_);
  return {*rest_, field.positions(), field.affine().clone()};
}

void WarpField::deform(const ModelDeformation& deformation) {
  if (!deformation.camera_from_model.matrix().allFinite() ||
      !deformation.camera_from_model_after.matrix().allFinite())
    throw NumericalError("the pose of the camera to the model is not finite");
  if (deformation.graph.positions.size() != field_.positions().size())
    throw std::invalid_argument("a deformation of a warp field is of its nodes");
  const Eigen::Matrix3d model_from_camera = deformation.camera_from_model.linear().transpose();
  const Array<float> forms = turned_forms(device_, deformation.affine, model_from_camera);
  field_.take(moved_forms(forms, field_.positions(),
                          deformation.camera_from_model_after.inverse() * deformation.camera_from_model),
              deformation.nearest_nodes);
  is_deformed_ = true;
  lattice_is_current_ = false;
  followed_.move(device_, field_);
}

void WarpField::follow(const Array<float>& points) {
  followed_ =
      is_deformed_ ? CarriedPoints(points_at_rest(device_, field_, points)) : CarriedPoints(points.clone());
  if (is_deformed_) followed_.move(device_, field_);
}

Mesh WarpField::mesh() const {
  Mesh mesh = canonical_->mesh();
  if (!is_deformed_) return mesh;
  CarriedPoints vertices(flatten(mesh.vertices));
  vertices.move(device_, field_);
  mesh.vertices = unflatten(vertices.now());
  return mesh;
}

namespace {

class WarpFieldUpdate : public ModelUpdate {
 public:
  explicit WarpFieldUpdate(const Parameters& section)
      : node_spacing_(section.real("node_spacing")), place_(section.place()) {}

  std::unique_ptr<DeformingModel> make(Device& device, std::unique_ptr<ReferenceModel> model) const override {
    auto* const tsdf = dynamic_cast<Tsdf*>(model.get());
    if (tsdf == nullptr)
      throw ConfigError(
          fmt::format("{}: warp_field: the model must be a tsdf, whose voxels it moves", place_));
    static_cast<void>(model.release());
    return std::make_unique<WarpField>(device, std::unique_ptr<Tsdf>(tsdf), node_spacing_);
  }

 private:
  double node_spacing_;
  std::string place_;
};

}  // namespace

void register_warp_field(Registry& registry) {
  registry.add<ModelUpdate>(
      "warp_field",
      "The model stays as it was at first, and a field of nodes moves it [Newcombe et al., DynamicFusion]",
      {real("node_spacing", 20)
           .unit("mm")
           .range(1, 1e4)
           .doc("From node to node about, each with an affine form; more are added as the surface grows")},
      [](const Parameters& section, const Registry&) { return std::make_unique<WarpFieldUpdate>(section); });
}

}  // namespace pliant
