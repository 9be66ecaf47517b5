// Reading and writing files: which files may be read, and which temporary files are removed.
#include "base/file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/inotify.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "base/digest.h"
#include "base/error.h"
#include "tests/support/kind_thrown.h"
#include "tests/support/sample_results.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

class File : public testing::Test {
 protected:
  std::string refusal(const std::string& name, uint64_t most_bytes = 100) const {
    return refusal_of(ErrorKind::file, [&] { read_file_below(folder.file("home"), name, most_bytes); });
  }
  // The number of a process that has ended.
  static pid_t dead_process() {
    const pid_t child = fork();
    if (child == 0) _exit(0);
    waitpid(child, nullptr, 0);
    return child;
  }
  TemporaryFolder folder;
};

TEST_F(File, ReadsBelowAFolderAndNowhereElse) {
  make_folder(folder.file("home/images/deeper"));
  write_file_atomically(folder.file("secret"), "secret");
  write_file_atomically(folder.file("home/images/a.png"), "a");
  fs::create_symlink("images/a.png", folder.file("home/inside.png"));
  fs::create_symlink("../secret", folder.file("home/outside.png"));
  fs::create_symlink("/", folder.file("home/root"));
  fs::create_symlink("loop.png", folder.file("home/loop.png"));
  EXPECT_EQ(read_file_below(folder.file("home"), "images/a.png", 100), "a");
  EXPECT_EQ(read_file_below(folder.file("home"), "images/deeper/../a.png", 100), "a");
  EXPECT_EQ(read_file_below(folder.file("home"), "inside.png", 100), "a");
  for (const std::string& name :
       {std::string("../secret"), std::string("images/../../secret"), std::string("outside.png"), folder.file("secret"),
        "root" + folder.file("secret"), std::string("/etc/passwd")})
    EXPECT_NE(refusal(name).find("leads out of the folder"), std::string::npos) << name;
  EXPECT_NE(refusal("loop.png").find("cannot be read"), std::string::npos);
  EXPECT_NE(refusal("absent.png").find("cannot be read"), std::string::npos);
  EXPECT_NE(refusal(std::string("a\0b", 3)), "");
}

TEST_F(File, ReadsRegularFilesOnly) {
  make_folder(folder.file("home"));
  ASSERT_EQ(mkfifo(folder.file("home/fifo.png").c_str(), 0600), 0);  // reading it would wait for a writer for ever
  EXPECT_NE(refusal("fifo.png").find("is not a regular file"), std::string::npos);
  EXPECT_NE(refusal(".").find("is not a regular file"), std::string::npos);
  write_file_atomically(folder.file("home/large.png"), std::string(101, 'x'));
  EXPECT_NE(refusal("large.png").find("more than 100 bytes"), std::string::npos);
  EXPECT_EQ(read_file_below(folder.file("home"), "large.png", 101).size(), 101u);
  EXPECT_THROW(read_file("/dev/zero", 1 << 20), Error);
}

TEST_F(File, ClearsWhatKilledProgramsLeftAndNothingElse) {
  // The process number does not tell whether the program still runs: numbers of ended processes are used again, and a
  // container counts separately.
  const std::string dead = std::to_string(dead_process()), alive = std::to_string(getpid());
  make_folder(folder.file("sub"));
  const std::string abandoned[] = {"results.csv.noonmark-" + dead + "-0.tmp",
                                   "p0000-map.exr.noonmark-" + dead + "-12.tmp",
                                   "results.csv.noonmark-" + alive + "-0.tmp", "results.csv.noonmark-1-0.tmp"};
  const std::string kept[] = {"results.csv.noonmark-" + dead + ".tmp",
                              "results.csv.noonmark-" + dead + "-x.tmp",
                              "results.csv.noonmark--1-0.tmp",
                              "results.csv.noonmark-" + dead + "-0.tmp.bak",
                              ".noonmark-" + dead + "-0.tmp",
                              "notes." + dead + "-0.tmp",
                              "results.csv",
                              "sub/results.csv.noonmark-" + dead + "-0.tmp"};
  for (const std::string& name : abandoned) write_file_atomically(folder.file(name), "part");
  for (const std::string& name : kept) write_file_atomically(folder.file(name), "kept");
  // Locked by a program whose process number this program cannot see, as in another container.
  const std::string held = "held.png.noonmark-" + dead + "-0.tmp";
  write_file_atomically(folder.file(held), "held");
  const int descriptor = open(folder.file(held).c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(flock(descriptor, LOCK_EX | LOCK_NB), 0);
  const std::string pipe = "pipe.noonmark-" + dead + "-0.tmp", link = "link.noonmark-" + dead + "-0.tmp";
  ASSERT_EQ(mkfifo(folder.file(pipe).c_str(), 0600), 0);
  fs::create_symlink("results.csv", folder.file(link));

  clear_abandoned_files(folder.path().string());
  for (const std::string& name : abandoned) EXPECT_FALSE(fs::exists(folder.file(name))) << name;
  for (const std::string& name : kept) EXPECT_TRUE(fs::exists(folder.file(name))) << name;
  EXPECT_TRUE(fs::exists(folder.file(held)));
  EXPECT_TRUE(fs::exists(folder.file(pipe)));
  EXPECT_TRUE(fs::is_symlink(folder.file(link)));
  close(descriptor);
  clear_abandoned_files(folder.path().string());
  EXPECT_FALSE(fs::exists(folder.file(held))) << "its program has ended";
  clear_abandoned_files(folder.file("absent"));
}

// A real case: a process that is killed while it writes, and is then a zombie.
TEST_F(File, ClearsWhatAKilledWriteLeft) {
  const auto temporaries = [&] {
    int count = 0;
    for (const auto& entry : fs::directory_iterator(folder.path())) count += entry.path().extension() == ".tmp";
    return count;
  };
  const int begun = inotify_init1(IN_CLOEXEC);
  ASSERT_GE(inotify_add_watch(begun, folder.path().c_str(), IN_CREATE), 0);
  const pid_t child = fork();
  if (child == 0) {
    const std::string large(1 << 24, 'x');
    for (;;) write_file_atomically(folder.file("large"), large);
  }
  // Each event is a file that the child created. The child is stopped at once, so it is in the middle of a write.
  char event[4096];
  for (int left = 0; left == 0;) {
    ASSERT_GT(read(begun, event, sizeof event), 0);
    kill(child, SIGSTOP);
    waitpid(child, nullptr, WUNTRACED);
    left = temporaries();
    if (left == 0) kill(child, SIGCONT);
  }
  close(begun);
  kill(child, SIGKILL);
  siginfo_t ended{};
  ASSERT_EQ(waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT), 0);
  ASSERT_EQ(kill(child, 0), 0) << "the process number of the zombie still exists";
  clear_abandoned_files(folder.path().string());
  EXPECT_EQ(temporaries(), 0);
  waitpid(child, nullptr, 0);
}

// While one program writes a file, another program that clears files must never remove it.
TEST_F(File, ClearsNothingOfTheLiving) {
  const pid_t child = fork();
  if (child == 0) {
    int failed = 0;
    for (int i = 0; i < 500; ++i) try {
        write_file_atomically(folder.file("file"), "whole");
      } catch (const Error&) {
        failed = 1;
      }
    _exit(failed);
  }
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) clear_abandoned_files(folder.path().string());
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_EQ(read_file(folder.file("file")), "whole");
}

TEST_F(File, MakesFoldersAndSaysWhyNot) {
  make_folder(folder.file("a/b/c"));
  EXPECT_TRUE(fs::is_directory(folder.file("a/b/c")));
  make_folder(folder.file("a/b/c/"));
  write_file_atomically(folder.file("file"), "");
  EXPECT_THROW(make_folder(folder.file("file")), Error);
  expect_refused(ErrorKind::file, {folder.file("file") + " is a file"},
                 [&] { make_folder(folder.file("file/below/deeper")); });
}

TEST(AtomicWrite, ReplacesAFileWhole) {
  const TemporaryFolder folder;
  write_file_atomically(folder.file("a"), "old");
  const std::string bytes(1 << 20, '\0');
  write_file_atomically(folder.file("a"), bytes);
  EXPECT_EQ(read_file(folder.file("a")), bytes);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(AtomicWrite, LeavesNothingWhereItCannotReplace) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "taken" / "inside");  // the rename fails, after the write
  EXPECT_THROW(write_file_atomically(folder.file("taken"), "bytes"), Error);
  EXPECT_TRUE(std::filesystem::is_directory(folder.path() / "taken" / "inside"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
  EXPECT_THROW(write_file_atomically(folder.file("absent/file"), "bytes"), Error);
}

// Image libraries write the head of a file last.
TEST(AtomicWrite, TakesPiecesInAnyOrder) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a");
  write_file_atomically(path, "old");
  {
    AtomicFile file(path);
    file.write_at(5, "world");
    file.write_at(0, "hello");
    EXPECT_EQ(file.digest(), digest_of("helloworld"));
    EXPECT_EQ(read_file(path), "old");
  }
  EXPECT_EQ(read_file(path), "old") << "it was not kept";
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
  AtomicFile file(path);
  file.write_at(0, std::string(70000, 'x'));
  file.write_at(1, "y");
  EXPECT_EQ(file.digest(), digest_of("xy" + std::string(69998, 'x')));
  file.keep();
  EXPECT_EQ(read_file(path), "xy" + std::string(69998, 'x'));
}

// A limit on the file size simulates a full disk: the write fails after its first part.
TEST(AtomicWrite, KeepsTheOldFileWhenTheDiskIsFull) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a");
  write_file_atomically(path, "old");
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1000, 1000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    try {
      write_file_atomically(path, std::string(5000, 'x'));
    } catch (const Error&) {
      ::_exit(42);
    }
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 42) << "no error was thrown";
  EXPECT_EQ(read_file(path), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

}  // namespace
}  // namespace noonmark
