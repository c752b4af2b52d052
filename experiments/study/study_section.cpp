#include "experiments/study/study_section.h"

#include <fmt/format.h>

#include <algorithm>
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
      groups("views", views_table())
          .optional()
          .doc("runs that are shown in three dimensions, by their titles"),
  };
}

Study make_study(const Parameters& section, const std::vector<RunRow>& rows) {
  Study study;
  if (section.has("title")) study.title = section.text("title");
  study.lead = section.text("lead");
  for (const auto& [name, chart] : section.sections("charts"))
    study.charts.push_back(make_chart(name, chart, rows, study.notes));
  for (const auto& [name, table] : section.sections("tables"))
    study.tables.push_back(make_figures_table(name, table, rows, study.notes));
  for (const auto& [name, claim] : section.sections("claims")) {
    for (Finding& finding : make_findings(claim, rows)) study.findings.push_back(std::move(finding));
  }
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
