#pragma once

#include "framework/core/log.h"

namespace pliant {

/// Shows progress on stderr: on a terminal a bar that redraws itself, elsewhere a line a step.
class ProgressLine {
 public:
  ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine() { clear(); }

  /// Leaves the terminal's line empty.
  void clear() const;

  /// Shows into this object, which must outlive it.
  ProgressSink sink();

 private:
  void show(const Progress& progress) const;

  bool is_terminal_;
};

/// Shows a step on stderr, in a line of its own that stays.
void show_line(const Progress& progress);

}  // namespace pliant
