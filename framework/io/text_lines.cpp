#include "framework/io/text_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "framework/core/error.h"
#include "framework/io/file.h"

namespace pliant {
namespace {

std::string text_of(const std::string& path) {
  const auto bytes = read_file(path);
  return {bytes.begin(), bytes.end()};
}

/// The start of a word, with what no terminal should show replaced.
std::string shown(std::string_view word) {
  constexpr std::size_t longest = 40;
  std::string text(word.substr(0, longest));
  std::replace_if(
      text.begin(), text.end(), [](char letter) { return letter < ' ' || letter > '~'; }, '?');
  return text;
}

std::vector<std::string_view> split(std::string_view line) {
  line = line.substr(0, line.find('#'));
  std::vector<std::string_view> words;
  constexpr std::string_view blanks = " \t\v\f";
  for (std::size_t begin = line.find_first_not_of(blanks); begin != std::string_view::npos;
       begin = line.find_first_not_of(blanks, begin)) {
    const std::size_t end = std::min(line.find_first_of(blanks, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = end;
  }
  return words;
}

/// Independent of the locale, unlike streams and strtod. A plus sign, which it does not know, is left out.
template <class Number>
bool parse(std::string_view word, Number& number) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc() && stop == word.data() + word.size();
}

}  // namespace

TextLines::TextLines(const std::string& path) : TextLines(text_of(path), path) {}

TextLines::TextLines(std::string text, std::string path, std::size_t begin, int first_line)
    : text_(std::move(text)), path_(std::move(path)), position_(begin), number_(first_line - 1) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (begin == 0 && text_.starts_with(byte_order_mark)) position_ = byte_order_mark.size();
}

std::optional<TextLines::Line> TextLines::next() {
  if (position_ >= text_.size()) return std::nullopt;
  const std::size_t end = std::min(text_.find_first_of("\r\n", position_), text_.size());
  Line line{++number_, split(std::string_view(text_).substr(position_, end - position_))};
  const bool is_pair = text_.compare(end, 2, "\r\n") == 0;
  position_ = std::min(end + (is_pair ? 2 : 1), text_.size());
  return line;
}

double TextLines::real(const Line& line, std::size_t word) const {
  double number = 0;
  if (word >= line.words.size()) fail(line.number, "a number is missing");
  if (!parse(line.words[word], number) || !std::isfinite(number))
    fail(line.number, fmt::format("'{}' is not a number", shown(line.words[word])));
  return number;
}

long long TextLines::integer(const Line& line, std::size_t word) const {
  long long number = 0;
  if (word >= line.words.size()) fail(line.number, "a number is missing");
  if (!parse(line.words[word], number))
    fail(line.number, fmt::format("'{}' is not a whole number", shown(line.words[word])));
  return number;
}

void TextLines::fail(int line, const std::string& what) const {
  throw DataError(fmt::format("{}:{}: {}", path_, line, what));
}

}  // namespace pliant
