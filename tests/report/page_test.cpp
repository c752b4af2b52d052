#include "experiments/report/page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "experiments/report/base64.h"
#include "framework/io/file.h"
#include "tests/report/sample_run.h"

namespace pliant {
namespace {

using testing::HasSubstr;
using testing::Not;

std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

/// The examples of RFC 4648.
TEST(Base64, AgreesWithTheStandard) {
  EXPECT_EQ(base64({}), "");
  EXPECT_EQ(base64(bytes_of("f")), "Zg==");
  EXPECT_EQ(base64(bytes_of("fo")), "Zm8=");
  EXPECT_EQ(base64(bytes_of("foobar")), "Zm9vYmFy");
  EXPECT_EQ(base64({0xfb, 0xff, 0xbf}), "+/+/");
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
      page,
      HasSubstr("solve</th><td class=\"bar-cell\"><span style=\"width:100.0%\"></span></td><td>90.25</td>"));
  EXPECT_THAT(page, HasSubstr("width:50.0%"));
  EXPECT_THAT(page, HasSubstr("total</th><td class=\"bar-cell\"></td><td>110.75</td>"));
}

TEST(Page, OmitsWhatThereIsNot) {
  RunArtefacts run;
  run.name = "bare";
  const std::string page = make_page(run);
  for (const char* text : {"<h2>Notes", "<h2>Pictures", "<img", "<tr"})
    EXPECT_THAT(page, Not(HasSubstr(text)));
}

TEST(Page, NeedsNoOtherFile) {
  const RunArtefacts run = sample_run();
  const std::string page = make_page(run);
  EXPECT_THAT(page, HasSubstr("src=\"data:image/png;base64," + base64(run.pictures[0].png())));
  for (const char* text : {"src=\"http", "href=\"http", "url(http", "@import", "<link"})
    EXPECT_THAT(page, Not(HasSubstr(text)));
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
