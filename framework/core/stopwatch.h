#pragma once

#include <chrono>
#include <map>
#include <string>

namespace pliant {

/// Milliseconds spent on each named stage.
using StageTimes = std::map<std::string, double>;

class Stopwatch {
 public:
  double milliseconds() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Runs `work` and adds its time on the host to a stage.
template <class Work>
auto timed(StageTimes& times, const std::string& stage, Work work) {
  const Stopwatch watch;
  auto result = work();
  times[stage] += watch.milliseconds();
  return result;
}

}  // namespace pliant
