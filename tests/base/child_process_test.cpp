#include "base/child_process.h"

#include <gtest/gtest.h>

#include <filesystem>

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
