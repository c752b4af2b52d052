#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "framework/core/error.h"
#include "tests/report/sample_run.h"

namespace pliant {
namespace {

TEST(Pictures, AreWrittenUnderTheirNames) {
  const auto folder = test_folder();
  const auto files = make_report("pictures")->write(sample_run(), folder);
  ASSERT_THAT(files, testing::ElementsAre(folder / "depth.png"));
  EXPECT_GT(cv::imread(files[0].string()).size().area(), 480 * 360);
  EXPECT_THAT(make_report("pictures")->files({{"a", "b"}, {}}), testing::ElementsAre("a.png", "b.png"));
}

TEST(Pictures, AreDrawnWhenTheyAreShownAndOnceForAllReports) {
  int drawn = 0;
  RunArtefacts run = sample_run();
  run.pictures = {{"one", "", [&] { return std::vector<std::uint8_t>{static_cast<std::uint8_t>(++drawn)}; }}};
  const auto folder = test_folder();
  make_report("surfaces")->write(run, folder);
  EXPECT_EQ(drawn, 0);
  for (const char* report : {"pictures", "page", "pictures"}) make_report(report)->write(run, folder);
  EXPECT_EQ(drawn, 1);
}

TEST(Pictures, SayWhichFileCannotBeWritten) {
  const auto missing = test_folder() / "missing";
  EXPECT_THAT([&] { make_report("pictures")->write(sample_run(), missing); },
              testing::ThrowsMessage<DataError>(testing::HasSubstr((missing / "depth.png").string())));
}

}  // namespace
}  // namespace pliant
