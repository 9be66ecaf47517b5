// Standard output and standard error, as the whole program writes them through stdio and fmt::print.
//
//   const Terminal terminal;          // first thing in main
//   fmt::print("{}\n", path);         // any path: what a terminal would obey arrives as \xNN
//   if (terminal.lost() != 0) ...     // last thing: something said on standard output did not arrive
//
// - No write that fails throws, kills or stops anything: a measurement is worth more than a line about it. A closed
//   stream, a full disk, a reader that went away (SIGPIPE is ignored) and a file at its size limit are the same.
// - Lines that are printed end as they were written; \n and \t pass, other control characters and bytes that are no
//   UTF-8 do not. A text that must stay one line is printed by printable() (scenes/text.h).
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

  // errno of the first write to standard output that failed; 0 when all arrived, or when its reader had read enough and
  // closed it (EPIPE), as `| head` does.
  int lost() const;

 private:
  std::FILE* const stdout_before_;
  std::FILE* const stderr_before_;
};

// To standard error as it is: for the program's own cursor movements.
void write_to_terminal(std::string_view bytes);

}  // namespace noonmark
