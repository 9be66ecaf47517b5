// Nothing of an earlier run may be taken for a result of this run: edited scenes, verdicts, stored numbers, pictures.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "base/digest.h"
#include "compare/store/seals.h"
#include "compare/store/sqlite.h"
#include "compare/store/store.h"
#include "tests/program/fixture.h"
#include "tests/support/sample_results.h"

namespace noonmark::acceptance {
namespace {

class Stale : public Program {
 protected:
  bool there(const std::string& file) const { return fs::exists(folder_ / file); }
  std::string good() { return write("x.toml", one_point + held_bound); }
  // As if another build of the program had measured the points in `out`, or as if this one had again.
  void of_another_program(bool another) const {
    sqlite::Database((folder_ / "out/results.sqlite").string(), sqlite::Database::Mode::existing)
        .execute(another ? "UPDATE info SET value = replace(value, 'program = ', 'program = other ')"
                         : "UPDATE info SET value = replace(value, 'program = other ', 'program = ')");
  }
};

// A floor and a spot light above it with the given cone, in radians.
std::string lit_floor(const std::string& cone) {
  const std::string down = R"("rotation": [-0.70710678118654757, 0, 0, 0.70710678118654757])";
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
"extensionsUsed": ["KHR_lights_punctual"],
"extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {"outerConeAngle": )" +
         cone + R"(}}]}},
"cameras": [{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.5, "zfar": 40}}],
"nodes": [{"mesh": 0, )" +
         down + R"(, "scale": [8, 8, 1], "translation": [-4, 0, 4]},
 {"camera": 0, )" +
         down + R"(, "translation": [0, 6, 0]},
 {"extensions": {"KHR_lights_punctual": {"light": 0}}, )" +
         down +
         R"(, "translation": [0, 4, 0]}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
 {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
"buffers": [{"byteLength": 60, "uri": "data:application/octet-stream;base64,)"
         "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAAAAAAAAAAgD8AAAAAAAABAAIAAAACAAMA\"}]}";
}

TEST_F(Stale, AnEditedSpotConeIsAnotherScene) {
  write("floor.gltf", lit_floor("0.6"));
  const std::string experiment =
      write("x.toml", "scene = \"floor.gltf\"\n" + small_view + "[phase]\ntexel_sizes = 2\nplacements = 1\n");
  const auto diagram = [&](const std::string& out) {
    return ResultStore::open((folder_ / out / "results.sqlite").string()).load().phases.at(0);
  };
  ASSERT_EQ(run({"run", experiment, "--out", "out"}), 0) << output_;
  const std::string csv = without_times(folder_ / "out/results.csv");
  const PhaseDiagram whole = diagram("out");
  ASSERT_EQ(whole.refused, "");
  write("floor.gltf", lit_floor("0.3"));
  expect_run({"run", experiment, "--out", "out"}, 0,
             {"floor.gltf have changed since its points were stored, so they are measured again",
              "1 point measured; the report", "1 point that this experiment does not have stays"});
  const std::string edited = without_times(folder_ / "out/results.csv");
  EXPECT_NE(edited, csv);
  ASSERT_EQ(run({"run", experiment, "--out", "new"}), 0) << output_;
  EXPECT_EQ(without_times(folder_ / "new/results.csv"), edited) << "as in a folder of its own";
  EXPECT_TRUE(same(diagram("out"), diagram("new")) && !same(diagram("out"), whole)) << "also the phase diagram";
  write("floor.gltf", "\n" + lit_floor("0.3") + "\n");  // the same scene in other bytes
  EXPECT_EQ(run({"run", experiment, "--out", "out"}), 0) << output_;
  EXPECT_TRUE(says("1 of 1 point is in out already") && !says("have changed")) << output_;
  write("floor.gltf", lit_floor("0.6"));  // back
  expect_run({"run", experiment, "--out", "out"}, 0, {"1 of 1 point is in out already", "0 points measured, 1 kept"});
  EXPECT_EQ(without_times(folder_ / "out/results.csv"), csv);
}

TEST_F(Stale, TheVerdictOfAnEarlierRunDoesNotOutliveARunThatFails) {
  const std::string experiment = good();
  const auto held = [&] {
    ASSERT_EQ(run({"check", experiment, "--out", "out", "--overwrite"}), 0) << output_;
    ASSERT_NE(text("out/summary.md").find("Held"), std::string::npos);
  };
  const auto verdict_says = [&](const std::string& why) {
    EXPECT_NE(text("out/junit.xml").find("errors=\"1\""), std::string::npos);
    EXPECT_NE(text("out/junit.xml").find(why), std::string::npos) << text("out/junit.xml");
    EXPECT_NE(text("out/summary.md").find("Not judged"), std::string::npos);
    EXPECT_EQ(text("out/summary.md").find("Held"), std::string::npos);
  };
  held();
  write("x.toml", "scene = \n");
  EXPECT_EQ(run({"check", experiment, "--out", "out"}), 2);
  verdict_says("x.toml:1");

  good();
  held();
  fs::remove(folder_ / "x.toml");
  EXPECT_EQ(run({"check", experiment, "--out", "out"}), 2);
  verdict_says("cannot be read");

  good();
  held();
  EXPECT_EQ(run({"check", experiment, "--out", "out", "--set", "scene.name=absent.glb", "--overwrite"}), 3);
  verdict_says("absent.glb");

  good();
  held();
  of_another_program(true);
  EXPECT_EQ(run({"check", experiment, "--out", "out"}), 2);
  verdict_says("measured by another program");

  good();
  held();
  of_another_program(true);
  EXPECT_EQ(run({"run", experiment, "--out", "out"}), 2);
  EXPECT_FALSE(there("out/junit.xml") || there("out/summary.md")) << "`run` must remove the old verdict";

  held();
  write("x.toml", "scene = \n");
  EXPECT_EQ(run({"run", experiment, "--out", "out"}), 2);
  EXPECT_FALSE(there("out/junit.xml") || there("out/summary.md"));
}

// The folder is known although the command line is wrong.
TEST_F(Stale, TheVerdictOfAnEarlierRunDoesNotOutliveAWrongCommandLine) {
  const std::string experiment = good();
  const auto file_held = [&](const std::string& file, const std::string& folder) {
    ASSERT_EQ(run({"check", file, "--out", folder, "--overwrite"}), 0) << output_;
    ASSERT_NE(text(folder + "/summary.md").find("Held"), std::string::npos);
  };
  const auto held = [&](const std::string& folder) { file_held(experiment, folder); };
  const auto not_judged = [&](const std::string& folder, const std::string& why) {
    EXPECT_NE(text(folder + "/junit.xml").find("errors=\"1\""), std::string::npos);
    EXPECT_NE(text(folder + "/junit.xml").find(why), std::string::npos) << text(folder + "/junit.xml");
    EXPECT_NE(text(folder + "/summary.md").find("Not judged"), std::string::npos);
  };
  for (const auto& [words, why] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"check", experiment, "--threads", "0", "--out", "out"}, "--threads"},
           {{"check", experiment, "--threads", "many", "--out=out"}, "--threads"},
           {{"check", "--out", "out", experiment, "--foo"}, "--foo"},
           {{"check", "--foo", "7", "--out", "out", "--", experiment}, "no option"},
           {{"check", experiment, "--out", "out", "--set"}, "--set"},
           {{"check", experiment, "--out", "other", "--out", "out"}, "--out"},
           {{"check", "--out", "out"}, "experiments"},
           {{"--foo", "check", experiment, "--out", "out"}, "--foo"},
           {{"chek", experiment, "--out", "out"}, "chek"}}) {
    SCOPED_TRACE(why);
    held("out");
    expect_run(words, 2, {why});
    not_judged("out", why);
    EXPECT_FALSE(there("other")) << "a wrong command line must not make a folder";
  }

  held("out/x");  // the default folder without --out
  EXPECT_EQ(run({"check", experiment, "--threads", "0"}), 2);
  not_judged("out/x", "--threads");
  held("all/x");
  write("y.toml", "");
  EXPECT_EQ(run({"check", experiment, "y.toml", "--foo", "--out", "all"}), 2);
  not_judged("all/x", "--foo");
  held("all/x");
  EXPECT_EQ(run({"check", experiment, experiment, "--out", "all"}), 2) << "the two would share one folder";
  not_judged("all/x", "share");
  fs::create_directories(folder_ / "exps/sub");
  fs::copy_file(experiment, folder_ / "exps/sub/x.toml");
  file_held("exps/sub/x.toml", "all/sub/x");
  write("exps/y.toml", "");
  EXPECT_EQ(run({"check", "exps", "--foo", "--out", "all"}), 2);
  not_judged("all/sub/x", "--foo");

  held("out");
  EXPECT_EQ(run({"run", experiment, "--out", "out", "--foo"}), 2);
  EXPECT_FALSE(there("out/junit.xml") || there("out/summary.md")) << "`run` must remove the old verdict";
  held("out");
  EXPECT_EQ(run({"render", experiment, "--out", "out", "--foo"}), 2);
  EXPECT_EQ(run({"check", "--help", "--out", "out"}), 0);
  EXPECT_TRUE(there("out/junit.xml")) << "neither of the two measures into this folder";
}

// If the run ends before it changes the store, the files are still the report of the store.
TEST_F(Stale, AReportStaysBesideTheResultsThatItShows) {
  const std::string experiment = good();
  ASSERT_EQ(run({"run", experiment, "--out", "out"}), 0) << output_;
  const std::string csv = text("out/results.csv"), report = text("out/report.html");
  const auto unchanged = [&] { return text("out/results.csv") == csv && text("out/report.html") == report; };
  of_another_program(true);
  expect_run({"run", experiment, "--out", "out", "--set", "map.resolution=64"}, 2,
             {"measured by another program or on another machine (now 'program", "--overwrite"});
  EXPECT_TRUE(unchanged());
  EXPECT_EQ(run({"run", "absent.toml", "--out", "out"}), 2);
  EXPECT_TRUE(unchanged());
  of_another_program(false);
  ASSERT_EQ(run({"report", "out"}), 0) << output_;
  EXPECT_TRUE(unchanged()) << "report makes the same files";
}

// Other bounds do not prevent a resume, so the old report would show the verdict of the old bounds.
TEST_F(Stale, AReportWithAnEarlierVerdictDoesNotOutliveARunThatFails) {
  const std::string experiment = good();
  ASSERT_EQ(run({"check", experiment, "--out", "out"}), 0) << output_;
  write("x.toml", one_point + "[[bound]]\nmetric = \"residual\"\nmax = -1\n");
  fs::remove(folder_ / "out/results.csv");
  fs::create_directories(folder_ / "out/results.csv/in the way");
  EXPECT_EQ(run({"check", experiment, "--out", "out"}), 3) << output_;
  EXPECT_FALSE(there("out/report.html"));
}

TEST_F(Stale, TheVerdictOfAnEarlierRunDoesNotOutliveAKill) {
  ASSERT_EQ(run({"check", good(), "--out", "out"}), 0) << output_;
  ASSERT_TRUE(there("out/junit.xml"));
  const std::string longer =
      write("x.toml", one_point + "[sweep]\nmap.shift_u_texels = {min = 0, max = 1, steps = 500}\n" + held_bound);
  const pid_t child = start_until("[1/500]", {"check", longer, "--out", "out", "--overwrite"});
  kill(child, SIGKILL);
  ASSERT_EQ(wait_for(child), -SIGKILL);
  EXPECT_FALSE(there("out/junit.xml") || there("out/summary.md") || there("out/report.html") ||
               there("out/results.csv"));
}

TEST_F(Stale, AFolderIsCheckedToItsEnd) {
  fs::create_directories(folder_ / "exps/sub");
  write("exps/a.toml", one_point + held_bound);
  write("exps/b.toml", "scne = \"plate\"\n");
  write("exps/c.toml", "scene = \"absent.glb\"\n" + small_view + held_bound);
  write("exps/sub/d.toml", one_point + "[[bound]]\nmetric = \"residual\"\nmax = -1\n");
  write("exps/sub/e.toml", one_point);  // has no bounds
  EXPECT_EQ(run({"check", "exps", "--out", "out"}), 3) << "the worst of 0, 2, 3, 1 and 2: " << output_;
  EXPECT_TRUE(says("did you mean 'scene'") && says("absent.glb") && says("has no [[bound]]")) << output_;
  EXPECT_TRUE(says("3 of 5 experiments could not be checked")) << output_;
  EXPECT_NE(text("out/a/summary.md").find("Held"), std::string::npos);
  EXPECT_NE(text("out/b/junit.xml").find("did you mean"), std::string::npos);
  EXPECT_NE(text("out/c/junit.xml").find("exit code 3"), std::string::npos);
  EXPECT_NE(text("out/sub/d/junit.xml").find("<failure"), std::string::npos)
      << "experiments after a bad file must be checked";
  EXPECT_NE(text("out/sub/e/summary.md").find("Not judged"), std::string::npos);
}

TEST_F(Stale, APipeInAFolderIsSaidAndTheRestIsChecked) {
  fs::create_directories(folder_ / "exps");
  write("exps/b.toml", one_point + held_bound);
  ASSERT_EQ(mkfifo((folder_ / "exps/a.toml").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", folder_ / "exps/c.toml");
  EXPECT_EQ(run({"check", "exps", "--out", "out"}, [] { alarm(60); }), 2) << output_;
  for (const char* name : {"a", "c"}) {
    EXPECT_TRUE(says(std::string("exps/") + name + ".toml: is not a regular file")) << output_;
    EXPECT_NE(text(std::string("out/") + name + "/junit.xml").find("not a regular file"), std::string::npos);
  }
  EXPECT_NE(text("out/b/summary.md").find("Held"), std::string::npos);
}

// A report beside no store, or beside another one, must not pass for this run's.
TEST_F(Stale, AFolderThatIsRenamedDuringACheckIsSaid) {
  const std::string sweep = "[sweep]\nbias.constant = {min = 0.001, max = 0.01, steps = 40}\n" + held_bound;
  for (const std::string pictures : {"none", "first", "worst"}) {
    SCOPED_TRACE(pictures);
    const std::string experiment =
        write("x.toml",
              "pictures = \"" + pictures + "\"\nscene = \"plate\"\n[view]\nwidth_px = 48\nheight_px = 27\n" + sweep);
    fs::remove_all(folder_ / "moved");
    const pid_t child = start_until("[2/40]", {"check", experiment, "--out", "out"});
    kill(child, SIGSTOP);
    fs::rename(folder_ / "out", folder_ / "moved");
    if (pictures == "worst") fs::create_directories(folder_ / "out");  // as by another program
    kill(child, SIGCONT);
    EXPECT_EQ(wait_for(child), 3);
    EXPECT_TRUE(there("moved/results.sqlite"));
    EXPECT_FALSE(there("out/results.sqlite") || there("out/report.html")) << "there is no store of its numbers";
    // The folder back in its place, the run continues.
    fs::remove_all(folder_ / "out");
    fs::rename(folder_ / "moved", folder_ / "out");
    expect_run({"check", experiment, "--out", "out"}, 0, {" points are in out already"});
    fs::remove_all(folder_ / "out");
  }
}

TEST_F(Stale, StoredNumbersThatWereEditedAreMeasuredAnew) {
  const std::string experiment = write("x.toml", one_point + "[sweep]\nmap.resolution = [16, 32]\n" + held_bound);
  ASSERT_EQ(run({"check", experiment, "--out", "out"}), 0) << output_;
  const std::string csv = without_times(folder_ / "out/results.csv");
  const auto edit = [&](const char* sql) {
    sqlite::Database((folder_ / "out/results.sqlite").string(), sqlite::Database::Mode::existing).execute(sql);
  };
  for (const char* sql :
       {"UPDATE metrics SET value = 0.5 WHERE point = 1 AND name = 'residual'",
        "DELETE FROM metrics WHERE point = 1 AND name = 'error'", "INSERT INTO metrics VALUES (7, 'residual', 3)"}) {
    SCOPED_TRACE(sql);
    edit(sql);
    expect_run({"report", "out"}, 3, {"are not those that were stored"});
    expect_run({"check", experiment, "--out", "out"}, 0,
               {std::string(sql).find("VALUES (7") != std::string::npos ? "point 7, which this experiment does not "
                                                                          "have; they are dropped"
                                                                        : "it is measured anew"});
    EXPECT_EQ(without_times(folder_ / "out/results.csv"), csv);
  }
}

// A user who can edit rows can also seal them again. So the sweep must check that the numbers it reads exist.
TEST_F(Stale, AStoredPointThatLacksNumbersIsMeasuredAnew) {
  const std::string experiment = write("x.toml", one_point + "[sweep]\nmap.resolution = [16, 32]\n" + held_bound);
  ASSERT_EQ(run({"check", experiment, "--out", "out"}), 0) << output_;
  const std::string csv = without_times(folder_ / "out/results.csv");
  for (const char* lost : {"residual", "facing", "error"}) {
    SCOPED_TRACE(lost);
    {
      sqlite::Database db((folder_ / "out/results.sqlite").string(), sqlite::Database::Mode::existing);
      db.execute(std::string("DELETE FROM metrics WHERE point = 1 AND name = '") + lost + "'");
      seal_point(db, 1);
    }
    expect_run({"check", experiment, "--out", "out"}, 0, {"it is measured anew"});
    EXPECT_EQ(without_times(folder_ / "out/results.csv"), csv);
  }
}

TEST_F(Stale, ResultsOfAnotherProgramDriverOrMachineAreNotGoneOnWith) {
  const std::string experiment = good();
  ASSERT_EQ(run({"run", experiment, "--out", "out"}), 0) << output_;
  for (const char* fact : {"noonmark", "program", "opengl", "embree", "machine"}) {
    const std::string line = std::string(fact) + " = ";
    sqlite::Database((folder_ / "out/results.sqlite").string(), sqlite::Database::Mode::existing)
        .execute("UPDATE info SET value = replace(value, '" + line + "', '" + line +
                 "other ') WHERE key = 'fingerprint'");
    expect_run({"run", experiment, "--out", "out"}, 2, {"now '" + line, "there '" + line + "other "});
    sqlite::Database((folder_ / "out/results.sqlite").string(), sqlite::Database::Mode::existing)
        .execute("UPDATE info SET value = replace(value, 'other ', '') WHERE key = 'fingerprint'");
  }
}

TEST_F(Stale, TheReportReadsItsOwnPicturesOnly) {
  const std::string experiment =
      write("x.toml", "scene = \"plate\"\npictures = \"first\"\n[view]\nwidth_px = 48\nheight_px = 27\n");
  ASSERT_EQ(run({"run", experiment, "--out", "out"}), 0) << output_;
  write("secret.png", "SECRET-BYTES");
  const std::string encoded = "U0VDUkVULUJZVEVT";  // base64 of these bytes
  ResultStore store = ResultStore::open((folder_ / "out/results.sqlite").string());
  fs::create_symlink("../../secret.png", folder_ / "out/images/link.png");
  fs::create_symlink("/dev/zero", folder_ / "out/images/zero.png");
  ASSERT_EQ(mkfifo((folder_ / "out/images/fifo.png").c_str(), 0600), 0);
  const std::string secret = digest_of("SECRET-BYTES"), own = digest_of(text("out/images/p0000-truth.png"));
  store.set_pictures(0, {{{"a", "images/link.png", "", secret},
                          {"b", "../secret.png", "", secret},
                          {"c", (folder_ / "secret.png").string(), "", secret},
                          {"d", "images/zero.png", "", ""},
                          {"e", "images/fifo.png", "", ""},
                          {"f", "images/p0000-truth.png", "", own}},
                         {}});
  ASSERT_EQ(run({"report", "out"}, [] { alarm(60); }), 0) << "the report must not wait for a pipe: " << output_;
  const std::string report = text("out/report.html");
  EXPECT_EQ(report.find(encoded), std::string::npos);
  size_t missing = 0;
  for (size_t at = 0; (at = report.find("class=\"missing\"", at)) != std::string::npos; ++at) ++missing;
  EXPECT_EQ(missing, 5u);
  EXPECT_NE(report.find("data:image/png;base64,"), std::string::npos) << "its own pictures must be shown";
}

TEST_F(Stale, PicturesThatAreLostOrAnothersAreMadeAgain) {
  for (const char* which : {"first", "extremes", "all"}) {
    SCOPED_TRACE(which);
    const std::string experiment = write(
        "x.toml", "scene = \"plate\"\npictures = \"" + std::string(which) +
                      "\"\nexr = true\n[view]\nwidth_px = 48\nheight_px = 27\n[sweep]\nmap.resolution = [16, 32]\n");
    ASSERT_EQ(run({"run", experiment, "--out", "out", "--overwrite"}), 0) << output_;
    const std::string report = text("out/report.html");
    std::vector<std::string> files;
    for (const auto& entry : fs::directory_iterator(folder_ / "out/images"))
      files.push_back(entry.path().filename().string());
    ASSERT_GE(files.size(), 11u);
    const std::string first =
        std::string("out/images/p000") + (fs::exists(folder_ / "out/images/p0000-map.exr") ? "0" : "1");
    for (const auto& [file, damage] : std::vector<std::pair<std::string, std::string>>{
             {"-truth.png", "lost"}, {"-ladder.exr", "lost"}, {"-map.png", "edited"}, {"-map.exr", "edited"}}) {
      SCOPED_TRACE(file);
      const std::string bytes = text(first + file);
      fs::remove(folder_ / (first + file));
      if (damage == "edited") write(first + file, bytes + " ");
      expect_run({"run", experiment, "--out", "out"}, 0,
                 {"pictures of point ", "made again", "2 of 2 points are in out already"});
      ASSERT_TRUE(there(first + file));
      EXPECT_TRUE(text(first + file) == bytes);
    }
    EXPECT_EQ(run({"run", experiment, "--out", "out"}), 0);
    EXPECT_FALSE(says("made again")) << output_;
  }
}

// OpenEXR files are large, so a run writes them only where the experiment asks.
TEST_F(Stale, NumbersBehindPicturesAreWrittenWhereTheyAreAskedFor) {
  const auto experiment = [&](const std::string& key, double most) {
    return write("x.toml", key + "scene = \"plate\"\npictures = \"all\"\n[view]\nwidth_px = 48\nheight_px = 27\n" +
                               "[sweep]\nmap.resolution = [16, 32]\n[[bound]]\nmetric = \"error\"\nmax = " +
                               std::to_string(most) + "\nwhere = {\"map.resolution\" = 16}\n");
  };
  const auto exr = [&] {
    std::set<std::string> files;
    for (const auto& entry : fs::directory_iterator(folder_ / "out/images"))
      if (entry.path().extension() == ".exr") files.insert(entry.path().filename().string());
    return files;
  };
  const std::set<std::string> none;
  const std::set<std::string> both = {"p0000-ladder.exr", "p0000-map.exr", "p0001-ladder.exr", "p0001-map.exr"};
  ASSERT_EQ(run({"check", experiment("", 1), "--out", "out"}), 0) << output_;
  EXPECT_EQ(exr(), none);
  ASSERT_EQ(run({"check", experiment("", 1e-9), "--out", "out"}), 1) << output_;
  EXPECT_EQ(exr(), none);
  ASSERT_EQ(run({"run", experiment("exr = true\n", 1), "--out", "out"}), 0) << output_;
  EXPECT_EQ(exr(), both);
  ASSERT_EQ(run({"check", experiment("exr = true\n", 1), "--out", "new"}), 0) << output_;
  EXPECT_TRUE(there("new/images/p0001-ladder.exr"));
}

TEST_F(Stale, TheAnimationOfAMotionIsOfItsWorstInstant) {
  const std::string frames = "[motion]\nmove_m = [-0.013, 0.003, -0.011]\nturn_deg = [0.05, 0.31, 0.02]\n";
  const std::string view = "scene = \"cube-room\"\npictures = \"worst\"\n[view]\nwidth_px = 64\nheight_px = 36\n";
  const auto run_of = [&](int last, int resolution) {
    const std::string motion =
        view + "[map]\nfit = \"view\"\nresolution = " + std::to_string(resolution) + "\n" + frames +
        "[curve]\nenabled = false\n[over]\nmotion.frame = {min = 0, max = " + std::to_string(last) +
        ", steps = " + std::to_string(last + 1) + "}\n";
    return run({"run", write("x.toml", motion), "--out", "out"});
  };
  const auto animations = [&] {
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator(folder_ / "out/images"))
      if (entry.path().string().ends_with("-motion.png"))
        found.push_back("out/images/" + entry.path().filename().string());
    return found;
  };
  ASSERT_EQ(run_of(3, 64), 0) << output_;
  ASSERT_EQ(animations().size(), 1u);
  const std::string file = animations()[0], four = text(file);
  EXPECT_NE(four.find(std::string("acTL\0\0\0\4", 8)), std::string::npos) << "four frames";
  EXPECT_NE(text("out/report.html").find("data-name=\"motion\""), std::string::npos);
  ASSERT_EQ(run_of(3, 64), 0);
  EXPECT_FALSE(says("made again")) << output_;
  fs::remove(folder_ / file);
  ASSERT_EQ(run_of(3, 64), 0);
  EXPECT_TRUE(says("made again") && text(file) == four) << output_;
  // Two frames need no animation: the picture "flicker" shows both.
  ASSERT_EQ(run_of(1, 32), 0) << output_;
  EXPECT_TRUE(animations().empty());
}

TEST_F(Stale, OnlyAPictureThatWasWrittenIsShown) {
  const std::string experiment =
      write("x.toml", "scene = \"plate\"\npictures = \"first\"\n[view]\nwidth_px = 48\nheight_px = 27\n");
  ASSERT_EQ(run({"run", experiment, "--out", "out"}), 0) << output_;
  const std::string secret = "SECRET-BYTES", picture = text("out/images/p0000-truth.png");
  write("secret", secret);
  const auto replace = [&](const std::string& file, const std::string& by) {
    fs::remove(folder_ / "out/images" / file);
    fs::create_hard_link(folder_ / by, folder_ / "out/images" / file);
  };
  replace("p0000-truth.png", "secret");
  replace("p0000-map.png", "out/images/p0000-classes.png");  // a valid picture, but another one
  ASSERT_EQ(run({"report", "out"}), 0) << output_;
  const std::string report = text("out/report.html");
  EXPECT_EQ(report.find("U0VDUkVULUJZVEVT"), std::string::npos);
  EXPECT_NE(report.find("images/p0000-truth.png is not shown"), std::string::npos);
  EXPECT_NE(report.find("images/p0000-map.png is not shown"), std::string::npos);
  // The same if the store was edited so that it names this file.
  ResultStore::open((folder_ / "out/results.sqlite").string())
      .set_pictures(0, {{{"truth", "images/p0000-truth.png", "", digest_of(secret)}}, {}});
  ASSERT_EQ(run({"report", "out"}), 0) << output_;
  EXPECT_EQ(text("out/report.html").find("U0VDUkVULUJZVEVT"), std::string::npos);
}

}  // namespace
}  // namespace noonmark::acceptance
