#include "framework/tracking/model_registration.h"

#include <fmt/format.h>

#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "framework/core/error.h"
#include "framework/geometry/pixel_index.h"
#include "framework/tracking/folded_cells.h"

namespace pliant {
namespace {

/// Of the matched points, how many cells may be turned inside out: the noise at a rim folds some.
constexpr double most_folded_share = 0.01;

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
                         const TrackingError& after) {
  if (registration.folded_cells > most_folded_share * after.matched)
    return fmt::format("{} cells of the surface are folded", registration.folded_cells);
  if (!(after.robust <= before.robust))
    return fmt::format("the model would lie further from the frame: {:.2f} instead of {:.2f} mm (robust)",
                       after.robust, before.robust);
  return {};
}

}  // namespace

TrackingError TrackingErrorMeter::measure(const PointSet& points) {
  meter_.measure(points);
  const Residual residual = meter_.read();
  return {residual.mean, residual.deviation, residual.matched, residual.robust};
}

void ModelRegistration::run(DeformingModel& model, const SurfaceMap& view, const SurfaceMap& seen,
                            const Eigen::Isometry3d& camera_from_model, TrackingErrorMeter& meter,
                            FrameRecord& record) const {
  record.rigid_error = record.error = meter.measure(view.map);
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
    const TrackingError after = meter.measure(moved.map);
    registration.iterations = deformation.iterations;
    registration.nodes = static_cast<int>(deformation.graph->nodes.size());
    registration.constraints = deformation.constraints;
    registration.folded_cells = count_folded_cells(device_, moved);
    registration.reason = why_rejected(registration, record.rigid_error, after);
    registration.is_rejected = !registration.reason.empty();
    if (registration.is_rejected) return;
    registration.reason = deformation.reason.empty() ? deformation.termination : deformation.reason;
    model.deform({*deformation.graph, deformation.affine, moved, method_.nearest_nodes, camera_from_model});
    record.error = after;
  } catch (const DataError& error) {
    reject(error.what());
  } catch (const NumericalError& error) {
    reject(error.what());
  }
}

}  // namespace pliant
