#include "experiments/program/view.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstring>

#include "experiments/program/output.h"
#include "experiments/runner/stored_result.h"
#include "framework/core/error.h"

namespace pliant {
namespace {

constexpr const char* opener = "xdg-open";

/// Waits for the opener, which only passes the file on.
void open_page(const std::string& page) {
  std::string name = opener;
  std::string file = page;
  const std::array<char*, 3> arguments{name.data(), file.data(), nullptr};
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, opener, nullptr, nullptr, arguments.data(), environ);
  if (error != 0)
    throw DataError(fmt::format("{}: cannot be opened by {}: {}; open it in a browser", page, opener,
                                std::strerror(error)));
  int status = 0;
  ::waitpid(child, &status, 0);
  if (status != 0)
    throw DataError(fmt::format("{}: {} found nothing to open it with; open it in a browser", page, opener));
}

}  // namespace

void view_command(const std::string& folder, bool open) {
  const std::string page = page_of_result(folder).string();
  print("{}\n", page);
  if (open) open_page(page);
}

}  // namespace pliant
