#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiments/report/base64.h"
#include "experiments/report/page.h"
#include "experiments/report/study_page.h"
#include "experiments/report/view_html.h"
#include "framework/core/error.h"
#include "framework/io/file.h"
#include "tests/report/sample_run.h"
#include "tests/report/sample_view.h"

namespace pliant {
namespace {

using nlohmann::ordered_json;
using testing::HasSubstr;
using testing::Not;

/// The inverse of base64().
std::vector<std::uint8_t> decode(const std::string& text) {
  const std::string alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char letter : text) {
    if (letter == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(alphabet.find(letter));
    count += 6;
    if (count >= 8) bytes.push_back(static_cast<std::uint8_t>(bits >> (count -= 8) & 0xFF));
  }
  return bytes;
}

std::vector<int> integers(const ordered_json& text) {
  const auto bytes = decode(text.get<std::string>());
  std::vector<int> values;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) values.push_back(bytes[i] + 256 * bytes[i + 1]);
  return values;
}

Eigen::Vector3f point(const ordered_json& view, const ordered_json& text, std::size_t index) {
  const auto values = integers(text);
  Eigen::Vector3f place;
  for (std::size_t i = 0; i < 3; ++i)
    place[static_cast<Eigen::Index>(i)] =
        view["box"]["low"][i].get<float>() +
        static_cast<float>(values[3 * index + i]) * view["box"]["step"].get<float>();
  return place;
}

TEST(ViewJson, KeepsPlacesToAHundredthOfAMillimetre) {
  const ViewData data = sample_view(9, 4);
  const ordered_json view = view_json(data);
  for (std::size_t i = 0; i < data.source.points.size(); ++i) {
    EXPECT_LT((point(view, view["source"]["points"], i) - data.source.points[i]).norm(), 0.01F);
    EXPECT_LT((point(view, view["steps"][2]["points"], i) - data.steps[2].points[i]).norm(), 0.01F);
  }
  EXPECT_LT((point(view, view["steps"][1]["nodes"], 2) - data.steps[1].nodes[2]).norm(), 0.01F);
  EXPECT_LT((point(view, view["steps"][1]["constraints"], 3) - data.target.points.back()).norm(), 0.01F);
}

TEST(ViewJson, KeepsErrorsAndWhereThereIsNone) {
  const ViewData data = sample_view(9, 4);
  const ordered_json view = view_json(data);
  const auto truth = decode(view["steps"][0]["truth"].get<std::string>());
  ASSERT_EQ(truth.size(), 81U);
  EXPECT_EQ(truth[0], 255);
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const float part = static_cast<float>(truth[i]) / 254;
    EXPECT_NEAR(part * part * view["largest_error"].get<float>(), data.steps[0].truth[i], 0.06);
  }
}

TEST(ViewJson, TellsOfGraphCellsAndUnmatchedPoints) {
  const ordered_json view = view_json(sample_view(9, 4));
  EXPECT_THAT(integers(view["graphs"][0]["edges"]), testing::ElementsAre(0, 1, 1, 2)) << "each once";
  EXPECT_EQ(view["graphs"][0]["cells"].size(), 3U);
  EXPECT_THAT(integers(view["unmatched"]),
              testing::ElementsAre(0, 7, 14, 21, 28, 35, 42, 49, 56, 63, 70, 77));
  EXPECT_EQ(view["result"], 3);
  EXPECT_EQ(view["has_truth"], true);
  EXPECT_EQ(view["steps"][1]["constraint_count"], 2000);
}

TEST(ViewJson, TellsOfFramesAndTheirCamera) {
  const ViewData data = sample_frames(8, 3);
  const ordered_json view = view_json(data);
  EXPECT_EQ(view["frames"]["columns"], 8);
  EXPECT_EQ(view["frames"]["gap"], 50);
  EXPECT_LT((point(view, view["frames"]["path"], 2) - Eigen::Vector3f(40, 0, 0)).norm(), 0.01F);
  const ordered_json& last = view["steps"][2];
  EXPECT_EQ(last["number"], 3);
  EXPECT_EQ(last["state"], "tracked");
  EXPECT_EQ(integers(last["cells"]), data.steps[2].cells);
  EXPECT_LT((point(view, last["camera"], 3) - data.steps[2].camera[3]).norm(), 0.01F);
  EXPECT_FALSE(view_json(sample_view(9, 4)).contains("frames"));
}

TEST(ViewJson, OfNothingIsStillAView) {
  EXPECT_NO_THROW(view_json(ViewData{}));
  EXPECT_EQ(view_json(ViewData{})["has_truth"], false);
}

TEST(ViewJson, StaysSmallWithAsManyPointsAsItShouldHave) {
  for (const bool has_truth : {false, true})
    for (const int steps : {2, 12}) {
      const std::size_t points = view_points(static_cast<std::size_t>(steps), has_truth);
      ViewData data = sample_view(static_cast<int>(std::sqrt(static_cast<double>(points))), steps);
      if (!has_truth)
        for (auto& step : data.steps) step.truth.clear();
      const std::size_t size = view_json(data).dump().size();
      EXPECT_LT(size, 1'050'000U) << steps << " steps";
      EXPECT_LE(points, 12'000U);
      EXPECT_GT(points, 3'500U);
    }
}

RunArtefacts run_with_view(int& gathered) {
  RunArtefacts run = sample_run();
  run.view.emplace([&gathered] {
    ++gathered;
    return sample_view(9, 3);
  });
  return run;
}

TEST(ViewReport, WritesAViewThatPagesOfStudiesShow) {
  int gathered = 0;
  const RunArtefacts run = run_with_view(gathered);
  const auto folder = test_folder();
  ASSERT_THAT(make_report("view")->write(run, folder), testing::ElementsAre(folder / "view.json"));
  EXPECT_THAT(make_report("view")->files({{}, {}, true}), testing::ElementsAre("view.json"));
  Study study;
  study.name = study.title = "study";
  study.views = {{"hand, seed 1 & more", folder / "view.json"}};
  const std::string page = make_study_page("", "", {study});
  EXPECT_THAT(page, HasSubstr("<h2>hand, seed 1 &amp; more</h2>"));
  EXPECT_THAT(page, HasSubstr("class=\"view-figure\" data-scale=\"8\""));
}

TEST(ViewReport, WritesNothingWhereThereIsNoView) {
  const auto folder = test_folder();
  EXPECT_TRUE(make_report("view")->write(sample_run(), folder).empty());
  EXPECT_TRUE(make_report("view")->files({{}, {}, false}).empty());
}

TEST(View, IsGatheredWhenItIsShownAndOnceForAllReports) {
  int gathered = 0;
  const RunArtefacts run = run_with_view(gathered);
  const auto folder = test_folder();
  for (const char* report : {"surfaces", "pictures"}) make_report(report)->write(run, folder);
  make_page(run, false);
  EXPECT_EQ(gathered, 0);
  for (const char* report : {"page", "view", "page"}) make_report(report)->write(run, folder);
  EXPECT_EQ(gathered, 1);
}

TEST(View, IsOnThePageOfItsRunUnlessThatIsNotAskedFor) {
  int gathered = 0;
  const RunArtefacts run = run_with_view(gathered);
  EXPECT_THAT(make_page(run), HasSubstr("class=\"view-figure\""));
  EXPECT_THAT(make_page(run, false), Not(HasSubstr("class=\"view-figure\"")));
}

TEST(ReadView, RefusesWhatIsNoViewAndNamesTheFile) {
  const auto file = test_folder() / "view.json";
  const auto refuses = [&](const std::string& text, const char* why) {
    write_file(file.string(), {text.begin(), text.end()});
    EXPECT_THAT([&] { read_view(file); },
                testing::ThrowsMessage<DataError>(testing::AllOf(HasSubstr(file.string()), HasSubstr(why))));
  };
  refuses("{\"format\"", "is no view");
  refuses("[1]", "is no view");
  refuses("{}", "is no view");
  refuses("{\"format\": 2}", "another version");
  EXPECT_THROW(read_view(test_folder() / "missing.json"), DataError);
}

}  // namespace
}  // namespace pliant
