#include "experiments/program/interruption.h"

#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "experiments/program/output.h"
#include "experiments/runner/result_folder.h"

namespace pliant {
namespace {

bool is_ignored(int signal) {
  struct sigaction action {};
  return ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

std::atomic<int> patient = 0;  // FinishOnInterruption objects that live
std::atomic<bool> is_asked_to_finish = false;

[[noreturn]] void end_after(int signal) {
  const auto kept = ResultFolder::abandon_all();
  write_message(isatty(STDERR_FILENO) != 0 ? "\r\033[Kinterrupted\n" : "interrupted\n");
  for (const auto& folder : kept)
    write_message(folder.string() +
                  ": what is finished; the same command goes on from whole runs of several\n");
  ::_exit(128 + signal);
}

}  // namespace

FinishOnInterruption::FinishOnInterruption() { ++patient; }
FinishOnInterruption::~FinishOnInterruption() { --patient; }
bool FinishOnInterruption::is_asked() const { return is_asked_to_finish; }  // NOLINT(*-to-static)

void answer_interruptions() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  if (!is_ignored(SIGHUP)) sigaddset(&signals, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::atexit([] { ResultFolder::abandon_all(); });  // for libraries that end the program on their own
  std::thread([signals] {
    int signal = 0;
    while (sigwait(&signals, &signal) == 0) {
      if (patient == 0 || is_asked_to_finish.exchange(true)) end_after(signal);
      write_message("\nfinishing with what there is; interrupt once more to end at once\n");
    }
  }).detach();
}

}  // namespace pliant
