#pragma once

#include <memory>
#include <string>

#include "experiments/datasets/data_source.h"

namespace pliant::testing {

/// The data source that a section of an experiment file describes, e.g. "{type: synthetic_sheet, noise: 1}".
std::unique_ptr<DataSource> data_of(const std::string& section);

/// The message of the ConfigError that this throws, "" with a failure when it throws none.
std::string config_error_of(const std::string& section);

}  // namespace pliant::testing
