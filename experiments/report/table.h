#pragma once

#include <optional>
#include <string>
#include <vector>

namespace pliant {

/// Figures in rows, for the terminal and for pages.
struct Table {
  struct Row {
    std::vector<std::string> cells;
    std::string link = {};  ///< where the first cell leads on a page; empty: nowhere
  };
  std::string title;
  std::vector<std::string> header;  ///< empty: rows are a name and a value
  std::vector<Row> rows;
  std::optional<std::size_t> main_column = {};  ///< the one that a page stresses
  std::vector<double> bars = {};  ///< of the first rows: lengths that a page draws before the last cell
};

/// The first column is left-aligned, all others right-aligned.
std::string to_text(const Table& table);

/// The header, where there is one, and the rows as comma-separated values [RFC 4180, with line feeds].
std::string to_csv(const Table& table);

/// A titled part of a page, whose table can be copied.
std::string to_html(const Table& table);

/// The same without the frame of a section.
std::string bare_html(const Table& table);

/// An HTML page that needs no other file.
std::string make_overview_page(const std::string& title, const std::string& lead,
                               const std::vector<Table>& tables);

}  // namespace pliant
