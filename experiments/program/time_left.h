#pragma once

#include <cstddef>
#include <string>

#include "framework/core/log.h"
#include "framework/core/stopwatch.h"

namespace pliant {

/// Tells how many of many runs are done and, by how long those took, how long the others may take.
class TimeLeft {
 public:
  explicit TimeLeft(std::size_t runs) : runs_(runs) {}

  /// Tells `sink` the same as the progress of the runs of one experiment tells, with that before it. Both
  /// must outlive what is given back.
  ProgressSink counting(const ProgressSink& sink);
  /// As in "run 12 of 240, about 3 min left".
  std::string text() const;

 private:
  void see(const Progress& progress);
  void end_run();

  std::size_t runs_;
  std::size_t begun_ = 0;
  std::size_t made_ = 0;   // those that were not taken from an earlier result
  double seconds_ = 0;     // that these took
  std::string current_;    // the run that is being made
  bool is_taken_ = false;  // whether that one is
  Stopwatch watch_;
};

}  // namespace pliant
