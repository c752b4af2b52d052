#pragma once

namespace pliant {

/// The command line: does what the arguments ask for. Errors are told on stderr.
/// Gives the exit code: 0, or 1 (unforeseen), 2 (arguments, configuration), 3 (data), 4 (device),
/// 5 (numerical).
int run_command_line(int argc, char** argv);

}  // namespace pliant
