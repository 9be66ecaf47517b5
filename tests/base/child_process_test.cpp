#include "base/child_process.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <thread>

#include "base/error.h"
#include "base/file.h"
#include "tests/support/temporary_folder.h"

namespace noonmark {
namespace {

TEST(ChildProcess, GivesItsCodeAndBothStreams) {
  const TemporaryFolder folder;
  const std::string log = folder.file("child.log");
  EXPECT_EQ(run_program({"/bin/sh", "-c", "echo out; echo err >&2; read line || exit 7"}, log), 7)
      << "its input is empty";
  EXPECT_EQ(read_file(log), "out\nerr\n");
  EXPECT_EQ(run_program({"/bin/sh", "-c", "kill -TERM $$"}, log), -15);
  EXPECT_EQ(read_file(log), "") << "the log is begun anew";
}

// The program waits for a file that is made when its first line is handed over, up to 10 s.
TEST(ChildProcess, HandsLinesOverWhileItRuns) {
  const TemporaryFolder folder;
  const std::string heard = folder.file("heard");
  std::vector<std::string> lines;
  const int code = run_program({"/bin/sh", "-c",
                                "echo one; echo; i=0; until test -e " + heard +
                                    "; do i=$((i + 1)); test $i -lt 500 || exit 9; sleep 0.02; done; printf two >&2"},
                               folder.file("log"), [&](const std::string& line) {
                                 lines.push_back(line);
                                 std::ofstream(heard) << line;
                               });
  EXPECT_EQ(code, 0);
  EXPECT_EQ(lines, (std::vector<std::string>{"one", "", "two"}));
  EXPECT_EQ(read_file(folder.file("log")), "one\n\ntwo");
}

// Whether a process runs: neither gone nor a zombie that nobody waits for.
bool runs(const std::string& pid) {
  std::ifstream stat("/proc/" + pid + "/stat");
  const std::string text{std::istreambuf_iterator<char>(stat), {}};
  const size_t name_end = text.rfind(')');
  return name_end != text.npos && text[name_end + 2] != 'Z' && text[name_end + 2] != 'X';
}

// A signal is delivered a little later than it is sent. What never comes fails here.
void wait_until(const std::function<bool()>& true_now) {
  for (int i = 0; i < 3000 && !true_now(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ASSERT_TRUE(true_now());
}

// A program that starts another one, writes both numbers into a file, and does what `then` says. Neither ends by SIGTERM.
std::vector<std::string> with_a_child(const std::string& file, const std::string& then) {
  return {"/bin/sh", "-c",
          "trap '' TERM; sleep 1000 & echo $! $$ > " + file + ".new && mv " + file + ".new " + file + "; " + then};
}

void wait_until_both_ended(const std::string& file) {
  wait_until([&] { return std::filesystem::exists(file); });
  std::istringstream numbers(read_file(file));
  for (std::string pid; numbers >> pid;) wait_until([&] { return !runs(pid); });
}

TEST(ChildProcess, WhatTheProgramStartedEndsWithIt) {
  const TemporaryFolder folder;
  EXPECT_EQ(run_program(with_a_child(folder.file("both"), "exit 3"), folder.file("log")), 3);
  wait_until_both_ended(folder.file("both"));
}

TEST(ChildProcess, TheWholeGroupEndsWhenThisProcessDoes) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGKILL}) {
    const TemporaryFolder folder;
    const pid_t caller = fork();
    if (caller == 0) {
      std::signal(signal, SIG_DFL);
      run_program(with_a_child(folder.file("both"), "wait"), folder.file("log"));
      _exit(0);
    }
    wait_until([&] { return std::filesystem::exists(folder.file("both")); });
    kill(caller, signal);
    int status = 0;
    waitpid(caller, &status, 0);
    EXPECT_EQ(WTERMSIG(status), signal) << "the caller ends at once";
    wait_until_both_ended(folder.file("both"));
  }
}

TEST(ChildProcess, WhatCannotBeStartedIsAnError) {
  const TemporaryFolder folder;
  const std::string log = folder.file("child.log");
  EXPECT_THROW(run_program({"/no/such/program"}, log), Error);
  EXPECT_THROW(run_program({"/bin/sh"}, "/no/such/folder/log"), Error);
}

TEST(ChildProcess, ProgramsAreFoundInThePath) {
  const auto shell = find_program("sh");
  ASSERT_TRUE(shell);
  EXPECT_EQ(find_program(*shell), shell);
  EXPECT_FALSE(find_program("no-such-program"));
  EXPECT_FALSE(find_program("/etc/passwd")) << "it may not be executed";
  EXPECT_TRUE(std::filesystem::is_regular_file(own_program()));
}

}  // namespace
}  // namespace noonmark
