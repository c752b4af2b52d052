// `pliant reproduce` of an installation whose chapter takes seconds.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/program/program_run.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class ReproduceTest : public ProgramTest {
 protected:
  ReproduceTest() {
    const fs::path bin = file("prefix/bin");
    fs::create_directories(bin);
    for (const char* chapter : {"chapter5", "chapter6"}) fs::create_directories(experiments_ / chapter);
    // A link would lead the program back to where it was built.
    fs::copy_file(PLIANT_PROGRAM, bin / "pliant");
    fs::copy(fs::path(PLIANT_EXPERIMENTS) / "methods", experiments_ / "methods");
    for (const auto& entry : fs::directory_iterator(PLIANT_EXPERIMENTS))
      if (entry.path().extension() == ".yaml") fs::copy(entry.path(), experiments_);
    set_program((bin / "pliant").string());
    add("chapter5/fig_1.yaml",
        small + "sweep: {data.noise: [0, 1], seed: [1, 2]}\nquick: [seed=1]\n" + study);
    add("chapter5/fig_2.yaml", small + "sweep: {seed: [3, 4]}\nquick: [seed=3]\n");
    add("chapter6/tracked.yaml", tracked + "sweep: {seed: [1, 2, 3]}\nquick: [seed=2]\n");
  }

  void add(const std::string& name, const std::string& text) const {
    write_file((experiments_ / name).string(), {text.begin(), text.end()});
  }

  const std::string small =
      "extends: ../methods/ed.yaml\nreports: {}\n"
      "data: {type: synthetic_sheet, image_width: 160, image_height: 120, focal_length: 131.25}\n";
  const std::string tracked =
      "reports: {}\nmodel: {type: tsdf, volume: fitted, resolution: 64}\nacquisition: {filter: none}\n"
      "data: {type: head, image_width: 160, image_height: 120, focal_length: 131.25, frames: 8, "
      "motion: {rotation_y: 5}}\n"
      "study: {charts: {error: {title: Figure Six, kind: frames, y_label: mm, series: {e: {value: "
      "error_mean}}}}}\n";
  const std::string study =
      "study:\n"
      "  title: Figure One\n"
      "  charts: {noise: {title: t, over: noise, y_label: mm, series: {r: {value: metrics.residual_mean}}}}\n"
      "  claims:\n"
      "    clean: {claim: without noise it is better, values: {a: {value: metrics.residual_mean, where: "
      "[noise=0]},\n"
      "            b: {value: metrics.residual_mean, where: [noise=1]}}, holds: a < b}\n";
  const fs::path experiments_ = file("prefix/share/pliant/experiments");
  const std::string no_data_ = "PLIANT_DATA=" + file("nothing");
};

TEST_F(ReproduceTest, MakesOnePageOverEverythingAndSaysWhatItSkips) {
  const ProgramRun run = call("reproduce --quick --out rep", no_data_);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("The report is " + file("rep/index.html")));
  EXPECT_THAT(run.out,
              HasSubstr("SKIPPED: its data was not found; looked for " + file("nothing/deepdeform")));
  const std::string page = text_of("rep/index.html");
  EXPECT_THAT(page, AllOf(HasSubstr("SKIPPED"), HasSubstr("<a href=\"sheet/index.html\">"),
                          HasSubstr("Figure One"), HasSubstr("without noise it is better")));
  EXPECT_TRUE(fs::exists(file("rep/sheet/index.html")));
  EXPECT_TRUE(fs::exists(file("rep/compare_solvers/compare.json")));
  EXPECT_TRUE(fs::exists(file("rep/fig_1/charts/noise.svg")));
  EXPECT_TRUE(fs::exists(file("rep/fig_1/results.csv")));
  EXPECT_THAT(page, HasSubstr("Figure Six"));
  EXPECT_TRUE(fs::exists(file("rep/tracked/seed=2/frames.jsonl")));
}

TEST_F(ReproduceTest, AChapterByItselfAndWhole) {
  const ProgramRun run = call("reproduce chapter5");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("The report is " + file("out/chapter5/index.html")));
  EXPECT_FALSE(fs::exists(file("out/chapter5/sheet")));
  EXPECT_TRUE(fs::exists(file("out/chapter5/fig_2/seed=4")));
  EXPECT_THAT(run.err, AllOf(HasSubstr("run 2 of 6"), HasSubstr(" left")));
  EXPECT_THAT(text_of("out/chapter5/index.html"), Not(HasSubstr("quick form")));
}

TEST_F(ReproduceTest, AnUnknownChapterIsAnsweredWithWhatThereIs) {
  const ProgramRun run = call("reproduce chapter4");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err,
              HasSubstr("unknown chapter 'chapter4'; expected chapter5, chapter6; did you mean 'chapter5'?"));
}

TEST_F(ReproduceTest, WhatFailsIsReportedAndKeepsNothingElseFromBeingMade) {
  add("chapter5/fig_1.yaml",
      small + "sweep: {data.distance: [800, 100000]}\n" + "study: {title: Figure One}\n");
  add("chapter5/fig_2.yaml", small + "runs: {far: {data: {distance: 100000}}}\n");
  add("chapter5/fig_3.yaml", small + "study: {title: Figure Three}\n");
  const ProgramRun run = call("reproduce chapter5 --out rep");
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("no pixel of the camera sees the flat sheet"));
  EXPECT_THAT(run.out, HasSubstr("The report is"));
  EXPECT_THAT(text_of("rep/index.html"), AllOf(HasSubstr("The run distance=100000 failed: "),
                                               HasSubstr("far failed: "), HasSubstr("Figure Three")));
  EXPECT_TRUE(fs::exists(file("rep/fig_1/distance=800")));
  EXPECT_TRUE(fs::exists(file("rep/fig_3/result.json")));
}

TEST_F(ReproduceTest, GoesOnWhereItWasKilled) {
  add("chapter5/fig_2.yaml", small + "repeat: 1000\nsweep: {seed: [3, 4]}\n");  // takes until it is killed
  write("kill.sh",
        "prefix/bin/pliant reproduce chapter5 --out rep >killed.out 2>&1 &\n"
        "while [ ! -e rep/unfinished/fig_1/result.json ] && kill -0 $!; do sleep 0.05; done\n"
        "kill -KILL $!\n");
  ASSERT_EQ(std::system(("cd '" + file("") + "' && sh kill.sh").c_str()), 0);
  EXPECT_FALSE(fs::exists(file("rep/index.html")));
  ASSERT_TRUE(fs::exists(file("rep/unfinished/fig_1/result.json"))) << text_of("killed.out");
  add("chapter5/fig_2.yaml", small + "sweep: {seed: [3, 4]}\n");
  const ProgramRun run = call("reproduce chapter5 --out rep");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, AllOf(HasSubstr("noise=0,seed=1: taken from the earlier result"),
                             HasSubstr("noise=1,seed=2: taken from the earlier result"),
                             Not(HasSubstr("noise=1,seed=2: measuring")), HasSubstr("seed=4: measuring")));
  EXPECT_THAT(text_of("rep/index.html"), HasSubstr("Figure One"));
  EXPECT_FALSE(fs::exists(file("rep/unfinished")));
}

TEST_F(ReproduceTest, ATrackedRunThatIsKilledIsMadeAnewAndFinishedOnesAreTaken) {
  add("chapter6/tracked.yaml", tracked + "runs: {one: , two: {data: {frames: 100000}}, three: }\n");
  write(
      "kill.sh",
      "prefix/bin/pliant reproduce chapter6 --out rep >killed.out 2>&1 &\n"
      "until [ -s rep/unfinished/tracked/unfinished/two/frames.jsonl ] || ! kill -0 $!; do sleep 0.02; done\n"
      "kill -KILL $!\n");
  ASSERT_EQ(std::system(("cd '" + file("") + "' && sh kill.sh").c_str()), 0) << text_of("killed.out");
  const std::string finished = text_of("rep/unfinished/tracked/unfinished/one/frames.jsonl");
  EXPECT_EQ(std::count(finished.begin(), finished.end(), '\n'), 8);
  add("chapter6/tracked.yaml", tracked + "runs: {one: , two: , three: }\n");
  const ProgramRun run = call("reproduce chapter6 --out rep");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, AllOf(HasSubstr("one: taken from the earlier result"),
                             Not(HasSubstr("two: taken from the earlier result"))));
  EXPECT_EQ(text_of("rep/tracked/one/frames.jsonl"), finished) << "with its times";
  const std::string anew = text_of("rep/tracked/two/frames.jsonl");
  EXPECT_EQ(std::count(anew.begin(), anew.end(), '\n'), 8);
  EXPECT_FALSE(fs::exists(file("rep/unfinished")));
}

TEST_F(ReproduceTest, AFullDiskLeavesTheOldOne) {
  ASSERT_EQ(call("reproduce --quick --out rep", no_data_).exit_code, 0);
  const auto before = all_of("rep");
  const ProgramRun run = call("reproduce --quick --out rep", "ulimit -f 4000; " + no_data_);
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("cannot be written: File too large"));
  EXPECT_EQ(all_of("rep"), before);
}

}  // namespace
}  // namespace pliant::test
