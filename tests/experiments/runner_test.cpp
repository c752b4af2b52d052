#include "experiments/runner/runner.h"

#include <gmock/gmock.h>

#include <set>

#include "framework/imaging/depth_filter.h"
#include "framework/tracking/register_pair.h"
#include "tests/experiments/experiment_files.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using ::testing::ElementsAre;
using ::testing::IsSupersetOf;

class RunnerTest : public ExperimentFiles {
 protected:
  ordered_json run(const ExperimentPlan& plan, const std::string& folder) {
    result_ = run_experiment(*task_, plan, file(folder), workbench_);
    return ordered_json::parse(text_of(folder + "/result.json"));
  }

  /// What the first run of an experiment comes to, without a file.
  RegistrationResult register_first(const ExperimentPlan& plan) {
    const ExperimentRun& run = plan.runs.at(0);
    return register_pair(workbench_.pair(run.values), make_method(run, registry_),
                         workbench_.device(run.values),
                         static_cast<std::uint64_t>(run.values.integer("seed")));
  }

  std::set<std::string> files_of(const std::string& folder) const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(file(folder))) names.insert(entry.path().filename());
    return names;
  }

  ExperimentResult result_;
  std::unique_ptr<Task> task_ = make_register_task();
};

void drop_times(ordered_json& json) {
  json["environment"].erase("date");
  for (auto& run : json["runs"]) {
    run.erase("time_ms");
    run.erase("timing");
  }
}

TEST_F(RunnerTest, ResultHasTheKeysThatOthersRead) {
  const ordered_json result = run(plan(""), "out");
  EXPECT_THAT(keys_of(result), ElementsAre("schema", "experiment", "environment", "runs"));
  EXPECT_EQ(result["schema"], 1);
  EXPECT_THAT(keys_of(result["environment"]),
              IsSupersetOf({"version", "commit", "device", "opencl_driver", "libraries", "seed"}));
  ASSERT_EQ(result["runs"].size(), 1U);
  const ordered_json& entry = result["runs"][0];
  EXPECT_THAT(keys_of(entry), ElementsAre("name", "termination", "reason", "warnings", "alignment", "counts",
                                          "metrics", "initial", "aligned", "history", "returned_iteration",
                                          "energy", "time_ms", "timing", "solver"));
  EXPECT_THAT(keys_of(entry["alignment"]),
              ElementsAre("method", "reason", "matches", "inliers", "rotation", "translation"));
  ASSERT_EQ(entry["history"].size(), entry["counts"]["outer_iterations"].get<std::size_t>() + 1);
  EXPECT_THAT(keys_of(entry["history"][0]), ElementsAre("residual_mean", "robust", "matched"));
  EXPECT_THAT(keys_of(entry["counts"]),
              ElementsAre("source_points", "matched_points", "nodes", "edges", "constraints", "unknowns",
                          "outer_iterations", "solver_iterations"));
  for (const char* stage : {"metrics", "initial", "aligned"})
    EXPECT_THAT(keys_of(entry[stage]),
                ElementsAre("residual_mean", "residual_sd", "coverage", "nearest_mean", "nearest_sd",
                            "epe_mean", "epe_sd", "epe_p95", "epe_moving_mean", "epe_seen_mean",
                            "epe_hidden_mean", "hidden_share"));
  EXPECT_THAT(keys_of(entry["energy"]), ElementsAre("initial", "final", "per_iteration"));
  EXPECT_EQ(entry["time_ms"].begin().key(), "total");
  EXPECT_THAT(keys_of(entry["solver"]), ElementsAre("name", "linear_solver", "termination"));
}

TEST_F(RunnerTest, ResultSaysWhatTheRegistrationCameTo) {
  const ordered_json entry = run(plan(""), "out")["runs"][0];
  EXPECT_EQ(entry["counts"]["source_points"], register_first(plan("")).source.size());
  EXPECT_EQ(entry["counts"]["unknowns"], 12 * entry["counts"]["nodes"].get<int>());
  EXPECT_EQ(entry["energy"]["per_iteration"].size(), entry["counts"]["outer_iterations"]);
  EXPECT_LT(entry["metrics"]["epe_mean"], 0.5 * entry["initial"]["epe_mean"].get<double>());
  EXPECT_EQ(entry["solver"]["name"], "gauss_newton");
}

/// Sees everything 3 mm further away than it is.
class Shifted : public DepthFilter {
 public:
  std::optional<DepthMap> filter(Device&, const DepthMap& map, const Camera&) const override {
    DepthMap shifted(map.window);
    shifted.depth = map.depth.clone();
    for (float& depth : shifted.depth.write_host()) depth += depth < DepthMap::no_depth ? 3.0F : 0.0F;
    return shifted;
  }
};

TEST_F(RunnerTest, AFilterServesTheRegistrationAndLeavesThePointsAsGiven) {
  registry_.add<DepthFilter>("shifted", "3 mm further away", {},
                             [](const Parameters&, const Registry&) { return std::make_unique<Shifted>(); });
  const ordered_json raw = run(plan(""), "raw")["runs"][0];
  const Surface source = register_first(plan("")).source;
  const ordered_json filtered = run(plan("filter: shifted"), "filtered")["runs"][0];
  const RegistrationResult result = register_first(plan("filter: shifted"));
  ASSERT_EQ(result.source.size(), source.size());
  for (std::size_t i = 0; i < source.size(); ++i)
    ASSERT_LT((result.source.points[i] - source.points[i]).norm(), 1e-3) << "point " << i;
  EXPECT_EQ(result.aligned_points, result.source.points);
  EXPECT_NE(result.node_positions.front().z(), source.points.front().z()) << "the graph is on what was seen";
  EXPECT_LT(filtered["metrics"]["residual_mean"], raw["metrics"]["residual_mean"].get<double>() + 0.5)
      << "the deformation goes for the given points, which meet the given target, not the shifted one";
}

TEST_F(RunnerTest, TwoRunsGiveTheSameBits) {
  ordered_json first = run(plan("data: {noise: 1}"), "first");
  Workbench fresh(registry_);
  run_experiment(*task_, plan("data: {noise: 1}"), file("second"), fresh);
  ordered_json second = ordered_json::parse(text_of("second/result.json"));
  drop_times(first);
  drop_times(second);
  EXPECT_EQ(first.dump(), second.dump());
  EXPECT_EQ(text_of("first/registered.ply"), text_of("second/registered.ply"));
}

TEST_F(RunnerTest, AdaptiveConstraintsThatSwingEndTheLoop) {
  // A threshold below the noise: masks gain and lose constraints in every iteration.
  const RegistrationResult result = register_first(
      plan("data: {noise: 1}\ngraph: {type: quadtree}\nsampler: {type: adaptive, threshold: 1}"));
  EXPECT_EQ(result.termination, "no_progress");
  EXPECT_LT(result.counts.outer_iterations, 30);
}

TEST_F(RunnerTest, AnotherSeedGivesOtherNoise) {
  const ordered_json one = run(plan("data: {noise: 1}"), "one");
  const ordered_json two = run(plan("data: {noise: 1}\nseed: 2"), "two");
  EXPECT_NE(one["runs"][0]["metrics"], two["runs"][0]["metrics"]);
}

TEST_F(RunnerTest, ASingleRunIsWrittenAtTheTop) {
  run(plan(""), "out");
  EXPECT_THAT(files_of("out"), IsSupersetOf({"result.json", "experiment.yaml", "source.ply", "target.ply",
                                             "registered.ply", "index.html", "error_final.png"}));
}

TEST_F(RunnerTest, SeveralRunsGetAFolderEachAndAPageOverAll) {
  const ordered_json result = run(plan("runs: {coarse: {graph: {spacing: 14}}, fine: }"), "out");
  EXPECT_EQ(files_of("out"), (std::set<std::string>{".pliant", "result.json", "results.csv",
                                                    "experiment.yaml", "index.html", "coarse", "fine"}));
  EXPECT_TRUE(files_of("out/fine").contains("registered.ply"));
  ASSERT_EQ(result["runs"].size(), 2U);
  EXPECT_EQ(result["runs"][0]["name"], "coarse");
  EXPECT_LT(result["runs"][0]["counts"]["nodes"], result["runs"][1]["counts"]["nodes"]);
  EXPECT_NE(text_of("out/index.html").find("coarse/index.html"), std::string::npos);
}

TEST_F(RunnerTest, TheSweepThatComesWithTheProjectComparesItsCombinations) {
  const ConfigSource source{std::string(PLIANT_EXPERIMENTS) + "/sheet_sweep.yaml", {}, {}, {}};
  const ordered_json result = run(plan_experiment(source, registry_), "out");
  ASSERT_EQ(result["runs"].size(), 6U);
  EXPECT_EQ(result["runs"][4]["name"], "noise=1,weight=10");
  EXPECT_TRUE(files_of("out/noise=1,weight=10").contains("registered.ply"));
  EXPECT_NE(text_of("out/index.html").find("noise=1,weight=10/index.html"), std::string::npos);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_LT(result["runs"][i]["metrics"]["residual_mean"],
              result["runs"][i + 3]["metrics"]["residual_mean"]);
}

TEST_F(RunnerTest, ReportsAreThoseOfTheExperiment) {
  write("bare.yaml",
        "data: {type: synthetic_sheet, image_width: 80, image_height: 60, focal_length: 65.6}\n"
        "graph: {spacing: 8}\n"
        "energies: {rotation: , regularization: , constraint: }\n"
        "stopping: {max_iterations: 1}\nreports: {}\n");
  const ExperimentPlan bare = plan_experiment({file("bare.yaml"), {}, {}, {}}, registry_);
  run(bare, "bare");
  EXPECT_EQ(files_of("bare"), (std::set<std::string>{".pliant", "result.json", "experiment.yaml"}));
  EXPECT_EQ(run_tables(*task_, bare, result_).at(0).rows.at(0).link, "");  // there is no page to lead to
  const ExperimentPlan whole = plan("");
  run(whole, "whole");
  EXPECT_EQ(run_tables(*task_, whole, result_, "sub").at(0).rows.at(0).link, "sub/index.html");
}

TEST_F(RunnerTest, TheExperimentBesideTheResultsGivesTheSameResults) {
  ordered_json first = run(plan("runs: {a: {seed: 3}}\nname: again"), "first");
  const ExperimentPlan again = plan_experiment({file("first/experiment.yaml"), {}, {}, {}}, registry_);
  EXPECT_EQ(again.experiment.to_json(), first["experiment"]);
  ordered_json second = run(again, "second");
  drop_times(first);
  drop_times(second);
  EXPECT_EQ(first, second);
}

TEST_F(RunnerTest, DataIsLoadedOnceForRunsThatShareIt) {
  const ExperimentPlan made = plan("runs: {a: , b: {sampler: {step: 3}}, c: {seed: 2}}");
  const FramePair* shared = &workbench_.pair(made.runs[0].values);
  EXPECT_EQ(shared, &workbench_.pair(made.runs[1].values));
  EXPECT_NE(shared, &workbench_.pair(made.runs[2].values));
}

TEST_F(RunnerTest, ProgressIsToldUnderTheNameOfTheRun) {
  std::set<std::string> names;
  double last = 0;
  run_experiment(*task_, plan("name: mine"), file("out"), workbench_, [&](const Progress& step) {
    names.insert(step.what);
    last = step.done;
  });
  EXPECT_EQ(names, std::set<std::string>{"mine"});
  EXPECT_EQ(last, 1);
}

TEST_F(RunnerTest, TheTimeSaysWhetherKernelsWereBuiltInIt) {
  EXPECT_EQ(run(plan(""), "first")["runs"][0]["timing"]["built_kernels"], true);
  const ordered_json again = run(plan(""), "again")["runs"][0];
  EXPECT_EQ(again["timing"]["built_kernels"], false);
  EXPECT_EQ(again["timing"]["repeats"], 1);
  EXPECT_EQ(again["timing"]["median_ms"], again["time_ms"]["total"]);
}

TEST_F(RunnerTest, RepeatsTellTheMedianAndTheSpreadOfRunsAfterTheFirst) {
  int warm_ups = 0;
  const auto count = [&](const Progress& step) {
    warm_ups += step.message.find("warm-up, iteration 1:") == 0;
  };
  const auto result = run_experiment(*task_, plan(""), file("out"), workbench_, count, {3});
  const ordered_json entry = ordered_json::parse(text_of("out/result.json"))["runs"][0];
  const ordered_json& timing = entry["timing"];
  EXPECT_EQ(warm_ups, 1);
  EXPECT_EQ(timing["repeats"], 3);
  EXPECT_EQ(timing["built_kernels"], false);
  EXPECT_LE(timing["min_ms"], timing["median_ms"]);
  EXPECT_LE(timing["median_ms"], timing["max_ms"]);
  EXPECT_EQ(timing["median_ms"], entry["time_ms"]["total"]);
  EXPECT_THAT(run_tables(*task_, plan(""), result).at(0).rows.at(0).cells.back(),
              ::testing::MatchesRegex("[0-9]+ .[0-9]+ to [0-9]+."));
}

TEST_F(RunnerTest, ARunMayWriteNoFileThatItDidNotAnnounce) {
  const ExperimentPlan registration = plan("");
  const auto announced = result_files(*task_, registration, registry_);
  run(registration, "out");
  for (const auto& name : files_of("out"))
    EXPECT_TRUE(name == ".pliant" || std::count(announced.begin(), announced.end(), name) == 1) << name;
}

TEST_F(RunnerTest, ARerunReplacesTheOldResultWholeAndLeavesOtherFiles) {
  run(plan("runs: {coarse: {graph: {spacing: 14}}, fine: }"), "out");
  write("out/notes.txt", "mine");
  write("out/coarse/notes.txt", "mine, too");
  run(plan("reports: {surfaces: }"), "out");
  EXPECT_FALSE(fs::exists(file("out/fine")));
  EXPECT_EQ(files_of("out/coarse"), std::set<std::string>{"notes.txt"});
  EXPECT_EQ(text_of("out/notes.txt"), "mine");
  EXPECT_TRUE(fs::exists(file("out/registered.ply")));
}

TEST_F(RunnerTest, CheckingMakesNoFile) {
  check_experiment(plan(""), workbench_);
  EXPECT_FALSE(fs::exists(file("out")));
}

TEST_F(RunnerTest, AFolderThatCannotBeMadeIsADataError) {
  write("taken", "a file");
  EXPECT_THROW(run_experiment(*task_, plan(""), file("taken"), workbench_), DataError);
  EXPECT_THROW(run_experiment(*task_, plan(""), file("taken") + "/below", workbench_), DataError);
}

TEST_F(RunnerTest, AComponentCombinationWithoutSenseIsAConfigError) {
  EXPECT_THROW(check_experiment(plan("graph: {type: quadtree, refine_threshold: 1, collapse_threshold: 2}"),
                                workbench_),
               ConfigError);
}

// ICP may slide a plane along itself, and what slides out of view counts for nothing.
TEST_F(RunnerTest, IcpDoesNotSlideASheetAwayFromItsFeatures) {
  write("creased.yaml",
        "extends: methods/best.yaml\nreports: {}\nseed: 2\nstopping: {max_iterations: 1}\n"
        "data: {type: sheet, target: [crease=1], distance: 700, "
        "sensor: {axial: 1, quantisation: 1, lateral: 1, grazing: 80, shadow: 75}}\n");
  const auto result =
      run(plan_experiment({file("creased.yaml"), {}, {}, {PLIANT_EXPERIMENTS}}, registry_), "out");
  EXPECT_LT(result["runs"][0]["aligned"]["epe_mean"], 30);
  EXPECT_GT(result["runs"][0]["alignment"]["inliers"], 100);
}

}  // namespace
}  // namespace pliant::test
