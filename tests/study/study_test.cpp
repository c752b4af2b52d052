#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "experiments/study/study_section.h"
#include "framework/config/config.h"
#include "framework/core/error.h"

namespace pliant {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// Two methods on two sets with two seeds each; the error is 10 * method + set + seed / 10.
std::vector<RunRow> runs() {
  std::vector<RunRow> rows;
  for (int method = 1; method <= 2; ++method)
    for (int set = 1; set <= 2; ++set)
      for (int seed = 1; seed <= 2; ++seed)
        rows.push_back(make_run_row(
            "method=" + std::string(method == 1 ? "ED" : "AdNodes") + ",set=" + std::to_string(set) +
                ",seed=" + std::to_string(seed),
            {{"metrics", {{"error", 10.0 * method + set + seed / 10.0}}}, {"nodes", 100 * set}}));
  return rows;
}

/// Of a run three frames, in the second of which it was lost; their error is 100 * method + seed + frame.
std::vector<Numbers> frames_of(const RunRow& row) {
  const double error = (row.on("method") == "ED" ? 100 : 200) + std::stod(*row.on("seed"));
  return {{{"frame", 1}, {"error", error + 1}}, {{"frame", 2}}, {{"frame", 3}, {"error", error + 3}}};
}

Study study(const std::string& yaml, const std::vector<RunRow>& rows = runs()) {
  const ParameterTable table{group("study", study_table())};
  const Experiment experiment = load_experiment(
      {ConfigText{yaml, "exp.yaml", std::filesystem::current_path()}, {}, {}, {}}, table, Registry());
  return make_study(experiment.values.section("study"), rows, frames_of);
}

std::string error_of(const std::string& yaml) {
  try {
    study(yaml);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(RunRow, TellsAxesAndNumbers) {
  const RunRow row = make_run_row("coarse,k=4", {{"a", {{"b", 2}, {"c", "text"}}}, {"list", {1, 2}}});
  EXPECT_EQ(row.on("run"), "coarse");
  EXPECT_EQ(row.on("k"), "4");
  EXPECT_EQ(row.on("seed"), std::nullopt);
  EXPECT_THAT(row.numbers, ElementsAre(testing::Pair("a.b", 2)));
}

TEST(RowFilter, TakesWhatMeetsAllConditions) {
  const std::vector<RunRow> rows = runs();
  const auto taken = [&](const std::vector<std::string>& where) {
    const RowFilter filter(where, rows, "here");
    return std::count_if(rows.begin(), rows.end(), [&](const RunRow& row) { return filter.takes(row); });
  };
  EXPECT_EQ(taken({}), 8);
  EXPECT_EQ(taken({"method=ED"}), 4);
  EXPECT_EQ(taken({"method=ED", "seed=2"}), 2);
  EXPECT_EQ(taken({"method=Ad*"}), 4);
  EXPECT_EQ(taken({"method=*", "set=1"}), 4);
  EXPECT_THROW(taken({"method=E"}), ConfigError);
  EXPECT_THROW(taken({"method=X*"}), ConfigError);
}

TEST(StudyChart, HasThePointsOfASeriesOverAnAxis) {
  const Study made = study(R"(
study:
  charts:
    error:
      title: "Figure 1"
      kind: lines
      over: set
      y_label: mm
      series:
        error: {value: metrics.error, by: method}
)");
  ASSERT_THAT(made.charts, SizeIs(1));
  const Chart& chart = made.charts[0];
  EXPECT_EQ(chart.name, "error");
  EXPECT_EQ(chart.x_label, "set");
  ASSERT_THAT(chart.series, SizeIs(2));
  EXPECT_EQ(chart.series[0].name, "ED");
  ASSERT_THAT(chart.series[1].points, SizeIs(2));
  const Chart::Point& point = chart.series[1].points[1];
  EXPECT_EQ(point.x, 2);
  EXPECT_EQ(point.label, "2");
  EXPECT_NEAR(point.value, 22.15, 1e-12);
  EXPECT_NEAR(point.spread, 0.05, 1e-12);
  EXPECT_EQ(point.count, 2);
}

TEST(StudyChart, IsDrawnWhereAFormulaSaysAndOnlyOfSomeRuns) {
  const Study made = study(R"(
study:
  charts:
    error:
      title: t
      over: set
      x: nodes / 10
      y_label: mm
      where: [seed=1]
      series:
        uniform: {value: metrics.error, where: [method=ED]}
        adaptive: {value: 2 * metrics.error, where: [method=AdNodes]}
)");
  const auto& series = made.charts[0].series;
  ASSERT_THAT(series, SizeIs(2));
  EXPECT_EQ(series[0].name, "uniform");
  EXPECT_EQ(series[0].points[1].x, 20);
  EXPECT_NEAR(series[0].points[1].value, 12.1, 1e-12);
  EXPECT_EQ(series[1].points[0].count, 1);
  EXPECT_NEAR(series[1].points[0].value, 42.2, 1e-12);
}

TEST(StudyChart, WordsOnAnAxisNeedBars) {
  const std::string chart =
      "study: {charts: {c: {title: t, over: method, y_label: mm, series: {e: {value: "
      "metrics.error}}, kind: KIND}}}\n";
  const auto with = [&](const std::string& kind) {
    return std::string(chart).replace(chart.find("KIND"), 4, kind);
  };
  EXPECT_THAT(error_of(with("lines")), HasSubstr("'ED' on the axis 'method' is no number; expected numbers"));
  const Study made = study(with("bars"));
  EXPECT_EQ(made.charts[0].series[0].points[0].label, "ED");
}

TEST(StudyChart, LeavesOutWhatHasNoNumbersAndSaysSo) {
  const Study made =
      study("study: {charts: {c: {title: t, over: set, y_label: mm, series: {e: {value: metrics.eror}}}}}\n");
  EXPECT_THAT(made.charts[0].series[0].points, IsEmpty());
  EXPECT_THAT(made.notes, ElementsAre(HasSubstr("no run has the number 'metrics.eror'; did you mean "
                                                "'metrics.error'?")));
}

TEST(StudyChart, GoesOverTheFramesOfRuns) {
  const Study made = study(R"(
study:
  charts:
    error:
      title: t
      kind: frames
      y_label: mm
      where: [set=1]
      series:
        rigid: {value: error, where: [method=ED], color: red}
        of each: {value: 2 * error, by: method}
      limits:
        threshold: {value: metrics.error, where: [method=ED]}
        constant: {value: 3}
)");
  const Chart& chart = made.charts[0];
  EXPECT_EQ(chart.kind, Chart::Kind::frames);
  EXPECT_EQ(chart.x_label, "frame");
  ASSERT_THAT(chart.series, SizeIs(3));
  ASSERT_TRUE(chart.series[0].color);
  EXPECT_EQ(chart_colors()[*chart.series[0].color], "red");
  EXPECT_FALSE(chart.series[1].color);
  ASSERT_THAT(chart.series[0].points, SizeIs(3));
  EXPECT_EQ(chart.series[0].points[2].x, 3);
  EXPECT_NEAR(chart.series[0].points[2].value, 104.5, 1e-12) << "the mean over the seeds";
  EXPECT_EQ(chart.series[0].points[2].count, 2);
  EXPECT_TRUE(std::isnan(chart.series[0].points[1].value)) << "lost";
  EXPECT_EQ(chart.series[2].name, "AdNodes, of each");
  EXPECT_NEAR(chart.series[2].points[0].value, 405, 1e-12);
  ASSERT_THAT(chart.limits, SizeIs(2));
  EXPECT_NEAR(chart.limits[0].value, 11.15, 1e-12);
  EXPECT_EQ(chart.limits[1].value, 3);
  EXPECT_THAT(made.notes, IsEmpty());
}

TEST(StudyChart, OverFramesSaysWhatItLacksAndWhatHasNoPlace) {
  const auto chart = [](const std::string& more) {
    return "study: {charts: {c: {title: t, kind: frames, y_label: mm, " + more +
           ", series: {e: {value: eror}}}}}\n";
  };
  EXPECT_THAT(study(chart("text: none")).notes,
              ElementsAre(HasSubstr("no frame has the number 'eror'; did you mean 'error'?")));
  EXPECT_THAT(error_of(chart("over: set")), HasSubstr("'over' has no place in a chart over frames"));
  EXPECT_THAT(error_of(chart("x: nodes")), HasSubstr("'x' has no place"));
  EXPECT_THAT(error_of("study: {charts: {c: {title: t, y_label: mm, series: {e: {value: nodes}}}}}\n"),
              HasSubstr("'over' is missing; expected an axis of the sweep"));
}

TEST(FrameNumbers, HaveTruthsAndNamesWithDots) {
  const Numbers numbers =
      numbers_of_frame({{"frame", 7}, {"registered", true}, {"error", {{"rotation", 2}}}});
  EXPECT_THAT(numbers, ElementsAre(testing::Pair("error.rotation", 2), testing::Pair("frame", 7),
                                   testing::Pair("registered", 1)));
}

TEST(StudyPictures, AreThoseOfAllRunsThatFit) {
  const Study made = study(
      "study: {pictures: {two: {title: t, where: [set=2, seed=1]}, strip: {title: s, picture: strip, where: "
      "[set=1, seed=1, method=ED]}}}\n");
  ASSERT_THAT(made.pictures, SizeIs(2));
  ASSERT_THAT(made.pictures[0].pictures, SizeIs(2));
  EXPECT_EQ(made.pictures[0].pictures[1].caption, "AdNodes");
  EXPECT_EQ(made.pictures[0].pictures[1].file.string(), "method=AdNodes,set=2,seed=1/errors.png");
  EXPECT_EQ(made.pictures[1].pictures[0].file.string(), "method=ED,set=1,seed=1/strip.png");
  EXPECT_EQ(made.pictures[1].pictures[0].caption, "method=ED,set=1,seed=1");
}

TEST(StudyTable, HasARowForEachCombination) {
  const Study made = study(R"(
study:
  tables:
    all:
      title: "Table 1"
      rows: [set, method]
      columns:
        error: {value: metrics.error, digits: 2, spread: true}
        nodes: {value: nodes, digits: 0}
)");
  const Table& table = made.tables[0];
  EXPECT_EQ(table.title, "Table 1");
  EXPECT_THAT(table.header, ElementsAre("set", "method", "error", "nodes"));
  ASSERT_THAT(table.rows, SizeIs(4));
  EXPECT_THAT(table.rows[1].cells, ElementsAre("2", "ED", "12.15 ± 0.05", "200"));
}

TEST(StudyClaim, IsJudgedOnce) {
  const Study made = study(R"(
study:
  claims:
    better: {claim: less, values: {a: {value: metrics.error, where: [method=ED]},
                                   b: {value: metrics.error, where: [method=AdNodes]}}, holds: a < b}
    worse: {claim: more, values: {a: {value: metrics.error, where: [method=ED], statistic: max},
                                  b: {value: metrics.error, where: [method=AdNodes], statistic: min}}, holds: a > b}
    none: {claim: nothing, values: {a: {value: metrics.eror}}, holds: a > 0}
)");
  ASSERT_THAT(made.findings, SizeIs(3));
  EXPECT_EQ(made.findings[0].verdict, Finding::Verdict::confirmed);
  EXPECT_EQ(made.findings[0].condition, "a < b");
  EXPECT_NEAR(made.findings[0].values[0].second, 11.65, 1e-12);
  EXPECT_EQ(made.findings[1].verdict, Finding::Verdict::not_confirmed);
  EXPECT_NEAR(made.findings[1].values[0].second, 12.2, 1e-12);
  EXPECT_EQ(made.findings[2].verdict, Finding::Verdict::unknown);
  EXPECT_THAT(made.findings[2].reason, HasSubstr("did you mean 'metrics.error'?"));
}

TEST(StudyClaim, IsJudgedOverSomeFrames) {
  const Study made = study(R"(
study:
  claims:
    low: {claim: low, values: {a: {value: error, frames: [2, 3], where: [method=ED, set=1]}}, holds: a < 104.6}
    none: {claim: none, values: {a: {value: error, frames: [4, 9]}}, holds: a > 0}
  tables:
    all: {title: t, rows: [method], columns: {error: {value: error, frames: [1, 3], where: [seed=1]}}}
)");
  EXPECT_NEAR(made.findings[0].values[0].second, 104.5, 1e-12) << "of frame 3, the mean over the seeds";
  EXPECT_EQ(made.findings[0].verdict, Finding::Verdict::confirmed);
  EXPECT_EQ(made.findings[1].reason, "no run has 'a'");
  EXPECT_THAT(made.tables[0].rows[0].cells, ElementsAre("ED", "103.00"));
  EXPECT_THAT(
      error_of("study: {claims: {c: {claim: c, values: {a: {value: error, frames: [3, 2]}}, holds: a < "
               "1}}}\n"),
      HasSubstr("'frames' ends before it begins"));
}

TEST(StudyClaim, IsJudgedForEachValueOnAnAxis) {
  const Study made = study(
      "study: {claims: {c: {claim: low, each: set, values: {a: {value: metrics.error, where: [method=ED]}}, "
      "holds: a < 12}}}\n");
  ASSERT_THAT(made.findings, SizeIs(2));
  EXPECT_EQ(made.findings[0].scope, "set: 1");
  EXPECT_EQ(made.findings[0].verdict, Finding::Verdict::confirmed);
  EXPECT_EQ(made.findings[1].verdict, Finding::Verdict::not_confirmed);
}

TEST(StudyClaim, IsUnknownWhereNoRunWasMade) {
  std::vector<RunRow> rows = runs();
  for (RunRow& row : rows)
    if (row.on("set") == "2") row.numbers.clear();
  const Study made = study(
      "study: {claims: {c: {claim: low, each: set, values: {a: {value: metrics.error}}, holds: a < 100}}}\n",
      rows);
  EXPECT_EQ(made.findings[0].verdict, Finding::Verdict::confirmed);
  EXPECT_EQ(made.findings[1].verdict, Finding::Verdict::unknown);
  EXPECT_EQ(made.findings[1].reason, "no run has 'a'");
}

TEST(StudyViews, ShowTheFirstRunThatFits) {
  const Study made = study("study: {views: {two: {where: [set=2, method=AdNodes]}}}\n");
  EXPECT_EQ(made.views[0].title, "two");
  EXPECT_EQ(made.views[0].file.string(), "method=AdNodes,set=2,seed=1/view.json");
}

TEST(StudyErrors, NameThePlaceAndTheNearest) {
  const std::string claim =
      "study: {claims: {c: {claim: low, WHAT, values: {a: {value: nodes}}, holds: a < 1}}}\n";
  const auto with = [&](const std::string& what) {
    return std::string(claim).replace(claim.find("WHAT"), 4, what);
  };
  EXPECT_THAT(
      error_of(with("each: sed")),
      HasSubstr("exp.yaml:1:18: the runs are not swept over 'sed'; expected one of method, set, seed; did "
                "you mean 'se"));
  EXPECT_THAT(error_of("study: {claims: {c: {claim: low, values: {a: {value: nodes}}, holds: b < 1}}}\n"),
              HasSubstr("'b' in 'holds' is none of 'values'; expected one of a"));
  EXPECT_THAT(error_of("study: {views: {v: {where: [method=Ed]}}}\n"),
              HasSubstr("no run has 'method=Ed'; expected one of ED, AdNodes; did you mean 'ED'?"));
  EXPECT_THAT(error_of("study: {views: {v: {where: [method]}}}\n"), HasSubstr("expected AXIS=VALUE"));
}

TEST(AllNumbers, HaveAColumnForEachAxisAndNumber) {
  const Table table = all_numbers(runs());
  EXPECT_THAT(table.header, ElementsAre("name", "method", "set", "seed", "metrics.error", "nodes"));
  ASSERT_THAT(table.rows, SizeIs(8));
  EXPECT_THAT(table.rows[0].cells, ElementsAre("method=ED,set=1,seed=1", "ED", "1", "1", "11.1", "100"));
}

}  // namespace
}  // namespace pliant
