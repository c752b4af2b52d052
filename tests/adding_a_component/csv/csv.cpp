#include <fmt/format.h>

#include "experiments/report/report.h"
#include "experiments/report/reports.h"
#include "framework/io/file.h"

namespace pliant {
namespace {

/// One line a value: the series, the step, the value.
class CsvReport : public Report {
 public:
  explicit CsvReport(char separator) : separator_(separator) {}

  std::vector<std::string> files(const ArtefactNames&) const override { return {"series.csv"}; }

  std::vector<std::filesystem::path> write(const RunArtefacts& run,
                                           const std::filesystem::path& folder) const override {
    std::string text;
    for (const Series& series : run.series)
      for (std::size_t step = 0; step < series.values.size(); ++step)
        text += fmt::format("{1}{0}{2}{0}{3}\n", separator_, series.title, step, series.values[step]);
    const std::filesystem::path file = folder / "series.csv";
    write_file(file.string(), {text.begin(), text.end()});
    return {file};
  }

 private:
  char separator_;
};

std::unique_ptr<Report> make_csv(const Parameters& section, const Registry& /*components*/) {
  return std::make_unique<CsvReport>(section.text("separator") == "comma" ? ',' : ';');
}

}  // namespace

void register_csv_report(Registry& registry) {
  registry.add<Report>(
      "csv", "series.csv: the plotted numbers, for other programs",
      {choice("separator", {"comma", "semicolon"}, "comma").doc("Between the cells of a line")}, make_csv);
}

}  // namespace pliant
