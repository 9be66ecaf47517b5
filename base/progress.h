// Shows how far a run is and how long the rest of it takes, from its first step to its last: one line that rewrites itself
// on a terminal, plain lines elsewhere. It uses standard error, because standard output is for results.
//
//   Progress progress(quiet);
//   const Progress::Work rows = progress.add(25);   // 25 steps
//   progress.say("the phase diagram");                         // what begins
//   for (int row = 0; row < 25; ++row) progress.finished(rows, "texel size 3 of 25");
//
// The time left is the rate so far: the steps of a work that are left take as long as those that are done, and those of a work
// that has not begun as long as the mean of all. The first step starts what the others use, so nothing is said before the main
// work has done two.
#pragma once
#include <cstddef>
#include <functional>
#include <optional>
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
  Work add(size_t steps);
  // The main work; without this call the first one that has steps.
  void set_main(Work work) { main_ = work; }
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

  std::optional<double> left_s() const;  // empty: nothing can be said yet
  double done_share() const;             // from 0 to 1, of the time of the whole; 0 while nothing can be said

 private:
  struct Known {
    size_t steps = 0, done = 0;
    double took_s = 0;
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
  std::optional<Work> main_;
};

}  // namespace noonmark
