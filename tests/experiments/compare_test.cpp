#include <gmock/gmock.h>

#include "experiments/runner/runner.h"
#include "tests/experiments/experiment_files.h"

namespace pliant::test {
namespace {

using nlohmann::ordered_json;
using ::testing::ElementsAre;

class CompareTest : public ExperimentFiles {
 protected:
  static constexpr const char* solvers =
      "solvers: {device: gauss_newton, sparse: {type: ceres_lm}, weak: {type: ceres_lm, max_iterations: 1}}\n"
      "compare: {repetitions: 2}\n";

  ExperimentResult compare(const ExperimentPlan& plan) {
    return run_experiment(*make_compare_task(), plan, file("out"), workbench_);
  }

  /// What the solvers made of the first run.
  ordered_json trials(const ExperimentPlan& plan) { return compare(plan).runs.at(0).json["solvers"]; }
};

TEST_F(CompareTest, SolversStartAlikeAndEndAtTheSameEnergy) {
  const ordered_json run = compare(plan(solvers)).runs.at(0).json;
  EXPECT_EQ(run["counts"]["unknowns"], 12 * run["counts"]["nodes"].get<int>());
  EXPECT_GT(run["counts"]["constraints"], 0);
  const ordered_json& trials = run["solvers"];
  ASSERT_EQ(trials.size(), 3U);
  for (const ordered_json& trial : trials) {
    EXPECT_EQ(trial["energy"]["initial"], trials[0]["energy"]["initial"]);
    EXPECT_LT(trial["energy"]["final"], trial["energy"]["initial"]);
    EXPECT_GT(trial["time_ms"]["solve"], 0);
    EXPECT_EQ(trial["time_ms"]["repetitions"], 2);
  }
  EXPECT_LT(trials[0]["energy"]["relative_difference"], 1e-4);
  EXPECT_LT(trials[1]["energy"]["relative_difference"], 1e-4);
  EXPECT_EQ(trials[2]["iterations"], 1);
}

TEST_F(CompareTest, FileHasARowPerRunAndSolver) {
  compare(plan(std::string(solvers) + "runs: {a: , b: {sampler: {step: 3}}}"));
  const auto json = ordered_json::parse(text_of("out/compare.json"));
  EXPECT_EQ(json["schema"], 1);
  ASSERT_EQ(json["runs"].size(), 2U);
  EXPECT_EQ(json["runs"][1]["name"], "b");
  EXPECT_GT(json["runs"][1]["counts"]["constraints"], json["runs"][0]["counts"]["constraints"]);
  const auto& row = json["runs"][0]["solvers"][1];
  EXPECT_EQ(row["name"], "sparse");
  EXPECT_EQ(row["solver"], "ceres_lm");
  EXPECT_EQ(row["linear_solver"], "sparse_normal_cholesky");
  EXPECT_DOUBLE_EQ(row["time_ms"]["total"],
                   row["time_ms"]["setup"].get<double>() + row["time_ms"]["solve"].get<double>());
}

TEST_F(CompareTest, NoFurtherSolveIsBegunAfterTheTime) {
  for (const ordered_json& trial :
       trials(plan(solvers, {"compare.repetitions=1000", "compare.max_seconds=1.0e-9"}))) {
    EXPECT_EQ(trial["time_ms"]["repetitions"], 1);
    EXPECT_GT(trial["time_ms"]["solve"], 0);
  }
}

TEST_F(CompareTest, NothingToCompareIsAConfigError) {
  EXPECT_THROW(compare(plan("")), ConfigError);
  EXPECT_FALSE(std::filesystem::exists(file("out")));
}

TEST_F(CompareTest, TablesListTheSolversOfEachRun) {
  const ExperimentPlan made = plan(std::string(solvers) + "runs: {a: , b: }");
  const auto tables = run_tables(*make_compare_task(), made, compare(made), "sub");
  ASSERT_EQ(tables.size(), 2U);
  std::vector<std::string> names;
  for (const auto& row : tables[1].rows) names.push_back(row.cells[0]);
  EXPECT_THAT(names, ElementsAre("device", "sparse", "weak"));
  EXPECT_EQ(tables[1].rows[0].link, "sub/index.html");
}

}  // namespace
}  // namespace pliant::test
