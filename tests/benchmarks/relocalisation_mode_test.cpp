#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/program/program_run.h"

namespace pliant::test {
namespace {

class RelocalisationModeTest : public ProgramTest {};

TEST_F(RelocalisationModeTest, FindsTheHeadWhereItLeapsTo) {
  const ProgramRun run = call("relocalisation --quick --json rows.json --only 'features none'");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto rows = nlohmann::json::parse(text_of("rows.json"));
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0]["relocalizer"], "features");
  EXPECT_EQ(rows[0]["texture"], "none");
  EXPECT_EQ(rows[0]["jumps"], 5);
  EXPECT_EQ(rows[0]["found"], 5);
  EXPECT_EQ(rows[0]["wrong_frames"], 0);
}

}  // namespace
}  // namespace pliant::test
