#include "experiments/report/study_page.h"

#include <gmock/gmock.h>

#include "tests/io/test_files.h"
#include "tests/report/sample_study.h"

namespace pliant::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class StudyPageFiles : public TestFiles {};

TEST(StudyPage, HoldsAllOfEachStudy) {
  const std::string page = make_study_page("Chapter <5>", "lead & more", sample_studies());
  for (const char* text :
       {"Chapter &lt;5&gt;", "lead &amp; more", "Figures 5.5 and 5.6", "Each data set was registered",
        "Figure 5.5: accuracy over nodes, hand", "More nodes help", "Table 5.1", "EPE of moving points",
        "<li>hand/seed_7 failed", "extends: methods/ed.yaml", "device driver</th><td>3.1", "seed</th><td>1",
        "Figure 5.11: speed"})
    EXPECT_THAT(page, HasSubstr(text));
}

TEST(StudyPage, ListsEveryFindingAndLeadsToIt) {
  const std::string page = make_study_page("", "", sample_studies());
  EXPECT_THAT(page, HasSubstr("1 ✓ confirmed"));
  EXPECT_THAT(page, HasSubstr("1 ✗ not confirmed"));
  EXPECT_THAT(page, HasSubstr("1 ? unknown"));
  EXPECT_THAT(page, HasSubstr("href=\"#figure-5-5-finding-2\">A low residual means a low true error</a>"));
  EXPECT_THAT(page, HasSubstr("id=\"figure-5-5-finding-2\""));
  EXPECT_THAT(page, HasSubstr("<code>epe &lt; 2 * residual</code>"));
  EXPECT_THAT(page, HasSubstr("epe = 4.2, residual = 1.1"));
  EXPECT_THAT(page, HasSubstr("unknown: the runs of AdNodes+AdCons failed"));
}

TEST(StudyPage, LeadsToEveryStudyAndGivesNoIdTwice) {
  auto studies = sample_studies();
  const Page page = study_page("", "", studies);
  ASSERT_EQ(page.contents.size(), 3U);
  for (const auto& link : page.contents)
    EXPECT_THAT(page.body, HasSubstr("id=\"" + link.id + "\"")) << link.title;
  EXPECT_THAT(page.body, HasSubstr("id=\"figure-5-5-speed\""));
  EXPECT_THAT(page.body, HasSubstr("id=\"figure-5-11-speed\""));
}

TEST_F(StudyPageFiles, ShowsPicturesOfRunsSideBySide) {
  Study study;
  study.name = study.title = "faces";
  study.pictures = {{"errors", "Figure 6.5", "by distance", {{"rigid <only>", write("a.png", "abc")}}}};
  const Page page = study_page("", "", {study});
  for (const char* text : {"id=\"faces-errors\"", "Figure 6.5", "by distance", "alt=\"rigid &lt;only&gt;\"",
                           "data:image/png;base64,YWJj"})
    EXPECT_THAT(page.body, HasSubstr(text));
  study.pictures[0].pictures[0].file = file("missing.png");
  EXPECT_THAT(data_error_of([&] { study_page("", "", {study}); }), HasSubstr("missing.png"));
}

TEST(StudyPage, OmitsWhatThereIsNot) {
  Study bare;
  bare.name = bare.title = "bare";
  const Page page = study_page("", "", {bare});
  for (const char* text : {"What was found", "Findings", "Notes", "<details", "<table", "charts"})
    EXPECT_THAT(page.body, Not(HasSubstr(text)));
}

TEST(HtmlPage, SaysSoWhereFiguresCannotMove) {
  const Page page{"title", "lead", "<figure class=\"chart-figure\"></figure>"};
  EXPECT_THAT(html_page(page, {}), HasSubstr("npm could not be reached"));
  const std::string moving = html_page(page, {"the script", "the style"});
  EXPECT_THAT(moving, Not(HasSubstr("npm could not be reached")));
  EXPECT_THAT(moving, HasSubstr("<script>\nthe script</script>"));
  EXPECT_THAT(moving, HasSubstr("the style</style>"));
  const std::string bare = html_page({"title", "lead", "body"}, {"the script", "the style"});
  for (const char* text : {"the script", "the style", "npm"}) EXPECT_THAT(bare, Not(HasSubstr(text)));
}

}  // namespace
}  // namespace pliant::test
