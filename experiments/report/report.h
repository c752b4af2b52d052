#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/geometry/frame.h"
#include "framework/registration/edit.h"
#include "framework/registration/metrics.h"
#include "framework/registration/result.h"

namespace pliant {

/// One run of an experiment: what came out and how good it is.
struct RunRecord {
  std::string name;
  RegistrationResult result;
  Metrics initial;  ///< before anything
  Metrics aligned;  ///< after the initial alignment
  Metrics metrics;  ///< at the end
};

/// One run of an experiment that bends a surface by handles.
struct EditRecord {
  std::string name;
  EditResult result;
};

/// What a report may draw on for one run.
struct ReportInput {
  const FramePair& pair;
  const SurfaceMap& target;
  const Evaluation& evaluation;
  const RunRecord& run;
};

struct EditInput {
  const FramePair& pair;  ///< only its source counts
  const EditRecord& run;
};

/// Writes something about one run into a folder that exists.
class Report {
 public:
  static constexpr const char* kind = "report";
  virtual ~Report() = default;
  /// Gives the files written. Throws DataError when one cannot be.
  virtual std::vector<std::filesystem::path> write(const ReportInput& input,
                                                   const std::filesystem::path& folder) const = 0;
  virtual std::vector<std::filesystem::path> write(const EditInput& input,
                                                   const std::filesystem::path& folder) const = 0;
};

}  // namespace pliant
