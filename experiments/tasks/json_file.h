#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/tasks/line_file.h"

namespace pliant {

// Every writer throws NumericalError naming the key of a number that is not finite (JSON knows none), and
// DataError naming the file that cannot be written.

/// Makes or replaces a file.
void write_json(const std::string& path, const nlohmann::ordered_json& json);

/// Throws DataError naming the file, and what is wrong with it.
nlohmann::ordered_json read_json(const std::string& path);

/// A LineFile with a JSON value a line.
class JsonLines {
 public:
  explicit JsonLines(const std::string& path) : lines_(path) {}
  void append(const nlohmann::ordered_json& json);

 private:
  LineFile lines_;
};

/// The values of the whole lines of a file; a last line without an end, torn when the program was ended, is
/// left out. Throws DataError naming file and line of one that is no JSON.
std::vector<nlohmann::ordered_json> read_json_lines(const std::string& path);

}  // namespace pliant
