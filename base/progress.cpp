#include "base/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numeric>

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

Progress::Work Progress::add(std::vector<double> expected_s) {
  Known work;
  work.left_expected_s = std::accumulate(expected_s.begin(), expected_s.end(), 0.0);
  work.expected_s = std::move(expected_s);
  works_.push_back(std::move(work));
  return works_.size() - 1;
}

void Progress::set_left(Work work, size_t steps) {
  Known& known = works_[work];
  const double each = known.expected_s.empty() ? 0 : known.expected_s.back();
  known.expected_s.resize(known.done + steps, each);
  known.left_expected_s =
      std::accumulate(known.expected_s.begin() + static_cast<std::ptrdiff_t>(known.done), known.expected_s.end(), 0.0);
}

double Progress::left_s() const {
  double took = 0, expected = 0;
  for (const Known& work : works_) took += work.took_s, expected += work.done_expected_s;
  const double of_all = expected > 0 ? took / expected : 1;
  double left = 0;
  for (const Known& work : works_)
    left += work.left_expected_s * (work.done_expected_s > 0 ? work.took_s / work.done_expected_s : of_all);
  return left;
}

double Progress::done_share() const {
  const double took = last_s_ - start_s_, left = left_s();
  return left > 0 ? took / (took + left) : 1;
}

void Progress::count(Work work) {
  Known& known = works_[work];
  const double now = now_(), expected = known.done < known.expected_s.size() ? known.expected_s[known.done] : 0;
  known.took_s += now - last_s_;
  known.done_expected_s += expected;
  known.left_expected_s = std::max(0.0, known.left_expected_s - expected);
  ++known.done;
  if (known.done >= known.expected_s.size()) known.left_expected_s = 0;  // not what rounding leaves
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
  const std::string left = works_.empty() ? "" : fmt::format(", about {} left", about(left_s()));
  if (!terminal_) {
    fmt::print(stderr, "{} ({:.1f} s so far{})\n", printable(what), so_far, left);
    return;
  }
  line_open_ = true;
  if (works_.empty()) {
    write_to_terminal(fmt::format("\r{:.0f} s so far  {:.60}\x1b[K", so_far, printable(what)));
    return;
  }
  constexpr int width = 20;
  const int filled = static_cast<int>(std::lround(width * done_share()));
  // Clears the rest of the line and stays within 79 columns.
  write_to_terminal(fmt::format("\r[{:=<{}}{: <{}}] {} left  {:.40}\x1b[K", "", filled, "", width - filled,
                                about(left_s()), printable(what)));
}

}  // namespace noonmark
