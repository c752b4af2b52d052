#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/program/program_run.h"

namespace pliant::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class PairModeTest : public ProgramTest {
 protected:
  json rows_of(const std::string& arguments) const {
    const ProgramRun run = call("pair --quick --json rows.json " + arguments, "PLIANT_DATA=" + file("none"));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return json::parse(text_of("rows.json"));
  }
};

void expect_sound(const json& row) {
  const double time = row["time_ms"];
  EXPECT_GT(time, 0);
  EXPECT_NEAR(row["fps"], 1000 / time, 1e-6 * 1000 / time);
  EXPECT_GT(row["nodes"], 0);
  EXPECT_GT(row["constraints"], 0);
  EXPECT_GT(row["residual_mean"], 0);
  EXPECT_GT(row["epe_initial_mean"], 9) << "the sheet bends by 20 mm at its peak";
  EXPECT_LT(row["epe_mean"], 2);
  for (const char* stage : {"alignment", "weights", "match", "solver", "warp"}) {
    ASSERT_TRUE(row["stages_ms"].contains(stage)) << stage;
    EXPECT_GT(row["stages_ms"][stage], 0) << stage;
    EXPECT_LT(row["stages_ms"][stage], 3 * time) << stage;
  }
}

TEST_F(PairModeTest, EachMethodRegistersTheSheetAsItself) {
  const json rows = rows_of("--only sheet");
  ASSERT_EQ(rows.size(), 5U);
  const std::vector<std::string> methods{"ed", "ad_nodes", "ad_nodes_ad_cons", "best", "best_depth"};
  for (std::size_t i = 0; i < methods.size(); ++i) {
    SCOPED_TRACE(methods[i]);
    EXPECT_EQ(rows[i]["name"], methods[i]);
    EXPECT_EQ(rows[i]["data"], "sheet");
    expect_sound(rows[i]);
  }
  EXPECT_LT(rows[1]["nodes"], rows[0]["nodes"]) << "a quadtree";
  EXPECT_GT(rows[3]["constraints"], 1.5 * rows[0]["constraints"].get<int>())
      << "every third pixel, not fourth";
}

TEST_F(PairModeTest, DataThatIsNotThereIsNamed) {
  if (std::filesystem::exists(std::filesystem::path(PLIANT_DATA_FOLDER) / "ict_face"))
    GTEST_SKIP() << "the project's own data folder has it";
  const ProgramRun run = call("pair --only cheeks", "PLIANT_DATA=" + file("none"));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("cheeks: skipped, ict_face/ict_face.glb was not found"));
}

}  // namespace
}  // namespace pliant::test
