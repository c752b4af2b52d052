#include <gmock/gmock.h>

#include <filesystem>

#include "experiments/runner/overview.h"
#include "experiments/runner/run_store.h"
#include "experiments/runner/runner.h"
#include "tests/experiments/experiment_files.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

class StudyRunTest : public ExperimentFiles {
 protected:
  ExperimentResult run(const ExperimentPlan& plan) {
    return run_experiment(*make_register_task(), plan, file("out"), workbench_);
  }
};

/// The first block of YAML in a page of documentation.
std::string first_yaml(const std::string& path) {
  const auto bytes = read_file(path);
  const std::string text(bytes.begin(), bytes.end());
  const std::string fence = "```yaml\n";
  const std::size_t begin = text.find(fence) + fence.size();
  return text.substr(begin, text.find("```", begin) - begin);
}

TEST_F(StudyRunTest, TheExampleOfTheDocumentationDoesWhatItSays) {
  const std::string example = write("my_study.yaml", first_yaml(PLIANT_EXPERIMENTS "/README.md"));
  const ExperimentPlan plan = plan_experiment({example, {}, {}, {PLIANT_EXPERIMENTS}}, registry_);
  ASSERT_THAT(plan.runs, SizeIs(12));
  const ExperimentResult made = run(plan);
  EXPECT_THAT(made.failed, SizeIs(0));
  const Study study = study_of(plan, made, workbench_.device(plan.runs[0].values).info(), file("out"));
  ASSERT_THAT(study.charts, SizeIs(2));
  ASSERT_THAT(study.charts[0].series, SizeIs(2));
  EXPECT_THAT(study.charts[0].series[0].points, SizeIs(3));
  EXPECT_EQ(study.charts[0].series[0].points[2].count, 2);
  EXPECT_THAT(study.tables[0].rows, SizeIs(6));
  ASSERT_THAT(study.findings, SizeIs(3));
  for (const Finding& finding : study.findings) EXPECT_EQ(finding.verdict, Finding::Verdict::confirmed);
  EXPECT_THAT(study.notes, SizeIs(0));
  EXPECT_THAT(text_of("out/index.html"), HasSubstr("Accuracy over the size of the image"));
  EXPECT_THAT(text_of("out/charts/nodes.svg"), HasSubstr("<svg"));
  EXPECT_THAT(text_of("out/results.csv"), HasSubstr("method=uniform"));
}

TEST_F(StudyRunTest, TellsWhichRunsAreMissing) {
  ExperimentPlan made = plan(
      "reports: {}\nsweep: {seed: [1, 2], data.noise: [0, 1]}\nquick: [seed=2]\n"
      "study: {claims: {low: {claim: c, each: seed, values: {r: {value: metrics.residual_mean}}, holds: r < "
      "99}}}\n");
  made.keep_quick_runs();
  ASSERT_THAT(made.runs, SizeIs(2));
  const ExperimentResult result = run(made);
  const Study study = study_of(made, result, workbench_.device(made.runs[0].values).info(), file("out"));
  EXPECT_THAT(study.notes, ElementsAre("The quick form: 2 of 4 runs"));
  EXPECT_EQ(study.findings[0].verdict, Finding::Verdict::unknown);
  EXPECT_EQ(study.findings[1].verdict, Finding::Verdict::confirmed);
}

TEST_F(StudyRunTest, WhatIsShownDoesNotMakeRunsAnew) {
  const std::string runs = "reports: {}\nsweep: {seed: [1, 2]}\n";
  const ExperimentPlan before = plan(runs);
  const ExperimentPlan after = plan(runs + "study: {title: other}\n");
  const DeviceInfo& device = workbench_.device(before.runs[0].values).info();
  const auto task = make_register_task();
  EXPECT_EQ(run_key(*task, before.runs[0], device, 0), run_key(*task, after.runs[0], device, 0));
  EXPECT_NE(run_key(*task, before.runs[0], device, 0), run_key(*task, before.runs[1], device, 0));
}

TEST_F(StudyRunTest, OneOfManyTakesWhatIsWhole) {
  const ExperimentPlan made = plan("reports: {}\nsweep: {seed: [1, 2]}\n");
  const auto task = make_register_task();
  const RunOptions options{.repeats = 0, .is_one_of_many = true};
  EXPECT_THAT(run_experiment(*task, made, file("out"), workbench_, {}, options).taken, SizeIs(0));
  EXPECT_THAT(run_experiment(*task, made, file("out"), workbench_, {}, options).taken, SizeIs(2));
  EXPECT_THAT(run_experiment(*task, made, file("out"), workbench_).taken, SizeIs(0));
}

TEST_F(StudyRunTest, OneOfManyTellsThatAllFailed) {
  const ExperimentPlan made = plan("reports: {}\nsweep: {data.distance: [100000]}\n");
  const RunOptions options{.repeats = 0, .is_one_of_many = true};
  const auto result = run_experiment(*make_register_task(), made, file("out"), workbench_, {}, options);
  EXPECT_THAT(result.runs, SizeIs(0));
  EXPECT_THAT(result.failed, SizeIs(1));
  EXPECT_FALSE(fs::exists(file("out")));
}

TEST_F(StudyRunTest, ARepeatOfTheFileIsThatOfItsRuns) {
  const auto result = run(plan("reports: {}\nrepeat: 2\n"));
  EXPECT_EQ(result.runs[0].json.at("timing").at("repeats"), 2);
}

TEST_F(StudyRunTest, AStudyIsCheckedBeforeAnythingIsRun) {
  try {
    plan("sweep: {seed: [1, 2]}\nstudy: {views: {first: {where: [sed=1]}}}\n");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("small.yaml:3:17: the runs are not swept over 'sed'"));
  }
}

}  // namespace
}  // namespace pliant::test
