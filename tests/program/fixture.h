// Runs the program itself, in a new folder.
#pragma once
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "base/file.h"
#include "compare/report/csv.h"
#include "compare/store/store.h"

namespace noonmark::acceptance {

namespace fs = std::filesystem;

// results.csv, and beside it every column of the points of its store.
inline std::string with_all_columns(const fs::path& csv) {
  const std::string store = (csv.parent_path() / "results.sqlite").string();
  return read_file(csv.string()) + "\n" + to_csv(ResultStore::read(store), CsvColumns::all);
}

// The columns before the times, which are the last columns (compare/report/csv.h), of both.
inline std::string without_times(const fs::path& csv) {
  std::istringstream lines(with_all_columns(csv));
  std::string line, kept;
  size_t columns = 0;
  while (std::getline(lines, line)) {
    std::vector<std::string> fields;
    std::istringstream row(line);
    for (std::string field; std::getline(row, field, ',');) fields.push_back(field);
    if (fields.empty()) columns = 0;
    if (columns == 0) {
      while (columns < fields.size() && !fields[columns].ends_with("_ms")) ++columns;
    }
    for (size_t i = 0; i < columns; ++i) kept += fields[i] + ",";
    kept += "\n";
  }
  return columns > 30 ? kept : "no times found";
}

// Experiments for tests in which the content does not matter: a small picture, one point, and a bound that holds.
inline const std::string small_view = "pictures = \"none\"\n[view]\nwidth_px = 48\nheight_px = 27\n";
inline const std::string one_point = "scene = \"plate\"\n" + small_view;
inline const std::string held_bound = "[[bound]]\nmetric = \"residual\"\nmax = 1e-6\n";

// For Program::run: root can read everything, unless it drops its privileges.
inline void without_privileges() {
  prctl(PR_CAPBSET_DROP, 1 /* CAP_DAC_OVERRIDE */);
  prctl(PR_CAPBSET_DROP, 2 /* CAP_DAC_READ_SEARCH */);
}

using Words = std::vector<std::string>;
inline Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

class Program : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("noonmark-" + std::to_string(getpid()) + "-" +
                                              testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override {
    for (int pipe : pipes_) close(pipe);
    fs::remove_all(folder_);
  }

  // prepare: runs in the new process before the program starts (limits, environment, other descriptors).
  pid_t start(const std::vector<std::string>& arguments, const std::function<void()>& prepare = {}) {
    std::vector<char*> argv = {const_cast<char*>(NOONMARK_PROGRAM)};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child != 0) return child;
    if (chdir(folder_.c_str()) != 0) _exit(126);
    const int output = open("output.txt", O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(output, 1);
    dup2(output, 2);
    close(output);
    if (prepare) prepare();
    execv(NOONMARK_PROGRAM, argv.data());
    _exit(127);
  }
  // Starts the program and waits until it has printed these words or has ended without them. Later output stays in the
  // pipe, which is open until the test ends; a few hundred lines of progress fit into it.
  pid_t start_until(const std::string& words, const std::vector<std::string>& arguments) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return -1;
    const pid_t child = start(arguments, [&] {
      dup2(ends[1], 1);
      dup2(ends[1], 2);
    });
    close(ends[1]);
    pipes_.push_back(ends[0]);
    output_.clear();
    char block[4096];
    for (ssize_t n = 1; n > 0 && !says(words);)
      if ((n = read(ends[0], block, sizeof block)) > 0) output_.append(block, static_cast<size_t>(n));
    EXPECT_TRUE(says(words)) << output_;
    return child;
  }
  static int wait_for(pid_t child) {
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  int run(const std::vector<std::string>& arguments, const std::function<void()>& prepare = {}) {
    const int code = wait_for(start(arguments, prepare));
    output_ = read_file((folder_ / "output.txt").string());
    return code;
  }
  // Runs the program, which must end with this exit code and print each of these texts.
  void expect_run(const std::vector<std::string>& arguments, int code, const std::vector<std::string>& printed) {
    EXPECT_EQ(run(arguments), code) << testing::PrintToString(arguments) << "\n" << output_;
    for (const std::string& text : printed) EXPECT_TRUE(says(text)) << text << " is not in\n" << output_;
  }
  std::string write(const std::string& name, const std::string& text) {
    write_file_atomically((folder_ / name).string(), text);
    return (folder_ / name).string();
  }
  std::string text(const std::string& file) const { return read_file((folder_ / file).string()); }
  bool says(const std::string& words) const { return output_.find(words) != std::string::npos; }

  fs::path folder_;
  std::string output_;
  std::vector<int> pipes_;
};

}  // namespace noonmark::acceptance
