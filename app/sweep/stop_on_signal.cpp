#include "app/sweep/stop_on_signal.h"

#include <unistd.h>

namespace noonmark {
namespace {

volatile std::sig_atomic_t stop_asked = 0;

}  // namespace

StopOnSignal::StopOnSignal() {
  stop_asked = 0;
  for (int i = 0; i < 2; ++i) {
    struct sigaction action {};
    action.sa_handler = [](int) {
      stop_asked = 1;
      static constexpr char text[] =
          "\nstopping after this point, which is then stored; a second signal stops at once\n";
      [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text, sizeof text - 1);
    };
    action.sa_flags = static_cast<int>(SA_RESETHAND);  // a second signal ends the program
    sigaction(signals_[i], &action, &before_[i]);
  }
}

StopOnSignal::~StopOnSignal() {
  for (int i = 0; i < 2; ++i) sigaction(signals_[i], &before_[i], nullptr);
}

bool StopOnSignal::asked() { return stop_asked != 0; }

}  // namespace noonmark
