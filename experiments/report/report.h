#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/report/artefacts.h"

namespace pliant {

/// Shows the artefacts of a run in files.
class Report {
 public:
  static constexpr const char* kind = "report";
  virtual ~Report() = default;
  /// The names of all files that it may write of artefacts with these names.
  virtual std::vector<std::string> files(const ArtefactNames& names) const = 0;
  /// Writes into a folder that exists; gives the files written. Throws DataError when one cannot be.
  virtual std::vector<std::filesystem::path> write(const RunArtefacts& run,
                                                   const std::filesystem::path& folder) const = 0;
};

}  // namespace pliant
