#pragma once

namespace pliant {

/// From now on SIGINT, SIGTERM and SIGHUP end the program at once, whatever it is doing: what it had begun to
/// write is removed but for finished runs of several and logs of tracked frames, earlier results stay whole,
/// and the exit code is 128 and the signal's number, as shells have it (130 after Ctrl-C). Nor does anything
/// begun stay behind when a library calls exit(). SIGHUP stays ignored where it is (nohup). To be called
/// before other threads are started: they must not get these signals.
void answer_interruptions();

/// While one lives, the first such signal asks for an end and only the next one ends the program.
class FinishOnInterruption {
 public:
  FinishOnInterruption();
  FinishOnInterruption(const FinishOnInterruption&) = delete;
  FinishOnInterruption& operator=(const FinishOnInterruption&) = delete;
  ~FinishOnInterruption();
  bool is_asked() const;
};

}  // namespace pliant
