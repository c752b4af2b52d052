#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/report/artefacts.h"
#include "experiments/tasks/task.h"

namespace pliant {

/// What a run comes of, as a short text: the task, the run's resolved experiment (without its name and the
/// other runs) with the files that it reads, how often it is timed, the device, and the program's version
/// with its commit and the changes to it.
std::string run_key(const Task& task, const ExperimentRun& run, const DeviceInfo& device, int repeats);

/// The finished runs of an experiment, of each what is kept of it in NAME/run.json, beside what its reports
/// wrote. The file comes last, and whole.
class RunStore {
 public:
  using Files = std::vector<std::filesystem::path>;

  /// `folder`: where the runs' folders are; `last`: where those of an earlier result are, of which runs may
  /// be taken; empty: none.
  explicit RunStore(std::filesystem::path folder, std::filesystem::path last = {})
      : folder_(std::move(folder)), last_(std::move(last)) {}

  /// `files`: those that its task and reports wrote, in the run's folder or below. Throws DataError when it
  /// cannot be written.
  void write(const RunSummary& run, const std::string& key, const Files& files) const;

  /// A run with all its files, as they were; none where it is not there, is broken or came of anything else.
  /// One that only the earlier result has is copied, with its files and no others. Throws DataError when it
  /// cannot be.
  std::optional<RunSummary> find(const std::string& name, const std::string& key) const;

  /// Removes what is there of a run.
  void remove(const std::string& name) const;

 private:
  std::filesystem::path folder_;
  std::filesystem::path last_;
};

}  // namespace pliant
