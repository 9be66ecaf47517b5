// The phase diagrams of a sweep ([phase]): what is stored and shown of them, and that a run which was stopped loses none.
#include <fmt/format.h>
#include <signal.h>

#include <algorithm>

#include "compare/store/store.h"
#include "tests/program/fixture.h"
#include "tests/support/sample_results.h"

namespace noonmark::acceptance {
namespace {

const std::string swept_phase = R"(
scene = "cube-room"
pictures = "none"
[view]
width_px = 96
height_px = 54
[bias]
unit = "m"
[phase]
texel_sizes = 3
placements = 2
width_px = 80
[sweep]
map.resolution = [128, 256]
map.extent_m = [20, 40]
bias.constant = [0.02, 0.05]
filter.kind = ["none", "box"]
)";

class Phase : public Program {
 protected:
  std::vector<PhaseDiagram> phases(const std::string& out) const {
    return ResultStore::open((folder_ / out / "results.sqlite").string()).load().phases;
  }
  std::string report(const std::string& out) const { return read_file((folder_ / out / "report.html").string()); }
};

TEST_F(Phase, ASweepStoresItsDiagramOnceWithItsPoints) {
  write("x.toml", swept_phase);
  ASSERT_EQ(run({"run", "x.toml", "--out", "one", "--threads", "1"}), 0) << output_;
  const std::vector<PhaseDiagram> one = phases("one");
  ASSERT_EQ(one.size(), 1u);
  const PhaseDiagram& d = one[0];
  EXPECT_EQ(d.rows.size(), 3u);
  EXPECT_EQ(d.width_px, 80);
  EXPECT_EQ(d.height_px, 45);
  EXPECT_NE(d.render.find("map.extent_m=40"), std::string::npos) << "the largest extent: " << d.render;
  ASSERT_EQ(d.points.size(), 16u);
  for (const PhasePoint& point : d.points) {
    const auto id = static_cast<size_t>(point.point);  // the last swept setting changes fastest
    if (id % 2 == 1) {
      EXPECT_EQ(point.left_out, "filter.kind = box");
      continue;
    }
    EXPECT_EQ(point.left_out, "");
    EXPECT_NEAR(point.bias_m, id / 2 % 2 ? 0.05 : 0.02, 1e-9);
    EXPECT_NEAR(point.texel_m, (id / 4 % 2 ? 40.0 : 20.0) / (id / 8 ? 256 : 128), 1e-9);
    EXPECT_LE(point.texel_m, d.rows.front().texel_m * (1 + 1e-9));
    EXPECT_GE(point.texel_m, d.rows.back().texel_m * (1 - 1e-9));
  }
  const std::string page = report("one");
  EXPECT_LT(page.find("id=\"chart-phase\""), page.find("<section id=\"answer\""));
  EXPECT_NE(page.find("8 of the 16 points of this sweep are on the diagram"), std::string::npos);
  EXPECT_NE(page.find("8 with filter.kind = box"), std::string::npos);

  ASSERT_EQ(run({"run", "x.toml", "--out", "two", "--threads", "2"}), 0) << output_;
  EXPECT_TRUE(same(phases("two").at(0), d)) << "no result depends on the number of threads";
  ASSERT_EQ(run({"report", "one"}), 0) << output_;
  EXPECT_EQ(report("one"), page) << "the store alone gives the page";
}

TEST_F(Phase, AKillLosesAndDoublesNoDiagram) {
  write("x.toml", swept_phase);
  ASSERT_EQ(run({"run", "x.toml", "--out", "whole"}), 0) << output_;
  const PhaseDiagram whole = phases("whole").at(0);
  for (const char* when : {"the phase diagram", "[1/16]"}) {
    SCOPED_TRACE(when);
    const std::string out = *when == '[' ? "after" : "during";
    const pid_t child = start_until(when, {"run", "x.toml", "--out", out});
    kill(child, SIGKILL);
    ASSERT_EQ(wait_for(child), -SIGKILL) << "the run ended before it was killed";
    ASSERT_EQ(run({"run", "x.toml", "--out", out}), 0) << output_;
    EXPECT_EQ(says("the phase diagram"), *when != '[')
        << "it is made again only if it is not in the store: " << output_;
    ASSERT_EQ(phases(out).size(), 1u);
    EXPECT_TRUE(same(phases(out)[0], whole));
  }

  // Another [phase] makes the diagram anew, and no point.
  std::string other = swept_phase;
  other.replace(other.find("texel_sizes = 3"), 15, "texel_sizes = 4");
  write("x.toml", other);
  expect_run({"run", "x.toml", "--out", "whole"}, 0, {"16 of 16 points are in whole already", "the phase diagram"});
  EXPECT_EQ(phases("whole").at(0).rows.size(), 4u);
  write("x.toml", other + "[phase]\nenabled = false\n");
  EXPECT_EQ(run({"run", "x.toml", "--out", "whole"}), 2) << "a table that stands twice";
  other.replace(other.find("texel_sizes = 4"), 15, "enabled = false");
  write("x.toml", other);
  ASSERT_EQ(run({"run", "x.toml", "--out", "whole"}), 0) << output_;
  EXPECT_TRUE(phases("whole").empty());
  EXPECT_EQ(report("whole").find("id=\"chart-phase\""), std::string::npos);
}

// A constant bias lies on the diagram whatever unit it is written in.
TEST_F(Phase, BiasesOfEveryUnitAreInMetres) {
  std::string parts =
      "pictures = \"none\"\n[view]\nwidth_px = 64\nheight_px = 36\n[map]\nresolution = 200\nextent_m = "
      "20\n[phase]\ntexel_sizes = 2\nplacements = 1\n";
  for (const char* unit : {"m", "texel", "depth"})
    parts += fmt::format("[[part]]\nname = \"{0}\"\n[part.bias]\nunit = \"{0}\"\nconstant = 0.25\n", unit);
  write("x.toml", parts);
  ASSERT_EQ(run({"run", "x.toml", "--out", "out"}), 0) << output_;
  const std::vector<PhaseDiagram> all = phases("out");
  ASSERT_EQ(all.size(), 3u);
  EXPECT_NEAR(all[0].points.at(0).bias_m, 0.25, 1e-9);
  EXPECT_NEAR(all[1].points.at(0).bias_m, 0.25 * 20 / 200, 1e-9);
  EXPECT_NEAR(all[2].points.at(0).bias_m, 0.25 * all[2].range_m, 1e-6);
}

// What can have no diagram says why, and its points are measured all the same.
TEST_F(Phase, APartThatCanHaveNoneSaysWhy) {
  write("x.toml", small_view + R"(
[phase]
texel_sizes = 2
placements = 1
[[part]]
name = "lamp"
scene = "point-room"
[[part]]
name = "slope"
bias.slope = 0.01
[[part]]
name = "wall"
[part.sweep]
bias.slope = [0.01, 0]
[[part]]
name = "quiet"
phase.enabled = false
)");
  expect_run({"run", "x.toml", "--out", "out"}, 0, {"5 points measured"});
  const std::vector<PhaseDiagram> all = phases("out");
  ASSERT_EQ(all.size(), 3u);
  EXPECT_NE(all[0].refused.find("a point light's cube"), std::string::npos) << all[0].refused;
  EXPECT_NE(all[1].refused.find("bias.unit = m"), std::string::npos) << all[1].refused;
  EXPECT_EQ(all[2].refused, "");
  ASSERT_EQ(all[2].points.size(), 2u);
  EXPECT_EQ(all[2].points[0].left_out, "bias.slope = 0.01") << "the first point that can have a diagram is the second";
  EXPECT_EQ(all[2].points[1].left_out, "");
  const std::string page = report("out");
  EXPECT_NE(page.find("There is no phase diagram: a phase diagram needs a map"), std::string::npos);
  EXPECT_NE(page.find("id=\"chart-phase\""), std::string::npos);
  expect_run({"run", "x.toml", "--out", "out", "--dry-run"}, 0, {"the phase diagram of part 'wall': 2 texel sizes"});
}

}  // namespace
}  // namespace noonmark::acceptance
