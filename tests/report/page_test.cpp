#include "experiments/report/page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "experiments/report/pictures.h"
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

TEST(Page, HoldsTheNumbers) {
  const SampleRun sample(4);
  const std::string page = make_page(sample.input());
  for (const char* text : {"1534", "2002", "3072", "gauss_newton", "cholesky", "converged",
                           "residual_settled", "87 of 123 agree", "10.0 mm", "From 81234.5 to 1021.25",
                           "solve", "90.25", "12.50", "110.75", "100.0 %"}) {
    EXPECT_THAT(page, HasSubstr(text));
  }
  // EPE: 30 mm at first, 20 after the alignment, 4 at the end.
  EXPECT_THAT(page, HasSubstr("<td>30.00</td><td>20.00</td><td class=\"final\">4.00</td>"));
}

TEST(Page, OmitsTruthThatIsNotKnown) {
  SampleRun sample(4);
  sample.run.initial.truth.reset();
  sample.run.aligned.truth.reset();
  sample.run.metrics.truth.reset();
  EXPECT_THAT(make_page(sample.input()), Not(HasSubstr("EPE")));
}

TEST(Page, NeedsNoOtherFile) {
  const SampleRun sample(4);
  const std::string page = make_page(sample.input());
  EXPECT_EQ(count(page, "<img"), 6u);
  for (const Picture& picture : draw_pictures(sample.input())) {
    EXPECT_THAT(page, HasSubstr("src=\"data:image/png;base64," + base64(picture.png)));
  }
  EXPECT_THAT(page, Not(HasSubstr("http")));
}

TEST(Page, EscapesNames) {
  const std::string page = make_page(SampleRun(4).input());
  EXPECT_THAT(page, HasSubstr("sheet/&lt;fast&gt;"));
  EXPECT_THAT(page, HasSubstr("planes &amp; more"));
  EXPECT_THAT(page, Not(HasSubstr("<fast>")));
}

TEST(Page, IsWrittenAsIndexHtml) {
  const SampleRun sample(4);
  const auto folder = test_folder();
  EXPECT_THAT(make_report("page")->write(sample.input(), folder),
              testing::ElementsAre(folder / "index.html"));
  EXPECT_EQ(read_file((folder / "index.html").string()), bytes_of(make_page(sample.input())));
}

}  // namespace
}  // namespace pliant
