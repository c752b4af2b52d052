#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/program/program_run.h"

namespace pliant::test {
namespace {

class RenderModeTest : public ProgramTest {};

TEST_F(RenderModeTest, TimesFramesBesideTheReference) {
  const ProgramRun run = call("render --quick --only 2500 --json rows.json");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto rows = nlohmann::json::parse(text_of("rows.json"));
  ASSERT_EQ(rows.size(), 2U);
  for (const auto& row : rows) {
    EXPECT_GT(row["triangles"], 2000);
    EXPECT_GT(row["time_ms"], 0);
    EXPECT_GT(row["reference_time_ms"], 0);
    EXPECT_GT(row["kernels_ms"]["draw"], 0);
  }
}

}  // namespace
}  // namespace pliant::test
