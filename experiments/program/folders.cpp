#include "experiments/program/folders.h"

#include <cstdlib>

#include "framework/core/error.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

std::optional<fs::path> find_experiments() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  std::vector<fs::path> candidates;
  if (!error) candidates.push_back(program.parent_path().parent_path() / "share/pliant/experiments");
  candidates.emplace_back(fs::path(PLIANT_SOURCE_FOLDER) / "experiments");
  // A source tree that was moved after it was configured: the program is somewhere below it.
  for (fs::path folder = program.parent_path(); folder != folder.root_path(); folder = folder.parent_path())
    candidates.push_back(folder / "experiments");
  for (const auto& candidate : candidates) {
    if (fs::exists(candidate / "methods/ed.yaml", error)) return candidate;
  }
  return std::nullopt;
}

}  // namespace

fs::path experiments_folder() {
  if (auto folder = find_experiments()) return *folder;
  throw ConfigError(
      "the experiments that come with Pliant were not found; expected share/pliant/experiments beside the "
      "folder of the program");
}

std::vector<fs::path> data_folders(const std::string& given) {
  std::vector<fs::path> folders;
  if (!given.empty()) folders.emplace_back(given);
  if (const char* variable = std::getenv("PLIANT_DATA"); variable != nullptr && *variable != '\0')
    folders.emplace_back(variable);
  if (const auto experiments = find_experiments()) folders.push_back(experiments->parent_path() / "data");
  return folders;
}

std::optional<fs::path> find_data(const std::vector<fs::path>& folders, const std::string& file) {
  std::error_code error;
  for (const auto& folder : folders) {
    if (fs::exists(folder / file, error)) return folder;
  }
  return std::nullopt;
}

}  // namespace pliant
