// Faults of the machine and of the file system. For each, the program ends with its exit code and one short line.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>

#include "base/text.h"
#include "compare/store/store.h"
#include "tests/program/fixture.h"

namespace noonmark::acceptance {
namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool sanitized = true;  // AddressSanitizer takes terabytes of address space and must be loaded first
#else
constexpr bool sanitized = false;
#endif

const std::string with_pictures = "scene = \"plate\"\npictures = \"first\"\n[view]\nwidth_px = 48\nheight_px = 27\n";
const std::string two_points = with_pictures + "[sweep]\nmap.resolution = [16, 32]\n";

class Adversity : public Program {
 protected:
  // The program must print one line, even if libraries print more, and no bytes that a terminal would obey.
  void expect_one_line(const std::string& about) {
    EXPECT_TRUE(says(about)) << output_;
    size_t lines = 0;
    for (size_t at = 0; (at = output_.find("noonmark: ", at)) != std::string::npos; ++at) ++lines;
    EXPECT_EQ(lines, 1u) << output_;
    EXPECT_FALSE(says("defect")) << output_;
    expect_printable();
  }
  void expect_printable() const { EXPECT_EQ(printable(output_, Lines::many), output_); }
  std::string results() const { return without_times(folder_ / "out/results.csv"); }
};

void redirect(int descriptor, const char* path) {
  const int file = open(path, O_WRONLY);
  dup2(file, descriptor);
  close(file);
}

TEST_F(Adversity, APathMayHoldAnyBytes) {
  const std::string odd = "\xff\x1b[31m\n\xe2\x82";
  fs::create_directories(folder_ / odd);
  write(odd + "/x\xfe.toml", with_pictures + held_bound);
  write(odd + "/bad.toml", "scne = 1\n");
  expect_run({"check", odd, "--out", odd + "/out"}, 2, {"did you mean 'scene'", ": Held: "});
  expect_printable();
  const fs::path out = folder_ / odd / "out" / "x\xfe";
  for (const char* file : {"junit.xml", "summary.md"}) {
    const std::string text = read_file((out / file).string());
    EXPECT_EQ(printable(text, Lines::many), text) << file;
  }
  EXPECT_EQ(run({"report", out.string()}), 0) << output_;
  expect_printable();
  EXPECT_EQ(run({"render", (folder_ / odd / "x\xfe.toml").string(), "--out", odd + "/one"}), 0) << output_;
  expect_printable();
  EXPECT_EQ(run({"run", odd + "/absent.toml"}), 2) << output_;
  expect_one_line("absent.toml");
  EXPECT_EQ(run({"run", "x.toml", "--" + odd}), 2) << output_;  // the message of a library
  EXPECT_TRUE(says("run has no option '--")) << output_;
  expect_printable();
  EXPECT_EQ(run({"render", "--set", "scene.name=" + odd + ".glb"}), 3) << output_;
  expect_one_line("no such file");
}

TEST_F(Adversity, AFolderThatCannotBeReadIsSaidAndTheRestIsChecked) {
  fs::create_directories(folder_ / "exps/closed");
  write("exps/a.toml", with_pictures + held_bound);
  write("exps/closed/b.toml", "");
  ASSERT_EQ(chmod((folder_ / "exps/closed").c_str(), 0), 0);
  EXPECT_EQ(run({"check", "exps", "--out", "out"}, without_privileges), 3) << output_;
  expect_one_line("exps/closed: cannot be read: Permission denied");
  EXPECT_TRUE(says(": Held: ")) << output_;
  chmod((folder_ / "exps/closed").c_str(), 0700);
}

TEST_F(Adversity, EndingsInCapitalsCount) {
  fs::create_directories(folder_ / "exps");
  write("exps/A.TOML", with_pictures + held_bound);
  expect_run({"check", "exps", "--out", "out"}, 0, {": Held: "});
  EXPECT_EQ(run({"render", "--set", "scene.name=ABSENT.GLTF"}), 3) << output_;
  expect_one_line("no such file");
}

TEST_F(Adversity, ProgressThatCannotBeWrittenLosesNothing) {
  const std::string experiment = write("x.toml", two_points);
  ASSERT_EQ(run({"run", experiment, "--out", "out"}), 0) << output_;
  const std::string whole = results();
  for (const char* how : {"full", "closed", "broken pipe"}) {
    SCOPED_TRACE(how);
    const auto prepare = [&] {
      if (std::string(how) == "full") redirect(STDERR_FILENO, "/dev/full");
      if (std::string(how) == "closed") close(STDERR_FILENO);
      if (std::string(how) == "broken pipe") {
        int ends[2];
        if (pipe(ends) == 0) dup2(ends[1], STDERR_FILENO);
        close(ends[0]);
        close(ends[1]);
      }
    };
    EXPECT_EQ(run({"run", experiment, "--out", "out", "--overwrite"}, prepare), 0) << output_;
    EXPECT_EQ(results(), whole);
    EXPECT_TRUE(says("2 points measured")) << output_;
  }
}

TEST_F(Adversity, StandardOutputThatCannotBeWrittenIsSaid) {
  const std::string experiment = write("x.toml", two_points + held_bound);
  const std::vector<Words> verbs = {{"check", experiment, "--out", "out"}, {"settings"}, {"doctor"}, {"--help"}};
  for (const Words& verb : verbs) {
    SCOPED_TRACE(verb[0]);
    EXPECT_EQ(run(verb, [] { redirect(STDOUT_FILENO, "/dev/full"); }), 3);
    expect_one_line("standard output cannot be written: No space left on device");
  }
  EXPECT_EQ(run(verbs[0], [] { close(STDOUT_FILENO); }), 3);
  expect_one_line("standard output cannot be written: Bad file descriptor");
  EXPECT_NE(read_file((folder_ / "out/summary.md").string()).find("Held"), std::string::npos)
      << "the file must be there";
  EXPECT_EQ(ResultStore::open((folder_ / "out/results.sqlite").string()).load().points.size(), 2u)
      << "output must not go into a file that has the number of a closed stream";
  // A broken bound still gives its own exit code.
  write("x.toml", two_points + "[[bound]]\nmetric = \"residual\"\nmax = -1\n");
  EXPECT_EQ(run({"check", experiment, "--out", "out"}, [] { close(STDERR_FILENO); }), 1);
}

TEST_F(Adversity, AReaderThatHasReadEnoughIsNoError) {
  const std::string experiment = write("x.toml", two_points);
  const auto nobody_reads = [] {
    int ends[2];
    if (pipe(ends) != 0) _exit(126);
    dup2(ends[1], STDOUT_FILENO);
    dup2(ends[1], STDERR_FILENO);
    close(ends[0]);
    close(ends[1]);
  };
  EXPECT_EQ(run({"settings"}, nobody_reads), 0);
  EXPECT_EQ(run({"run", experiment, "--out", "out"}, nobody_reads), 0) << "a sweep must continue without a reader";
  EXPECT_EQ(ResultStore::open((folder_ / "out/results.sqlite").string()).load().points.size(), 2u);
}

TEST_F(Adversity, AFullDiskOrAFileLimitIsAnError) {
  const std::string experiment = write("x.toml", two_points);
  const auto limited = [] {
    const rlimit most{20000, 20000};
    setrlimit(RLIMIT_FSIZE, &most);  // without handling, SIGXFSZ would end the program
  };
  EXPECT_EQ(run({"run", experiment, "--out", "out"}, limited), 3) << output_;
  expect_one_line("results.sqlite");
}

TEST_F(Adversity, AnExperimentThatSaysNothingIsAMistake) {
  for (const char* text : {"", " \t\r\n# scene = \"plate\"\n\n"}) {
    write("x.toml", text);
    EXPECT_EQ(run({"run", "x.toml"}), 2);
    expect_one_line("x.toml: is empty");
    EXPECT_FALSE(fs::exists(folder_ / "out"));
  }
  EXPECT_EQ(run({"run", "/dev/zero"}, [] { alarm(60); }), 2);
  expect_one_line("/dev/zero: is not a regular file");
  EXPECT_EQ(run({"run", "."}), 2);
  expect_one_line("is not a regular file but a folder");
}

TEST_F(Adversity, AStoreThatIsNoFileIsAnError) {
  fs::create_directories(folder_ / "out");
  ASSERT_EQ(mkfifo((folder_ / "out/results.sqlite").c_str(), 0600), 0);
  EXPECT_EQ(run({"report", "out"}, [] { alarm(60); }), 3);
  expect_one_line("out/results.sqlite: is not a regular file");
}

TEST_F(Adversity, WhatIsNoFileBesideTheStoreIsAnError) {
  const std::string experiment = write("x.toml", with_pictures + held_bound);
  ASSERT_EQ(run({"check", experiment, "--out", "out"}), 0) << output_;
  ASSERT_EQ(mkfifo((folder_ / "out/results.sqlite-journal").c_str(), 0600), 0);
  const std::vector<Words> verbs = {
      {"report", "out"}, {"run", experiment, "--out", "out"}, {"check", experiment, "--out", "out"}};
  for (const Words& verb : verbs) {
    SCOPED_TRACE(verb[0]);
    EXPECT_EQ(run(verb, [] { alarm(60); }), 3);
    expect_one_line("out/results.sqlite-journal: is not a regular file");
    EXPECT_TRUE(says("--overwrite")) << output_;
  }
  EXPECT_EQ(run({"check", experiment, "--out", "out", "--overwrite"}, [] { alarm(60); }), 0) << output_;
}

TEST_F(Adversity, NothingIsWrittenThroughALinkInTheImagesPlace) {
  const std::string experiment = write("x.toml", with_pictures + held_bound);
  ASSERT_EQ(run({"check", experiment, "--out", "out"}), 0) << output_;  // so that the folder is a run's
  fs::remove(folder_ / "out/results.sqlite");
  fs::remove_all(folder_ / "out/images");
  fs::create_directories(folder_ / "outside");
  const std::string theirs = "p0000-truth.png";  // a name that --overwrite would remove
  write("outside/" + theirs, "theirs");
  for (const char* target : {"../outside", "../not-there"}) {
    fs::remove(folder_ / "out/images");
    fs::create_symlink(target, folder_ / "out/images");
    for (const char* verb : {"run", "check"}) {
      SCOPED_TRACE(verb);
      for (const bool overwrite : {false, true}) {
        write("out/junit.xml", "of an earlier run");
        std::vector<std::string> words = {verb, experiment, "--out", "out"};
        if (overwrite) words.emplace_back("--overwrite");
        EXPECT_EQ(run(words), 3);
        expect_one_line("out/images: is a symbolic link");
        EXPECT_FALSE(fs::exists(folder_ / "out/results.sqlite")) << "the error must come before the first measurement";
        EXPECT_FALSE(fs::exists(folder_ / "out/junit.xml")) << "the verdict of an earlier run must be removed";
      }
    }
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "outside"), {}), 1);
  EXPECT_EQ(text("outside/" + theirs), "theirs");
  fs::remove(folder_ / "out/images");
  write("out/images", "a file");
  EXPECT_EQ(run({"run", experiment, "--out", "out"}), 3);
  expect_one_line("out/images: is not a folder");
  fs::remove(folder_ / "out/images");
  EXPECT_EQ(run({"run", experiment, "--out", "out"}), 0) << output_;
}

TEST_F(Adversity, TemporaryFilesOfKilledRunsAreCleared) {
  const std::string experiment = write("x.toml", with_pictures);
  const pid_t dead = fork();
  if (dead == 0) _exit(0);
  wait_for(dead);
  const std::string name = ".noonmark-" + std::to_string(dead) + "-0.tmp";
  ASSERT_EQ(run({"run", experiment, "--out", "out"}), 0) << output_;  // so that the folder is a run's
  for (const std::string& file : {"out/results.csv" + name, "out/images/p0000-truth.png" + name}) write(file, "half");
  write("out/mine.tmp", "kept");
  ASSERT_EQ(run({"run", experiment, "--out", "out"}), 0) << output_;
  EXPECT_FALSE(fs::exists(folder_ / ("out/results.csv" + name)));
  EXPECT_FALSE(fs::exists(folder_ / ("out/images/p0000-truth.png" + name)));
  EXPECT_TRUE(fs::exists(folder_ / "out/mine.tmp"));
}

TEST_F(Adversity, ThreadsThatCannotStartAreSaid) {
  if (sanitized) GTEST_SKIP() << "AddressSanitizer must be loaded before anything else";
  const std::string experiment = write("x.toml", two_points);
  ASSERT_EQ(run({"run", experiment, "--out", "out"}), 0) << output_;
  const std::string whole = results();
  // Libraries start threads before main: OpenImageIO's log4cplus starts 4 on Debian 12. With 6, none are left for
  // Noonmark.
  for (const int threads : {6, 20, 24}) {
    SCOPED_TRACE(threads);
    const auto prepare = [&] {
      setenv("LD_PRELOAD", NOONMARK_PRELOAD_THREADS, 1);
      setenv("NOONMARK_TEST_THREADS", std::to_string(threads).c_str(), 1);
      alarm(120);
    };
    const int code = run({"run", experiment, "--out", "out", "--overwrite", "--threads", "8"}, prepare);
    if (threads == 6) {
      EXPECT_EQ(code, 4);
      expect_one_line("threads: only ");
    } else {
      EXPECT_EQ(code, 0) << output_;
      EXPECT_TRUE(says("note: no more than")) << output_;
      EXPECT_EQ(results(), whole);
    }
  }
}

// At every limit of address space the program ends by itself, with the measurement or with one error line. (Below the
// smallest limit the system cannot load the program and reports this itself.)
TEST_F(Adversity, MemoryThatRunsOutIsSaid) {
  if (sanitized) GTEST_SKIP() << "AddressSanitizer takes terabytes of address space";
  const std::string experiment = write("x.toml", two_points);
  int failed = 0, done = 0;
  for (uint64_t megabytes = 600; megabytes <= 2400; megabytes += megabytes < 1400 ? 100 : 500) {
    SCOPED_TRACE(megabytes);
    const auto limited = [&] {
      const rlimit most{megabytes << 20, megabytes << 20};
      setrlimit(RLIMIT_AS, &most);
      alarm(120);  // Embree once waited forever for a lock that it had not released
    };
    const int code = run({"run", experiment, "--out", "out", "--overwrite", "--threads", "2"}, limited);
    if (code == 127 && says("error while loading shared libraries")) continue;
    EXPECT_TRUE(code == 0 || code == 2 || code == 4) << code << ": " << output_;
    if (code != 0) expect_one_line("noonmark: ");
    EXPECT_EQ(code == 2, says("are available (the limit of the address space")) << output_;
    ++(code == 0 ? done : failed);
  }
  EXPECT_GT(failed, 2);
  EXPECT_GT(done, 0);
  EXPECT_EQ(run({"doctor"},
                [] {
                  const rlimit most{uint64_t{900} << 20, uint64_t{900} << 20};
                  setrlimit(RLIMIT_AS, &most);
                }),
            4);
  EXPECT_TRUE(says("NOT USABLE: memory")) << output_;
}

}  // namespace
}  // namespace noonmark::acceptance
