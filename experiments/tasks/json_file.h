#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pliant {

// Every writer throws NumericalError naming the key of a number that is not finite (JSON knows none), and
// DataError naming the file that cannot be written.

/// Makes or replaces a file.
void write_json(const std::string& path, const nlohmann::ordered_json& json);

/// Throws DataError naming the file, and what is wrong with it.
nlohmann::ordered_json read_json(const std::string& path);

/// A file with a JSON value a line. Each line is with the system when append() returns: what ends the program
/// later takes nothing of it.
class JsonLines {
 public:
  /// Goes on behind the last whole line of the file that is there, or makes one.
  explicit JsonLines(const std::string& path);
  JsonLines(const JsonLines&) = delete;
  JsonLines& operator=(const JsonLines&) = delete;
  ~JsonLines();

  void append(const nlohmann::ordered_json& json);

 private:
  std::string path_;
  int file_;
};

/// The values of the whole lines of a file; a last line without an end, torn when the program was ended, is
/// left out. Throws DataError naming file and line of one that is no JSON.
std::vector<nlohmann::ordered_json> read_json_lines(const std::string& path);

}  // namespace pliant
