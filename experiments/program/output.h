#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

namespace pliant {

/// What of 0, 1 and 2 is closed becomes a stream that nothing can be read from or written to; the next file
/// to be opened would take its number, and messages would go into it. Writing to a pipe that nobody reads and
/// beyond the largest file allowed become errors. To be called before anything else.
void secure_standard_streams();

/// Writes to standard output at once. What goes wrong is kept for check_output: it shall not end a run.
void write_output(const std::string& text);

template <class... Values>
void print(fmt::format_string<Values...> format, Values&&... values) {
  write_output(fmt::format(format, std::forward<Values>(values)...));
}

/// Throws DataError with the reason when something was asked for on standard output and is not there.
void check_output();

/// Writes to standard error, if it can be written.
void write_message(const std::string& text);

}  // namespace pliant
