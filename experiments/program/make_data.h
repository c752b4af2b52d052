#pragma once

#include <string>

#include "experiments/program/commands.h"

namespace pliant {

/// Writes the frames of a data source and their truth into a folder. `options.file` is the name of a source
/// or an experiment file, whose `data` is taken; `layout`: tum or deepdeform.
void make_data_command(const ExperimentOptions& options, const std::string& layout);

}  // namespace pliant
