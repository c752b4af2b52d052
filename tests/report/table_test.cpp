#include "experiments/report/table.h"

#include <gmock/gmock.h>

namespace pliant::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const Table table{"sheet", {"run", "EPE mm"}, {{{"a<b", "0.86"}, "sheet/index.html"}, {{"longer", "12.50"}}}};

TEST(Table, TextAlignsNamesLeftAndNumbersRight) {
  EXPECT_EQ(to_text(table),
            "sheet\n"
            "run     EPE mm\n"
            "a<b       0.86\n"
            "longer   12.50\n");
}

TEST(Table, PageEscapesNamesAndLinksThemWhereTheyLead) {
  const std::string page = make_overview_page("All", "of it", {table});
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\"><a href=\"sheet/index.html\">a&lt;b</a></th><td>0.86</td>"));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">longer</th><td>12.50</td>"));
  EXPECT_THAT(page, Not(HasSubstr("a<b")));
}

TEST(Table, CsvQuotesWhatWouldEndACell) {
  EXPECT_EQ(to_csv({"", {"a", "b, c"}, {{{"", "say \"no\""}}, {{"1.5", "2"}}}}),
            "a,\"b, c\"\n,\"say \"\"no\"\"\"\n1.5,2\n");
  EXPECT_EQ(to_csv({"", {}, {{{"Nodes", "256"}}}}), "Nodes,256\n");
}

TEST(Table, PageSetsNamesFromTheLeftAndFiguresFromTheRight) {
  const std::string html =
      to_html({"", {"set", "method", "mm"}, {{{"a", "ED", "1.2"}}, {{"b", "AdNodes", "-1"}}}});
  EXPECT_THAT(html, HasSubstr("<th class=\"name\">method</th><th>mm</th>"));
  EXPECT_THAT(html, HasSubstr("<td class=\"name\">ED</td><td>1.2</td>"));
}

}  // namespace
}  // namespace pliant::test
