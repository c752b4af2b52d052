#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/program/program_run.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;

class CommandLineTest : public ProgramTest {
 protected:
  CommandLineTest() {
    write("small.yaml",
          "extends: methods/ed.yaml\n"
          "data: {type: synthetic_sheet, image_width: 160, image_height: 120, focal_length: 131.25}\n"
          "graph: {spacing: 12}\n"
          "solvers: {device: gauss_newton, ceres: ceres_lm}\n"
          "compare: {repetitions: 1}\n");
  }
};

TEST_F(CommandLineTest, HelpTeachesEveryCommand) {
  const ProgramRun help = call("--help");
  EXPECT_EQ(help.exit_code, 0);
  for (const char* command : {"reproduce", "run", "check", "compare", "view", "components", "devices"}) {
    EXPECT_THAT(help.out, HasSubstr(command));
    const ProgramRun own = call(std::string(command) + " --help");
    EXPECT_EQ(own.exit_code, 0);
    EXPECT_THAT(own.out, HasSubstr("Usage: pliant " + std::string(command)));
    EXPECT_THAT(own.out, HasSubstr("Example"));
  }
}

TEST_F(CommandLineTest, VersionNamesTheCommit) {
  EXPECT_THAT(call("--version").out, MatchesRegex("pliant [0-9.]+ \\((unknown|[0-9a-f]+(-dirty)?)\\)\n"));
}

TEST_F(CommandLineTest, RunWritesResultsAndSaysWhere) {
  const ProgramRun run = call("run small.yaml --out made --set data.amplitude=30");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("Results are in made"));
  EXPECT_THAT(run.err, HasSubstr("small: iteration 1: residual "));  // no terminal: plain lines
  EXPECT_EQ(run.err.find('\033'), std::string::npos);
  const auto result = nlohmann::json::parse(text_of("made/result.json"));
  EXPECT_EQ(result["experiment"]["data"]["amplitude"], 30.0);
}

TEST_F(CommandLineTest, WithoutOutResultsGoBelowTheCurrentFolder) {
  ASSERT_EQ(call("run small.yaml --set name=mine").exit_code, 0);
  EXPECT_TRUE(fs::exists(file("out/mine/result.json")));
}

TEST_F(CommandLineTest, SetMayBeRepeatedAndStandAnywhere) {
  ASSERT_EQ(call("run --set seed=5 --set sampler.step=5 small.yaml --out made").exit_code, 0);
  const auto experiment = nlohmann::json::parse(text_of("made/result.json"))["experiment"];
  EXPECT_EQ(experiment["seed"], 5);
  EXPECT_EQ(experiment["sampler"]["step"], 5);
}

TEST_F(CommandLineTest, OnlyTheFirstRunSaysThatItBuildsKernels) {
  const auto run = [&] { return call("run small.yaml --out made", "POCL_CACHE_DIR=kernels").err; };
  const std::string first = run();
  const auto told = first.find("building kernels");
  ASSERT_NE(told, std::string::npos) << first;
  EXPECT_EQ(first.find("building kernels", told + 1), std::string::npos) << first;
  EXPECT_THAT(run(), Not(HasSubstr("building kernels")));
}

TEST_F(CommandLineTest, CheckSaysGoodAndRunsNothing) {
  const ProgramRun run = call("check small.yaml");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.out, "small.yaml: good; it makes 1 run: small\n");
  EXPECT_EQ(run.err, "");
  EXPECT_FALSE(fs::exists(file("out")));
}

TEST_F(CommandLineTest, CheckTellsEveryErrorWithItsPlace) {
  write("bad.yaml", "extends: methods/ed.yaml\ndata: synthetic_shet\nsampler: {stp: 4}\nseed: one\n");
  const ProgramRun run = call("check bad.yaml");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.errors(), ElementsAre(HasSubstr("bad.yaml:2:7: unknown data 'synthetic_shet'"),
                                        HasSubstr("bad.yaml:3:11: unknown key 'stp' in 'sampler'"),
                                        HasSubstr("bad.yaml:4:7: 'seed' is 'one'")));
}

TEST_F(CommandLineTest, ComparePrintsAndWritesATable) {
  const ProgramRun run = call("compare small.yaml --out made");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("sparse_normal_cholesky"));
  EXPECT_EQ(nlohmann::json::parse(text_of("made/compare.json"))["runs"][0]["solvers"].size(), 2U);
  EXPECT_THAT(text_of("made/index.html"), HasSubstr("sparse_normal_cholesky"));
}

TEST_F(CommandLineTest, ComponentsFromTheListToOneParameter) {
  EXPECT_THAT(call("components").out, HasSubstr("\nsolver\n"));
  EXPECT_THAT(call("components sampler").out, HasSubstr("uniform"));
  EXPECT_THAT(call("components sampler uniform").out, HasSubstr("step"));
  const auto schema = nlohmann::json::parse(call("components --json").out);
  EXPECT_TRUE(schema["properties"].contains("solvers"));
}

TEST_F(CommandLineTest, DevicesNamesWhatOpenClOffers) {
  const ProgramRun run = call("devices");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, HasSubstr("compute units"));
}

TEST_F(CommandLineTest, FilesAreFoundBelowTheDataFolders) {
  write("pair.yaml",
        "extends: methods/ed.yaml\n"
        "data: {type: rgbd_pair, source: {depth: d.png}, target: {depth: d.png}, intrinsics: k.txt}\n");
  const ProgramRun missing = call("check pair.yaml", "PLIANT_DATA=" + file("elsewhere"));
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.err, HasSubstr(file("elsewhere/d.png")));
  EXPECT_THAT(call("check pair.yaml --data given").err, HasSubstr(file("given/d.png")));
}

TEST_F(CommandLineTest, UnknownWordsAreAnsweredWithWhatThereIs) {
  const struct {
    const char* arguments;
    const char* answer;
  } cases[] = {
      {"rnu small.yaml", "unknown command 'rnu'; expected one of .*; did you mean 'run'\\?"},
      {"run small.yaml --ot x",
       "error: The following argument.* not expected: .*--ot.*see pliant run --help"},
      {"run", "error: FILE.yaml is required; see pliant run --help"},
      {"", "error: A subcommand is required; see pliant --help"},
      {"components solvr", "unknown kind of component 'solvr'; .*did you mean 'solver'\\?"},
      {"components sampler unifrm", "unknown sampler 'unifrm'; .*did you mean 'uniform'\\?"},
  };
  for (const auto& [arguments, answer] : cases) {
    const ProgramRun run = call(arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments;
    EXPECT_THAT(run.errors(), ElementsAre(MatchesRegex(answer))) << arguments;
  }
}

}  // namespace
}  // namespace pliant::test
