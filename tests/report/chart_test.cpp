#include "experiments/report/chart_axis.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <regex>

#include "experiments/report/chart_html.h"
#include "experiments/report/chart_svg.h"
#include "experiments/report/chart_values.h"
#include "tests/report/sample_study.h"

namespace pliant {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

/// One series over 0, 1, 2, ...
Chart steps(const std::vector<double>& values) {
  Chart chart;
  chart.title = "energy <E>";
  chart.x_label = "iteration";
  chart.y_label = "energy";
  chart.log_y = true;
  chart.series = {{"E", {}}};
  for (std::size_t i = 0; i < values.size(); ++i)
    chart.series[0].points.push_back({double(i), "", values[i]});
  return chart;
}

/// The numbers of an attribute, in the order in which they come.
std::vector<double> numbers(const std::string& svg, const std::string& elements,
                            const std::string& attribute) {
  const std::regex pattern("<" + elements + "[^>]*? " + attribute + "=\"([-0-9.]+)\"");
  std::vector<double> found;
  for (std::sregex_iterator at(svg.begin(), svg.end(), pattern); at != std::sregex_iterator(); ++at)
    found.push_back(std::stod((*at)[1]));
  return found;
}

TEST(ChartAxis, MarksRoundValues) {
  const ChartAxis axis = axis_around({0, 9.7}, false);
  EXPECT_EQ(axis.low, 0);
  EXPECT_THAT(axis.ticks, ElementsAre(0, 2, 4, 6, 8, 10));
  EXPECT_THAT(axis_around({3, 2000}, true).ticks, ElementsAre(10, 100, 1000));
}

TEST(ChartAxis, MarksNothingBetweenWholeValuesThatAreAllWhole) {
  EXPECT_THAT(axis_around({0, 1, 2}, false).ticks, ElementsAre(0, 1, 2));
  EXPECT_GT(axis_around({0, 1, 2.5}, false).ticks.size(), 4U);
}

TEST(ChartAxis, LabelsAreAsShortAsTheyCanBe) {
  EXPECT_EQ(tick_label(0.1 + 0.2), "0.3");
  EXPECT_EQ(tick_label(500000), "500000");
}

TEST(ChartAxis, HoldsItsValuesAndLetsBarsStandOnZero) {
  for (const bool is_log : {false, true}) {
    const ChartAxis axis = axis_around({101, 102}, is_log);
    EXPECT_GT(axis.place(101), 0);
    EXPECT_LT(axis.place(102), 1);
    EXPECT_GE(axis.ticks.size(), 2U);
  }
  EXPECT_EQ(axis_around({101, 102}, false, true).low, 0);
  EXPECT_EQ(axis_around({-3, -1}, false, true).high, 0);
}

TEST(ChartAxis, LeavesOutWhatItDoesNotTake) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const ChartAxis axis = axis_around({0, -5, nan, 10, 20}, true);
  EXPECT_GT(axis.low, 5);
  EXPECT_FALSE(axis.takes(0));
  EXPECT_FALSE(axis.takes(nan));
  EXPECT_LT(axis_around({}, false).low, axis_around({}, false).high);
  EXPECT_LT(axis_around({0, 0}, false).low, axis_around({0, 0}, false).high);
}

TEST(ChartSvg, HasAMarkForEachValueAndLabelledAxes) {
  const std::string svg = chart_svg(steps({1000, 10, 1, 5}));
  EXPECT_EQ(count(svg, "<circle"), 4U);
  for (const char* text : {">iteration</text>", ">energy</text>", ">1000</text>", ">10</text>",
                           "<title>E, 0: 1000</title></circle>", "aria-label=\"energy &lt;E&gt;\""})
    EXPECT_THAT(svg, HasSubstr(text));
}

TEST(ChartSvg, IsLogarithmicWhereItIsAskedToBe) {
  const std::vector<double> heights = numbers(chart_svg(steps({100, 10, 1})), "circle", "cy");
  ASSERT_EQ(heights.size(), 3U);
  EXPECT_LT(heights[0], heights[1]);
  EXPECT_NEAR(heights[1] - heights[0], heights[2] - heights[1], 0.2);
}

TEST(ChartSvg, LeavesOutWhatHasNoPlace) {
  EXPECT_EQ(count(chart_svg(steps({0, 10, -1, std::nan(""), 2})), "<circle"), 2U);
  EXPECT_THAT(chart_svg(steps({0, 0})), Not(HasSubstr("<svg")));
  EXPECT_THAT(chart_svg(Chart{}), HasSubstr("No value"));
}

TEST(ChartSvg, WhiskersAreOneSpreadLongEitherWay) {
  Chart chart = steps({100, 200});
  chart.log_y = false;
  EXPECT_EQ(count(chart_svg(chart), "whisker"), 0U);
  chart.series[0].points[0].spread = 50;
  chart.series[0].points[1].spread = 50;
  const std::string svg = chart_svg(chart);
  const std::vector<double> places = numbers(svg, "circle", "cy");
  const double spread = (places[0] - places[1]) / 2;  // in 100
  EXPECT_NEAR(numbers(svg, "line class=\"whisker", "y1")[0], places[0] + spread, 0.2);
  EXPECT_NEAR(numbers(svg, "line class=\"whisker", "y2")[0], places[0] - spread, 0.2);
}

TEST(ChartSvg, BarsStandOnZeroAndAreAsHighAsTheirValues) {
  const Chart chart = sample_bars(Chart::Kind::bars);
  const std::string svg = chart_svg(chart);
  std::vector<double> heights = numbers(svg, "rect class=\"bar", "height");
  heights.erase(heights.begin(), heights.begin() + 2);  // of the legend
  ASSERT_EQ(heights.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(heights[i] / heights[0], chart.series[i / 3].points[i % 3].value / 14, 0.01);
}

TEST(ChartSvg, StackedBarsStandOnEachOther) {
  const std::string svg = chart_svg(sample_bars(Chart::Kind::stacked_bars));
  const std::vector<double> tops = numbers(svg, "rect class=\"bar", "y");
  const std::vector<double> heights = numbers(svg, "rect class=\"bar", "height");
  ASSERT_EQ(tops.size(), 8U);
  for (std::size_t i = 2; i < 5; ++i) EXPECT_NEAR(tops[i + 3] + heights[i + 3], tops[i], 0.2);
}

TEST(ChartSvg, FramesAreALineWithoutMarksThatIsBrokenWhereThereIsNone) {
  const std::string svg = chart_svg(sample_frames());
  EXPECT_EQ(count(svg, "class=\"mark"), 0U);
  EXPECT_THAT(svg, HasSubstr("class=\"line s8\" d=\"M"));
  EXPECT_THAT(svg, HasSubstr("stroke=\"#d1242f\""));
  const std::size_t rigid = svg.find("class=\"line s8\" d=");
  const std::string path = svg.substr(rigid, svg.find("fill", rigid) - rigid);
  EXPECT_EQ(count(path, "M"), 2U);
  EXPECT_EQ(count(path, "L"), 53U);
}

TEST(ChartSvg, LimitsAreDashedAcrossAndAlwaysSeen) {
  Chart chart = sample_frames();
  chart.limits = {{"threshold", 9}};
  const std::string svg = chart_svg(chart);
  EXPECT_THAT(svg, HasSubstr("stroke-dasharray"));
  EXPECT_THAT(svg, HasSubstr(">threshold: 9</text>"));
  const std::vector<double> places = numbers(svg, "line class=\"limit", "y1");
  ASSERT_EQ(places.size(), 1U);
  EXPECT_GT(places[0], 0);
}

TEST(ChartSvg, NamesTheSeriesWhereThereAreSeveral) {
  EXPECT_THAT(chart_svg(sample_lines()), HasSubstr(">adaptive nodes &lt;AdNodes&gt;</text>"));
  EXPECT_THAT(chart_svg(steps({1, 2})), Not(HasSubstr(">E</text>")));
}

TEST(ChartSvg, AFileNeedsNothingElse) {
  const std::string svg = chart_svg_file(sample_lines());
  EXPECT_THAT(svg, HasSubstr("xmlns=\"http://www.w3.org/2000/svg\""));
  EXPECT_THAT(svg, HasSubstr("--s0:"));
  EXPECT_THAT(svg, HasSubstr("stroke=\"#2f6fdb\"")) << "for programs that know of no variables";
}

TEST(ChartValues, ComeAsATable) {
  EXPECT_THAT(to_csv(values_table(sample_bars(Chart::Kind::bars))),
              HasSubstr("data set,ED,AdNodes+AdCons\nsheet (I),14 ± 1.5,22.4 ± 2\n"));
  Chart chart = steps({1, 2});
  chart.series.push_back({"F", {{0.5, "half", 7}}});
  EXPECT_EQ(to_csv(values_table(chart)), "iteration,E,F\n0,1,\nhalf,,7\n1,2,\n");
}

TEST(ChartValues, OfAStudyAreOneARow) {
  Study study;
  study.charts = {sample_bars(Chart::Kind::bars)};
  const std::string csv = to_csv(values_table(study));
  EXPECT_THAT(csv, HasSubstr("chart,series,x,label,value,spread,count\nspeed,ED,0,sheet (I),14,1.5,10\n"));
  EXPECT_EQ(count(csv, "\n"), 7U);
}

TEST(ChartHtml, GivesThePageItsNumbersWithoutEndingTheScript) {
  Chart chart = steps({1, std::nan("")});
  chart.series[0].name = "</script><b>\xff";
  const std::string html = chart_html(chart);
  EXPECT_THAT(html, HasSubstr("\"kind\":\"lines\""));
  EXPECT_THAT(html, HasSubstr("\"value\":null"));
  EXPECT_EQ(count(html, "</script>"), 1U);
  EXPECT_THAT(html, Not(HasSubstr("<b>")));
}

}  // namespace
}  // namespace pliant
