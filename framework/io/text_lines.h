#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pliant {

/// A text, line by line and word by word. Lines end with \n, \r\n or \r; words stand between blanks and tabs;
/// a byte-order mark is skipped. What is wrong is told with the file and the line.
class TextLines {
 public:
  struct Line {
    int number = 0;  ///< from 1
    std::vector<std::string_view> words;

    bool empty() const { return words.empty(); }
  };

  /// Reads a file. Throws DataError naming it when it cannot be read.
  explicit TextLines(const std::string& path);
  /// A text that was read from `path` already, from byte `begin` on, whose first line has this number.
  TextLines(std::string text, std::string path, std::size_t begin = 0, int first_line = 1);

  // Lines look into the text.
  TextLines(const TextLines&) = delete;
  TextLines& operator=(const TextLines&) = delete;

  /// The next line, which may be empty; none after the last. What follows `#` in a line is left out.
  std::optional<Line> next();
  /// The byte that the next line begins with.
  std::size_t position() const { return position_; }

  // Each throws DataError, as "FILE:LINE: ...", when the word is none, and says what was expected.
  double real(const Line& line, std::size_t word) const;
  long long integer(const Line& line, std::size_t word) const;

  [[noreturn]] void fail(int line, const std::string& what) const;

 private:
  std::string text_;
  std::string path_;
  std::size_t position_ = 0;
  int number_ = 0;
};

}  // namespace pliant
