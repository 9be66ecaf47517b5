// What the program prints reaches the terminal without control characters, whatever text a file or a library brought.
#include "base/terminal.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <functional>
#include <string>

namespace noonmark {
namespace {

// The bytes that a process with a Terminal writes to its standard output.
std::string written(const std::function<void()>& print) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return "no pipe";
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDOUT_FILENO);
    close(ends[0]);
    close(ends[1]);
    {
      const Terminal terminal;
      print();
    }
    _exit(0);
  }
  close(ends[1]);
  std::string bytes;
  std::array<char, 256> some{};
  for (ssize_t count; (count = read(ends[0], some.data(), some.size())) > 0;)
    bytes.append(some.data(), static_cast<size_t>(count));
  close(ends[0]);
  waitpid(child, nullptr, 0);
  return bytes;
}

TEST(Terminal, ShowsControlCharactersAsText) {
  EXPECT_EQ(written([] { std::fputs("a\x1b[31mb\xff\tc\n", stdout); }), "a\\x1b[31mb\\xff\tc\n");
}

TEST(Terminal, KeepsACharacterThatIsWrittenInTwoPieces) {
  EXPECT_EQ(written([] {
              for (const char* piece : {"\xc3", "\xbc", " \xe2\x82", "\xac\n"}) {
                std::fputs(piece, stdout);
                std::fflush(stdout);
              }
            }),
            "\xc3\xbc \xe2\x82\xac\n");
  EXPECT_EQ(written([] { std::fputs("\xe2\x82", stdout); }), "\\xe2\\x82") << "its end never came";
}

}  // namespace
}  // namespace noonmark
