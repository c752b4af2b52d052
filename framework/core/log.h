#pragma once

#include <functional>
#include <string>

namespace pliant {

/// One step forward of a long piece of work, for whoever watches it.
struct Progress {
  std::string what;     ///< e.g. "registering sheet/device"
  double done = 0;      ///< 0 .. 1
  std::string message;  ///< e.g. "iteration 3: residual 0.81 mm"
};

/// Called from the thread that works; may be empty. The framework itself never writes to a terminal.
using ProgressSink = std::function<void(const Progress&)>;

}  // namespace pliant
