#include "experiments/tasks/registration_view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "experiments/report/heat_map.h"
#include "experiments/tasks/drawings.h"
#include "experiments/tasks/iteration_recorder.h"
#include "experiments/tasks/thinned_surface.h"
#include "framework/geometry/bounding_box.h"

namespace pliant {
namespace {

constexpr int most_iterations = 11;            // and the start
constexpr std::size_t most_constraints = 700;  // lines of a step
constexpr float surroundings = 0.15F;          // of the source's size, that are shown of the target

/// Evenly chosen, with the last one and that of the result.
std::set<int> chosen_iterations(const RegistrationResult& result) {
  const int last = result.counts.outer_iterations;
  const int count = std::min(last, most_iterations);
  std::set<int> numbers;
  for (int i = 1; i <= count; ++i)
    numbers.insert(static_cast<int>(std::lround(static_cast<double>(i) * last / count)));
  if (result.returned_iteration > 0) numbers.insert(result.returned_iteration);
  return numbers;
}

/// What of the target lies around the source, wherever it is moved.
Surface near(const Surface& target, const RegistrationResult& result) {
  Eigen::AlignedBox3f box;
  for (const auto* points : {&result.source.points, &result.aligned_points, &result.points})
    box.extend(box_around(*points));
  const Eigen::Vector3f air = Eigen::Vector3f::Constant(surroundings * box.sizes().maxCoeff());
  const Eigen::AlignedBox3f around(box.min() - air, box.max() + air);
  Surface part;
  for (std::size_t i = 0; i < target.size(); ++i) {
    if (!around.contains(target.points[i])) continue;
    part.points.push_back(target.points[i]);
    part.pixels.push_back(target.pixels[i]);
  }
  return part;
}

/// Evenly chosen.
template <class T>
std::vector<T> some(const std::vector<T>& all, std::size_t most) {
  const std::size_t step = (all.size() + most - 1) / most;
  std::vector<T> chosen;
  for (std::size_t i = 0; i < all.size(); i += step) chosen.push_back(all[i]);
  return chosen;
}

/// Fits the result: what is worse, as the start may be, has the colour of the end. True errors may be many
/// times the distances to the target, which should still be told apart.
float scale_of(const ViewData::Step& result) {
  return static_cast<float>(
      round_up(std::max({quantile(result.nearest, 0.95), quantile(result.truth, 0.5), 0.1F})));
}

class Gathering {
 public:
  explicit Gathering(const Registration& registration)
      : made_(registration),
        recorder_(registration.device, chosen_iterations(registration.result)),
        evaluation_(registration.pair, registration.truth, registration.result.source, registration.target) {
    register_pair(made_.pair, made_.method, made_.device, made_.seed, recorder_.observer());
  }

  ViewData gather() const {
    const RegistrationResult& result = made_.result;
    const std::size_t most = view_points(recorder_.iterations().size() + 1, made_.truth.has_value());
    const ThinnedSurface source(result.source, most);
    const Surface around = near(make_surface(made_.target, {}), result);
    const ThinnedSurface target(around, most);
    ViewData view;
    view.source = {source.of(result.source.points), source.triangles()};
    view.target = {target.of(around.points), target.triangles()};
    view.matched = source.of(result.matched);
    for (const auto& graph : recorder_.graphs()) view.graphs.push_back(graph_of(graph, source));
    view.steps.push_back(step({0, recorder_.rest(), 0, {}}, source));
    for (const auto& iteration : recorder_.iterations()) {
      if (iteration.number == result.returned_iteration) view.result = view.steps.size();
      view.steps.push_back(step(iteration, source));
    }
    view.scale = scale_of(view.steps[view.result]);
    view.picture = made_.picture.png();
    return view;
  }

 private:
  static ViewData::Graph graph_of(const IterationRecorder::Graph& graph, const ThinnedSurface& source) {
    ViewData::Graph shown{graph.edges, {}};
    std::set<std::pair<int, int>> drawn;  // neighbours share a rim
    for (const GraphCell& cell : graph.cells) {
      shown.cells.push_back(source.outline(cell));
      std::erase_if(shown.cells.back().lines, [&](const auto& line) {
        return !drawn.insert(std::minmax(line.first, line.second)).second;
      });
    }
    return shown;
  }

  ViewData::Step step(const IterationRecorder::Iteration& iteration, const ThinnedSurface& source) const {
    const std::vector<Eigen::Vector3f> points = as_given(iteration.points);
    ViewData::Step step;
    step.number = iteration.number;
    step.points = source.of(points);
    step.nearest = evaluation_.nearest(step.points);
    const std::vector<float> errors = evaluation_.end_point_errors(points);
    if (!errors.empty()) step.truth = source.of(errors);
    step.graph = iteration.graph;
    if (!recorder_.graphs().empty())
      for (const int node : recorder_.graphs()[iteration.graph].nodes)
        step.nodes.push_back(points[static_cast<std::size_t>(node)]);
    step.constraints = some(iteration.constraints, most_constraints);
    step.constraint_count = iteration.constraints.size();
    return step;
  }

  /// The source's points as they were given, moved as those that a filter made of them were.
  std::vector<Eigen::Vector3f> as_given(const std::vector<Eigen::Vector3f>& moved) const {
    std::vector<Eigen::Vector3f> points = made_.result.aligned_points;
    for (std::size_t i = 0; i < moved.size(); ++i) points[i] = moved[i] + (points[i] - recorder_.rest()[i]);
    return points;
  }

  const Registration& made_;
  IterationRecorder recorder_;
  Evaluation evaluation_;
};

}  // namespace

ViewData gather_view(const Registration& registration) { return Gathering(registration).gather(); }

}  // namespace pliant
