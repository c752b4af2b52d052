#pragma once

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
  std::vector<std::string> header;
  std::vector<Row> rows;
};

/// The first column is left-aligned, all others right-aligned.
std::string to_text(const Table& table);

/// An HTML page that needs no other file.
std::string make_overview_page(const std::string& title, const std::string& lead,
                               const std::vector<Table>& tables);

}  // namespace pliant
