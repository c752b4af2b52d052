#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pliant {

/// Where the experiments that come with the program are: of an installation `share/pliant/experiments`, of a
/// build the source tree's. Throws ConfigError when they are not to be found.
std::filesystem::path experiments_folder();

/// Where files that an experiment names are looked for after its own folder: `given` (may be empty), the
/// variable PLIANT_DATA, `data/` of the project.
std::vector<std::filesystem::path> data_folders(const std::string& given);

/// The first data folder that has `file`.
std::optional<std::filesystem::path> find_data(const std::vector<std::filesystem::path>& folders,
                                               const std::string& file);

}  // namespace pliant
