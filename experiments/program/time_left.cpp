#include "experiments/program/time_left.h"

#include <fmt/format.h>

#include <cmath>

#include "experiments/runner/runner.h"

namespace pliant {
namespace {

std::string rounded(double seconds) {
  if (seconds < 60) return fmt::format("{:.0f} s", std::ceil(seconds));
  return fmt::format("{:.0f} min", std::ceil(seconds / 60));
}

}  // namespace

ProgressSink TimeLeft::counting(const ProgressSink& sink) {
  end_run();
  return [this, &sink](const Progress& progress) {
    see(progress);
    sink({progress.what, progress.done, fmt::format("{}; {}", progress.message, text())});
  };
}

std::string TimeLeft::text() const {
  std::string text = fmt::format("run {} of {}", begun_, runs_);
  if (made_ == 0) return text;
  const double left = seconds_ / static_cast<double>(made_) * static_cast<double>(runs_ - begun_ + 1);
  return text + fmt::format(", about {} left", rounded(left));
}

void TimeLeft::see(const Progress& progress) {
  if (progress.what != current_) {
    end_run();
    current_ = progress.what;
    ++begun_;
  }
  is_taken_ = is_taken_ || progress.message == taken_message;
}

void TimeLeft::end_run() {
  const double milliseconds = watch_.milliseconds();
  watch_ = Stopwatch();
  if (!current_.empty() && !is_taken_) {
    ++made_;
    seconds_ += milliseconds / 1000;
  }
  current_.clear();
  is_taken_ = false;
}

}  // namespace pliant
