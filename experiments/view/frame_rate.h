#pragma once

#include <chrono>

namespace pliant {

/// Frames a second by the clock, told anew about every second so that it can be read.
class FrameRate {
 public:
  /// When frame `number` is there. Gives 0 until there have been two.
  double at(int number) {
    const auto now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - since_).count();
    if (first_ == 0 || seconds >= 1 || rate_ == 0) {
      if (first_ != 0 && seconds > 0) rate_ = (number - first_) / seconds;
      first_ = number;
      since_ = now;
    }
    return rate_;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point since_;
  int first_ = 0;
  double rate_ = 0;
};

}  // namespace pliant
