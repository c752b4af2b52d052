#include "framework/io/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "framework/core/error.h"

namespace pliant {
namespace {

/// Whether another file may take the place of `path`: not that of a device, a pipe or a link.
bool is_replaceable(const std::filesystem::path& path) {
  std::error_code ignored;
  const auto status = std::filesystem::symlink_status(path, ignored);
  return !std::filesystem::exists(status) || std::filesystem::is_regular_file(status);
}

/// A name of which there is no file in the same folder. Short: that of `path` may be as long as names can be.
std::string name_beside(const std::filesystem::path& path) {
  static std::atomic<int> count = 0;
  return (path.parent_path() / fmt::format(".pliant-{}-{}", ::getpid(), count++)).string();
}

/// Gives 0, or the error number of what went wrong. A full disk may show only when the file is closed.
int write_bytes(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) return errno;
  int problem = 0;
  for (std::size_t done = 0; done < bytes.size() && problem == 0;) {
    const ssize_t more = ::write(file, bytes.data() + done, bytes.size() - done);
    if (more >= 0)
      done += static_cast<std::size_t>(more);
    else if (errno != EINTR)
      problem = errno;
  }
  return ::close(file) == 0 || problem != 0 ? problem : errno;
}

}  // namespace

std::vector<std::uint8_t> read_file(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) throw DataError(fmt::format("{}: no such file", path));
  // Opening a folder succeeds and reads nothing, which would be reported as an empty file.
  if (std::filesystem::is_directory(path, ignored)) {
    throw DataError(fmt::format("{}: is a folder, expected a file", path));
  }
  if (std::filesystem::is_character_file(path, ignored))  // which may never end
    throw DataError(fmt::format("{}: is a device, expected a file", path));
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw DataError(fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
  std::vector<std::uint8_t> bytes;
  // By growing blocks: a pipe does not say how long it is.
  while (stream) {
    const std::size_t done = bytes.size();
    bytes.resize(2 * done + 65536);
    stream.read(reinterpret_cast<char*>(bytes.data() + done),
                static_cast<std::streamsize>(bytes.size() - done));
    bytes.resize(done + static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) throw DataError(fmt::format("{}: reading failed", path));
  return bytes;
}

void write_file(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  const std::string fresh = is_replaceable(path) ? name_beside(path) : path;
  const int problem = write_bytes(fresh, bytes);
  if (problem == 0 && (fresh == path || std::rename(fresh.c_str(), path.c_str()) == 0)) return;
  const int why = problem != 0 ? problem : errno;
  if (fresh != path) ::unlink(fresh.c_str());
  throw DataError(fmt::format("{}: cannot be written: {}", path, std::strerror(why)));
}

}  // namespace pliant
