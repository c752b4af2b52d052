#include "framework/io/file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "framework/core/error.h"

namespace pliant {

std::vector<std::uint8_t> read_file(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) throw DataError(fmt::format("{}: no such file", path));
  // Opening a folder succeeds and reads nothing, which would be reported as an empty file.
  if (std::filesystem::is_directory(path, ignored)) {
    throw DataError(fmt::format("{}: is a folder, expected a file", path));
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw DataError(fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
  std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (stream.bad()) throw DataError(fmt::format("{}: reading failed", path));
  return bytes;
}

void write_file(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  std::ofstream stream(path, std::ios::binary | std::ios::trunc);
  if (!stream) throw DataError(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
  stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  // A full disk may show only when the buffer is flushed.
  stream.close();
  if (!stream) throw DataError(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
}

}  // namespace pliant
