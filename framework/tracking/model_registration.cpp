#include "framework/tracking/model_registration.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "framework/core/error.h"
#include "framework/deformation/warp.h"
#include "framework/geometry/pixel_index.h"
#include "framework/tracking/folded_cells.h"

namespace pliant {
namespace {

/// Of the matched points, how many cells may be turned inside out: the noise at a rim folds some.
constexpr double most_folded_share = 0.01;

/// Of the matches before, how many must be left: losing those that fit worst is no gain.
constexpr double least_kept_matches = 0.98;

/// What is registered: the points of a map, and behind them those of a graph that it must use.
struct Source {
  std::vector<int> offsets;  ///< of the points, in the map's window
  PixelIndex pixels;
  PointSet rest;
  std::optional<GivenGraph> graph;
};

PointSet points_and_nodes(Device& device, const DeformationStart& start, const std::vector<int>& offsets) {
  const Array<int> indices(offsets);
  if (start.nodes.empty()) return pick_points(device, start.rest.map, indices);
  PointSet all = no_points(device, offsets.size() + start.nodes.size());
  std::vector<int> places(offsets.size());
  std::iota(places.begin(), places.end(), 0);
  place_points(device, pick_points(device, start.rest.map, indices), Array<int>(places), all);
  places.resize(start.nodes.size());
  std::iota(places.begin(), places.end(), static_cast<int>(offsets.size()));
  PointSet nodes = no_points(device, start.nodes.size());
  nodes.points = flatten(start.nodes);
  place_points(device, nodes, Array<int>(places), all);
  return all;
}

Source source_of(Device& device, DeformationStart start) {
  std::vector<int> offsets = indices_of_points(device, start.rest.map);
  PixelIndex pixels(start.rest.window, offsets);
  PointSet rest = points_and_nodes(device, start, offsets);
  Source source{std::move(offsets), std::move(pixels), std::move(rest), std::nullopt};
  if (start.nodes.empty()) return source;
  std::vector<int> nodes(start.nodes.size());
  std::iota(nodes.begin(), nodes.end(), static_cast<int>(source.offsets.size()));
  source.graph = GivenGraph{std::move(nodes), std::move(start.affine)};
  return source;
}

std::string why_rejected(const RegistrationRecord& registration, const TrackingError& before,
                         const TrackingError& after, double min_gain) {
  if (registration.folded_cells > most_folded_share * after.matched)
    return fmt::format("{} cells of the surface are folded", registration.folded_cells);
  if (after.matched < least_kept_matches * before.matched)
    return fmt::format("only {} of {} points would still match", after.matched, before.matched);
  if (!(after.mean < (1 - min_gain) * before.mean))  // not where nothing is matched, either
    return fmt::format("the error would go from {:.3f} to {:.3f} mm", before.mean, after.mean);
  return {};
}

/// The rigid motion of least weighted squares [Kabsch 1976].
Eigen::Isometry3d fitted_motion(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to,
                                const Eigen::VectorXd& weights) {
  const Eigen::Vector3d middle_from = from * weights / weights.sum();
  const Eigen::Vector3d middle_to = to * weights / weights.sum();
  const Eigen::Matrix3d spread =
      (to.colwise() - middle_to) * weights.asDiagonal() * (from.colwise() - middle_from).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(spread, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d signs(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1);
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  motion.translation() = middle_to - motion.linear() * middle_from;
  return motion;
}

}  // namespace

/// Weights of Geman and McClure's loss fall from those of least squares to those that leave out what deforms.
Eigen::Isometry3d common_motion(const EmbeddedGraph& graph, const Array<float>& affine) {
  constexpr int iterations = 12;
  constexpr double narrowing = 0.6;  // of the loss, from one to the next
  constexpr double least_scale = 1;  // mm
  const auto count = static_cast<Eigen::Index>(graph.positions.size());
  Eigen::Matrix3Xd from(3, count);
  Eigen::Matrix3Xd to(3, count);
  for (Eigen::Index j = 0; j < count; ++j) {
    from.col(j) = graph.positions[static_cast<std::size_t>(j)].cast<double>();
    to.col(j) = from.col(j) +
                Eigen::Map<const Eigen::Vector3f>(affine.host().data() + affine_size * j + 9).cast<double>();
  }
  const auto distances_of = [&](const Eigen::Isometry3d& motion) -> Eigen::ArrayXd {
    return ((motion.linear() * from).colwise() + motion.translation() - to).colwise().norm().transpose();
  };
  Eigen::Isometry3d motion = fitted_motion(from, to, Eigen::VectorXd::Ones(count));
  Eigen::ArrayXd distances = distances_of(motion);
  double scale = distances.maxCoeff();
  for (int iteration = 0; iteration < iterations; ++iteration) {
    scale = std::max(least_scale, narrowing * scale);
    motion = fitted_motion(from, to, (1 + (distances / scale).square()).square().inverse());
    distances = distances_of(motion);
  }
  return motion;
}

Eigen::Isometry3d ModelRegistration::run(DeformingModel& model, const SurfaceMap& view,
                                         const SurfaceMap& seen, const Eigen::Isometry3d& camera_from_model,
                                         TrackingErrorMeter& meter, FrameRecord& record) const {
  const TrackingError before = meter.measure(view, seen);
  RegistrationRecord& registration = record.registration.emplace();
  const auto reject = [&](const std::string& reason) {
    registration.is_rejected = true;
    registration.reason = reason;
  };
  try {
    DeformationStart start = model.start();
    const Source source = source_of(device_, std::move(start));
    static const std::string name = "the model";
    const PointMatches none;
    const NonRigidInput input{
        name, source.pixels, source.rest, seen, 0, none, source.graph ? &*source.graph : nullptr};
    Deformation deformation = NonRigid(method_, device_).deform(input);
    SurfaceMap moved(view.camera, view.window, no_points(device_, view.window.size()));
    place_points(device_, deformation.points, Array<int>(source.offsets), moved.map);
    const TrackingError after = meter.measure(moved, seen);
    registration.iterations = deformation.iterations;
    registration.nodes = static_cast<int>(deformation.graph->nodes.size());
    registration.constraints = deformation.constraints;
    registration.folded_cells = count_folded_cells(device_, moved);
    registration.reason = why_rejected(registration, before, after, min_gain_);
    registration.is_rejected = !registration.reason.empty();
    if (registration.is_rejected) return camera_from_model;
    registration.reason = deformation.reason.empty() ? deformation.termination : deformation.reason;
    Eigen::Isometry3d pose_after = common_motion(*deformation.graph, deformation.affine) * camera_from_model;
    model.deform({*deformation.graph, deformation.affine, moved, method_.nearest_nodes, camera_from_model,
                  pose_after});
    record.error = after;
    return pose_after;
  } catch (const DataError& error) {
    reject(error.what());
  } catch (const NumericalError& error) {
    reject(error.what());
  }
  return camera_from_model;
}

}  // namespace pliant
