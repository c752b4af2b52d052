// Surfaces bent by handles: no target, the same graphs, energies and solvers.
#include "framework/registration/edit.h"

#include <gmock/gmock.h>

#include <set>

#include "experiments/runner/runner.h"
#include "framework/config/schema.h"
#include "framework/core/angle.h"
#include "framework/core/error.h"
#include "tests/experiments/experiment_files.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string two_handles =
    "length_unit: 1000\n"
    "solver: {type: gauss_newton, max_iterations: 200}\n"
    "handles:\n"
    "  left: {type: point, at: [-150, 0, 800], radius: 40}\n"
    "  right: {type: point, at: [150, 0, 800], radius: 40, move: [-60, 0, -100], rotate: [0, 50, 0]}\n";

class EditTest : public ExperimentFiles {
 protected:
  ordered_json edit(const ExperimentPlan& plan, const std::string& folder = "out") {
    result_ = run_experiment(*make_edit_task(), plan, file(folder), workbench_);
    return ordered_json::parse(text_of(folder + "/result.json"));
  }

  /// What the first run of an experiment comes to, without a file.
  EditResult bend(const ExperimentPlan& plan) {
    const ExperimentRun& run = plan.runs.at(0);
    return edit_surface(workbench_.pair(run.values), make_handles(run, registry_),
                        make_method(run, registry_), workbench_.device(run.values));
  }

  /// The error that checking ends in; the folder of the test left out.
  std::string error(const std::string& text, const std::vector<std::string>& sets = {}) {
    try {
      check_experiment(plan(text, sets), workbench_);
    } catch (const ConfigError& error) {
      std::string line = error.what();
      const std::string folder = file("");
      for (auto at = line.find(folder); at != std::string::npos; at = line.find(folder))
        line.erase(at, folder.size());
      return line;
    }
    return "";
  }

  ExperimentResult result_;
};

TEST_F(EditTest, ResultTellsOfHandlesAndOfNothingThatNeedsATarget) {
  const ordered_json result = edit(plan(two_handles));
  EXPECT_EQ(result["schema"], 1);
  const ordered_json& run = result["runs"][0];
  EXPECT_THAT(keys_of(run), ElementsAre("name", "warnings", "counts", "metrics", "initial", "handles",
                                        "energy", "time_ms", "timing", "solver"));
  EXPECT_THAT(keys_of(run["counts"]),
              ElementsAre("source_points", "nodes", "edges", "constraints", "unknowns", "solver_iterations"));
  EXPECT_THAT(keys_of(run["metrics"]), ElementsAre("handle_residual_mean", "handle_residual_max"));
  EXPECT_THAT(keys_of(run["handles"]), ElementsAre("left", "right"));
  EXPECT_EQ(run["handles"]["left"]["points"].get<int>() + run["handles"]["right"]["points"].get<int>(),
            run["counts"]["constraints"]);
  EXPECT_EQ(run["handles"]["left"]["residual_initial_mean"], 0);
  EXPECT_EQ(run["energy"]["per_iteration"].size(), run["counts"]["solver_iterations"]);
  EXPECT_EQ(run["solver"]["termination"], "converged");
  std::set<std::string> files;
  for (const auto& entry : fs::directory_iterator(file("out"))) files.insert(entry.path().filename());
  EXPECT_EQ(files, (std::set<std::string>{".pliant", "result.json", "experiment.yaml", "index.html",
                                          "source.ply", "registered.ply", "depth_source.png",
                                          "depth_registered.png", "motion.png", "graph.png"}));
  EXPECT_EQ(run_tables(*make_edit_task(), plan(two_handles), result_).at(0).rows.at(0).link, "index.html");
}

TEST_F(EditTest, TheSurfaceGoesWithTheHandlesAndStaysWhole) {
  const EditResult result = bend(plan(two_handles));
  const auto all = result.all_handles();
  EXPECT_GT(all.initial_mean, 50);
  EXPECT_LT(all.mean, 2);
  // Between the handles it bends rather than stretches: neighbouring points keep their distance.
  double worst = 0;
  for (std::size_t i = 1; i < result.points.size(); ++i) {
    if (result.source.pixels[i].y() != result.source.pixels[i - 1].y()) continue;
    const double before = (result.source.points[i] - result.source.points[i - 1]).norm();
    worst = std::max(worst, std::abs((result.points[i] - result.points[i - 1]).norm() / before - 1));
  }
  EXPECT_LT(worst, 0.35);
  EXPECT_GT(worst, 0) << "and it does bend";
}

TEST_F(EditTest, OneHandleTurnsTheWholeSurfaceRigidly) {
  const EditResult result = bend(plan(
      "length_unit: 1000\nsolver: {max_iterations: 200}\n"
      "handles: {middle: {type: pixel, at: [80, 60], radius: 60, move: [10, 0, 50], rotate: [0, 0, 70]}}\n"));
  const Handle handle{.pixel = Eigen::Vector2i(80, 60),
                      .radius = 60,
                      .move = {10, 0, 50},
                      .rotation = {0, 0, static_cast<float>(70 * degree)}};
  const Grip grip = take_hold(handle, result.source);
  EXPECT_LT((grip.motion.linear() * Eigen::Vector3f::UnitX() -
             Eigen::Vector3f(std::cos(handle.rotation.z()), std::sin(handle.rotation.z()), 0))
                .norm(),
            1e-5F);
  for (std::size_t i = 0; i < result.points.size(); ++i)
    ASSERT_LT((result.points[i] - grip.motion * result.source.points[i]).norm(), 0.5) << "point " << i;
  EXPECT_LT(result.energy.final, 1e-5 * result.energy.initial);
}

TEST_F(EditTest, HandlesThatStayLeaveTheSurfaceAsItIs) {
  const EditResult result = bend(plan("handles: {a: {type: pixel, at: [60, 60], radius: 30}}"));
  EXPECT_EQ(result.energy.initial, 0);
  for (std::size_t i = 0; i < result.points.size(); ++i)
    ASSERT_LT((result.points[i] - result.source.points[i]).norm(), 1e-3) << "point " << i;
}

TEST_F(EditTest, DeviceAndCeresFindTheSameMinimum) {
  for (const std::string more : {"", "graph: {type: quadtree}\n", "transform: quaternion\n",
                                 "energies: {point_to_plane: {weight: 10}}\n"}) {
    SCOPED_TRACE(more);
    const EditResult device = bend(plan(two_handles + more, {"solver.tolerance=1.0e-7"}));
    const EditResult ceres =
        bend(plan(two_handles + more, {"solver={type: ceres_lm, max_iterations: 500, tolerance: 1.0e-9}"}));
    EXPECT_EQ(ceres.solver.name, "ceres_lm");
    EXPECT_GT(ceres.energy.final, 0);
    EXPECT_NEAR(device.energy.final, ceres.energy.final, 1e-4 * ceres.energy.final);
  }
}

TEST_F(EditTest, SolversCanBeComparedOnIt) {
  const ExperimentPlan made =
      plan(two_handles +
           "solvers: {device: {type: gauss_newton, max_iterations: 200}}\ncompare: {repetitions: 1}\n");
  const ordered_json run =
      run_experiment(*make_compare_task(), made, file("out"), workbench_).runs.at(0).json;
  const EditResult bent = bend(made);
  EXPECT_EQ(run["counts"]["nodes"], bent.counts.nodes);
  EXPECT_NEAR(run["solvers"][0]["energy"]["final"], bent.energy.final, 1e-4 * bent.energy.final);
}

TEST_F(EditTest, WhatIsWrongIsToldWithItsPlace) {
  const auto handles = [](const std::string& text) { return "handles:\n  a: {" + text + "}\n"; };
  EXPECT_EQ(error(handles("type: pixel, at: [80, 60], radius: 10")), "");
  EXPECT_EQ(error("handles: {}\n"), "small.yaml:2:1: 'handles' has 0 entries; expected at least 1");
  EXPECT_THAT(error("handles:\n"), HasSubstr("'handles' is empty"));
  EXPECT_THAT(error(handles("type: pixel, at: [80, 60], radius: 10, mvoe: [1, 0, 0]")),
              HasSubstr("small.yaml:3:46: unknown key 'mvoe' in 'handles.a'"));
  EXPECT_THAT(error(handles("type: pixle, at: [80, 60], radius: 10")),
              HasSubstr("small.yaml:3:13: unknown handle 'pixle'"));
  EXPECT_THAT(error(handles("type: pixel, at: [80, 60]")),
              HasSubstr("small.yaml:3:3: missing key 'handles.a.radius'"));
  EXPECT_THAT(error(handles("type: pixel, at: [80, 60], radius: 0")), HasSubstr("above 0 (mm)"));
  EXPECT_THAT(error(handles("type: pixel, at: [80, 60, 2], radius: 5")),
              HasSubstr("small.yaml:3:24: 'handles.a.at' has 3 items; expected a list of 2 finite numbers"));
  EXPECT_EQ(error(handles("type: pixel, at: [0, 60], radius: 10")),
            "small.yaml:3:3: the handle is outside of the surface: there is no point at pixel (0, 60)");
  EXPECT_EQ(error(handles("type: pixel, at: [1.0e+30, 60], radius: 10")),
            "small.yaml:3:3: the handle is outside of the surface: there is no point at pixel (1000000, 60)");
  EXPECT_THAT(
      error(handles("type: point, at: [0, 0, 700], radius: 10")),
      AllOf(HasSubstr("small.yaml:3:3: the handle holds nothing: the nearest point of the surface is 100."),
            HasSubstr(" mm away, its radius is 10 mm")));
  EXPECT_THAT(error("", {"handles={a: {type: pixel, at: [0, 60], radius: 10}}"}),
              HasSubstr("--set handles: the handle is outside of the surface"));
}

TEST_F(EditTest, EnergiesThatHandlesCannotServeAreErrors) {
  const std::string one = "handles: {a: {type: pixel, at: [80, 60], radius: 10}}\n";
  EXPECT_THAT(error(one + "energies: {feature: {weight: 1}}\n"),
              HasSubstr("small.yaml: the energy 'feature' needs a target"));
  EXPECT_THROW(run_experiment(*make_compare_task(),
                              plan(one + "energies: {feature: {weight: 1}}\nsolvers: {a: gauss_newton}\n"),
                              file("out"), workbench_),
               ConfigError);
  write("bare.yaml",
        "data: {type: synthetic_sheet, image_width: 80, image_height: 60, focal_length: 65.6}\n"
        "energies: {rotation: , regularization: }\n" +
            one);
  const ExperimentPlan bare = plan_experiment({file("bare.yaml"), {}, {}, {}}, registry_);
  EXPECT_THROW(check_experiment(bare, workbench_), ConfigError);
}

TEST_F(EditTest, ASolveThatFailsIsAnError) {
  try {
    edit(plan(two_handles + "energies: {constraint: {weight: 1.0e+300}}\n"));
    FAIL() << "there is no finite answer";
  } catch (const NumericalError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("small.yaml: synthetic sheet"), HasSubstr("finite")));
  }
}

TEST_F(EditTest, ARunCannotHaveHandlesAlone) {
  EXPECT_THAT(error("runs: {bent: {handles: {a: {type: pixel, at: [80, 60], radius: 10}}}}\n"),
              HasSubstr("run bent: the run has handles, the experiment has none"));
  const auto variants = plan(
      "handles: {a: {type: pixel, at: [80, 60], radius: 10}}\n"
      "runs: {near: , far: {handles: {a: {move: [0, 0, 90]}}}}\n");
  EXPECT_EQ(edit(variants)["runs"].size(), 2U);
  EXPECT_TRUE(fs::exists(file("out/far/registered.ply")));
}

TEST_F(EditTest, EditorsKnowTheKeys) {
  const auto schema = json_schema(experiment_table(), registry_);
  EXPECT_EQ(schema["properties"]["handles"]["minProperties"], 1);
  EXPECT_EQ(schema["$defs"]["handle.pixel"]["properties"]["at"]["minItems"], 2);
  EXPECT_TRUE(schema["$defs"]["handle.point"]["properties"].contains("rotate"));
}

TEST_F(EditTest, TheOneThatComesWithTheProjectBendsDeeply) {
  const ConfigSource source{std::string(PLIANT_EXPERIMENTS) + "/edit_handles.yaml", {"reports={}"}, {}, {}};
  const ExperimentPlan made = plan_experiment(source, registry_);
  const ordered_json result = edit(made);
  for (const ordered_json& run : result["runs"]) {
    SCOPED_TRACE(run["name"]);
    EXPECT_EQ(run["solver"]["termination"], "converged");
    EXPECT_LT(run["metrics"]["handle_residual_mean"], 0.5);
    EXPECT_LT(run["energy"]["final"], 0.01 * run["energy"]["initial"].get<double>());
  }
}

}  // namespace
}  // namespace pliant::test
