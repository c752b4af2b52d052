#include "experiments/study/study_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "experiments/study/charts.h"
#include "experiments/study/claims.h"
#include "experiments/study/figures_table.h"

namespace pliant {
namespace {

std::vector<ShownView> views_of(const Parameters& section, const std::vector<RunRow>& rows) {
  std::vector<ShownView> views;
  for (const auto& [title, view] : section.sections("views")) {
    const RowFilter filter(view.words("where"), rows, view.place());
    const auto row =
        std::find_if(rows.begin(), rows.end(), [&](const RunRow& each) { return filter.takes(each); });
    if (row != rows.end()) views.push_back({title, std::filesystem::path(row->name) / "view.json"});
  }
  return views;
}

/// What tells a row from the others: its values on the axes on which they differ.
std::string caption_of(const RunRow& row, const std::vector<RunRow>& others) {
  std::string caption;
  for (const SweptValue& value : row.axes) {
    const bool differs = std::any_of(others.begin(), others.end(), [&](const RunRow& other) {
      return other.on(value.name) != value.value;
    });
    if (differs) caption += (caption.empty() ? "" : ", ") + value.value;
  }
  return caption.empty() ? row.name : caption;
}

PictureFigure figure_of(const std::string& name, const Parameters& section, const std::vector<RunRow>& rows) {
  const RowFilter filter(section.words("where"), rows, section.place());
  std::vector<RunRow> shown;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(shown),
               [&](const RunRow& row) { return filter.takes(row); });
  PictureFigure figure{name, section.text("title"), section.text("text"), {}};
  for (const RunRow& row : shown)
    figure.pictures.push_back(
        {caption_of(row, shown), std::filesystem::path(row.name) / (section.text("picture") + ".png")});
  return figure;
}

ParameterTable pictures_table() {
  return {
      text("title").doc("with the number that the figure has in a paper"),
      text("text", "").doc("what it shows, in a sentence or two"),
      text("picture", "errors")
          .doc("which of the pictures that the report `pictures` writes of each run, by its file's name"),
      words("where").optional().doc("of the runs that have AXIS=VALUE all are shown"),
  };
}

ParameterTable views_table() {
  return {words("where").optional().doc("of the runs that have AXIS=VALUE the first is shown")};
}

std::string number_text(double value) { return fmt::format("{:.9g}", value); }

}  // namespace

ParameterTable study_table() {
  return {
      text("title").optional().doc("of the part of a page that shows it; the experiment's name by default"),
      text("lead", "").doc("what is done, in a sentence or two"),
      groups("charts", chart_table()).optional().doc("figures over what was varied"),
      groups("tables", figures_table()).optional().doc("tables of the runs' numbers"),
      groups("claims", claim_table()).optional().doc("what is claimed, to be held against the numbers"),
      groups("pictures", pictures_table()).optional().doc("pictures of runs side by side"),
      groups("views", views_table())
          .optional()
          .doc("runs that are shown in three dimensions, by their titles"),
  };
}

Study make_study(const Parameters& section, const std::vector<RunRow>& rows, const FramesOf& frames_of) {
  Study study;
  if (section.has("title")) study.title = section.text("title");
  study.lead = section.text("lead");
  for (const auto& [name, chart] : section.sections("charts"))
    study.charts.push_back(make_chart(name, chart, rows, frames_of, study.notes));
  for (const auto& [name, table] : section.sections("tables"))
    study.tables.push_back(make_figures_table(name, table, rows, frames_of, study.notes));
  for (const auto& [name, claim] : section.sections("claims")) {
    for (Finding& finding : make_findings(claim, rows, frames_of))
      study.findings.push_back(std::move(finding));
  }
  for (const auto& [name, figure] : section.sections("pictures"))
    study.pictures.push_back(figure_of(name, figure, rows));
  study.views = views_of(section, rows);
  return study;
}

Table all_numbers(const std::vector<RunRow>& rows) {
  const std::vector<std::string> axes = axes_of(rows);
  std::set<std::string> numbers;
  for (const RunRow& row : rows)
    for (const auto& [name, value] : row.numbers) numbers.insert(name);
  Table table{"Runs", {"name"}, {}};
  table.header.insert(table.header.end(), axes.begin(), axes.end());
  table.header.insert(table.header.end(), numbers.begin(), numbers.end());
  for (const RunRow& row : rows) {
    std::vector<std::string> cells{row.name};
    for (const std::string& axis : axes) cells.push_back(row.on(axis).value_or(""));
    for (const std::string& name : numbers) {
      const auto found = row.numbers.find(name);
      cells.push_back(found == row.numbers.end() ? "" : number_text(found->second));
    }
    table.rows.push_back({std::move(cells)});
  }
  return table;
}

}  // namespace pliant
