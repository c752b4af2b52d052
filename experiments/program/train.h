#pragma once

#include "experiments/program/commands.h"

namespace pliant {

/// Trains what `options.file` says, a forest that finds heads: `head_forest`, with the usual settings, or a
/// file of settings. Writes it to `options.out`, a file.
void train_command(const ExperimentOptions& options);

}  // namespace pliant
