#include <gmock/gmock.h>

#include <filesystem>

#include "tests/program/program_run.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;
using ::testing::EndsWith;
using ::testing::HasSubstr;

class ViewTest : public ProgramTest {
 protected:
  /// A result in the folder `made`.
  void make(const std::string& reports, const std::string& more = "") {
    write("small.yaml",
          "extends: methods/ed.yaml\n"
          "data: {type: synthetic_sheet, image_width: 160, image_height: 120, focal_length: 131.25}\n"
          "graph: {spacing: 12}\nreports: " +
              reports + "\n" + more);
    const ProgramRun run = call("run small.yaml --out made");
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }

  /// A program xdg-open that keeps what it is called with, and ends with a code.
  std::string path_with_opener(int code) const {
    fs::create_directories(file("bin"));
    const std::string opener =
        write("bin/xdg-open", "#!/bin/sh\necho \"$1\" >opened\nexit " + std::to_string(code) + "\n");
    fs::permissions(opener, fs::perms::owner_all);
    return "PATH='" + file("bin") + "':\"$PATH\"";
  }
};

TEST_F(ViewTest, SaysWhereThePageOfAResultIs) {
  make("{page: {view: false}}");
  const std::string before = text_of("made/index.html");
  const ProgramRun view = call("view made");
  EXPECT_EQ(view.exit_code, 0) << view.err;
  EXPECT_EQ(view.out, file("made/index.html") + "\n");
  EXPECT_EQ(text_of("made/index.html"), before);
  EXPECT_EQ(call("view made/").out, view.out);
}

TEST_F(ViewTest, MakesAPageOfWhatIsStoredWhereThereIsNone) {
  make("{view: }");
  ASSERT_FALSE(fs::exists(file("made/index.html")));
  const ProgramRun view = call("view made");
  ASSERT_EQ(view.exit_code, 0) << view.err;
  const std::string page = text_of("made/index.html");
  for (const char* text : {"<title>made - Pliant", "epe_mean", "outer_iterations", "class=\"view-figure\"",
                           "robust residual, mm", "opencl_driver"})
    EXPECT_THAT(page, HasSubstr(text));
  // It belongs to the result now: the next one replaces it.
  EXPECT_EQ(call("run small.yaml --out made --set reports.page=page").exit_code, 0);
  EXPECT_THAT(text_of("made/index.html"), HasSubstr("<title>small - Pliant"));
}

TEST_F(ViewTest, MakesAPageOfATrackedStreamWhereThereIsNone) {
  write("head.yaml",
        "data: {type: head, image_width: 160, image_height: 120, focal_length: 131.25, frames: 3}\n"
        "model: {type: tsdf, volume: fitted, resolution: 64}\nreports: {}\n");
  ASSERT_EQ(call("track head.yaml --out made").exit_code, 0);
  const ProgramRun view = call("view made");
  ASSERT_EQ(view.exit_code, 0) << view.err;
  const std::string page = text_of("made/index.html");
  for (const char* text : {"Tracking", "frame_ms", "ate_translation"}) EXPECT_THAT(page, HasSubstr(text));
}

TEST_F(ViewTest, MakesThePageOfOneRunOfSeveral) {
  make("{}", "runs: {a: , b: }\n");
  const ProgramRun view = call("view made/b");
  ASSERT_EQ(view.exit_code, 0) << view.err;
  EXPECT_EQ(view.out, file("made/b/index.html") + "\n");
  EXPECT_THAT(text_of("made/.pliant"), HasSubstr("b/index.html"));
  EXPECT_EQ(call("run small.yaml --out made").exit_code, 0);
}

TEST_F(ViewTest, OpensThePage) {
  make("{page: {view: false}}");
  EXPECT_EQ(call("view made --open", path_with_opener(0)).exit_code, 0);
  EXPECT_EQ(text_of("opened"), file("made/index.html") + "\n");
}

TEST_F(ViewTest, SaysSoWhereNothingOpensIt) {
  make("{page: {view: false}}");
  const ProgramRun refused = call("view made --open", path_with_opener(3));
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.err, HasSubstr("open it in a browser"));
  const ProgramRun missing = call("view made --open", "PATH=/nowhere");
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_THAT(missing.err, HasSubstr("xdg-open"));
}

TEST_F(ViewTest, RefusesWhatIsNoResult) {
  fs::create_directories(file("other"));
  const ProgramRun other = call("view other");
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_THAT(other.err, HasSubstr("other: holds no result"));
  EXPECT_THAT(call("view nowhere").err, HasSubstr("nowhere: there is no such folder"));
}

TEST_F(ViewTest, NamesTheFileThatIsNotWhatARunWrites) {
  make("{}");
  write("made/result.json", "{\"runs\": [{\"name\": 3}]}");
  const ProgramRun broken = call("view made");
  EXPECT_EQ(broken.exit_code, 3);
  EXPECT_THAT(broken.err, HasSubstr("made/result.json: is not what pliant run writes"));
  EXPECT_FALSE(fs::exists(file("made/index.html")));
}

}  // namespace
}  // namespace pliant::test
