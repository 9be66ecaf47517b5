// Colours of verdicts, and where there are none.
#include "app/verbs/terminal_text.h"

#include <gtest/gtest.h>
#include <pty.h>
#include <unistd.h>

#include <cstdlib>

namespace noonmark {
namespace {

TEST(TerminalText, ColoursTheVerdictsAlone) {
  EXPECT_EQ(with_coloured_verdicts("held: acne <= 1%; found 0.5%\n  broken: not at the line's start\nbroken\n"),
            "\x1b[32mheld\x1b[0m: acne <= 1%; found 0.5%\n  broken: not at the line's start\nbroken\n");
  EXPECT_EQ(with_coloured_verdicts("broken: x"), "\x1b[31mbroken\x1b[0m: x");
  EXPECT_EQ(with_coloured_verdicts(""), "");
  EXPECT_EQ(with_coloured_verdicts("\n\nwarning: x\n"), "\n\n\x1b[33mwarning\x1b[0m: x\n");
}

// Standard output becomes a terminal, or a pipe, while the test runs.
TEST(TerminalText, OnlyATerminalHasColours) {
  const int saved = dup(STDOUT_FILENO);
  int master = -1, slave = -1;
  ASSERT_EQ(openpty(&master, &slave, nullptr, nullptr, nullptr), 0);
  const auto asked = [&](int output, const char* term, const char* no_color) {
    setenv("TERM", term, 1);
    if (no_color)
      setenv("NO_COLOR", no_color, 1);
    else
      unsetenv("NO_COLOR");
    dup2(output, STDOUT_FILENO);
    const bool has = terminal_has_colours();
    dup2(saved, STDOUT_FILENO);
    return has;
  };
  EXPECT_TRUE(asked(slave, "xterm", nullptr));
  EXPECT_TRUE(asked(slave, "xterm", "")) << "no-color.org: an empty value refuses nothing";
  EXPECT_FALSE(asked(slave, "xterm", "1"));
  EXPECT_FALSE(asked(slave, "dumb", nullptr));
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  EXPECT_FALSE(asked(ends[1], "xterm", nullptr));
  for (const int one : {saved, master, slave, ends[0], ends[1]}) close(one);
}

}  // namespace
}  // namespace noonmark
