#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/evaluation/metrics.h"
#include "framework/geometry/frame.h"
#include "framework/registration/edit.h"
#include "framework/tracking/result.h"

namespace pliant {

/// How long a run took, of which its result tells the stages.
struct Timing {
  int repeats = 1;  ///< runs that were timed; the result is that of the median one
  double min_ms = 0;
  double max_ms = 0;
  bool built_kernels = false;  ///< in the time that is told: a later run takes less
};

/// One run of an experiment: what came out and how good it is.
struct RunRecord {
  std::string name;
  RegistrationResult result;
  Timing timing;
  Metrics initial;  ///< before anything
  Metrics aligned;  ///< after the initial alignment
  Metrics metrics;  ///< at the end
};

/// One run of an experiment that bends a surface by handles.
struct EditRecord {
  std::string name;
  EditResult result;
  Timing timing;
};

/// Per source point the distance in mm to the nearest target point, measured once for all who show it.
struct NearestDistances {
  std::vector<float> initial;
  std::vector<float> aligned;
  std::vector<float> final;
};

/// What a report may draw on for one run.
struct ReportInput {
  const FramePair& pair;
  const SurfaceImage& target;
  const NearestDistances& nearest;
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
  /// The names of all files that it may write.
  virtual std::vector<std::string> files() const = 0;
  /// Gives the files written. Throws DataError when one cannot be.
  virtual std::vector<std::filesystem::path> write(const ReportInput& input,
                                                   const std::filesystem::path& folder) const = 0;
  virtual std::vector<std::filesystem::path> write(const EditInput& input,
                                                   const std::filesystem::path& folder) const = 0;
};

}  // namespace pliant
