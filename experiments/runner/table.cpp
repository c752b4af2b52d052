#include "experiments/runner/table.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/report/html.h"

namespace pliant {
namespace {

std::string line(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths) {
  std::string text;
  for (std::size_t i = 0; i < cells.size(); ++i)
    text +=
        i == 0 ? fmt::format("{:<{}}", cells[i], widths[i]) : fmt::format("  {:>{}}", cells[i], widths[i]);
  return text + "\n";
}

std::string to_html(const Table& table) {
  std::string html = "<div class=\"scroll\"><table><thead><tr>";
  for (const auto& cell : table.header) html += "<th>" + html_escape(cell) + "</th>";
  html += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      std::string cell = html_escape(row.cells[i]);
      if (i == 0 && !row.link.empty())
        cell = fmt::format("<a href=\"{}\">{}</a>", html_escape(row.link), cell);
      html += (i == 0 ? "<tr><td>" : "<td>") + cell + "</td>";
    }
    html += "</tr>\n";
  }
  return html_section(html_escape(table.title), html + "</tbody></table></div>\n");
}

}  // namespace

std::string to_text(const Table& table) {
  std::vector<std::size_t> widths;
  for (const auto& cell : table.header) widths.push_back(cell.size());
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < widths.size(); ++i) widths[i] = std::max(widths[i], row.cells[i].size());
  }
  std::string text = table.title + "\n" + line(table.header, widths);
  for (const auto& row : table.rows) text += line(row.cells, widths);
  return text;
}

std::string make_overview_page(const std::string& title, const std::string& lead,
                               const std::vector<Table>& tables) {
  std::string body;
  for (const auto& table : tables) body += to_html(table);
  return html_page(title, lead, body);
}

}  // namespace pliant
