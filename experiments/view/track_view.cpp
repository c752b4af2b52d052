#include "experiments/view/track_view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "experiments/view/clustered_mesh.h"
#include "experiments/view/frame_picture.h"
#include "experiments/view/model_distance.h"

namespace pliant {
namespace {

constexpr int most_cells = 3000;
constexpr std::size_t most_vertices = 5000;  // of the model
constexpr float picture_share =
    0.08F;  // of the distance to the object: how far the camera's picture is before it
constexpr float steepest =
    4;  // neighbours are joined that lie so many times further apart than when seen face on

int cells(int length, int spacing) { return (length + spacing - 1) / spacing; }

/// Of what a map shows; 0 of nothing.
float median_depth(const SurfaceMap& map) {
  std::vector<float> depths;
  const std::vector<float>& points = map.points().host();
  for (std::size_t i = 2; i < points.size(); i += 3)
    if (points[i] > 0) depths.push_back(points[i]);
  if (depths.empty()) return 0;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return *middle;
}

/// Where a camera is, then the corners of a picture so far before it.
std::vector<Eigen::Vector3f> camera_shape(const Camera& camera, float distance,
                                          const Eigen::Isometry3d& model_from_camera) {
  const Eigen::Isometry3f motion = model_from_camera.cast<float>();
  std::vector<Eigen::Vector3f> shape{motion.translation()};
  for (const auto& [u, v] :
       {std::pair(0, 0), {camera.width, 0}, {camera.width, camera.height}, {0, camera.height}})
    shape.emplace_back(motion * camera.unproject(u, v, distance).cast<float>());
  return shape;
}

}  // namespace

bool TrackView::show(const TrackedFrame& tracked) {
  if (tracked.model == nullptr) return true;
  if (spacing_ == 0) choose_grid(tracked);
  if (path_.takes_next()) path_.keep(tracked.record.camera_from_model.inverse().translation().cast<float>());
  if (steps_.takes_next()) steps_.keep(step_of(tracked));
  return true;
}

/// As fine as a view has room for.
void TrackView::choose_grid(const TrackedFrame& tracked) {
  const PixelWindow& window = tracked.seen->window;
  spacing_ = 1;
  while (cells(window.width, spacing_) * cells(window.height, spacing_) > most_cells) ++spacing_;
  const float depth = median_depth(*tracked.seen);
  frames_.columns = cells(window.width, spacing_);
  frames_.gap = steepest * static_cast<float>(spacing_) * depth / static_cast<float>(camera_.fx);
  picture_distance_ = picture_share * depth;
}

ViewData::Step TrackView::step_of(const TrackedFrame& tracked) const {
  const Eigen::Isometry3d model_from_camera = tracked.record.camera_from_model.inverse();
  const PixelWindow& window = tracked.seen->window;
  const Image<float> distances = model_distances(*tracked.seen, *tracked.model);
  const std::vector<float>& points = tracked.seen->points().host();
  ViewData::Step step;
  step.number = tracked.record.number;
  step.state = to_string(tracked.record.state);
  step.camera = camera_shape(camera_, picture_distance_, model_from_camera);
  for (int v = 0; v < window.height; v += spacing_)
    for (int u = 0; u < window.width; u += spacing_) {
      const std::size_t at =
          static_cast<std::size_t>(v) * static_cast<std::size_t>(window.width) + static_cast<std::size_t>(u);
      const Eigen::Map<const Eigen::Vector3f> point(points.data() + 3 * at);
      if (!(point.z() > 0)) continue;
      step.points.emplace_back(model_from_camera.cast<float>() * point);
      step.nearest.push_back(distances.data()[at]);
      step.cells.push_back(v / spacing_ * frames_.columns + u / spacing_);
    }
  return step;
}

ViewData TrackView::view(const Mesh& model, std::vector<std::uint8_t> picture) const {
  ViewData view;
  view.target = clustered_mesh(model, most_vertices);
  view.steps = steps_.kept();
  view.result = view.steps.size() - 1;
  view.frames = frames_;
  view.frames->path = path_.kept();
  view.scale = error_scale(view.steps[view.steps.size() / 2].nearest).highest;
  view.picture = std::move(picture);
  return view;
}

}  // namespace pliant
