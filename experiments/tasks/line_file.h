#pragma once

#include <string>
#include <vector>

namespace pliant {

/// A file that grows by lines. Each line is with the system when append() returns: what ends the program
/// later takes nothing of it. Throws DataError naming the file when it cannot be written.
class LineFile {
 public:
  /// Goes on behind the last whole line of the file that is there, or makes one.
  explicit LineFile(const std::string& path);
  LineFile(const LineFile&) = delete;
  LineFile& operator=(const LineFile&) = delete;
  ~LineFile();

  /// `line` ends with a line feed.
  void append(const std::string& line);

 private:
  std::string path_;
  int file_;
};

/// The lines of a file that have an end, without it; a last one that was torn when the program was ended is
/// left out. Throws DataError when it cannot be read.
std::vector<std::string> read_whole_lines(const std::string& path);

}  // namespace pliant
