#include "experiments/runner/compare.h"

#include <gmock/gmock.h>

#include "tests/experiments/experiment_files.h"

namespace pliant::testing {
namespace {

using nlohmann::ordered_json;
using ::testing::ElementsAre;

class CompareTest : public ExperimentFiles {
 protected:
  static constexpr const char* solvers =
      "solvers: {device: gauss_newton, sparse: {type: ceres_lm}, weak: {type: ceres_lm, max_iterations: 1}}\n"
      "compare: {repetitions: 2}\n";
};

TEST_F(CompareTest, SolversStartAlikeAndEndAtTheSameEnergy) {
  const auto comparisons = compare_solvers(plan(solvers), file("out"), workbench_);
  ASSERT_EQ(comparisons.size(), 1U);
  const auto& trials = comparisons[0].trials;
  ASSERT_EQ(trials.size(), 3U);
  EXPECT_EQ(comparisons[0].unknowns, 12 * comparisons[0].nodes);
  EXPECT_GT(comparisons[0].constraints, 0);
  for (const auto& trial : trials) {
    EXPECT_EQ(trial.initial_energy, trials[0].initial_energy);
    EXPECT_LT(trial.final_energy, trial.initial_energy);
    EXPECT_GT(trial.solve_ms, 0);
    EXPECT_EQ(trial.repetitions, 2);
  }
  EXPECT_LT(trials[0].relative_difference, 1e-4);
  EXPECT_LT(trials[1].relative_difference, 1e-4);
  EXPECT_EQ(trials[2].summary.iterations, 1);
}

TEST_F(CompareTest, SummaryAgreesWithTheEnergyMeasuredFromOutside) {
  const auto trials = compare_solvers(plan(solvers), file("out"), workbench_)[0].trials;
  for (const auto& trial : trials)
    EXPECT_NEAR(trial.summary.final_energy, trial.final_energy, 1e-4 * trial.final_energy) << trial.name;
}

TEST_F(CompareTest, FileHasARowPerRunAndSolver) {
  compare_solvers(plan(std::string(solvers) + "runs: {a: , b: {sampler: {step: 3}}}"), file("out"),
                  workbench_);
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
  const auto made = plan(solvers, {"compare.repetitions=1000", "compare.max_seconds=1.0e-9"});
  const auto trials = compare_solvers(made, file("out"), workbench_)[0].trials;
  for (const auto& trial : trials) {
    EXPECT_EQ(trial.repetitions, 1);
    EXPECT_GT(trial.solve_ms, 0);
  }
}

TEST_F(CompareTest, NothingToCompareIsAConfigError) {
  EXPECT_THROW(compare_solvers(plan(""), file("out"), workbench_), ConfigError);
}

TEST_F(CompareTest, TablesListTheSolversOfEachRun) {
  const auto tables = compare_tables(compare_solvers(plan(solvers), file("out"), workbench_));
  ASSERT_EQ(tables.size(), 1U);
  std::vector<std::string> names;
  for (const auto& row : tables[0].rows) names.push_back(row.cells[0]);
  EXPECT_THAT(names, ElementsAre("device", "sparse", "weak"));
}

}  // namespace
}  // namespace pliant::testing
