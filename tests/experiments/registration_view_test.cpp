#include "experiments/tasks/registration_view.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "experiments/runner/runner.h"
#include "experiments/tasks/iteration_recorder.h"
#include "experiments/tasks/thinned_surface.h"
#include "tests/experiments/experiment_files.h"

namespace pliant::test {
namespace {

/// A plane of width x height pixels with a hole at (4, 4).
Surface plane(int width, int height) {
  Surface surface;
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      if (u == 4 && v == 4) continue;
      surface.points.emplace_back(u, v, 800);
      surface.pixels.emplace_back(u, v);
    }
  return surface;
}

TEST(ThinnedSurface, LeavesEveryNthPixelAndJoinsThem) {
  const Surface surface = plane(16, 12);
  EXPECT_EQ(ThinnedSurface(surface, 191).size(), 191U);
  const ThinnedSurface thinned(surface, 100);
  EXPECT_EQ(thinned.size(), 8U * 6 - 1);
  EXPECT_EQ(thinned.triangles().size(), 2U * 7 * 5 - 6) << "none with a corner in the hole";
  for (const Eigen::Vector3f& point : thinned.of(surface.points)) {
    EXPECT_EQ(std::fmod(point.x(), 2), 0);
    EXPECT_EQ(std::fmod(point.y(), 2), 0);
  }
  EXPECT_EQ(ThinnedSurface(Surface{}, 10).size(), 0U);
}

TEST(ThinnedSurface, FollowsTheRimOfACell) {
  const Surface surface = plane(16, 12);
  const ThinnedSurface thinned(surface, 100);
  const auto points = thinned.of(surface.points);
  const auto outline = thinned.outline({4, 4, 12, 8, 2, false});
  EXPECT_EQ(outline.level, 2);
  EXPECT_EQ(outline.lines.size(), 2U * (4 + 2) - 2) << "the hole is one of its corners";
  for (const auto& [from, to] : outline.lines)
    EXPECT_EQ((points[static_cast<std::size_t>(from)] - points[static_cast<std::size_t>(to)]).norm(), 2);
  EXPECT_TRUE(thinned.outline({-40, -40, -20, -20, 1, false}).lines.empty());
}

const std::string adaptive =
    "data: {noise: 1}\ngraph: {type: quadtree}\nsampler: {type: adaptive, threshold: 1}\n";

class RegistrationViewTest : public ExperimentFiles {
 protected:
  /// What the run of an experiment comes to, and its view.
  void make(const std::string& text) {
    plan_.emplace(plan(text));
    made_.emplace(make_register_task()->make(plan_->runs.at(0), workbench_, {[](const Progress&) {}}));
  }
  const ViewData& view() const { return made_->view->data(); }

  /// The registration of which the view is.
  RegistrationResult result() {
    const ExperimentRun& run = plan_->runs.at(0);
    return register_pair(workbench_.pair(run.values), make_method(run, registry_),
                         workbench_.device(run.values),
                         static_cast<std::uint64_t>(run.values.integer("seed")));
  }

  std::optional<ExperimentPlan> plan_;
  std::optional<RunArtefacts> made_;
};

/// Whatever the method follows: all points, or those that are constrained.
TEST_F(RegistrationViewTest, ItsResultIsThatOfTheRunBitForBit) {
  for (const char* text : {"filter: {type: bilateral}\n", adaptive.c_str()}) {
    make(text);
    const RegistrationResult registered = result();
    const ThinnedSurface thinned(registered.source, view_points(view().steps.size(), true));
    ASSERT_EQ(view().steps.at(view().result).number, registered.returned_iteration);
    EXPECT_EQ(view().steps[view().result].points, thinned.of(registered.points)) << text;
    EXPECT_EQ(view().steps.front().points, thinned.of(registered.aligned_points));
    EXPECT_EQ(view().source.points, thinned.of(registered.source.points));
    EXPECT_EQ(view().matched, thinned.of(registered.matched));
  }
}

TEST_F(RegistrationViewTest, TellsHowFarEachStepIsFromTargetAndTruth) {
  make("");
  const auto mean = [](const std::vector<float>& values) {
    double sum = 0;
    for (const float value : values) sum += value;
    return sum / static_cast<double>(values.size());
  };
  const auto& steps = view().steps;
  // All points of so small a sheet are shown.
  EXPECT_NEAR(mean(steps.front().nearest), made_->json["aligned"]["nearest_mean"], 0.3);
  EXPECT_NEAR(mean(steps[view().result].nearest), made_->json["metrics"]["nearest_mean"], 0.05);
  EXPECT_NEAR(mean(steps[view().result].truth), made_->json["metrics"]["epe_mean"], 0.1);
  EXPECT_GT(view().scale, mean(steps[view().result].nearest));
}

TEST_F(RegistrationViewTest, KeepsGraphsNodesAndConstraints) {
  make(adaptive);
  const auto& last = view().steps.back();
  ASSERT_LT(last.graph, view().graphs.size());
  EXPECT_EQ(last.nodes.size(), made_->json["counts"]["nodes"]);
  EXPECT_FALSE(view().graphs[last.graph].cells.empty());
  for (const Edge& edge : view().graphs[last.graph].edges)
    EXPECT_LT(static_cast<std::size_t>(std::max(edge.from, edge.to)), last.nodes.size());
  EXPECT_EQ(view().steps.front().constraint_count, 0U);
  EXPECT_GT(last.constraint_count, 100U);
  EXPECT_LE(last.constraints.size(), 700U);
  for (const auto& [from, to] : last.constraints) EXPECT_LT((from - to).norm(), 60);
}

TEST_F(RegistrationViewTest, HasAboutADozenStepsOfALongRun) {
  make(
      "stopping: {max_iterations: 30, min_progress: 0, min_gain: 0, residual: 0}\nschedule: {iterations: "
      "30}\n");
  const int last = made_->json["counts"]["outer_iterations"];
  ASSERT_GT(last, 14);
  EXPECT_LE(view().steps.size(), 13U);
  EXPECT_GE(view().steps.size(), 12U);
  EXPECT_EQ(view().steps.front().number, 0);
  EXPECT_EQ(view().steps.back().number, last);
  for (std::size_t i = 1; i < view().steps.size(); ++i) {
    const int gap = view().steps[i].number - view().steps[i - 1].number;
    EXPECT_GE(gap, 1);
    EXPECT_LE(gap, 3);
  }
}

TEST_F(RegistrationViewTest, WithoutTruthTellsOfTheTargetAlone) {
  const ExperimentPlan planned = plan("");
  const FramePair& pair = workbench_.pair(planned.runs[0].values);
  const Method method = make_method(planned.runs[0], registry_);
  Device& device = workbench_.device(planned.runs[0].values);
  const RegistrationResult registered = register_pair(pair, method, device, 1);
  const SurfaceImage target = make_surface_image(pair.target, pair.camera);
  const Picture picture("", "", [] { return std::vector<std::uint8_t>{1}; });
  const ViewData gathered = gather_view({pair, std::nullopt, method, device, 1, registered, target, picture});
  EXPECT_TRUE(gathered.steps.front().truth.empty());
  EXPECT_FALSE(gathered.steps.front().nearest.empty());
  EXPECT_EQ(gathered.picture, std::vector<std::uint8_t>{1});
}

/// What it keeps is of the iterations it was asked for, and in their order.
TEST_F(RegistrationViewTest, ARecorderKeepsTheIterationsItWasAskedFor) {
  const ExperimentPlan planned =
      plan("stopping: {max_iterations: 4, min_progress: 0, min_gain: 0, residual: 0}\n");
  const ExperimentRun& run = planned.runs[0];
  Device& device = workbench_.device(run.values);
  IterationRecorder recorder(device, {1, 3, 99});
  register_pair(workbench_.pair(run.values), make_method(run, registry_), device, 1, recorder.observer());
  ASSERT_EQ(recorder.iterations().size(), 2U);
  EXPECT_EQ(recorder.iterations()[0].number, 1);
  EXPECT_EQ(recorder.iterations()[1].number, 3);
  EXPECT_EQ(recorder.graphs().size(), 1U) << "a graph that stays is kept once";
}

TEST_F(RegistrationViewTest, IsWrittenWhereAReportAsksForIt) {
  const ExperimentPlan planned = plan("reports: {view: , page: {view: false}}\n");
  run_experiment(*make_register_task(), planned, file("out"), workbench_);
  EXPECT_THAT(text_of("out/view.json"), ::testing::HasSubstr("\"steps\""));
  EXPECT_THAT(text_of("out/.pliant"), ::testing::HasSubstr("view.json"));
  EXPECT_THAT(text_of("out/index.html"), ::testing::Not(::testing::HasSubstr("class=\"view-figure\"")));
}

}  // namespace
}  // namespace pliant::test
