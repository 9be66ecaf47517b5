// Experiment files with parts, phase diagrams and laws.
#include <gtest/gtest.h>

#include <set>

#include "app/definition/experiment.h"
#include "app/definition/experiment_file.h"
#include "app/sweep/survey.h"
#include "base/error.h"
#include "tests/support/kind_thrown.h"

namespace noonmark {
namespace {

Experiment parse_parts(const std::string& toml) { return parse_experiment(toml, "folder/x.toml"); }

std::string message(const std::string& toml) {
  return refusal_of(ErrorKind::usage, [&] { parse_parts(toml); });
}

// The message must begin with the place and contain every text.
void expect_error(const std::string& toml, const std::string& place, std::initializer_list<const char*> texts) {
  const std::string found = message(toml);
  EXPECT_TRUE(found.starts_with("folder/x.toml:" + place)) << found;
  for (const char* text : texts) EXPECT_NE(found.find(text), std::string::npos) << found << "\nlacks " << text;
}

constexpr const char* two_parts = R"(
title = "t"
scene = "plane"
[map]
resolution = 256
[curve]
acne_bound = 0
[let]
k = "1 / 2"
[[part]]
name = "first"
[part.sweep]
scene.theta_deg = [10, 20, 30]
[[part.law]]
name = "a law"
measured = "error"
at_most = "k * texel"
[part.let]
texel = "map.extent_scale / map.resolution"
[[part]]
name = "second"
scene = "wall"
[part.map]
resolution = 512
[part.sweep]
map.format = ["16", "24"]
scene.thickness_m = [0.1, 0.2]
[part.curve]
enabled = false
)";

TEST(ExperimentParts, APhaseDiagramIsAskedForByItsTable) {
  EXPECT_FALSE(parse_parts("").phase.enabled);
  const PhaseRequest plain = parse_parts("[phase]\n").phase;
  EXPECT_TRUE(plain.enabled);
  EXPECT_FALSE(plain.acne_bound || plain.peter_panning_bound) << "those of the curve";
  const PhaseRequest all =
      parse_parts(
          "[phase]\nacne_bound = 0.01\npeter_panning_bound = 0.002\nplacements = 4\ntexel_sizes = 9\nwidth_px = 160\n")
          .phase;
  EXPECT_EQ(all.acne_bound, 0.01);
  EXPECT_EQ(all.peter_panning_bound, 0.002);
  EXPECT_EQ(all.placements, 4);
  EXPECT_EQ(all.texel_sizes, 9);
  EXPECT_EQ(all.width_px, 160);
  const Experiment parts = parse_parts(
      "[phase]\nplacements = 4\n[[part]]\nname = \"a\"\n[[part]]\nname = \"b\"\n[part.phase]\nenabled = false\n");
  EXPECT_TRUE(parts.parts[0].phase.enabled);
  EXPECT_EQ(parts.parts[0].phase.placements, 4);
  EXPECT_FALSE(parts.parts[1].phase.enabled);
  // Only the diagram is made anew if its options change.
  EXPECT_EQ(fingerprint(parse_parts("[phase]\n"), {}), fingerprint(parse_parts(""), {}));
}

TEST(ExperimentParts, FollowEachOtherWithTheirOwnSettings) {
  const Experiment e = parse_parts(two_parts);
  ASSERT_EQ(e.parts.size(), 2u);
  EXPECT_EQ(point_count(e), 3 + 4);
  const std::vector<Settings> all = points(e);
  ASSERT_EQ(all.size(), 7u);
  EXPECT_EQ(all[2].scene.name, "plane");
  EXPECT_EQ(all[2].scene.theta_deg, 30);
  EXPECT_EQ(all[2].map.resolution, 256);
  EXPECT_EQ(all[3].scene.name, "wall");
  EXPECT_EQ(all[3].map.resolution, 512);
  EXPECT_EQ(all[6].map.format, DepthFormat::d24);
  EXPECT_EQ(all[6].scene.thickness_m, 0.2);
  EXPECT_EQ(part_of_point(e, 2).part, "first");
  EXPECT_EQ(part_of_point(e, 3).part, "second");
  EXPECT_EQ(part_of_point(e, 2).curve.acne_bound, 0);
  EXPECT_TRUE(part_of_point(e, 2).curve_enabled);
  EXPECT_FALSE(part_of_point(e, 3).curve_enabled);
  EXPECT_EQ(swept_names(e), (std::vector<std::string>{"scene.theta_deg", "map.format", "scene.thickness_m"}));
  ASSERT_EQ(e.parts[0].laws.size(), 1u);
  EXPECT_EQ(e.parts[0].laws[0].let.size(), 2u);
  EXPECT_TRUE(e.parts[1].laws.empty());
}

TEST(ExperimentParts, OverridesReachEveryPart) {
  Experiment e = parse_parts(two_parts);
  apply_override(e, "map.resolution=64");
  apply_override(e, "map.format=32f");
  EXPECT_EQ(point_count(e), 3 + 2);
  for (const Settings& settings : points(e)) {
    EXPECT_EQ(settings.map.resolution, 64);
    EXPECT_EQ(settings.map.format, DepthFormat::d32f);
  }
}

TEST(ExperimentParts, APointIsReproducedByItsNumber) {
  Experiment e = parse_parts(two_parts);
  apply_override(e, "map.resolution=64");
  PointRecord point;
  point.id = 4;
  point.settings = settings_map(points(e)[4]);
  EXPECT_EQ(reproduce_command(e, point), "noonmark render folder/x.toml --set map.resolution=64 --point 4");
}

TEST(ExperimentParts, OnlyTheChosenOnesAreMeasured) {
  Experiment e = parse_parts(two_parts);
  choose_parts(e, {"second"});
  ASSERT_EQ(points(e).size(), 4u);
  EXPECT_EQ(points(e)[0].scene.name, "wall");
  EXPECT_EQ(part_of_point(e, 0).part, "second");
  PointRecord point;
  point.id = 1;
  EXPECT_EQ(reproduce_command(e, point), "noonmark render folder/x.toml --part second --point 1");

  Experiment both = parse_parts(two_parts);
  choose_parts(both, {"second", "first"});
  EXPECT_EQ(point_count(both), 7) << "the parts must be in the file's order";
  EXPECT_EQ(part_of_point(both, 0).part, "first");

  const auto message = [](Experiment from, const std::string& name) {
    return refusal_of(ErrorKind::usage, [&] { choose_parts(from, {name}); });
  };
  EXPECT_EQ(message(parse_parts(two_parts), "secnd"),
            "--part secnd: folder/x.toml has no such part; did you mean 'second'?");
  EXPECT_EQ(message(parse_parts(two_parts), "x"), "--part x: folder/x.toml has no such part; it has 'first', 'second'");
  EXPECT_EQ(message(parse_parts(""), "first"), "--part first: folder/x.toml has no parts");
}

TEST(ExperimentParts, TheFingerprintSeesEveryPart) {
  const auto print = [](const std::string& text) { return fingerprint(parse_parts(text), {}); };
  const std::string whole = two_parts;
  std::set<std::string> prints{print(whole)};
  for (const auto& [from, to] : {std::pair("[10, 20, 30]", "[10, 20, 31]"), std::pair("= 512", "= 128"),
                                 std::pair("\"second\"", "\"other\""), std::pair("acne_bound = 0", "acne_bound = 1")}) {
    std::string changed = whole;
    changed.replace(changed.find(from), std::string(from).size(), to);
    EXPECT_TRUE(prints.insert(print(changed)).second) << to;
  }
  std::string law = whole;
  law.replace(law.find("k * texel\""), 9, "2 * texel");
  EXPECT_FALSE(prints.insert(print(law)).second) << "a law changes no result, so it must not change the fingerprint";
}

TEST(ExperimentParts, MistakesAreNamedWithTheirPlace) {
  expect_error("[[part]]\nscene = \"plane\"", "1:1", {"needs a name"});
  expect_error("[[part]]\nname = \"a\"\n[[part]]\nname = \"a\"", "3:1", {"two parts have the name 'a'"});
  expect_error("[sweep]\nmap.resolution = [1, 2]\n[[part]]\nname = \"a\"", "1:1", {"inside a [[part]]"});
  expect_error("[[law]]\nname = \"l\"\nmeasured = \"error\"\nequals = 0\n[[part]]\nname = \"a\"",
               "1:", {"inside a [[part]]"});
  expect_error("[[part]]\nname = \"a\"\ntitle = \"t\"", "3:1", {"no key 'part.title'"});
  expect_error("[part]\nname = \"a\"", "1:1", {"[[part]]"});
  expect_error("[[part]]\nname = \"a\"\n[part.map]\nresolutio = 3", "4:1", {"map.resolution"});
  expect_error("[[part]]\nname = \"a\"\n[part.map]\nnear_m = 3\nfar_m = 2", "4:", {"part 'a'", "map.near_m"});
}

std::string law(const std::string& keys) { return "[[law]]\nname = \"l\"\n" + keys; }

TEST(ExperimentLaws, AreReadWhole) {
  const Experiment e = parse_parts(R"(
[let]
k = "(filter.size - 1) / 2 + 0.5"
two_k = "2 * k"
[sweep]
map.resolution = [128, 256]
filter.size = [3, 5]
[[law]]
name = "a"
says = "what"
measured = "acne"
at_most = "two_k * error"
within = 0.05
slack = 0.25
join = "slope"
over = "map.resolution"
where = {filter.size = 3}
[[law]]
name = "b"
measured = "error + acne"
equals = 0
against = {filter.size = 5}
)");
  ASSERT_EQ(e.laws.size(), 2u);
  const Law& a = e.laws[0];
  EXPECT_EQ(a.name, "a");
  EXPECT_EQ(a.says, "what");
  EXPECT_EQ(a.measured, "acne");
  EXPECT_EQ(a.predicted, "two_k * error");
  EXPECT_EQ(a.relation, LawRelation::at_most);
  EXPECT_EQ(a.within, 0.05);
  EXPECT_EQ(a.slack, "0.25");
  EXPECT_EQ(a.join, "slope");
  EXPECT_EQ(a.over, "map.resolution");
  EXPECT_EQ(a.where, (Conditions{{"filter.size", {"3"}}}));
  EXPECT_EQ(a.let, (std::vector<std::pair<std::string, std::string>>{{"k", "(filter.size - 1) / 2 + 0.5"},
                                                                     {"two_k", "2 * k"}}));
  EXPECT_EQ(e.laws[1].relation, LawRelation::equal);
  EXPECT_EQ(e.laws[1].predicted, "0");
  EXPECT_EQ(e.laws[1].against, (Conditions{{"filter.size", {"5"}}}));
}

TEST(ExperimentLaws, MistakesAreNamedWithTheirPlace) {
  expect_error(law("measured = \"erro\"\nequals = 0"), "1:", {"'erro'", "did you mean 'error'?"});
  expect_error(law("measured = \"error +\"\nequals = 0"), "3:12", {"cannot be read"});
  expect_error(law("measured = \"error\""), "1:", {"one of equals"});
  expect_error(law("measured = \"error\"\nequals = 0\nat_most = 1"), "5:1", {"one of equals, at_most and at_least"});
  expect_error(law("measured = \"error\"\nequls = 0"), "4:1", {"did you mean 'law.equals'?"});
  expect_error(law("measured = \"error\"\nequals = \"map.format\""), "1:", {"map.format is no number"});
  expect_error(law("measured = \"error\"\nequals = 0\nwithin = -1"), "1:", {"within"});
  expect_error(law("measured = \"error\"\nequals = 0\njoin = \"slope\""), "1:", {"`over`"});
  expect_error(law("measured = \"error\"\nequals = 0\nover = \"map.resolution\""), "1:", {"only a slope"});
  expect_error(law("measured = \"error\"\nequals = 0\njoin = \"slope\"\nover = \"map.format\""), "1:", {"no number"});
  expect_error(law("measured = \"error\"\nequals = 0\nwhere = {map.resolution = 3}"), "5:", {"no point has"});
  expect_error("[curve]\nenabled = false\n" + law("measured = \"best_error\"\nequals = 0"),
               "3:", {"curve.enabled is false"});
  expect_error("[let]\nerror = \"1\"\n" + law("measured = \"error\"\nequals = 0"), "3:", {"name that is already used"});
  expect_error("[law]\nname = \"l\"", "1:1", {"[[law]]"});
  const std::string slope = "measured = \"error\"\nequals = 0\njoin = \"slope\"\nover = \"map.resolution\"";
  expect_error(law(slope), "1:", {"map.resolution", "one value"});
  const std::string plain = law("measured = \"error\"\nequals = 0\n");
  expect_error(plain + plain, "5:", {"two laws have the name 'l'"});
  expect_error(
      "[[part]]\nname = \"a\"\n[[part.law]]\nname = \"l\"\nmeasured = \"error\"\nequals = 0\n[[part]]\nname = "
      "\"b\"\n[[part.law]]\nname = \"l\"\nmeasured = \"error\"\nequals = 0",
      "7:", {"two laws have the name 'l'"});
  expect_error("[let]\nx = \"1 = 2\"", "2:5", {"compare with =="});
  expect_error("[let]\nk = \"1 / 2\"\n[[part]]\nname = \"a\"\n[part.let]\nk = \"2\"", "6:1", {"let defines 'k' twice"});
}

// With one note for each part, eight equal lines hid the other notes.
TEST(IdleNotes, NameASettingOnceForAllParts) {
  std::string file = "scene = \"plane\"\n[bias]\nunit = \"texel\"\n";
  for (const char* name : {"a", "b", "c", "d"})
    file += std::string("[[part]]\nname = \"") + name + "\"\n[part.bias]\nnormal_offset = 1\nconstant = 0\n";
  file += "[[part]]\nname = \"read\"\n[part.bias]\nconstant = 1\n";
  const Experiment experiment = parse_parts(file);
  IdleNotes notes;
  const std::vector<Settings> planned = points(experiment);
  for (size_t id = 0; id < planned.size(); ++id)
    notes.add(part_of_point(experiment, static_cast<int64_t>(id)), planned[id], LightKind::directional);
  EXPECT_EQ(notes.fixed(),
            (std::vector<std::string>{"bias.unit has no effect at any point of 4 parts ('a', 'b', 'c' and 1 other)"}));
}

}  // namespace
}  // namespace noonmark
