#include "experiments/program/progress_line.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "experiments/program/output.h"

namespace pliant {
namespace {

constexpr int bar_width = 24;

/// Columns of the terminal; a longer line would wrap and could not be redrawn.
std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

ProgressLine::ProgressLine() : is_terminal_(isatty(STDERR_FILENO) != 0) {}

void ProgressLine::clear() const {
  if (is_terminal_) write_message("\r\033[K");
}

ProgressSink ProgressLine::sink() {
  return [this](const Progress& progress) { show(progress); };
}

void ProgressLine::show(const Progress& progress) const {
  if (!is_terminal_) {
    show_line(progress);
    return;
  }
  const auto filled = static_cast<int>(std::lround(bar_width * std::clamp(progress.done, 0.0, 1.0)));
  const std::string line = fmt::format("[{}{}] {}: {}", std::string(filled, '#'),
                                       std::string(bar_width - filled, '.'), progress.what, progress.message);
  write_message("\r\033[K" + line.substr(0, terminal_width() - 1));
}

void show_line(const Progress& progress) {
  const bool may_hold_a_bar = isatty(STDERR_FILENO) != 0;
  write_message(fmt::format("{}{}: {}\n", may_hold_a_bar ? "\r\033[K" : "", progress.what, progress.message));
}

}  // namespace pliant
