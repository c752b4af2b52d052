#pragma once

#include <filesystem>
#include <vector>

#include "experiments/report/study.h"

namespace pliant {

/// What a result, or the folder of one of its runs, stores of each run: as much as a page can show of it.
/// Throws DataError that names the folder which is no result, or the file which is not what a run writes.
std::vector<Study> stored_studies(const std::filesystem::path& folder);

/// The page of a result, or of one of its runs. One whose experiment asked for none gets it made of what is
/// stored. Throws as stored_studies() does, and when the page cannot be written.
std::filesystem::path page_of_result(const std::filesystem::path& folder);

}  // namespace pliant
