// Shows how far a run is and how long the rest of it takes, from its first step to its last: one line that rewrites itself
// on a terminal, plain lines elsewhere. It uses standard error, because standard output is for results.
//
//   Progress progress(quiet);
//   const Progress::Work rows = progress.add(25, 1.0);   // 25 steps, each expected to take a second
//   progress.say("the phase diagram");                         // what begins
//   for (int row = 0; row < 25; ++row) progress.finished(rows, "texel size 3 of 25");
//
// The expected seconds are those of any machine: from the first finished step on, the steps of a work take as long as those
// before, in proportion, and the steps of a work that has not begun are as much slower or faster as the others were.
#pragma once
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace noonmark {

class Progress {
 public:
  using Work = size_t;
  // now: seconds of a clock that only rises. terminal: whether standard error is one.
  explicit Progress(bool quiet, std::function<double()> now = seconds_now, bool terminal = on_terminal());
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Work that the run will do, all of it before the first step.
  Work add(size_t steps, double expected_s) { return add(std::vector<double>(steps, expected_s)); }
  Work add(std::vector<double> expected_s);  // of each step, in their order
  // What is left of a work, once that is known better.
  void set_left(Work work, size_t steps);

  // One step is done. The time since the last step, or since say(), is its time.
  void finished(Work work, const std::string& what);
  // The same of a step that is one of very many: its line comes at most every second, on a terminal ten times as often.
  void finished_small(Work work, const std::string& what);
  // What begins now. Without any work there is no remaining time, only that so far.
  void say(const std::string& what);
  // Ends the line that rewrites itself, before something else is printed.
  void end_line();

  double left_s() const;
  double done_share() const;  // from 0 to 1, of the time of the whole

 private:
  struct Known {
    std::vector<double> expected_s;
    size_t done = 0;
    double done_expected_s = 0, left_expected_s = 0, took_s = 0;
  };
  static double seconds_now();
  static bool on_terminal();
  void count(Work work);
  void print(const std::string& what);

  bool quiet_, terminal_;
  std::function<double()> now_;
  double start_s_, last_s_;
  double printed_s_;
  bool line_open_ = false;
  std::vector<Known> works_;
};

}  // namespace noonmark
