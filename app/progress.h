// Shows how far a sweep is, with one line that rewrites itself on a terminal and with plain lines elsewhere. It uses
// standard error, because standard output is for results.
#pragma once
#include <chrono>
#include <cstdint>
#include <string>

namespace noonmark {

class Progress {
 public:
  // already: points finished by an earlier run. quiet: prints nothing.
  Progress(int64_t total, int64_t already, bool quiet);
  ~Progress();

  // Says what is being made, and makes it. Its time does not count for the points' rate.
  template <class Make>
  void aside(const std::string& what, const Make& make) {
    say(what);
    const auto begin = std::chrono::steady_clock::now();
    make();
    start_ += std::chrono::steady_clock::now() - begin;
  }
  void finished(int64_t done, const std::string& what);
  void say(const std::string& what);

 private:
  int64_t total_, already_;
  bool quiet_, terminal_;
  bool line_open_ = false;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace noonmark
