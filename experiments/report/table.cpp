#include "experiments/report/table.h"

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

/// What follows a mean, its standard deviation, is set in a quieter colour.
std::string cell_html(const std::string& cell) {
  const std::size_t spread = cell.find(" ± ");
  if (spread == std::string::npos) return html_escape(cell);
  return html_escape(cell.substr(0, spread)) + " <span class=\"quiet\">" +
         html_escape(cell.substr(spread + 1)) + "</span>";
}

std::string first_cell_html(const Table::Row& row) {
  const std::string cell = cell_html(row.cells.front());
  const std::string linked =
      row.link.empty() ? cell : fmt::format("<a href=\"{}\">{}</a>", html_escape(row.link), cell);
  return "<tr><th scope=\"row\">" + linked + "</th>";
}

std::string bar_html(const Table& table, std::size_t row) {
  if (table.bars.empty()) return "";
  if (row >= table.bars.size()) return "<td></td>";
  const double longest = *std::max_element(table.bars.begin(), table.bars.end());
  return fmt::format("<td class=\"bar\"><span style=\"width:{:.1f}%\"></span></td>",
                     longest > 0 ? 100 * table.bars[row] / longest : 0);
}

std::string row_html(const Table& table, std::size_t row) {
  const auto& cells = table.rows[row].cells;
  std::string html = first_cell_html(table.rows[row]);
  for (std::size_t i = 1; i < cells.size(); ++i) {
    if (i + 1 == cells.size()) html += bar_html(table, row);
    html += (table.main_column == i ? "<td class=\"final\">" : "<td>") + cell_html(cells[i]) + "</td>";
  }
  return html + "</tr>\n";
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

std::string to_html(const Table& table) {
  std::string html =
      fmt::format("<div class=\"scroll\"><table{}>", table.header.empty() ? " class=\"facts\"" : "");
  if (!table.header.empty()) html += "<thead><tr>";
  for (const auto& cell : table.header) html += "<th>" + html_escape(cell) + "</th>";
  if (!table.header.empty()) html += "</tr></thead>";
  html += "<tbody>\n";
  for (std::size_t i = 0; i < table.rows.size(); ++i) html += row_html(table, i);
  return html_section(html_escape(table.title), html + "</tbody></table></div>\n");
}

std::string make_overview_page(const std::string& title, const std::string& lead,
                               const std::vector<Table>& tables) {
  std::string body;
  for (const auto& table : tables) body += to_html(table);
  return html_page(title, lead, body);
}

}  // namespace pliant
