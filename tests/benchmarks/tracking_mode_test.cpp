#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/program/program_run.h"

namespace pliant::test {
namespace {

class TrackingModeTest : public ProgramTest {};

TEST_F(TrackingModeTest, TimesEveryStageBesideOpenCv) {
  const std::vector<std::string> stages{"bilateral", "normals", "icp", "integrate", "raycast", "frame"};
  for (const std::string name : {"full", "object"}) {
    const ProgramRun run = call("tracking --quick --json rows.json --only '" + name + " '");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const auto lists = nlohmann::json::parse(text_of("rows.json"));
    ASSERT_EQ(lists.size(), 3U);
    const auto& rows = lists.at(name);
    ASSERT_EQ(rows.size(), stages.size()) << name;
    for (std::size_t i = 0; i < stages.size(); ++i) {
      EXPECT_EQ(rows[i].size(), 4U);
      EXPECT_EQ(rows[i]["stage"], stages[i]);
      const double time = rows[i]["time_ms"], opencv_time = rows[i]["opencv_time_ms"];
      EXPECT_GT(time, 0);
      EXPECT_GT(opencv_time, 0);
      EXPECT_NEAR(rows[i]["ratio_to_opencv"], time / opencv_time, 1e-9 * time / opencv_time);
    }
  }
}

TEST_F(TrackingModeTest, MeasuresOnlyWhatIsAskedFor) {
  const ProgramRun run = call("tracking --quick --json rows.json --only 'object normals'");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto lists = nlohmann::json::parse(text_of("rows.json"));
  EXPECT_TRUE(lists.at("full").empty());
  EXPECT_EQ(lists.at("object").size(), 1U);
  EXPECT_TRUE(lists.at("policies").empty());
}

TEST_F(TrackingModeTest, TracksASequenceByAPolicy) {
  const ProgramRun run =
      call("tracking --quick --json rows.json --only 'policies smile adaptive_reintegration'");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto lists = nlohmann::json::parse(text_of("rows.json"));
  const auto& rows = lists.at("policies");
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0]["sequence"], "smile");
  EXPECT_EQ(rows[0]["policy"], "adaptive_reintegration");
  EXPECT_GT(rows[0]["frames"], 150);
  EXPECT_GT(rows[0]["fps"], 0);
  EXPECT_GE(rows[0]["slowest_frame_ms"].get<double>(), 1000 / rows[0]["fps"].get<double>());
  EXPECT_GT(rows[0]["registered"], 0);
  EXPECT_LT(rows[0]["registered"], 1);
  EXPECT_EQ(rows[0]["lost"], 0);
}

}  // namespace
}  // namespace pliant::test
