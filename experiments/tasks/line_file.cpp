#include "experiments/tasks/line_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "framework/core/error.h"
#include "framework/io/file.h"

namespace pliant {
namespace {

[[noreturn]] void fail(const std::string& path, int why) {
  throw DataError(fmt::format("{}: cannot be written: {}", path, std::strerror(why)));
}

/// How many bytes of a text are in lines that have an end.
std::size_t whole_lines(const std::vector<std::uint8_t>& text) {
  std::size_t size = text.size();
  while (size > 0 && text[size - 1] != '\n') --size;
  return size;
}

}  // namespace

LineFile::LineFile(const std::string& path)
    : path_(path), file_(::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666)) {
  if (file_ < 0) fail(path_, errno);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return;
  if (::ftruncate(file_, static_cast<off_t>(whole_lines(read_file(path_)))) == 0) return;
  const int why = errno;
  ::close(file_);
  fail(path_, why);
}

LineFile::~LineFile() { ::close(file_); }

void LineFile::append(const std::string& line) {
  const off_t begin = ::lseek(file_, 0, SEEK_END);
  for (std::size_t done = 0; done < line.size();) {
    const ssize_t more = ::write(file_, line.data() + done, line.size() - done);
    if (more >= 0) {
      done += static_cast<std::size_t>(more);
    } else if (errno != EINTR) {
      const int why = errno;
      if (::ftruncate(file_, begin) != 0) fail(path_, errno);  // a later line would be glued to this one
      fail(path_, why);
    }
  }
}

std::vector<std::string> read_whole_lines(const std::string& path) {
  const auto bytes = read_file(path);
  const std::string text(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(whole_lines(bytes)));
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

}  // namespace pliant
