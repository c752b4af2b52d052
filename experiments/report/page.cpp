#include "experiments/report/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "experiments/report/base64.h"
#include "experiments/report/chart_html.h"
#include "experiments/report/html.h"
#include "experiments/report/reports.h"
#include "experiments/report/view_html.h"
#include "framework/io/file.h"

namespace pliant {
namespace {

/// Tables with a header, or those without, which need less room.
std::string tables_html(const std::vector<Table>& tables, bool with_header) {
  std::string html;
  for (const Table& table : tables)
    if (table.header.empty() != with_header) html += to_html(table);
  return html;
}

std::string series_html(const std::vector<Series>& all) {
  std::string html;
  for (const Series& series : all) html += chart_html(chart_of(series));
  return html;
}

std::string columns_of(const std::string& html) {
  return html.empty() ? "" : "<div class=\"columns\">\n" + html + "</div>\n";
}

std::string picture_grid(const std::vector<Picture>& pictures) {
  if (pictures.empty()) return "";
  std::string figures;
  for (const Picture& picture : pictures) {
    figures += fmt::format("<figure><img alt=\"{}\" src=\"data:image/png;base64,{}\"></figure>\n",
                           html_escape(picture.caption()), base64(picture.png()));
  }
  return html_section("Pictures", "<div class=\"pictures\">\n" + figures + "</div>\n");
}

/// What the page shows first: the run itself, if it can be turned.
std::string run_html(const RunArtefacts& run, bool with_view) {
  return with_view && run.view ? view_html("In three dimensions", view_json(run.view->data())) : "";
}

class PageReport : public Report {
 public:
  explicit PageReport(bool with_view) : with_view_(with_view) {}
  std::vector<std::string> files(const ArtefactNames&) const override { return {"index.html"}; }
  std::vector<std::filesystem::path> write(const RunArtefacts& run,
                                           const std::filesystem::path& folder) const override {
    const std::filesystem::path file = folder / "index.html";
    const std::string page = make_page(run, with_view_);
    write_file(file.string(), {page.begin(), page.end()});
    return {file};
  }

 private:
  bool with_view_;
};

}  // namespace

std::string make_page(const RunArtefacts& run, bool with_view) {
  Page page{run.name, run.lead, html_notes(run.notes)};
  const auto add = [&](const std::string& id, const std::string& title, const std::string& html) {
    if (html.empty()) return;
    page.contents.push_back({id, title});
    page.body += fmt::format("<div id=\"{}\">\n{}</div>\n", id, html);
  };
  add("view", "In three dimensions", run_html(run, with_view));
  add("distances", "Distances", tables_html(run.tables, true));
  add("steps", "Step by step", columns_of(series_html(run.series)));
  add("numbers", "Numbers", columns_of(tables_html(run.tables, false)));
  add("pictures", "Pictures", picture_grid(run.pictures));
  return html_page(page);
}

void register_page_report(Registry& registry) {
  registry.add<Report>(
      "page", "index.html: metrics, energy, times and pictures on one page",
      {
          boolean("view").optional().doc(
              "Whether it shows the run in three dimensions, for which it is registered once more; "
              "true by default"),
      },
      [](const Parameters& parameters, const Registry&) {
        return std::make_unique<PageReport>(!parameters.has("view") || parameters.boolean("view"));
      });
}

}  // namespace pliant
