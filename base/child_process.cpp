#include "base/child_process.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>
#include <utility>

#include "base/error.h"
#include "base/system_error.h"

namespace noonmark {
namespace {

bool can_be_executed(const std::string& path) {
  std::error_code none;
  return std::filesystem::is_regular_file(path, none) && access(path.c_str(), X_OK) == 0;
}

// A shell that becomes the program. What it leaves beside the program waits for the end of this process.
constexpr const char* keep_group =
    "(trap '' TERM; read -r _; kill -TERM 0; sleep 1; kill -KILL 0) <&3 3<&- & exec \"$@\" 3<&-";

constexpr size_t most_line_bytes = 1 << 16;  // a longer one is handed over in parts

}  // namespace

std::optional<std::string> find_program(const std::string& name) {
  if (name.find('/') != name.npos) return can_be_executed(name) ? std::optional(name) : std::nullopt;
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (const std::string found = (folder.empty() ? "." : folder) + "/" + name; can_be_executed(found)) return found;
  return std::nullopt;
}

std::string own_program() {
  std::error_code none;
  return std::filesystem::read_symlink("/proc/self/exe", none).string();
}

int run_program(const std::vector<std::string>& arguments, const std::string& log,
                const std::function<void(const std::string&)>& said) {
  const auto fail = [](const std::string& what, int code) {
    throw Error(kind_of_failure(code), what + ": " + std::strerror(code));
  };
  if (!can_be_executed(arguments[0]))
    fail(arguments[0] + " cannot be started", access(arguments[0].c_str(), X_OK) != 0 ? errno : EACCES);
  const int output = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (output < 0) fail(log + " cannot be written", errno);
  int lifeline[2];  // its second end is this process's alone, so the first one ends when this process does
  if (pipe2(lifeline, O_CLOEXEC) != 0) {
    const int code = errno;
    close(output);
    fail("no pipe for " + arguments[0], code);
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, output, 1);
  posix_spawn_file_actions_adddup2(&actions, output, 2);
  posix_spawn_file_actions_adddup2(&actions, lifeline[0], 3);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETPGROUP);  // the shell, which becomes the program, leads the group
  std::vector<char*> words;
  for (const char* word : {"/bin/sh", "-c", keep_group, "sh"}) words.push_back(const_cast<char*>(word));
  for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  pid_t child = 0;
  const int failed = posix_spawn(&child, words[0], &actions, &attributes, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  close(output);
  close(lifeline[0]);
  if (failed) close(lifeline[1]), fail(arguments[0] + " cannot be started", failed);
  // The group is killed before its leader is waited for: until then no other group can have its number.
  std::ifstream printed(log);
  std::string line;
  const auto hand_over = [&] {
    for (char c = 0; printed.get(c);) {
      if (c != '\n') line += c;
      if (c == '\n' || line.size() == most_line_bytes) said(std::exchange(line, ""));
    }
    printed.clear();  // more may come
  };
  const auto runs = [&] {
    siginfo_t ended{};
    const int options = WEXITED | WNOWAIT | (said ? WNOHANG : 0);
    return waitid(P_PID, static_cast<id_t>(child), &ended, options) < 0 ? errno == EINTR : ended.si_pid == 0;
  };
  while (runs())
    if (said) hand_over(), std::this_thread::sleep_for(std::chrono::milliseconds(20));
  kill(-child, SIGKILL);
  close(lifeline[1]);
  if (said) hand_over();
  if (!line.empty()) said(line);
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) fail(arguments[0] + " cannot be waited for", errno);
  return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

}  // namespace noonmark
