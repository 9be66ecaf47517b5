#include "app/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "app/terminal.h"
#include "scenes/text.h"

namespace noonmark {

Progress::Progress(int64_t total, int64_t already, bool quiet)
    : total_(total), already_(already), quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (line_open_) write_to_terminal("\n");
}

void Progress::say(const std::string& what) {
  if (quiet_) return;
  if (!terminal_) return fmt::print(stderr, "{}\n", printable(what));
  write_to_terminal(fmt::format("\r{:.78}\x1b[K", printable(what)));
  line_open_ = true;
}

void Progress::finished(int64_t done, const std::string& what) {
  if (quiet_) return;
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const int64_t here = done - already_;
  const double left = here > 0 ? elapsed / static_cast<double>(here) * static_cast<double>(total_ - done) : 0;
  if (!terminal_) {
    fmt::print(stderr, "[{}/{}] {} ({:.1f} s so far, about {:.0f} s left)\n", done, total_, printable(what), elapsed,
               left);
    return;
  }
  constexpr int width = 30;
  const int filled = total_ > 0 ? static_cast<int>(width * done / total_) : width;
  // Clears the rest of the line and stays within 79 columns.
  write_to_terminal(fmt::format("\r[{:=<{}}{: <{}}] {}/{}  {:.0f} s left  {:.24}\x1b[K", "", filled, "", width - filled,
                                done, total_, left, printable(what)));
  line_open_ = true;
}

}  // namespace noonmark
