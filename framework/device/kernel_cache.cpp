#include "framework/device/kernel_cache.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <functional>

namespace pliant {
namespace {

namespace fs = std::filesystem;

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// What PoCL takes, but for what it makes of an empty or missing HOME; empty: there is none.
fs::path usual_folder() {
  if (const auto own = variable("POCL_CACHE_DIR"); !own.empty()) return own;
  if (const auto caches = variable("XDG_CACHE_HOME"); !caches.empty())
    return fs::path(caches) / "pocl/kcache";
  if (const auto home = variable("HOME"); !home.empty()) return fs::path(home) / ".cache/pocl/kcache";
  return {};
}

fs::path private_folder() {
  const std::string temporary = variable("TMPDIR");
  return fs::path(temporary.empty() ? "/tmp" : temporary) / fmt::format("pliant-{}", geteuid());
}

bool can_write_down_to(int depth, const fs::path& folder) {
  // What is gone was another run's, which has finished with it meanwhile.
  if (access(folder.c_str(), R_OK | W_OK | X_OK) != 0) return errno == ENOENT;
  if (depth == 0) return true;
  std::error_code error;
  const fs::directory_iterator entries(folder, error);
  return std::all_of(begin(entries), end(entries), [&](const fs::directory_entry& entry) {
    return !entry.is_directory(error) || can_write_down_to(depth - 1, entry.path());
  });
}

/// Makes the folder where it is missing; whether this user can write to it and to what is kept in it: PoCL's
/// folders of programs, two levels down, may be another user's.
bool can_be_used(const fs::path& folder) {
  std::error_code error;
  if (fs::create_directories(folder, error)) fs::permissions(folder, fs::perms::owner_all, error);
  return fs::is_directory(folder, error) && can_write_down_to(2, folder);
}

/// Kernels are code: in a folder that others can write to, or that somebody else has put there, they could be
/// anybody's.
bool is_private(const fs::path& folder) {
  struct stat status {};
  return lstat(folder.c_str(), &status) == 0 && S_ISDIR(status.st_mode) && status.st_uid == geteuid() &&
         (status.st_mode & (S_IRWXG | S_IRWXO)) == 0;
}

bool can_be_private(const fs::path& folder) {
  mkdir(folder.c_str(), S_IRWXU);
  return is_private(folder) && can_be_used(folder);
}

fs::path note_of(const fs::path& cache, const std::string& program) {
  return cache / "pliant" / fmt::format("{:016x}", std::hash<std::string>{}(program));
}

}  // namespace

fs::path open_kernel_cache() {
  const fs::path usual = usual_folder();
  const bool is_usual = !usual.empty() && can_be_used(usual);
  fs::path folder = is_usual ? usual : private_folder();
  if (!is_usual && !can_be_private(folder)) return {};
  // PoCL does not stand an empty one.
  const char* given = std::getenv("POCL_CACHE_DIR");
  if (!is_usual || (given != nullptr && *given == '\0')) setenv("POCL_CACHE_DIR", folder.c_str(), 1);
  return folder;
}

std::string kernel_cache_problem() {
  if (!open_kernel_cache().empty()) return "";
  const std::string usual = usual_folder().string();
  return fmt::format(
      "kernels can be kept neither in {} nor in {}, which must be a folder that you alone can write to; set "
      "POCL_CACHE_DIR to a folder of yours",
      usual.empty() ? "your home (HOME is not set)" : usual, private_folder().string());
}

bool is_noted(const fs::path& cache, const std::string& program) {
  std::error_code error;
  return !cache.empty() && fs::exists(note_of(cache, program), error);
}

void note(const fs::path& cache, const std::string& program) {
  if (cache.empty()) return;
  const fs::path file = note_of(cache, program);
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  const std::ofstream made(file);
}

}  // namespace pliant
