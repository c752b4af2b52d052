#include "experiments/report/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "experiments/report/chart_html.h"
#include "experiments/report/html.h"
#include "experiments/report/reports.h"
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

std::string series_html(const Series& series) {
  Chart::Series values{series.value, {}};
  for (std::size_t i = 0; i < series.values.size(); ++i)
    values.points.push_back({static_cast<double>(i), "", series.values[i]});
  Chart chart;
  chart.title = series.title;
  chart.text = series.note;
  chart.x_label = series.step;
  chart.y_label = series.value + " (log scale)";
  chart.log_y = true;
  chart.series.push_back(std::move(values));
  return chart_html(chart);
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

class PageReport : public Report {
 public:
  std::vector<std::string> files(const ArtefactNames&) const override { return {"index.html"}; }
  std::vector<std::filesystem::path> write(const RunArtefacts& run,
                                           const std::filesystem::path& folder) const override {
    const std::filesystem::path file = folder / "index.html";
    const std::string page = make_page(run);
    write_file(file.string(), {page.begin(), page.end()});
    return {file};
  }
};

}  // namespace

std::string base64(const std::vector<std::uint8_t>& bytes) {
  constexpr const char* alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? alphabet[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string make_page(const RunArtefacts& run) {
  std::string columns;
  for (const Series& series : run.series) columns += series_html(series);
  columns += tables_html(run.tables, false);
  return html_page({run.name, run.lead,
                    html_notes(run.notes) + tables_html(run.tables, true) + "<div class=\"columns\">\n" +
                        columns + "</div>\n" + picture_grid(run.pictures)});
}

void register_page_report(Registry& registry) {
  registry.add<Report>("page", "index.html: metrics, energy, times and pictures on one page", {},
                       [](const Parameters&, const Registry&) { return std::make_unique<PageReport>(); });
}

}  // namespace pliant
