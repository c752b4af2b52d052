// Finished runs are kept for the next call when a result does not come to its end.
#include "experiments/runner/run_store.h"

#include <gmock/gmock.h>

#include <chrono>
#include <set>
#include <stdexcept>

#include "experiments/report/report.h"
#include "experiments/runner/runner.h"
#include "tests/experiments/experiment_files.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class RunStoreTest : public ExperimentFiles {
 protected:
  RunStoreTest() { fs::create_directories(file("store/a")); }

  std::string key(const ExperimentPlan& plan, int repeats = 0, std::size_t run = 0) {
    return run_key(*task_, plan.runs.at(run), workbench_.device(plan.runs.at(run).values).info(), repeats);
  }

  std::unique_ptr<Task> task_ = make_register_task();
  RunStore store_{file("store")};
  RunSummary summary_{"a",
                      {{"name", "a"}, {"error", 0.1 + 0.2}},
                      {"", {"run", "EPE mm"}, {{{"a", "1.00 -> 0.50"}}}},
                      {"ended well", "warning: dark"},
                      "place: why"};
};

TEST_F(RunStoreTest, GivesBackWhatItWasGiven) {
  store_.write(summary_, "key", {});
  const auto found = store_.find("a", "key");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->json.dump(), summary_.json.dump());
  EXPECT_EQ(found->summary.header, summary_.summary.header);
  EXPECT_EQ(found->summary.rows.at(0).cells, summary_.summary.rows[0].cells);
  EXPECT_EQ(found->notes, summary_.notes);
  EXPECT_EQ(found->failure, summary_.failure);
  const auto json = ordered_json::parse(text_of("store/a/run.json"));
  EXPECT_EQ(json["schema"], 1);
  EXPECT_EQ(json["run"], summary_.json);
}

TEST_F(RunStoreTest, TakesFilesInFoldersOfTheRunWithIt) {
  fs::create_directories(file("store/a/tracks"));
  store_.write(summary_, "key", {write("store/a/tracks/frame_0001.ply", "ply")});
  const RunStore next(file("next"), file("store"));
  ASSERT_TRUE(next.find("a", "key"));
  EXPECT_EQ(text_of("next/a/tracks/frame_0001.ply"), "ply");
  write("store/a/tracks/frame_0001.ply", "edited");
  EXPECT_FALSE(store_.find("a", "key"));
  auto json = ordered_json::parse(text_of("next/a/run.json"));
  json["files"] = {{"../../store/a/tracks/frame_0001.ply", "6 0"}};
  write("next/a/run.json", json.dump());
  EXPECT_FALSE(RunStore(file("next")).find("a", "key")) << "not of the run";
}

TEST_F(RunStoreTest, AFolderIsAnotherOneWhenItsFilesChange) {
  const Parameters section("tum", {{"folder", file("store")}});
  const std::string before = fingerprint(section);
  EXPECT_EQ(fingerprint(section), before);
  const std::string added = write("store/a/1.png", "one");
  const std::string with_file = fingerprint(section);
  EXPECT_NE(with_file, before);
  fs::last_write_time(added, fs::last_write_time(added) + std::chrono::seconds(5));
  EXPECT_NE(fingerprint(section), with_file);
}

TEST_F(RunStoreTest, GivesNothingElse) {
  const std::string page = write("store/a/index.html", "page");
  store_.write(summary_, "key", {page});
  EXPECT_TRUE(store_.find("a", "key"));
  EXPECT_FALSE(store_.find("a", "other key"));
  EXPECT_FALSE(store_.find("b", "key"));
  write("store/a/index.html", "");
  EXPECT_FALSE(store_.find("a", "key")) << "a file of the run is torn";
  write("store/a/index.html", "qage");
  EXPECT_FALSE(store_.find("a", "key")) << "a file of the run was edited";
  fs::remove(page);
  EXPECT_FALSE(store_.find("a", "key")) << "a file of the run is gone";
  write("store/a/run.json", "{\"key\": \"key\", ");
  EXPECT_FALSE(store_.find("a", "key"));
  write("store/a/run.json", "{\"key\": \"key\", \"files\": {}}");
  EXPECT_FALSE(store_.find("a", "key"));
  write("notes", "mine");
  write("store/a/run.json", "{\"key\": \"key\", \"files\": {\"../../notes\": \"4 0\"}}");
  EXPECT_FALSE(store_.find("a", "key"));
}

TEST_F(RunStoreTest, TakesARunOfAnEarlierResultWithItsFilesAndNoOthers) {
  store_.write(summary_, "key", {write("store/a/index.html", "page")});
  write("store/a/notes", "mine");
  const RunStore other(file("other"), file("store"));
  EXPECT_FALSE(other.find("a", "other key"));
  EXPECT_TRUE(other.find("a", "key"));
  EXPECT_TRUE(RunStore(file("other")).find("a", "key"));
  EXPECT_EQ(text_of("other/a/index.html"), "page");
  EXPECT_FALSE(fs::exists(file("other/a/notes")));
  write("taken", "a file");
  EXPECT_THAT(data_error_of([&] { RunStore(file("taken"), file("store")).find("a", "key"); }),
              HasSubstr("taken/a/index.html: cannot be written"));
}

TEST_F(RunStoreTest, TheKeyChangesWithWhatARunComesOfAndWithNothingElse) {
  const std::string first = key(plan("runs: {a: , b: {seed: 2}}"));
  EXPECT_EQ(key(plan("name: other\nruns: {c: , d: , e: }\nquick: [c]")), first);
  EXPECT_EQ(key(plan("")), first);
  EXPECT_NE(key(plan("runs: {a: , b: {seed: 2}}"), 0, 1), first);
  EXPECT_NE(key(plan("graph: {spacing: 11}")), first);
  EXPECT_NE(key(plan("reports: {surfaces: {depth_step: 10}}")), first);
  EXPECT_NE(key(plan(""), 3), first);
  task_ = make_compare_task();
  EXPECT_NE(key(plan("")), first);
}

TEST_F(RunStoreTest, TheKeyChangesWithAFileThatTheRunReads) {
  write("k.txt", "131.25 0 79.5\n0 131.25 59.5\n0 0 1\n");
  const std::string image = write("d.png", "one");
  const ExperimentPlan made =
      plan("data: {type: rgbd_pair, source: {depth: d.png}, target: {depth: d.png}, intrinsics: k.txt}");
  const std::string first = key(made);
  EXPECT_EQ(key(made), first);
  fs::last_write_time(image, fs::last_write_time(image) + std::chrono::seconds(1));
  EXPECT_NE(key(made), first);
}

class UnfinishedTest : public ExperimentFiles {
 protected:
  static constexpr const char* with_a_bad_run = "runs: {a: , bad: {graph: {spacing: 1000}}, c: {seed: 3}}";

  ExperimentResult run(const ExperimentPlan& plan, const ProgressSink& progress = {}) {
    return run_experiment(*make_register_task(), plan, file("out"), workbench_, progress);
  }

  ordered_json result() const { return ordered_json::parse(text_of("out/result.json")); }

  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(file("out"))) names.insert(entry.path().filename());
    return names;
  }

  /// Ends a call as a library that has no more memory would, when the run `name` begins.
  void run_until(const ExperimentPlan& plan, const std::string& name) {
    EXPECT_THROW(run(plan,
                     [&](const Progress& step) {
                       if (step.what == name) throw std::runtime_error("the end");
                     }),
                 std::runtime_error);
  }
};

TEST_F(UnfinishedTest, ARunThatFailsKeepsNoOtherFromBeingMadeAndTold) {
  const ExperimentResult made = run(plan(with_a_bad_run));
  ASSERT_EQ(made.runs.size(), 2U);
  EXPECT_THROW(check_ends(made), DataError);
  const ordered_json json = result();
  EXPECT_EQ(json["schema"], 1);
  EXPECT_EQ(json["runs"][1]["name"], "c");
  ASSERT_EQ(json["failed"].size(), 1U);
  EXPECT_EQ(json["failed"][0]["name"], "bad");
  EXPECT_THAT(json["failed"][0]["error"].get<std::string>(), HasSubstr("small.yaml, run bad: "));
  EXPECT_EQ(files(), (std::set<std::string>{".pliant", "result.json", "results.csv", "experiment.yaml",
                                            "index.html", "a", "c"}));
}

TEST_F(UnfinishedTest, TheOverviewNamesTheRunsThatFailed) {
  run(plan(with_a_bad_run));
  EXPECT_THAT(text_of("out/index.html"), HasSubstr("choose a finer one"));
}

/// Writes nothing from the second run on, as to a disk that is full.
class FullDisk : public Report {
 public:
  std::vector<std::string> files(const ArtefactNames&) const override { return {"f.txt"}; }
  std::vector<fs::path> write(const RunArtefacts& run, const fs::path& folder) const override {
    if (run.name != "a") throw DataError((folder / "f.txt").string() + ": No space left on device");
    return {};
  }
};

TEST_F(UnfinishedTest, WhatCannotBeWrittenLeavesTheOldResultWhole) {
  run(plan("runs: {a: , b: }"));
  const std::string before = text_of("out/result.json");
  registry_.add<Report>("full_disk", "", {},
                        [](const Parameters&, const Registry&) { return std::make_unique<FullDisk>(); });
  const ExperimentPlan full = plan("runs: {a: , b: , c: }\nreports: {full_disk: }");
  EXPECT_THAT(data_error_of([&] { run(full); }), HasSubstr("b/f.txt: No space left"));
  EXPECT_EQ(text_of("out/result.json"), before);
  EXPECT_TRUE(fs::exists(file("out/unfinished/a/run.json"))) << "what was finished is kept for the next call";
}

TEST_F(UnfinishedTest, TheNextCallTakesTheOthersUnchangedAndMakesTheFailedOneAgain) {
  run(plan(with_a_bad_run));
  const ordered_json before = result();
  EXPECT_THAT(run(plan(with_a_bad_run)).taken, ElementsAre("a", "c"));
  EXPECT_EQ(result()["failed"], before["failed"]);
  const std::string surface = text_of("out/a/registered.ply");
  const ExperimentPlan mended = plan("runs: {a: , bad: {graph: {spacing: 14}}, c: {seed: 3}}");
  const ExperimentResult made = run(mended);
  EXPECT_THAT(made.taken, ElementsAre("a", "c"));
  EXPECT_EQ(run_tables(*make_register_task(), mended, made).at(0).rows.at(1).link, "bad/index.html");
  const ordered_json after = result();
  EXPECT_FALSE(after.contains("failed"));
  ASSERT_EQ(after["runs"].size(), 3U);
  EXPECT_EQ(after["runs"][0].dump(), before["runs"][0].dump()) << "with its times";
  EXPECT_EQ(after["runs"][2].dump(), before["runs"][1].dump());
  EXPECT_EQ(text_of("out/a/registered.ply"), surface);
}

TEST_F(UnfinishedTest, AResultThatIsWholeIsMadeAnew) {
  run(plan("runs: {a: , b: }"));
  EXPECT_THAT(run(plan("runs: {a: , b: }")).taken, IsEmpty());
}

TEST_F(UnfinishedTest, RunsOfOtherValuesAreMadeAnew) {
  run(plan(with_a_bad_run));
  EXPECT_THAT(run(plan(with_a_bad_run, {"data.noise=1"})).taken, IsEmpty());
}

TEST_F(UnfinishedTest, WhereAllRunsFailTheFirstErrorIsThrownAndTheOldResultStays) {
  run(plan("runs: {a: , b: }"));
  const std::string before = text_of("out/result.json");
  EXPECT_THAT(data_error_of([&] { run(plan("graph: {spacing: 1000}\nruns: {x: , y: }")); }),
              HasSubstr("run x: "));
  EXPECT_EQ(text_of("out/result.json"), before);
  EXPECT_FALSE(fs::exists(file("out/unfinished")));
}

TEST_F(UnfinishedTest, WhatEndsACallLeavesTheOldResultAndTheFinishedRunsForTheNext) {
  run(plan("seed: 5"));
  const std::string before = text_of("out/result.json");
  const ExperimentPlan made = plan("runs: {a: , b: {seed: 2}, c: {seed: 3}}");
  run_until(made, "b");
  EXPECT_EQ(text_of("out/result.json"), before);
  EXPECT_TRUE(fs::exists(file("out/unfinished/a/registered.ply")));
  const ordered_json of_a = ordered_json::parse(text_of("out/unfinished/a/run.json"))["run"];
  fs::create_directories(file("out/unfinished/b"));
  write("out/unfinished/b/source.ply", "half of it");
  run_until(made, "c");
  EXPECT_THAT(run(made).taken, ElementsAre("a", "b"));
  EXPECT_EQ(result()["runs"][0].dump(), of_a.dump()) << "with its times";
  EXPECT_FALSE(fs::exists(file("out/unfinished")));
}

TEST_F(UnfinishedTest, AnotherExperimentClearsItAway) {
  run_until(plan("runs: {a: , b: }"), "b");
  EXPECT_THAT(run(plan("runs: {a: {seed: 4}, d: }")).taken, IsEmpty());
  EXPECT_EQ(files(), (std::set<std::string>{".pliant", "result.json", "experiment.yaml", "index.html",
                                            "results.csv", "a", "d"}));
}

TEST_F(UnfinishedTest, ASingleRunLeavesNothing) {
  run_until(plan(""), "small");
  EXPECT_FALSE(fs::exists(file("out")));
}

}  // namespace
}  // namespace pliant::test
