#include "experiments/runner/experiment.h"

#include <gmock/gmock.h>

#include "tests/experiments/experiment_files.h"

namespace pliant::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;

class ExperimentTest : public ExperimentFiles {
 protected:
  std::string error(const std::string& text) const {
    try {
      plan(text);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  }
};

std::vector<std::string> run_names(const ExperimentPlan& plan) {
  std::vector<std::string> names;
  for (const auto& run : plan.runs) names.push_back(run.name);
  return names;
}

TEST_F(ExperimentTest, WithoutRunsItIsOneRunNamedAfterTheFile) {
  const ExperimentPlan made = plan("");
  EXPECT_EQ(made.name, "small");
  EXPECT_THAT(run_names(made), ElementsAre("small"));
  EXPECT_EQ(made.experiment.to_json().at("name"), "small");
  EXPECT_EQ(made.experiment.to_json().begin().key(), "name");
}

TEST_F(ExperimentTest, ItsOwnNameGoesBeforeTheFile) {
  EXPECT_EQ(plan("name: bent").name, "bent");
  EXPECT_THAT(run_names(plan("name: bent")), ElementsAre("bent"));
}

TEST_F(ExperimentTest, RunsAreTheWholeExperimentWithTheirValuesLaidOver) {
  const ExperimentPlan made =
      plan("sampler: {step: 4}\nruns: {fine: {sampler: {step: 2}}, other: {seed: 7}}");
  EXPECT_THAT(run_names(made), ElementsAre("fine", "other"));
  EXPECT_EQ(made.runs[0].values.section("sampler").integer("step"), 2);
  EXPECT_EQ(made.runs[0].values.integer("seed"), 1);
  EXPECT_EQ(made.runs[1].values.section("sampler").integer("step"), 4);
  EXPECT_EQ(made.runs[1].values.integer("seed"), 7);
}

TEST_F(ExperimentTest, ASweepMakesARunOfEachCombination) {
  ExperimentPlan made = plan(
      "sweep: {seed: [1, 2], energies.rotation.weight: [0.5]}\nruns: {fine: {sampler: {step: 2}}, other: }\n"
      "quick: ['other,seed=2,weight=0.5']");
  EXPECT_THAT(run_names(made), ElementsAre("fine,seed=1,weight=0.5", "fine,seed=2,weight=0.5",
                                           "other,seed=1,weight=0.5", "other,seed=2,weight=0.5"));
  EXPECT_EQ(made.runs[1].values.integer("seed"), 2);
  EXPECT_EQ(made.runs[1].values.section("sampler").integer("step"), 2);
  EXPECT_THAT(made.runs[1].place, EndsWith("small.yaml, run fine,seed=2,weight=0.5"));
  made.keep_quick_runs();
  EXPECT_THAT(run_names(made), ElementsAre("other,seed=2,weight=0.5"));
}

TEST_F(ExperimentTest, ASweepMakesNamesThatCanNameAFolderAndAreNoFileOfAResult) {
  const ExperimentPlan made = plan("sweep: {device: [a/b, 'c:d', result.json]}");
  EXPECT_THAT(run_names(made), ElementsAre("device=a_b", "device=c_d", "device=result.json"));
  EXPECT_THAT(error("runs: {index.html: , ../up: }\nsweep: {seed: [1]}"),
              HasSubstr("small.yaml:2:22: the run's name '../up,seed=1' cannot name a folder"));
}

TEST_F(ExperimentTest, AWrongValueOfASweepIsToldWhereItStands) {
  EXPECT_THAT(error("sweep: {seed: [1, -1], graph.spacng: [2]}"),
              AllOf(HasSubstr("small.yaml:2:19: 'seed' is '-1'"),
                    HasSubstr("small.yaml:2:24: unknown key 'spacng' in 'graph'")));
}

TEST_F(ExperimentTest, FromTextItIsNamedAfterTheText) {
  plan("");  // writes base.yaml
  const auto from_text = [&](const std::string& text, const std::string& name) {
    const ConfigText source{text, name, std::filesystem::path(file("base.yaml")).parent_path()};
    return plan_experiment({source, {}, {}, {PLIANT_EXPERIMENTS}}, registry_);
  };
  const ExperimentPlan made = from_text("extends: base.yaml\nseed: 3", "from the editor.yaml");
  EXPECT_EQ(made.name, "from the editor");
  EXPECT_EQ(made.runs[0].values.integer("seed"), 3);
  EXPECT_EQ(made.runs[0].place, "from the editor.yaml");
  EXPECT_EQ(from_text("extends: base.yaml", "").name, "_");
  EXPECT_EQ(from_text("extends: base.yaml\nname: own", "text").name, "own");
}

TEST_F(ExperimentTest, SaysHowKernelsAreShaped) {
  const DeviceOptions by_default = device_options(plan("").runs[0].values);
  EXPECT_FALSE(by_default.vector_width || by_default.work_group_size);
  const ExperimentPlan made =
      plan("kernels: {vector_width: 1}\nruns: {wide: {kernels: {work_group_size: 64}}}");
  const DeviceOptions of_run = device_options(made.runs[0].values);
  EXPECT_EQ(of_run.vector_width, 1);
  EXPECT_EQ(of_run.work_group_size, 64);
}

TEST_F(ExperimentTest, KernelsOfAShapeThatThereIsNotAreAnErrorWithItsPlace) {
  EXPECT_THAT(
      error("kernels: {vector_width: 4}"),
      AllOf(HasSubstr("small.yaml:"), HasSubstr("'kernels' asks for a vector width of 4; expected 1 or 16")));
  EXPECT_THAT(error("kernels: {work_group_size: 12}"), HasSubstr("expected a power of two"));
  EXPECT_THAT(error("runs: {a: , b: {kernels: {work_group_size: 12}}}"),
              HasSubstr("expected a power of two"));
}

TEST_F(ExperimentTest, QuickRunsAreThoseListed) {
  ExperimentPlan made = plan("runs: {a: , b: , c: }\nquick: [c, a]");
  made.keep_quick_runs();
  EXPECT_THAT(run_names(made), ElementsAre("a", "c"));
  ExperimentPlan all = plan("runs: {a: , b: }");
  all.keep_quick_runs();
  EXPECT_THAT(run_names(all), ElementsAre("a", "b"));
}

TEST_F(ExperimentTest, QuickRunThatIsNoneIsAnError) {
  EXPECT_THAT(error("runs: {alpha: , b: }\nquick: [alpa]"),
              HasSubstr("'quick' lists 'alpa', which is no run; expected alpha, b; did you mean 'alpha'?"));
}

TEST_F(ExperimentTest, NamesThatCannotNameAFolderAreErrors) {
  EXPECT_THAT(error("runs: {../up: }"), HasSubstr("the run's name '../up' cannot name a folder"));
  for (const char* name : {"a/b", "a#b", "a?b", ".a", "a:b", "a%41"})
    EXPECT_THAT(error("name: '" + std::string(name) + "'"),
                HasSubstr("the experiment's name '" + std::string(name) + "' cannot name a folder"));
}

TEST_F(ExperimentTest, ExperimentsThatComeWithTheProjectAreGood) {
  for (const char* name : {"sheet", "quickstart", "compare_solvers", "edit_handles", "sheet_sweep"}) {
    const ConfigSource source{std::string(PLIANT_EXPERIMENTS) + "/" + name + ".yaml", {}, {}, {}};
    const ExperimentPlan made = plan_experiment(source, registry_);
    EXPECT_EQ(made.name, name);
    EXPECT_FALSE(made.runs.empty());
  }
}

}  // namespace
}  // namespace pliant::test
