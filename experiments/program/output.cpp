#include "experiments/program/output.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "framework/core/error.h"

namespace pliant {
namespace {

/// Of the first write to standard output that failed.
int output_error = 0;

}  // namespace

void secure_standard_streams() {
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream)
    if (::fcntl(stream, F_GETFD) < 0) ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

void write_output(const std::string& text) {
  const bool is_written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if ((!is_written || std::fflush(stdout) != 0) && output_error == 0) output_error = errno;
}

void check_output() {
  if (output_error != 0)
    throw DataError(fmt::format("standard output cannot be written: {}", std::strerror(output_error)));
}

void write_message(const std::string& text) { std::fwrite(text.data(), 1, text.size(), stderr); }

}  // namespace pliant
