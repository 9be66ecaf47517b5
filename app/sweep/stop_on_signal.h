// SIGINT and SIGTERM end a sweep after the point that is being measured.
//
//   const StopOnSignal guard;
//   for (const Settings& point : points(experiment)) { measure(point); if (StopOnSignal::asked()) break; }
#pragma once
#include <csignal>

namespace noonmark {

// While one exists, the first signal is only remembered, and said on standard error. A second one ends the program at
// once. One at a time, because a signal handler can use only globals.
class StopOnSignal {
 public:
  StopOnSignal();
  ~StopOnSignal();
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;

  // Whether a signal came since the last one was made.
  static bool asked();

 private:
  static constexpr int signals_[2] = {SIGINT, SIGTERM};
  struct sigaction before_[2]{};
};

}  // namespace noonmark
