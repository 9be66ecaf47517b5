// Standard output and standard error, for all writes of the program through stdio and fmt::print.
//
//   const Terminal terminal;          // first thing in main
//   fmt::print("{}\n", path);         // any path: control characters are printed as \xNN
//   if (terminal.lost() != 0) return; // last thing: a write to standard output has failed
//
// - A write that fails does not throw, kill or stop anything, because a measurement is worth more than a line about it.
//   This holds for a closed stream, a full disk, a reader that went away (SIGPIPE is ignored) and a file at its size
//   limit.
// - Line ends are printed unchanged: \n and \t pass. Other control characters and bytes that are not UTF-8 are
//   replaced. A text that must stay in one line is printed with printable() (base/text.h).
#pragma once
#include <cstdio>
#include <string_view>

namespace noonmark {

class Terminal {
 public:
  Terminal();
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  // errno of the first write to standard output that failed. 0 if all writes succeeded, or if the reader closed the
  // stream early (EPIPE), as `| head` does.
  int lost() const;

 private:
  std::FILE* const stdout_before_;
  std::FILE* const stderr_before_;
};

// Writes bytes to standard error unchanged, for the program's own cursor movements.
void write_to_terminal(std::string_view bytes);

}  // namespace noonmark
