#pragma once

#include <string>
#include <vector>

#include "framework/config/config.h"

namespace pliant {

/// What several commands take.
struct ExperimentOptions {
  std::string file;
  std::vector<std::string> sets;
  std::string out;    ///< empty: out/<name of the experiment> below the current folder
  std::string data;   ///< empty: none given
  bool show = false;  ///< the frames in a window while they are tracked
  int repeats = 0;    ///< timed runs after one that is not timed; 0: one run, timed
};

/// How an experiment file of this program is read: with the data folders and the methods that come with it.
ConfigSource config_source(const ExperimentOptions& options);

// The sub-commands. Each prints its result on stdout and throws an Error when there is none.

void run_command(const ExperimentOptions& options);
void track_command(const ExperimentOptions& options);
void check_command(const ExperimentOptions& options);
void compare_command(const ExperimentOptions& options);
void components_command(const std::string& kind, const std::string& name, bool as_json);
void devices_command();

}  // namespace pliant
