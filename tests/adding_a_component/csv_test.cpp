#include <gmock/gmock.h>

#include <cstdlib>

#include "experiments/report/report.h"
#include "experiments/report/reports.h"
#include "framework/config/config.h"
#include "framework/core/error.h"
#include "framework/io/file.h"

// What the reader of docs/adding-a-component.md has after the report's last step. Built by follow.cmake in a
// copy of the room `report` that was changed as the document says.
namespace pliant::test {
namespace {

class Csv : public testing::Test {
 protected:
  Csv() {
    register_reports(registry_);
    run_.series = {{"Energy", "outer iteration", "energy", {1000, 2.5}},
                   {"Residual", "frame", "mm", {0.125}}};
  }

  std::unique_ptr<Report> make(const Parameters& values) const { return registry_.make<Report>(values); }

  Registry registry_;
  RunArtefacts run_;
};

TEST_F(Csv, IsListed) {
  const auto* info = registry_.find("report", "csv");
  ASSERT_NE(info, nullptr);
  EXPECT_EQ(info->doc, "series.csv: the plotted numbers, for other programs");
}

TEST_F(Csv, WritesEverySeriesAsTheExperimentOfTheDocumentAsks) {
  const char* file = std::getenv("PLIANT_REPORT_EXAMPLE");
  ASSERT_NE(file, nullptr);
  const auto experiment = load_experiment({file, {}, {}}, {components("reports", "report")}, registry_);
  const auto& sections = experiment.values.sections("reports");
  const auto found = std::find_if(sections.begin(), sections.end(),
                                  [](const auto& section) { return section.first == "csv"; });
  ASSERT_NE(found, sections.end());
  const auto written = make(found->second)->write(run_, testing::TempDir());
  ASSERT_EQ(written.size(), 1U);
  EXPECT_THAT(make(found->second)->files({}), testing::ElementsAre(written[0].filename()));
  const auto bytes = read_file(written[0].string());
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), "Energy;0;1000\nEnergy;1;2.5\nResidual;0;0.125\n");
}

TEST_F(Csv, AFolderThatIsNotThereIsADataError) {
  EXPECT_THROW(make(Parameters("csv", {{"separator", std::string("comma")}}))->write(run_, "/nowhere"),
               DataError);
}

}  // namespace
}  // namespace pliant::test
