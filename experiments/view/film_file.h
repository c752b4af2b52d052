#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

namespace pliant {

/// A film of JPEG pictures in an AVI file (Motion JPEG, 30 pictures a second). What is there can be played at
/// any time: its head counts the pictures after each, and who ends the program takes none of them away. (That
/// of OpenCV 4.6 writes beyond its buffers: its issue 19634.)
class FilmFile {
 public:
  /// Throws DataError naming the file when it cannot be written, as append() does.
  FilmFile(std::filesystem::path file, int width, int height);
  FilmFile(const FilmFile&) = delete;
  FilmFile& operator=(const FilmFile&) = delete;

  /// A picture of the film's size; gives whether there was room: such a file has no more than 2 GB.
  bool append(const std::vector<std::uint8_t>& jpeg);

 private:
  void write(const std::vector<std::uint8_t>& bytes);
  void write_number(std::streamoff at, std::size_t number);

  std::filesystem::path file_;
  std::ofstream stream_;
  std::size_t size_ = 0;
  std::size_t pictures_ = 0;
};

}  // namespace pliant
