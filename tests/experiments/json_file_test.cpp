#include "experiments/tasks/json_file.h"

#include <gmock/gmock.h>

#include <limits>

#include "framework/core/error.h"
#include "tests/io/test_files.h"

namespace pliant::test {
namespace {

using nlohmann::ordered_json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class JsonFileTest : public TestFiles {
 protected:
  std::string text_of(const std::string& name) const {
    const auto bytes = read_file(file(name));
    return {bytes.begin(), bytes.end()};
  }
};

TEST_F(JsonFileTest, JsonWithoutFiniteNumbersIsNotWritten) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const ordered_json bad = {{"runs", {{{"metrics", {{"epe_mean", nan}}}}}}};
  try {
    write_json(file("bad.json"), bad);
    FAIL() << "NaN was written";
  } catch (const NumericalError& error) {
    EXPECT_STREQ(error.what(), "runs[0].metrics.epe_mean is nan; there is no finite answer");
  }
  EXPECT_FALSE(std::filesystem::exists(file("bad.json")));
}

TEST_F(JsonFileTest, WhatIsNoJsonIsADataErrorWithTheFile) {
  EXPECT_THAT(data_error_of([&] { read_json(write("torn.json", "{\"a\": ")); }),
              HasSubstr("torn.json: is no JSON"));
  EXPECT_THAT(data_error_of([&] { read_json(file("missing.json")); }),
              HasSubstr("missing.json: no such file"));
}

TEST_F(JsonFileTest, LinesAreThereAsSoonAsTheyAreAppended) {
  JsonLines lines(file("frames.jsonl"));
  lines.append({{"frame", 0}, {"error", 0.5}});
  EXPECT_EQ(text_of("frames.jsonl"), "{\"frame\":0,\"error\":0.5}\n");
  lines.append({{"frame", 1}, {"why", "two\nlines"}});
  const auto values = read_json_lines(file("frames.jsonl"));
  ASSERT_EQ(values.size(), 2U);
  EXPECT_EQ(values[1]["why"], "two\nlines");
}

TEST_F(JsonFileTest, ALineThatWasTornIsLeftOutAndWrittenOver) {
  write("frames.jsonl", "{\"frame\": 0}\n{\"frame\": 1}\n{\"fra");
  EXPECT_EQ(read_json_lines(file("frames.jsonl")).size(), 2U);
  JsonLines(file("frames.jsonl")).append({{"frame", 2}});
  EXPECT_THAT(
      read_json_lines(file("frames.jsonl")),
      ElementsAre(ordered_json{{"frame", 0}}, ordered_json{{"frame", 1}}, ordered_json{{"frame", 2}}));
  EXPECT_TRUE(read_json_lines(write("only_torn.jsonl", "{")).empty());
  EXPECT_TRUE(read_json_lines(write("empty.jsonl", "")).empty());
}

TEST_F(JsonFileTest, ABrokenLineBeforeTheLastIsADataErrorWithFileAndLine) {
  const std::string broken = write("frames.jsonl", "{\"frame\": 0}\n{\"frame\n{\"frame\": 2}\n");
  EXPECT_THAT(data_error_of([&] { read_json_lines(broken); }), HasSubstr("frames.jsonl:2: is no JSON"));
}

TEST_F(JsonFileTest, ALineWithoutFiniteNumbersIsNotWritten) {
  JsonLines lines(file("frames.jsonl"));
  EXPECT_THROW(lines.append({{"error", std::numeric_limits<double>::infinity()}}), NumericalError);
  EXPECT_EQ(text_of("frames.jsonl"), "");
}

TEST_F(JsonFileTest, LinesThatCannotBeWrittenAreADataErrorWithTheFile) {
  EXPECT_THAT(data_error_of([&] { JsonLines(file("missing/frames.jsonl")); }),
              HasSubstr("missing/frames.jsonl: cannot be written: No such file"));
  EXPECT_THAT(data_error_of([&] {
                JsonLines("/dev/full").append({{"frame", 0}});
              }),
              HasSubstr("/dev/full: cannot be written"));
}

}  // namespace
}  // namespace pliant::test
