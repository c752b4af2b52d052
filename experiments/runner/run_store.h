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

/// The finished runs of an experiment below a folder: of each what is kept of it in NAME/run.json, beside
/// what its reports wrote. The file comes last, and whole.
class RunStore {
 public:
  using Files = std::vector<std::filesystem::path>;
  explicit RunStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// `files`: those that reports wrote, in the run's folder. Throws DataError when it cannot be written.
  void write(const RunSummary& run, const std::string& key, const Files& files) const;

  /// A run with all its files; none where it is not there, is broken or came of anything else.
  std::optional<RunSummary> find(const std::string& name, const std::string& key) const;

  /// Removes what is there of a run.
  void remove(const std::string& name) const;

  /// Copies a run that find() gives, with its files and no others. Throws DataError when it cannot be
  /// written.
  void copy_to(const RunStore& other, const std::string& name) const;

 private:
  std::filesystem::path file(const std::string& name) const { return folder_ / name / "run.json"; }

  std::filesystem::path folder_;
};

}  // namespace pliant
