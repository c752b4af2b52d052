#include "experiments/report/page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "experiments/report/plot.h"
#include "framework/io/file.h"
#include "tests/report/sample_run.h"

namespace pliant {
namespace {

using testing::HasSubstr;
using testing::Not;

std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

/// The examples of RFC 4648.
TEST(Base64, AgreesWithTheStandard) {
  EXPECT_EQ(base64({}), "");
  EXPECT_EQ(base64(bytes_of("f")), "Zg==");
  EXPECT_EQ(base64(bytes_of("fo")), "Zm8=");
  EXPECT_EQ(base64(bytes_of("foobar")), "Zm9vYmFy");
  EXPECT_EQ(base64({0xfb, 0xff, 0xbf}), "+/+/");
}

TEST(LogPlot, HasADotForEachValueAndLabelledAxes) {
  const std::string svg = log_plot_svg({1000, 10, 1, 5}, "iteration", "energy");
  EXPECT_EQ(count(svg, "<circle"), 4u);
  for (const char* text :
       {">iteration</text>", ">energy</text>", ">1000</text>", ">10</text>", ">3</text>"}) {
    EXPECT_THAT(svg, HasSubstr(text));
  }
}

TEST(LogPlot, IsLogarithmic) {
  const std::string svg = log_plot_svg({100, 10, 1}, "", "");
  std::vector<double> heights;
  for (std::size_t at = svg.find("cy=\""); at != std::string::npos; at = svg.find("cy=\"", at + 1)) {
    heights.push_back(std::stod(svg.substr(at + 4)));
  }
  ASSERT_EQ(heights.size(), 3u);
  EXPECT_LT(heights[0], heights[1]);
  EXPECT_NEAR(heights[1] - heights[0], heights[2] - heights[1], 0.2);
}

TEST(LogPlot, LeavesOutWhatHasNoLogarithm) {
  EXPECT_EQ(count(log_plot_svg({0, 10, -1, std::numeric_limits<double>::quiet_NaN(), 2}, "", ""), "<circle"),
            2u);
  EXPECT_THAT(log_plot_svg({0, 0}, "", ""), Not(HasSubstr("<svg")));
  EXPECT_THAT(log_plot_svg({}, "", ""), Not(HasSubstr("<svg")));
}

TEST(LogPlot, LabelsANarrowRangeToo) {
  EXPECT_GE(count(log_plot_svg({1.02, 1.01}, "", ""), "class=\"grid\""), 1u);
  EXPECT_GE(count(log_plot_svg({7}, "", ""), "class=\"grid\""), 1u);
}

TEST(Page, HoldsEveryKindOfArtefact) {
  const std::string page = make_page(sample_run());
  for (const char* text :
       {"<li>warning: dark &amp; noisy</li>", "<h2>Distances &amp; more</h2>", "<th>before</th>",
        "<td>30.00 <span class=\"quiet\">± 2.00</span></td><td class=\"final\">4.00</td>",
        "<tr><th scope=\"row\">Nodes</th><td>256</td></tr>", "<h2>Energy</h2>", "energy (log scale)",
        "From 1000 to 5."})
    EXPECT_THAT(page, HasSubstr(text));
}

TEST(Page, DrawsBarsWhereATableHasThem) {
  const std::string page = make_page(sample_run());
  EXPECT_THAT(
      page, HasSubstr("solve</th><td class=\"bar\"><span style=\"width:100.0%\"></span></td><td>90.25</td>"));
  EXPECT_THAT(page, HasSubstr("width:50.0%"));
  EXPECT_THAT(page, HasSubstr("total</th><td></td><td>110.75</td>"));
}

TEST(Page, OmitsWhatThereIsNot) {
  RunArtefacts run;
  run.name = "bare";
  const std::string page = make_page(run);
  for (const char* text : {"Notes", "Pictures", "<img", "<table"}) EXPECT_THAT(page, Not(HasSubstr(text)));
}

TEST(Page, NeedsNoOtherFile) {
  const RunArtefacts run = sample_run();
  const std::string page = make_page(run);
  EXPECT_EQ(count(page, "<img"), 1u);
  EXPECT_THAT(page, HasSubstr("src=\"data:image/png;base64," + base64(run.pictures[0].png())));
  EXPECT_THAT(page, Not(HasSubstr("http")));
}

TEST(Page, EscapesNames) {
  const std::string page = make_page(sample_run());
  for (const char* text :
       {"sheet/&lt;fast&gt;", "planes &amp; more", "ended &lt;well&gt;", "Depth &amp; more"})
    EXPECT_THAT(page, HasSubstr(text));
  EXPECT_THAT(page, Not(HasSubstr("<fast>")));
}

TEST(Page, IsWrittenAsIndexHtml) {
  const RunArtefacts run = sample_run();
  const auto folder = test_folder();
  EXPECT_THAT(make_report("page")->write(run, folder), testing::ElementsAre(folder / "index.html"));
  EXPECT_EQ(read_file((folder / "index.html").string()), bytes_of(make_page(run)));
}

}  // namespace
}  // namespace pliant
