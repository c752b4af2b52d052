#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "framework/core/error.h"
#include "framework/deformation/warp.h"
#include "framework/registration/history.h"
#include "framework/registration/nonrigid.h"
#include "framework/tracking/method.h"
#include "framework/tracking/scene.h"
#include "tests/experiments/experiment_files.h"
#include "tests/registration/scripted_solver.h"

// Registration as who follows a surface asks for it: where it ended, and from a graph that is there already.
namespace pliant::test {
namespace {

using ::testing::HasSubstr;

/// Leaves the unknowns as they are.
class IdleSolver : public Solver {
 public:
  std::unique_ptr<BoundSolver> bind(Problem&, Device&) const override { return std::make_unique<Bound>(); }

 private:
  class Bound : public BoundSolver {
    void solve() override { ++solves_; }
    std::vector<SolverSummary> summaries() override { return std::vector<SolverSummary>(solves_); }
    std::size_t solves_ = 0;
  };
};

class DeformTest : public ExperimentFiles {
 protected:
  Parameters values_of(const std::vector<std::string>& sets) const { return plan("", sets).runs[0].values; }
  Method method_of(const std::vector<std::string>& sets) const {
    return make_method(values_of(sets), registry_);
  }
  Scene scene_of(const std::vector<std::string>& sets, const Method& method) {
    pair_ = workbench_.pair(values_of(sets));
    StageTimes times;
    return make_scene(pair_, method, device_, 1, times);
  }

  Device device_;
  FramePair pair_;
};

TEST_F(DeformTest, GivesThePointsOfTheLastIteration) {
  const std::vector<std::pair<std::string, int>> cases{{"{type: uniform, step: 4}", 1},
                                                       {"{type: adaptive, threshold: 1}", 2}};
  for (const auto& [sampler, iterations] : cases) {
    SCOPED_TRACE(sampler);
    const std::vector<std::string> sets{
        "stopping={min_progress: 0, max_iterations: " + std::to_string(iterations) + "}",
        "sampler=" + sampler};
    const Method method = method_of(sets);
    const Scene scene = scene_of(sets, method);
    const NonRigid registration(method, device_);
    const NonRigidResult result = registration.run(input_of(scene));
    ASSERT_EQ(result.returned_iteration, iterations) << "the last one is the best";
    const Deformation deformation = registration.deform(input_of(scene));
    EXPECT_EQ(unflatten(deformation.points.points), result.points);
    EXPECT_EQ(unflatten(deformation.points.normals), result.normals);
    EXPECT_EQ(deformation.graph->positions, result.node_positions);
    EXPECT_EQ(deformation.affine.size(), affine_size * result.node_positions.size());
    EXPECT_EQ(deformation.iterations, result.counts.outer_iterations);
    EXPECT_EQ(deformation.constraints, result.counts.constraints);
    EXPECT_EQ(deformation.termination, result.termination);
  }
}

TEST_F(DeformTest, ChoosesNotAmongTheIterations) {
  const std::vector<std::string> sets{"stopping={min_progress: 0, max_iterations: 2}"};
  Method method = method_of(sets);
  method.solver = std::make_unique<ScriptedSolver>(std::vector<float>{0.5, -25});
  const Scene scene = scene_of(sets, method);
  const NonRigid registration(method, device_);
  EXPECT_LT(registration.run(input_of(scene)).returned_iteration, 2);
  const Deformation deformation = registration.deform(input_of(scene));
  const std::vector<float>& rest = scene.rest.points.host();
  const std::vector<float>& points = deformation.points.points.host();
  ASSERT_EQ(points.size(), rest.size());
  for (std::size_t i = 0; i < rest.size(); ++i) ASSERT_NEAR(points[i] - rest[i], i % 3 == 2 ? -25 : 0, 1e-3);
}

TEST_F(DeformTest, AnIterationWithoutAnAnswerLeavesItWhereTheOneBeforeLed) {
  const std::vector<std::string> sets{"stopping={min_progress: 0, max_iterations: 9}"};
  Method method = method_of(sets);
  method.solver = std::make_unique<ScriptedSolver>(std::vector<float>{0.5, 1});
  const Scene scene = scene_of(sets, method);
  const Deformation deformation = NonRigid(method, device_).deform(input_of(scene));
  EXPECT_EQ(deformation.termination, "failed");
  EXPECT_THAT(deformation.reason, HasSubstr("the script is at its end"));
  EXPECT_EQ(deformation.iterations, 2);
  EXPECT_NEAR(deformation.points.points.host()[2] - scene.rest.points.host()[2], 1, 1e-3);
}

/// The surface of a scene too far from its target to be matched, and behind its points nodes that know how
/// far: every fiftieth point, beside the surface.
struct Sunk {
  static constexpr float depth = 200;  // mm

  PointSet rest;
  std::vector<Eigen::Vector3f> nodes;
  GivenGraph graph;

  explicit Sunk(const Scene& scene) {
    std::vector<Eigen::Vector3f> points = unflatten(scene.rest.points);
    std::vector<Eigen::Vector3f> normals = unflatten(scene.rest.normals);
    for (Eigen::Vector3f& point : points) point.z() += depth;
    for (std::size_t i = 0; i < scene.pixels.count; i += 50) {
      graph.nodes.push_back(static_cast<int>(points.size()));
      nodes.push_back(points[i] + Eigen::Vector3f(1, 2, 3));
      points.push_back(nodes.back());
      normals.emplace_back(0, 0, 0);
    }
    rest = {flatten(points), flatten(normals)};
    graph.affine = Array<float>(lifted(nodes.size(), -depth));
  }

  NonRigidInput input(const Scene& scene, bool has_graph = true) const {
    return {
        scene.pair.name, scene.pixels, rest, scene.target, 0, scene.features, has_graph ? &graph : nullptr};
  }
};

int count_in_force(const Problem& problem) {
  int count = 0;
  for (const Term& term : problem.terms())
    if (term.constraints)
      for (const float confidence : term.constraints->confidence.host()) count += confidence > 0 ? 1 : 0;
  return count;
}

const std::vector<std::vector<std::string>> kSamplers{{"sampler={type: uniform, step: 4}"},
                                                      {"sampler={type: adaptive, threshold: 1}"}};

TEST_F(DeformTest, AGivenGraphIsTheGraphAndItsFormsAreTheStart) {
  for (const auto& sets : kSamplers) {
    SCOPED_TRACE(sets.front());
    const Method method = method_of(sets);
    const Scene scene = scene_of(sets, method);
    const Sunk sunk(scene);
    const NonRigid registration(method, device_);
    const auto problem = registration.freeze(sunk.input(scene));
    EXPECT_EQ(problem->graph().nodes, sunk.nodes);
    EXPECT_EQ(problem->unknowns().host(), sunk.graph.affine.host());
    EXPECT_GT(count_in_force(*problem), 100);
    EXPECT_EQ(count_in_force(*registration.freeze(sunk.input(scene, false))), 0)
        << "from the identity there is nothing to match";
  }
}

TEST_F(DeformTest, AGivenGraphMovesAllPointsAsItsFormsSay) {
  for (const auto& sets : kSamplers) {
    SCOPED_TRACE(sets.front());
    Method method = method_of(sets);
    method.solver = std::make_unique<IdleSolver>();
    const Scene scene = scene_of(sets, method);
    Sunk sunk(scene);
    auto& affine = sunk.graph.affine.write_host();
    for (std::size_t i = 0; i < affine.size(); ++i)
      affine[i] += 0.002F * static_cast<float>(i % 7) - 0.006F;  // not all nodes alike
    const Deformation deformation = NonRigid(method, device_).deform(sunk.input(scene));
    EXPECT_EQ(deformation.affine.host(), sunk.graph.affine.host());
    EXPECT_EQ(deformation.graph->nodes, sunk.graph.nodes);
    const auto influences =
        compute_influences_reference(sunk.rest.points.host(), sunk.nodes, method.nearest_nodes);
    const PointSet expected = warp_reference(sunk.rest, influences, flatten(sunk.nodes), sunk.graph.affine);
    ASSERT_EQ(deformation.points.points.size(), expected.points.size());
    for (std::size_t i = 0; i < expected.points.size(); ++i)
      ASSERT_NEAR(deformation.points.points.host()[i], expected.points.host()[i], 0.01);
  }
}

TEST_F(DeformTest, ARegistrationGoesOnFromAGivenGraph) {
  for (const auto& sets : kSamplers) {
    SCOPED_TRACE(sets.front());
    const Method method = method_of(sets);
    const Scene scene = scene_of(sets, method);
    const Sunk sunk(scene);
    const NonRigidResult result = NonRigid(method, device_).run(sunk.input(scene));
    EXPECT_EQ(result.node_positions, sunk.nodes);
    EXPECT_LT(result.history.back().residual_mean, 0.5 * result.history.front().residual_mean);
    EXPECT_LE(result.history.front().matched, static_cast<int>(scene.pixels.count))
        << "nodes are not matched";
    ASSERT_EQ(result.matched.size(), result.points.size());
    EXPECT_EQ(std::count(result.matched.begin() + static_cast<std::ptrdiff_t>(scene.pixels.count),
                         result.matched.end(), 1),
              0)
        << "nodes are not matched";
    EXPECT_EQ(std::accumulate(result.matched.begin(), result.matched.end(), 0), result.counts.matched_points);
  }
}

TEST(History, KeepsTheBestState) {
  const StoppingRule rule;
  const Schedule schedule;
  History history(rule, schedule);
  const auto graph = std::make_shared<const EmbeddedGraph>();
  const auto later_graph = std::make_shared<const EmbeddedGraph>();
  const auto add = [&](double robust, const std::shared_ptr<const EmbeddedGraph>& of, float unknown) {
    history.add({.mean = robust, .matched = 10, .robust = robust}, of,
                Array<float>(std::vector<float>{unknown}));
  };
  add(5, graph, 0);
  add(2, graph, 1);
  add(3, later_graph, 2);
  history.close();
  EXPECT_EQ(history.best().iteration, 1U);
  EXPECT_EQ(history.best().graph, graph);
  EXPECT_EQ(history.best().unknowns.host(), std::vector<float>{1});
}

}  // namespace
}  // namespace pliant::test
