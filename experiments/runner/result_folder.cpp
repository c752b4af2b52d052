#include "experiments/runner/result_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <utility>

#include "framework/core/error.h"
#include "framework/io/file.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;
using Files = ResultFolder::Files;

constexpr const char* list_name = ".pliant";
constexpr const char* replaced_name = ".replaced";  ///< in the unfinished folder, for the old result
constexpr const char* list_head =
    "# The result's files, which the next result replaces; it touches no others.\n";

/// Guards the folders that are open, and is held while one changes.
std::mutex& guard() {
  static std::mutex mutex;
  return mutex;
}

std::set<ResultFolder*>& open_folders() {
  static auto& folders = *new std::set<ResultFolder*>;  // never destroyed: asked for while the program exits
  return folders;
}

/// The files that `folder` lists as a result's, and those that results in folders of this one do.
Files listed(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::is_regular_file(folder / list_name, ignored)) return {};
  const auto bytes = read_file((folder / list_name).string());
  const std::string text(bytes.begin(), bytes.end());
  Files files;
  std::set<fs::path> below;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const fs::path file = text.substr(at, end - at);
    at = end + 1;
    if (file.empty() || file.native().front() == '#' || leads_out(file)) continue;
    files.push_back(file);
    if (file.has_parent_path()) below.insert(*file.begin());
  }
  for (const fs::path& name : below)
    for (const fs::path& file : listed(folder / name)) files.push_back(name / file);
  return files;
}

void write_list(const fs::path& folder, const Files& files) {
  std::string text = list_head;
  for (const auto& name : std::set<fs::path>(files.begin(), files.end())) text += name.string() + "\n";
  write_file((folder / list_name).string(), {text.begin(), text.end()});
}

/// All files of a result in a folder, seen from it.
Files files_below(const fs::path& folder) {
  Files files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const fs::path file = entry.path().lexically_relative(folder);
    if (!entry.is_directory() && file != list_name) files.push_back(file);
  }
  return files;
}

/// Whether the folder is one that results are begun in, or could be.
bool is_of_results(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_directory(fs::symlink_status(folder, ignored)) &&
         (fs::exists(folder / list_name, ignored) || fs::exists(folder / replaced_name, ignored) ||
          fs::is_empty(folder, ignored));
}

/// Whether the open folder is still the one of that name.
bool is_at(int open, const fs::path& folder) {
  struct stat ours {};
  struct stat there {};
  return ::fstat(open, &ours) == 0 && ::stat(folder.c_str(), &there) == 0 && ours.st_ino == there.st_ino &&
         ours.st_dev == there.st_dev;
}

/// The numbers of a result: first to go, and last to come, so that a result which has them is whole.
bool is_crown(const fs::path& file) {
  return file.filename() == "result.json" || file.filename() == "compare.json";
}

void make_folders(const fs::path& folder, const Files& files) {
  for (const auto& file : files) fs::create_directories((folder / file).parent_path());
}

void move_files(const fs::path& from, const fs::path& to, const Files& files) {
  for (const auto& file : files) {
    std::error_code ignored;
    if (!fs::exists(fs::symlink_status(from / file, ignored))) continue;
    fs::rename(from / file, to / file);
  }
}

/// Removes the folders of `files` that have nothing in them any more.
void remove_empty_folders(const fs::path& folder, const Files& files) {
  std::set<fs::path> parents;
  for (const auto& file : files)
    for (fs::path parent = file.parent_path(); !parent.empty(); parent = parent.parent_path())
      parents.insert(parent);
  std::error_code ignored;
  for (auto parent = parents.rbegin(); parent != parents.rend(); ++parent)
    fs::remove(folder / *parent, ignored);
}

bool is_input(const fs::path& file, const Files& inputs) {
  return std::any_of(inputs.begin(), inputs.end(), [&](const fs::path& input) {
    std::error_code ignored;
    return fs::equivalent(file, input, ignored);
  });
}

/// Removes what is in a folder but for its list, by which it is known for a result's, and those names.
void clear_but_list(const fs::path& folder, const Files& names) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const fs::path name = entry.path().filename();
    if (name != list_name && std::find(names.begin(), names.end(), name) == names.end())
      fs::remove_all(entry.path(), ignored);
  }
}

/// Whoever is killed in between leaves a folder that is still known for a result's.
void remove_with_list_last(const fs::path& folder) {
  std::error_code ignored;
  clear_but_list(folder, {});
  fs::remove_all(folder, ignored);
}

}  // namespace

bool leads_out(const fs::path& file) {
  return file.is_absolute() || std::find(file.begin(), file.end(), "..") != file.end();
}

ResultFolder::ResultFolder(const fs::path& folder, const Files& files, const Files& inputs,
                           Leftovers leftovers)
    : folder_(folder) {
  check_free(files, inputs);
  const std::scoped_lock lock(guard());
  open();
  is_kept_ = true;  // until it is decided what becomes of it
  if (leftovers == Leftovers::go) clear_but({});
  open_folders().insert(this);
}

ResultFolder::~ResultFolder() {
  const std::scoped_lock lock(guard());
  open_folders().erase(this);
  if (!unfinished_.empty() && !is_kept_) abandon();
  if (lock_ >= 0) ::close(lock_);
}

void ResultFolder::check_free(const Files& files, const Files& inputs) const {
  const Files ours = listed(folder_);
  std::set<std::string> problems;
  for (const auto& file : files)
    for (fs::path part = file; !part.empty(); part = part.parent_path()) {
      const fs::path path = folder_ / part;
      std::error_code ignored;
      const bool is_in_the_way = part == file ? fs::exists(fs::symlink_status(path, ignored))
                                              : fs::exists(path, ignored) && !fs::is_directory(path, ignored);
      if (!is_in_the_way) continue;
      if (is_input(path, inputs))
        problems.insert(path.string() + " is read by this experiment");
      else if (std::find(ours.begin(), ours.end(), part) == ours.end())
        problems.insert(path.string() + " is not of an earlier result");
    }
  if (problems.empty()) return;
  throw DataError(
      fmt::format("{}: the result would take the place of other files: {}; choose another folder with --out",
                  folder_.string(), fmt::join(problems, ", ")));
}

void ResultFolder::open() {
  std::error_code error;
  for (fs::path above = fs::absolute(folder_); !fs::exists(above, error); above = above.parent_path())
    topmost_made_ = above;
  fs::create_directories(folder_, error);
  if (error || !fs::is_directory(folder_, error))
    throw DataError(fmt::format("{}: the output folder cannot be made: {}", folder_.string(),
                                error ? error.message() : "there is a file of this name"));
  unfinished_ = folder_ / "unfinished";
  try {
    lock();
    write_list(unfinished_, {});
  } catch (const DataError&) {
    if (lock_ >= 0) ::close(lock_);
    unfinished_.clear();
    is_kept_ = false;
    abandon();
    throw;
  }
}

/// The lock is gone with the process, however that ends.
void ResultFolder::lock() {
  do {
    if (lock_ >= 0) ::close(lock_);
    if (::mkdir(unfinished_.c_str(), 0777) != 0 && errno != EEXIST)
      throw DataError(
          fmt::format("{}: the output folder cannot be written: {}", folder_.string(), std::strerror(errno)));
    if (!is_of_results(unfinished_))
      throw DataError(
          fmt::format("{} is not of an earlier result, and results are begun there; choose another "
                      "folder with --out",
                      unfinished_.string()));
    lock_ = ::open(unfinished_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock_ < 0)
      throw DataError(fmt::format("{}: cannot be read: {}", unfinished_.string(), std::strerror(errno)));
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
      throw DataError(
          fmt::format("{}: another process is writing a result here; wait for its end, or choose "
                      "another folder with --out",
                      folder_.string()));
  } while (!is_at(lock_, unfinished_));  // unless the process before has just put its result in place
}

void ResultFolder::abandon() {
  std::error_code ignored;
  // Another thread may still be writing into it; it cannot make the folder anew.
  for (int i = 0; i < 200 && !unfinished_.empty() && fs::exists(unfinished_, ignored); ++i) {
    if (i > 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    remove_with_list_last(unfinished_);
  }
  if (topmost_made_.empty()) return;
  for (fs::path made = fs::absolute(folder_); fs::remove(made, ignored); made = made.parent_path())
    if (made == topmost_made_) return;
}

void ResultFolder::commit() {
  const std::scoped_lock lock(guard());
  try {
    const Files fresh = files_below(unfinished_);
    check_free(fresh, {});
    replace_by(fresh);
  } catch (const std::exception& error) {
    const std::string kept = unfinished_.string();
    unfinished_.clear();
    throw DataError(fmt::format("{}; the new result is kept in {}", error.what(), kept));
  }
  std::error_code ignored;
  fs::remove_all(unfinished_, ignored);
  unfinished_.clear();
}

/// All that needs room on the disk comes first.
void ResultFolder::replace_by(Files fresh) const {
  Files old = listed(folder_);
  const fs::path replaced = unfinished_ / replaced_name;
  write_list(unfinished_, fresh);
  make_folders(replaced, old);
  make_folders(folder_, fresh);
  Files both = old;
  both.insert(both.end(), fresh.begin(), fresh.end());
  write_list(folder_, both);
  std::stable_partition(old.begin(), old.end(), is_crown);
  std::stable_partition(fresh.begin(), fresh.end(), [](const fs::path& file) { return !is_crown(file); });
  move_files(folder_, replaced, old);
  move_files(unfinished_, folder_, fresh);
  clear_but_list(unfinished_, {});
  fs::rename(unfinished_ / list_name, folder_ / list_name);
  remove_empty_folders(folder_, old);
}

void ResultFolder::keep_only(const Files& names) {
  const std::scoped_lock lock(guard());
  clear_but(names);
}

void ResultFolder::clear_but(const Files& names) {
  clear_but_list(unfinished_, names);
  is_kept_ = !names.empty();
}

void ResultFolder::keep() {
  const std::scoped_lock lock(guard());
  is_kept_ = true;
}

/// What is listed and not there does no harm; what is there and not listed would be in the next result's way.
void ResultFolder::add(const fs::path& folder, const fs::path& name, const std::string& text) {
  const std::string list = (folder / list_name).string();
  auto bytes = read_file(list);
  const std::string line = name.string() + "\n";
  bytes.insert(bytes.end(), line.begin(), line.end());
  write_file(list, bytes);
  write_file((folder / name).string(), {text.begin(), text.end()});
}

Files ResultFolder::abandon_all() {
  guard().lock();  // for ever
  Files kept;
  for (ResultFolder* folder : open_folders()) {
    if (folder->is_kept_)
      kept.push_back(folder->unfinished_);
    else
      folder->abandon();
  }
  return kept;
}

}  // namespace pliant
