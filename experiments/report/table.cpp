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

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char letter : text) quoted += letter == '"' ? std::string("\"\"") : std::string(1, letter);
  return quoted + "\"";
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
  if (row >= table.bars.size()) return "<td class=\"bar-cell\"></td>";
  const double longest = *std::max_element(table.bars.begin(), table.bars.end());
  return fmt::format("<td class=\"bar-cell\"><span style=\"width:{:.1f}%\"></span></td>",
                     longest > 0 ? 100 * table.bars[row] / longest : 0);
}

std::string heading(const Table& table) {
  return table.title.empty() ? "" : "<h2>" + html_escape(table.title) + "</h2>";
}

/// Words are set from the left and may be broken; figures are not.
bool holds_words(const Table& table) {
  return std::any_of(table.rows.begin(), table.rows.end(), [](const Table::Row& row) {
    return std::any_of(row.cells.begin() + 1, row.cells.end(),
                       [](const std::string& cell) { return cell.size() > 40; });
  });
}

const char* kind(const Table& table) {
  if (table.header.empty()) return " class=\"facts\"";
  return holds_words(table) ? " class=\"words\"" : "";
}

std::string csv_line(const std::vector<std::string>& cells) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) line += (i == 0 ? "" : ",") + csv_cell(cells[i]);
  return line + "\n";
}

/// Names are set from the left, figures from the right.
bool names_things(const Table& table, std::size_t column) {
  return std::none_of(table.rows.begin(), table.rows.end(), [&](const Table::Row& row) {
    return row.cells[column].find_first_of("0123456789") == 0 || row.cells[column].find_first_of("+-–") == 0;
  });
}

std::string cell_class(const Table& table, std::size_t column) {
  if (table.main_column == column) return " class=\"final\"";
  return !table.header.empty() && column > 0 && names_things(table, column) ? " class=\"name\"" : "";
}

std::string header_html(const Table& table) {
  if (table.header.empty()) return "";
  std::string html = "<thead><tr>";
  for (std::size_t i = 0; i < table.header.size(); ++i)
    html += "<th" + (table.main_column == i ? "" : cell_class(table, i)) + ">" +
            html_escape(table.header[i]) + "</th>";
  return html + "</tr></thead>";
}

std::string row_html(const Table& table, std::size_t row) {
  const auto& cells = table.rows[row].cells;
  std::string html = first_cell_html(table.rows[row]);
  for (std::size_t i = 1; i < cells.size(); ++i) {
    if (i + 1 == cells.size()) html += bar_html(table, row);
    html += "<td" + cell_class(table, i) + ">" + cell_html(cells[i]) + "</td>";
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

std::string to_csv(const Table& table) {
  std::string text = table.header.empty() ? "" : csv_line(table.header);
  for (const auto& row : table.rows) text += csv_line(row.cells);
  return text;
}

std::string bare_html(const Table& table) {
  std::string html = "<div class=\"table\"><div class=\"head\">" + heading(table) + "</div>\n" +
                     fmt::format("<div class=\"scroll\"><table{}>", kind(table)) + header_html(table) +
                     "<tbody>\n";
  for (std::size_t i = 0; i < table.rows.size(); ++i) html += row_html(table, i);
  return html + "</tbody></table></div></div>\n";
}

std::string to_html(const Table& table) { return "<section>" + bare_html(table) + "</section>\n"; }

std::string make_overview_page(const std::string& title, const std::string& lead,
                               const std::vector<Table>& tables) {
  std::string body;
  for (const auto& table : tables) body += to_html(table);
  return html_page({title, lead, body});
}

}  // namespace pliant
