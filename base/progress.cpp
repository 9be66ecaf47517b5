#include "base/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "base/terminal.h"
#include "base/text.h"

namespace noonmark {
namespace {

// "48 s", "3 min", "2.5 h": a remaining time is no more certain than that.
std::string about(double seconds) {
  if (seconds < 99.5) return fmt::format("{:.0f} s", seconds);
  return seconds < 99.5 * 60 ? fmt::format("{:.0f} min", seconds / 60) : fmt::format("{:.1f} h", seconds / 3600);
}

}  // namespace

double Progress::seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

bool Progress::on_terminal() { return isatty(STDERR_FILENO) == 1; }

Progress::Progress(bool quiet, std::function<double()> now, bool terminal)
    : quiet_(quiet),
      terminal_(terminal),
      now_(std::move(now)),
      start_s_(now_()),
      last_s_(start_s_),
      printed_s_(start_s_) {}

Progress::~Progress() { end_line(); }

void Progress::end_line() {
  if (line_open_) write_to_terminal("\n");
  line_open_ = false;
}

Progress::Work Progress::add(size_t steps) {
  works_.push_back({.steps = steps});
  if (!main_ && steps > 0) main_ = works_.size() - 1;
  return works_.size() - 1;
}

void Progress::set_left(Work work, size_t steps) { works_[work].steps = works_[work].done + steps; }

std::optional<double> Progress::left_s() const {
  if (!main_ || works_[*main_].done < std::min<size_t>(2, works_[*main_].steps)) return std::nullopt;
  double took = 0, done = 0, left = 0;
  for (const Known& work : works_) took += work.took_s, done += static_cast<double>(work.done);
  for (const Known& work : works_) {
    const double rate = work.done > 0 ? work.took_s / static_cast<double>(work.done) : done > 0 ? took / done : 0;
    left += rate * static_cast<double>(work.steps - std::min(work.steps, work.done));
  }
  return left;
}

double Progress::done_share() const {
  const std::optional<double> left = left_s();
  const double took = last_s_ - start_s_;
  return !left ? 0 : *left > 0 ? took / (took + *left) : 1;
}

void Progress::count(Work work) {
  const double now = now_();
  works_[work].took_s += now - last_s_;
  ++works_[work].done;
  last_s_ = now;
}

void Progress::finished(Work work, const std::string& what) {
  count(work);
  print(what);
}

void Progress::finished_small(Work work, const std::string& what) {
  count(work);
  if (last_s_ - printed_s_ >= (terminal_ ? 0.1 : 1.0)) print(what);
}

void Progress::say(const std::string& what) {
  last_s_ = now_();
  print(what);
}

void Progress::print(const std::string& what) {
  printed_s_ = last_s_;
  if (quiet_) return;
  const double so_far = last_s_ - start_s_;
  const std::optional<double> left_s = this->left_s();
  const std::string left = left_s ? fmt::format("about {} left", about(*left_s)) : "";
  if (!terminal_) {
    fmt::print(stderr, "{} ({:.1f} s so far{}{})\n", printable(what), so_far, left.empty() ? "" : ", ", left);
    return;
  }
  line_open_ = true;
  if (!left_s) {
    write_to_terminal(fmt::format("\r{:.0f} s so far  {:.60}\x1b[K", so_far, printable(what)));
    return;
  }
  constexpr int width = 20;
  const int filled = static_cast<int>(std::lround(width * done_share()));
  // Clears the rest of the line and stays within 79 columns.
  write_to_terminal(fmt::format("\r[{:=<{}}{: <{}}] {} left  {:.40}\x1b[K", "", filled, "", width - filled,
                                about(*left_s), printable(what)));
}

}  // namespace noonmark
