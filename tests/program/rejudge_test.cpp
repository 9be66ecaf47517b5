// A changed experiment keeps the stored points that it still has: what only judges measures nothing, and a new value
// measures its own points. What comes out is the same as that of a new run.
#include <fmt/format.h>

#include "compare/store/seals.h"
#include "compare/store/sqlite.h"
#include "compare/store/store.h"
#include "tests/program/fixture.h"
#include "tests/support/sample_results.h"

namespace noonmark::acceptance {
namespace {

std::string cubes(const std::string& resolutions, const std::string& more = "", const std::string& pictures = "none") {
  return fmt::format(
      "scene = \"cube-room\"\npictures = \"{}\"\n[view]\nwidth_px = 64\nheight_px = 36\n[sweep]\nmap.resolution = {}\n"
      "filter.kind = [\"none\", \"box\"]\n[[bound]]\nmetric = \"acne\"\nmax = 1\n{}",
      pictures, resolutions, more);
}

class Rejudge : public Program {
 protected:
  // Runs the experiment into `out`, and expects these numbers of points.
  void check(const std::string& toml, const std::string& out, int measured, int kept, int code = 0) {
    write("x.toml", toml);
    EXPECT_EQ(run({"check", "x.toml", "--out", out}), code) << output_;
    const std::string counts = fmt::format("{} point{} measured{}", measured, measured == 1 ? "" : "s",
                                           kept == 0 ? "" : fmt::format(", {} kept", kept));
    EXPECT_TRUE(says("; " + counts + "; the report is")) << counts << "\n" << output_;
  }
  // The numbers in the folder are those of a new run.
  void expect_as_new(const std::string& toml, const std::string& out) {
    write("x.toml", toml);
    EXPECT_NE(run({"check", "x.toml", "--out", "new", "--overwrite"}), 2) << output_;
    EXPECT_EQ(without_times(folder_ / out / "results.csv"), without_times(folder_ / "new/results.csv"));
  }
  Results load(const std::string& out) const {
    return ResultStore::open((folder_ / out / "results.sqlite").string()).load();
  }
};

TEST_F(Rejudge, BoundsLawsAndTheAnswerMeasureNothing) {
  check(cubes("[32, 64]"), "out", 4, 0);
  check(cubes("[32, 64]", "[[bound]]\nmetric = \"error\"\nmax = 0\n"), "out", 0, 4, 1);
  check(cubes("[32, 64]", "[[law]]\nname = \"x\"\nmeasured = \"acne\"\nat_most = 1\n"), "out", 0, 4);
  check(cubes("[32, 64]", "[answer]\ncost = \"map_bytes\"\n[plot]\nmetrics = [\"acne\"]\n"), "out", 0, 4);
}

TEST_F(Rejudge, BoundsOfTheCurveMeasureNothing) {
  check(cubes("[64, 128]"), "out", 4, 0);
  const std::vector<PointRecord> before = load("out").points;
  int changed = 0;
  for (const auto& [acne, panning] : {std::pair(0.05, 0.05), std::pair(0.0, 0.0), std::pair(0.0123, 0.004)}) {
    SCOPED_TRACE(acne);
    const std::string other =
        cubes("[64, 128]", fmt::format("[curve]\nacne_bound = {}\npeter_panning_bound = {}\n", acne, panning));
    check(other, "out", 0, 4);
    expect_as_new(other, "out");
    const std::vector<PointRecord> after = load("out").points, fresh = load("new").points;
    for (size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(after[i].curve->acne_bound, acne);
      EXPECT_EQ(after[i].curve->window_min_depth, fresh[i].curve->window_min_depth) << i;
      EXPECT_EQ(after[i].curve->window_max_depth, fresh[i].curve->window_max_depth) << i;
      changed += after[i].curve->window_min_depth != before[i].curve->window_min_depth;
    }
  }
  EXPECT_GT(changed, 0) << "no window depends on these bounds, so the test shows nothing";
  check(cubes("[64, 128]", "[curve]\nacne_bound = 0.5\n"), "large", 4, 0);
  check(cubes("[64, 128]", "[curve]\nacne_bound = 0.6\n"), "large", 4, 0);
}

// The window of a reduction was judged by the bounds with which it was measured.
TEST_F(Rejudge, OtherBoundsMeasureTheCurveOfAFilteredMapAgain) {
  const auto filtered = [](const std::string& curve) {
    return "scene = \"cube-room\"\n" + small_view +
           "[map]\nresolution = 64\n[lookup]\nkind = \"vsm\"\n[filter]\nkind = \"box\"\n" + held_bound + curve;
  };
  check(filtered(""), "out", 1, 0);
  check(filtered(""), "out", 0, 1);
  const std::string other = filtered("[curve]\nacne_bound = 0.25\npeter_panning_bound = 0.25\n");
  check(other, "out", 1, 0);
  expect_as_new(other, "out");
  EXPECT_EQ(load("out").points.at(0).lookup_bounds, (CauseBounds{0.25, 0.25}));
  check(filtered("[curve]\nenabled = false\n"), "out", 1, 0);
  EXPECT_TRUE(load("out").points.at(0).lookup_curve.empty());
  check(other, "out", 0, 1);  // it stayed in the store
  EXPECT_EQ(load("out").points.at(0).lookup_curve.size(), 100u);
}

TEST_F(Rejudge, BoundsOfTheCurveAtAllPlacementsMeasureNothing) {
  const auto placed = [](const std::string& curve) {
    return "scene = \"cube-room\"\n" + small_view + "[map]\nresolution = 64\nplacements = 3\n" + held_bound + curve;
  };
  check(placed(""), "out", 1, 0);
  const std::string other = placed("[curve]\nacne_bound = 0.03\npeter_panning_bound = 0.02\n");
  check(other, "out", 0, 1);
  expect_as_new(other, "out");
  const BiasCurve now = *load("out").points.at(0).curve, fresh = *load("new").points.at(0).curve;
  EXPECT_TRUE(now.window_min_worst_depth.has_value());
  EXPECT_EQ(now.window_min_worst_depth, fresh.window_min_worst_depth);
  EXPECT_EQ(now.window_max_worst_depth, fresh.window_max_worst_depth);
}

TEST_F(Rejudge, OtherValuesOfCurveOverMeasureAFilteredMapAgain) {
  const auto over = [](const std::string& values) {
    return "scene = \"cube-room\"\n" + small_view +
           "[map]\nresolution = 64\n[lookup]\nkind = \"vsm\"\n[filter]\nkind = \"box\"\n" + held_bound +
           (values.empty() ? "" : "[curve]\nover = \"lookup.v_min\"\nover_values = " + values + "\n");
  };
  check(over("[0, 1e-4]"), "out", 1, 0);
  EXPECT_EQ(load("out").points.at(0).over_curve.size(), 3u) << "and the value as set";
  check(over("[0, 1e-4]"), "out", 0, 1);
  check(over("[0, 1e-3]"), "out", 1, 0);
  expect_as_new(over("[0, 1e-3]"), "out");
  check(over(""), "out", 1, 0);
  EXPECT_TRUE(load("out").points.at(0).over_curve.empty());
}

TEST_F(Rejudge, ANewValueMeasuresItsOwnPoints) {
  check(cubes("[32, 64]", "", "all"), "out", 4, 0);
  const std::string wider = cubes("[48, 64, 32]", "", "all");
  check(wider, "out", 2, 4);
  EXPECT_FALSE(says("made again")) << "the pictures go with their points: " << output_;
  expect_as_new(wider, "out");
  for (const PointRecord& point : load("out").points) {
    EXPECT_GE(point.pictures.size(), 5u);
    for (const PictureRecord& picture : point.pictures) {
      EXPECT_TRUE(picture.path.starts_with(fmt::format("images/p{:04}-", point.id))) << picture.path;
      EXPECT_EQ(text("out/" + picture.path), text("new/" + picture.path)) << picture.path;
    }
  }
}

TEST_F(Rejudge, PointsThatAreGoneAreKeptForLater) {
  check(cubes("[32, 64, 128]", "", "first"), "out", 6, 0);
  check(cubes("[64]"), "out", 0, 2);
  EXPECT_TRUE(says("4 points that this experiment does not have stay in the store")) << output_;
  EXPECT_EQ(load("out").points.size(), 2u);
  expect_as_new(cubes("[64]"), "out");
  expect_run({"report", "out"}, 0, {"2 of 2 points"});
  check(cubes("[128, 64, 32]"), "out", 0, 6);
  expect_as_new(cubes("[128, 64, 32]"), "out");
}

// The everyday loop: a setting of one's own file is changed, the file is run again, and changed back.
TEST_F(Rejudge, AChangedSettingIsASetOfNewPoints) {
  const auto biased = [](const std::string& bias) {
    return cubes("[32, 64]", "[bias]\nconstant = " + bias + "\n", "first");
  };
  check(biased("0.001234"), "out", 4, 0);
  check(biased("0.004321"), "out", 4, 0);
  EXPECT_TRUE(says("4 points that this experiment does not have stay in the store for a later one")) << output_;
  expect_as_new(biased("0.004321"), "out");
  for (const char* file : {"out/report.html", "out/junit.xml", "out/summary.md", "out/images/p0000-truth.png"})
    EXPECT_TRUE(fs::exists(folder_ / file)) << file;
  const std::string report = text("out/report.html");
  EXPECT_EQ(report.find("0.001234"), std::string::npos) << "a bias of the points that were set aside";
  check(biased("0.001234"), "out", 0, 4);
  expect_as_new(biased("0.001234"), "out");
  // The points of the other bias are still there.
  check(cubes("[32, 64]", "[bias]\nconstant = 0.004321\n"), "out", 0, 4);
  for (const char* other : {"scene.name=plane", "view.width_px=63", "light.elevation_deg=40", "filter.kind=box"}) {
    SCOPED_TRACE(other);
    write("x.toml", one_point + held_bound);
    expect_run({"check", "x.toml", "--out", "set", "--set", other}, 0, {"; 1 point measured; the report is"});
  }
}

TEST_F(Rejudge, OnlyThePointsOfANewPartAreMeasured) {
  const auto parts = [](std::initializer_list<const char*> scenes) {
    std::string toml = small_view;
    for (const char* scene : scenes)
      toml += fmt::format("[[part]]\nname = \"{0}\"\nscene = \"{0}\"\n[[part.bound]]\nmetric = \"residual\"\nmax = 1\n",
                          scene);
    return toml;
  };
  check(parts({"plane", "wall"}), "out", 2, 0);
  check(parts({"plate", "wall", "plane"}), "out", 1, 2);
  expect_as_new(parts({"plate", "wall", "plane"}), "out");
}

// Edited rows that are sealed again show that the diagram was not measured again.
TEST_F(Rejudge, AnotherBoundOrPointKeepsThePhaseDiagram) {
  const auto phase = [](const std::string& resolutions, const std::string& more) {
    return cubes(resolutions, "[bias]\nunit = \"m\"\n[phase]\ntexel_sizes = 3\nplacements = 2\n" + more);
  };
  check(phase("[64, 128]", ""), "out", 4, 0);
  const double edited = 0.4321;
  {
    sqlite::Database db((folder_ / "out/results.sqlite").string(), sqlite::Database::Mode::existing);
    db.execute(fmt::format("UPDATE phase_rows SET last_acne_m = {}", edited));
    seal_phase(db, 0);
  }
  check(phase("[96, 64, 128]", "acne_bound = 0.02\n"), "out", 2, 4);
  const PhaseDiagram kept = load("out").phases.at(0);
  ASSERT_EQ(kept.rows.size(), 3u);
  EXPECT_EQ(kept.rows[0].last_acne_m, edited);
  EXPECT_EQ(kept.acne_bound, 0.02);
  EXPECT_EQ(kept.points.size(), 6u);
  // With the measured numbers it is that of a new run.
  expect_as_new(phase("[96, 64, 128]", "acne_bound = 0.02\n"), "out");
  PhaseDiagram fresh = load("new").phases.at(0);
  for (PhaseRow& row : fresh.rows) row.last_acne_m = edited;
  EXPECT_TRUE(same(kept, fresh));
}

TEST_F(Rejudge, ADeadSweepIsNamed) {
  write("x.toml", one_point + held_bound + "[sweep]\nfilter.size = [3, 5]\nmap.resolution = [16, 32]\n");
  const std::string dead =
      "warning: the sweep of filter.size is dead: no point reads it (with filter.kind = none), so its 2 "
      "values measure the same";
  for (const char* verb : {"run", "check"}) {
    expect_run({verb, "x.toml", "--dry-run"}, 0, {dead});
    expect_run({verb, "x.toml", "--out", "out"}, 0, {dead});
    EXPECT_FALSE(says("map.resolution is dead")) << output_;
  }
  for (const char* file : {"out/report.html", "out/summary.md"})
    EXPECT_NE(text(file).find("the sweep of filter.size is dead"), std::string::npos) << file;
  // One point that reads it is enough.
  write("x.toml", one_point + held_bound + "[sweep]\nfilter.size = [3, 5]\nfilter.kind = [\"none\", \"box\"]\n");
  EXPECT_EQ(run({"check", "x.toml", "--out", "live"}), 0) << output_;
  EXPECT_FALSE(says("is dead")) << output_;
}

}  // namespace
}  // namespace noonmark::acceptance
