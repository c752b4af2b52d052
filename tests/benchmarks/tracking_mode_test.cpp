#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/program/program_run.h"

namespace pliant::testing {
namespace {

class TrackingModeTest : public ProgramTest {};

TEST_F(TrackingModeTest, TimesEveryStageBesideOpenCv) {
  const ProgramRun run = call("tracking --quick --json rows.json");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto lists = nlohmann::json::parse(text_of("rows.json"));
  ASSERT_EQ(lists.size(), 2U);
  const std::vector<std::string> stages{"bilateral", "normals", "icp", "integrate", "raycast", "frame"};
  for (const char* name : {"full", "object"}) {
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
}

}  // namespace
}  // namespace pliant::testing
