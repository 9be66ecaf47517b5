#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "app/sweep/retract.h"
#include "app/verbs/command_line.h"
#include "base/error.h"
#include "base/failure.h"
#include "base/shell_words.h"
#include "base/terminal.h"

namespace noonmark {
namespace {

// The terminate handler. A library may stop an exception on its way, and then main cannot catch it. If memory or
// threads have run out, this handler prints one line and ends the program with the exit code of the machine. Any other
// exception ends the program as usual.
[[noreturn]] void give_up() {
  try {
    if (const std::exception_ptr exception = std::current_exception()) std::rethrow_exception(exception);
  } catch (const std::bad_alloc&) {
  } catch (const std::system_error&) {
  } catch (...) {
    std::abort();
  }
  write_to_terminal("noonmark: a library ended the program; most likely memory or threads have run out\n");
  std::_Exit(static_cast<int>(ErrorKind::device));
}

// Without arguments: what to do first. It is an error, because nothing was asked for.
int first_steps() {
  std::fputs(
      "noonmark: no verb is given. First steps with a model of your own:\n"
      "  noonmark init MODEL.glb            writes MODEL.toml, a first experiment (inspect MODEL.glb shows the model)\n"
      "  noonmark recommend MODEL.toml      searches the settings to use, and writes them for other engines too\n"
      "  noonmark check out/recommend-MODEL/recommended.toml   judges them; the report shows every wrong pixel\n"
      "noonmark --help lists all verbs.\n",
      stderr);
  return static_cast<int>(ErrorKind::usage);
}

// Runs the verb. If it fails, the verdicts of an earlier run are removed.
int run(int argc, char** argv) {
  if (argc < 2) return first_steps();
  const std::vector<std::string> words(argv + 1, argv + argc);
  std::string command = "noonmark";
  for (const std::string& word : words) command += " " + shell_quoted(word);
  CommandLine line;
  try {
    return line.run(argc, argv, command);
  } catch (...) {
    const Failure failure = current_failure();
    retract_verdicts(meant_folders(words, line.vocabulary()), failure, command);
    return tell(failure);
  }
}

}  // namespace
}  // namespace noonmark

int main(int argc, char** argv) {
  using namespace noonmark;
  const Terminal terminal;
  std::set_terminate(give_up);
  int exit_code = 0;
  try {
    exit_code = run(argc, argv);
  } catch (...) {
    exit_code = tell(current_failure());
  }
  if (const int error = terminal.lost(); error != 0) {
    tell({static_cast<int>(ErrorKind::file),
          fmt::format("standard output cannot be written: {}; its text is lost, but the files are written",
                      std::strerror(error))});
    exit_code = std::max(exit_code, static_cast<int>(ErrorKind::file));
  }
  return exit_code;
}
