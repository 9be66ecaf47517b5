// The messages and exit codes for mistakes of a user.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <ctime>

#include "compare/store/sqlite.h"
#include "tests/program/fixture.h"

namespace noonmark::acceptance {
namespace {

class Messages : public Program {};

TEST_F(Messages, AWrongOptionIsNamedInPlainWords) {
  const std::string experiment = write("x.toml", one_point);
  expect_run({"render", experiment, "--point", "abc"}, 2, {"--point: 'abc' is not a whole number from 0 on"});
  expect_run({"render", experiment, "--point", "-1"}, 2, {"--point: '-1' is not a whole number from 0 on"});
  for (const char* threads : {"0", "1025", "1.5", "99999999999999999999"})
    expect_run({"run", experiment, "--threads", threads}, 2,
               {std::string("--threads: '") + threads + "' is not a whole number from 1 to 1024"});
  for (const char* budget : {"0", "-1", "nan", "inf", "1x", ""})
    expect_run({"recommend", "plate", "--budget", budget}, 2, {"is not a number above 0"});
  expect_run({"--foo"}, 2, {"there is no option '--foo'"});
  expect_run({"--verson"}, 2, {"did you mean '--version'?"});
  EXPECT_EQ(run({}), 2);
  EXPECT_TRUE(says("subcommand") || says("verb")) << output_;
  EXPECT_EQ(run({"--version"}), 0);
  EXPECT_EQ(run({"-h"}), 0);
}

TEST_F(Messages, TheExperimentsFaultComesBeforeThatOfTheFolder) {
  write("file", "");
  write("x.toml", "scne = \"plate\"\n");
  for (const char* verb : {"run", "check"}) {
    EXPECT_EQ(run({verb, "x.toml", "--out", "file/below"}), 2);
    EXPECT_TRUE(says("did you mean 'scene'") && !says("folder")) << output_;
  }
  write("x.toml", one_point + held_bound);
  for (const char* verb : {"run", "check"})
    expect_run({verb, "x.toml", "--out", "file/below"}, 2, {"cannot make the folder file/below", "another --out"});
}

TEST_F(Messages, AModelInPlaceOfAnExperimentIsNamed) {
  write("model.gltf", "{}");
  for (const char* verb : {"run", "check"}) {
    expect_run({verb, "model.gltf"}, 2, {"is a model, not an experiment; noonmark init model.gltf"});
    expect_run({verb, "plate"}, 2, {"plate is a built-in scene, not an experiment"});
  }
}

TEST_F(Messages, VerbsOfOnePointTakeASceneByItsName) {
  for (const Words& verb :
       {Words{"render", "plate", "--out", "r"}, {"section", "plate", "--out", "s.svg"}, {"live", "plate"}}) {
    EXPECT_EQ(run(verb + Words{"--set", "view.width_px=32", "--set", "view.height_px=18"}), 0)
        << verb.front() << output_;
  }
  expect_run({"render", "plaet"}, 2, {"(did you mean "});
}

TEST_F(Messages, WhatCouldNotBeCheckedIsAllInTheLastLines) {
  fs::create_directories(folder_ / "exps/closed");
  write("exps/a.toml", one_point + held_bound);
  write("exps/b.toml", "scne = 1\n");
  ASSERT_EQ(chmod((folder_ / "exps/closed").c_str(), 0), 0);
  EXPECT_EQ(run({"check", "exps", "--out", "out"}, without_privileges), 3) << output_;
  EXPECT_TRUE(says("1 of 2 experiments and 1 folder could not be checked:\n  exps/closed\n  exps/b.toml\n")) << output_;
  fs::remove(folder_ / "exps/b.toml");
  EXPECT_EQ(run({"check", "exps", "--out", "out"}, without_privileges), 3) << output_;
  EXPECT_TRUE(says("1 folder could not be checked:\n  exps/closed\n")) << output_;
  chmod((folder_ / "exps/closed").c_str(), 0700);
}

TEST_F(Messages, AnUnjudgedRunHasItsTime) {
  const std::string before = [] {
    char text[32];
    const std::time_t now = std::time(nullptr);
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", std::gmtime(&now));
    return std::string(text);
  }();
  EXPECT_EQ(run({"check", "absent.toml", "--out", "out"}), 2);
  const std::string junit = text("out/junit.xml");
  const size_t at = junit.find("timestamp=\"");
  ASSERT_NE(at, std::string::npos);
  EXPECT_GE(junit.substr(at + 11, before.size()), before);
}

// Every point is checked before the first is measured, by run, by a dry run and by render. The message names the place
// in the file.
TEST_F(Messages, APointThatCannotBeIsNamedBeforeTheFirstIsMeasured) {
  write("x.toml", one_point +
                      "[sweep]\nlight.kind = [\"directional\", \"point\"]\nfilter.kind = [\"none\", \"box\"]\n" +
                      held_bound);
  for (const Words& how : {Words{"run", "x.toml", "--out", "out"},
                           {"run", "x.toml", "--out", "out", "--dry-run"},
                           {"check", "x.toml", "--out", "out"},
                           {"render", "x.toml", "--point", "3", "--out", "out"}}) {
    EXPECT_EQ(run(how), 2) << output_;
    EXPECT_TRUE(
        says("x.toml:8:15: point 3 (light.kind = point, filter.kind = box): filter.kind = box needs a flat map"))
        << output_;
    EXPECT_FALSE(fs::exists(folder_ / "out/results.sqlite") || fs::exists(folder_ / "out/report.html"));
  }
  // A mistake that can be found only with the volume of the scene.
  write("x.toml",
        one_point + "[[part]]\nname = \"a\"\n[[part]]\nname = \"b\"\n[part.sweep]\nmap.far_m = [1000, -1000]\n");
  expect_run({"run", "x.toml", "--out", "out"}, 2,
             {"x.toml:11:13: part 'b', point 2 (map.far_m = -1000): the map's near plane"});
  expect_run({"run", "x.toml", "--out", "out", "--set", "filter.kind=box", "--set", "filter.size=4"}, 2,
             {"--set filter.size=4: part 'a', point 0: filter.size = 4 is even"});
}

TEST_F(Messages, AReportSaysWhatIsWrongWithTheResults) {
  for (const char* folder : {"absent", "empty"}) {
    fs::create_directories(folder_ / "empty");
    for (const Words& words : {Words{"report", folder}, {"merge", folder}, {"merge", "joined", folder}}) {
      EXPECT_EQ(run(words), 2) << words[0];
      EXPECT_TRUE(says(std::string(folder) + ": there are no results here (no results.sqlite); give the folder"))
          << output_;
    }
  }
  const std::string experiment = write("x.toml", one_point);
  ASSERT_EQ(run({"run", experiment, "--out", "out"}), 0) << output_;
  const std::string whole = text("out/results.sqlite");
  const auto refused = [&](const std::string& why) {
    expect_run({"report", "out"}, 3, {why});
    EXPECT_FALSE(says("--out")) << "report has no such option: " << output_;
    EXPECT_TRUE(says("run the experiment into this folder again")) << output_;
  };
  write("out/results.sqlite", "no database, but as long as the head of one has to be");
  refused("file is not a database");
  write("out/results.sqlite", whole.substr(0, whole.size() / 2));
  refused("results.sqlite");
  write("out/results.sqlite", whole);
  sqlite::Database((folder_ / "out/results.sqlite").string(), sqlite::Database::Mode::existing)
      .execute("PRAGMA application_id = 1");
  refused("not one of Noonmark's results");
  // `run` has both options.
  expect_run({"run", experiment, "--out", "out"}, 3, {"choose another --out, or pass --overwrite"});
}

// A shell makes an empty path of a variable that is not set.
TEST_F(Messages, AnEmptyPathIsNamedAsSuch) {
  for (const char* verb : {"report", "run", "check", "render"}) {
    expect_run({verb, ""}, 2, {"the path is empty"});
    EXPECT_EQ(output_.find(": :"), std::string::npos) << output_;
    EXPECT_FALSE(fs::exists(folder_ / "out/render")) << "nothing was measured";
  }
}

TEST_F(Messages, AnExperimentOfAByteOrderMarkIsEmpty) {
  for (const char* said : {"\xef\xbb\xbf", "\xef\xbb\xbf\r\n# nothing\n"}) {
    write("x.toml", said);
    expect_run({"run", "x.toml", "--out", "out"}, 2, {"x.toml: is empty"});
  }
  write("x.toml", "\xef\xbb\xbf" + one_point);
  EXPECT_EQ(run({"run", "x.toml", "--out", "out"}), 0) << output_;
}

TEST_F(Messages, TheDoctorNamesWhatDecidesGeometry) {
  run({"doctor"});
  EXPECT_TRUE(says("Draco 1.") && says("meshoptimizer 0.")) << output_;
  EXPECT_FALSE(says(";\n")) << output_;
}

// A pasted command must work, whatever bytes a name holds.
TEST_F(Messages, ACommandToReproduceCanBePasted) {
  const std::string odd = "a\x1b[31m'\\\n\xff.toml";
  write(odd, one_point + "[sweep]\nmap.resolution = [16, 32]\n[[bound]]\nmetric = \"residual\"\nmax = -1\n");
  ASSERT_EQ(run({"check", odd, "--out", "out"}), 1) << output_;
  const size_t at = output_.find("noonmark render ");
  ASSERT_NE(at, std::string::npos) << output_;
  const std::string command = output_.substr(at + 9, output_.find('\n', at) - at - 9) + " --out again";
  const pid_t shell = fork();
  if (shell == 0) {
    if (chdir(folder_.c_str()) != 0) _exit(126);
    const std::string line = std::string(NOONMARK_PROGRAM) + " " + command + " > pasted.txt 2>&1";
    execlp("bash", "bash", "-c", line.c_str(), nullptr);
    _exit(127);
  }
  EXPECT_EQ(wait_for(shell), 0) << command << "\n" << text("pasted.txt");
  EXPECT_TRUE(fs::exists(folder_ / "again/point.json"));
  EXPECT_EQ(text("out/report.html").find('\x1b'), std::string::npos);
}

}  // namespace
}  // namespace noonmark::acceptance
