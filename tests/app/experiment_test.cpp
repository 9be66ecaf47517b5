// Experiment files: the points that they give, and the errors, which must name the place and suggest what was meant.
#include "app/definition/experiment.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/definition/experiment_file.h"
#include "base/error.h"
#include "base/file.h"
#include "tests/support/kind_thrown.h"
#include "tests/support/sample_results.h"

namespace noonmark {
namespace {

Experiment parse(const std::string& toml) { return parse_experiment(toml, "folder/x.toml"); }

std::vector<std::string> values_of(const Experiment& experiment, const std::string& name) {
  std::vector<std::string> texts;
  for (const Settings& settings : points(experiment)) texts.push_back(find_setting(name).get(settings));
  return texts;
}
using Texts = std::vector<std::string>;
PointRecord point_of(const Experiment& experiment, int64_t id) {
  PointRecord point;
  point.id = id;
  point.settings = settings_map(points(experiment).at(static_cast<size_t>(id)));
  return point;
}

TEST(Experiment, WithoutAnythingIsOnePointOfDefaults) {
  const Experiment experiment = parse("");
  EXPECT_EQ(point_count(experiment), 1);
  EXPECT_EQ(settings_map(points(experiment).at(0)), settings_map(Settings{}));
  EXPECT_TRUE(experiment.curve_enabled);
  EXPECT_EQ(experiment.pictures, "first");
}

// The name with an @ and the name in stores are the same number, wherever a metric or quantity is named.
TEST(Experiment, ReadsWhatFollowsAnAt) {
  const auto text = [](const std::string& worst, const std::string& window, const std::string& time) {
    return "[map]\nplacements = 2\n[plot]\nmetrics = [\"" + worst + "\", \"" + window + "\"]\n[answer]\ncost = \"" +
           time + "\"\n[[bound]]\nmetric = \"" + worst + "\"\nmax = 1\n[[bound]]\nmetric = \"" + window +
           "\"\nmin = 0\n";
  };
  const Experiment at = parse(text("acne@worst", "window_min_m@worst", "map_ms@low"));
  const Experiment stored = parse(text("acne_worst", "window_min_worst_m", "map_low_ms"));
  EXPECT_EQ(at.plot, (Texts{"acne_worst", "window_min_worst_m"}));
  EXPECT_EQ(at.plot, stored.plot);
  EXPECT_EQ(at.cost, "map_low_ms");
  EXPECT_EQ(time_asked_for(at), "map_low_ms");
  ASSERT_EQ(at.bounds.size(), 2u);
  for (size_t i = 0; i < 2; ++i) EXPECT_EQ(at.bounds[i].metric, stored.bounds[i].metric);
  for (const char* none : {"acne@wrost", "flip@mean", "@worst", "acne@"})
    EXPECT_THROW(parse("[plot]\nmetrics = [\"" + std::string(none) + "\"]\n"), Error) << none;
}

TEST(Experiment, ReadsEveryPart) {
  const Experiment e = parse(R"(
title = "A title"
pictures = "worst"
[scene]
name = "plane"
theta_deg = 30
[view]
eye_m = [1, 2.5, -3]
target_m = "auto"
[map]
format = 16
lit_beyond_far = false
cull = "back"
[plot]
metrics = ["acne", "window_width_m"]
[curve]
acne_bound = 0.01
peter_panning_bound = 0
bias_depth = [0.001, 0.5]
[[bound]]
metric = "acne"
max = 1
[[bound]]
metric = "best_error"
min = 0
max = 0.5
join = "mean"
where.map = { format = 16, cull = ["back"] }
where.view.eye_m = [1, 2.5, -3]
)");
  EXPECT_EQ(e.title, "A title");
  EXPECT_EQ(e.pictures, "worst");
  EXPECT_EQ(e.base.scene.name, "plane");
  EXPECT_EQ(e.base.scene.theta_deg, 30);
  EXPECT_EQ(e.base.view.eye_m, glm::dvec3(1, 2.5, -3));
  EXPECT_EQ(e.base.view.target_m, std::nullopt);
  EXPECT_EQ(e.base.map.format, DepthFormat::d16);
  EXPECT_FALSE(e.base.map.lit_beyond_far);
  EXPECT_EQ(e.plot, (Texts{"acne", "window_width_m"}));
  EXPECT_EQ(e.curve.acne_bound, 0.01);
  EXPECT_EQ(e.curve.peter_panning_bound, 0);
  EXPECT_EQ(e.curve.bias_depth, (std::vector<double>{0, 0.001, 0.5})) << "a curve starts at 0";
  ASSERT_EQ(e.bounds.size(), 2u);
  EXPECT_EQ(e.bounds[0].max, 1);
  EXPECT_EQ(e.bounds[0].join, "worst");
  EXPECT_EQ(e.bounds[1].min, 0);
  EXPECT_EQ(e.bounds[1].join, "mean");
  EXPECT_EQ(e.bounds[1].where.at("map.format"), Texts{"16"});
  EXPECT_EQ(e.bounds[1].where.at("map.cull"), Texts{"back"});
  EXPECT_EQ(e.bounds[1].where.at("view.eye_m"), Texts{"1,2.5,-3"});
}

TEST(Experiment, SweepsEveryCombinationFirstNamedOutermost) {
  // Only the order in the file decides, not the order of names or of groups.
  const Experiment e = parse(
      "[sweep]\nmap.resolution = [512, 1024]\nfilter.kind = [\"none\", \"box\"]\nmap.cull = [\"front\", \"back\"]\n");
  EXPECT_EQ(values_of(e, "map.resolution"), (Texts{"512", "512", "512", "512", "1024", "1024", "1024", "1024"}));
  EXPECT_EQ(values_of(e, "filter.kind"), (Texts{"none", "none", "box", "box", "none", "none", "box", "box"}));
  EXPECT_EQ(values_of(e, "map.cull"), (Texts{"front", "back", "front", "back", "front", "back", "front", "back"}));
}

TEST(Experiment, TheSweepMayBeWrittenThreeWays) {
  const std::string expected = fingerprint(parse("[sweep]\nmap.resolution = [512, 1024]\n"), {});
  EXPECT_EQ(fingerprint(parse("[sweep.map]\nresolution = [512, 1024]\n"), {}), expected);
  EXPECT_EQ(fingerprint(parse("[sweep]\n\"map.resolution\" = [512, 1024]\n"), {}), expected);
}

TEST(Experiment, RangesHoldBothEnds) {
  const Experiment linear = parse("[sweep]\nbias.constant = {min = 0, max = 0.3, steps = 4}\n");
  EXPECT_EQ(values_of(linear, "bias.constant"), (Texts{"0", "0.1", "0.2", "0.3"}));

  const Experiment doubling = parse("[sweep]\nmap.resolution = {min = 128, max = 8192, steps = 7, scale = \"log\"}\n");
  EXPECT_EQ(values_of(doubling, "map.resolution"), (Texts{"128", "256", "512", "1024", "2048", "4096", "8192"}));

  const std::vector<Settings> logarithmic =
      points(parse("[sweep]\nbias.constant = {min = 1e-4, max = 1e-1, steps = 7, scale = \"log\"}\n"));
  ASSERT_EQ(logarithmic.size(), 7u);
  for (int i = 0; i < 7; ++i)  // tolerance: 4 units in the last place, for pow() and one product
    EXPECT_NEAR(logarithmic[i].bias["constant"] / std::pow(10.0, -4 + i / 2.0), 1, 1e-15);
  EXPECT_EQ(logarithmic.back().bias["constant"], 1e-1);
}

// `where` and --set name a value by its text. So the value must be 40, not 39.99999999999999.
TEST(Experiment, RangesGiveShortDecimals) {
  const auto swept = [](const std::string& name, const std::string& range) {
    return values_of(parse("[sweep]\n" + name + " = {" + range + "}\n"), name);
  };
  EXPECT_EQ(swept("map.extent_m", "min = 10, max = 80, steps = 4, scale = \"log\""), (Texts{"10", "20", "40", "80"}));
  EXPECT_EQ(swept("map.shift_u_texels", "min = -0.3, max = 0.3, steps = 7"),
            (Texts{"-0.3", "-0.2", "-0.1", "0", "0.1", "0.2", "0.3"}));
  EXPECT_EQ(swept("bias.constant", "min = 1e-6, max = 1e6, steps = 13, scale = \"log\""),
            (Texts{"1e-06", "1e-05", "0.0001", "0.001", "0.01", "0.1", "1", "10", "100", "1000", "10000", "100000",
                   "1000000"}));
  EXPECT_EQ(swept("map.extent_m", "min = 1, max = 2, steps = 4").at(1), "1.3333333333333333")
      << "this value has no short decimal";
}

TEST(Experiment, ScenePathsStartAtTheFilesFolder) {
  EXPECT_EQ(parse("scene = \"models/a.gltf\"").base.scene.name, "folder/models/a.gltf");
  EXPECT_EQ(parse("scene = \"../a.GLB\"").base.scene.name, "a.GLB");
  EXPECT_EQ(parse("[scene]\nname = \"/abs/a.glb\"").base.scene.name, "/abs/a.glb");
  EXPECT_EQ(parse("scene = \"cube-room\"").base.scene.name, "cube-room");
  EXPECT_EQ(values_of(parse("[sweep]\nscene.name = [\"plane\", \"b.glb\"]"), "scene.name"),
            (Texts{"plane", "folder/b.glb"}));
}

// Conditions change slowest, wherever the file gives them, and are told from choices.
TEST(Experiment, ConditionsComeBeforeChoices) {
  const Experiment e = parse(
      "[sweep]\nmap.resolution = [512, 1024]\nfilter.kind = [\"none\", \"box\"]\n"
      "[over]\nview.fov_deg = [40, 60]\nlight.cone_deg = [20, 30, 40]\n");
  EXPECT_EQ(swept_names(e),
            (std::vector<std::string>{"view.fov_deg", "light.cone_deg", "map.resolution", "filter.kind"}));
  EXPECT_EQ(condition_names(e), (std::vector<std::string>{"view.fov_deg", "light.cone_deg"}));
  EXPECT_EQ(point_count(e), 24);
  EXPECT_EQ(swept_text(e, 1), "view.fov_deg = 40, light.cone_deg = 20, map.resolution = 512, filter.kind = box");
}

TEST(Experiment, TheAnswerNamesItsMetrics) {
  const Experiment e = parse("[answer]\ncost = \"map_bytes\"\naccuracy = \"error\"\n");
  EXPECT_EQ(e.cost, "map_bytes");
  EXPECT_EQ(e.accuracy, "error");
  EXPECT_EQ(parse("").cost, "texel_work");
  EXPECT_EQ(parse("[answer]\nchoose = [\"bias\", \"map.fit\"]\n").choose,
            (std::vector<std::string>{"bias", "map.fit"}));
  EXPECT_THROW(parse("[answer]\nchoose = [\"bias.constant\"]\n"), Error);
  EXPECT_THROW(parse("[answer]\nchoose = [\"bias\", \"bias\"]\n"), Error);
}

TEST(Experiment, OverridesReplaceTheValueAndItsSweep) {
  Experiment e = parse("[sweep]\nmap.resolution = [512, 1024]\nmap.cull = [\"none\", \"back\"]\n");
  apply_override(e, "map.resolution=2048");
  apply_override(e, "view.eye_m=1,2,3");
  EXPECT_EQ(values_of(e, "map.resolution"), (Texts{"2048", "2048"}));
  EXPECT_EQ(e.base.view.eye_m, glm::dvec3(1, 2, 3));
  apply_override(e, "scene=plane");
  EXPECT_EQ(e.base.scene.name, "plane");
  EXPECT_EQ(reproduce_command(e, point_of(e, 1)),
            "noonmark render folder/x.toml --set map.resolution=2048 --set view.eye_m=1,2,3 --set scene.name=plane "
            "--set map.cull=back");
  for (const char* bad : {"map.resolution", "=3", "map.resolution=0", "map.resolution=512,1024", "map.resolutio=1"})
    EXPECT_THROW(apply_override(e, bad), Error) << bad;
  apply_override(e, "filter.size=4");
  EXPECT_NO_THROW(points(e)) << "no filter reads it";
  apply_override(e, "filter.kind=box");
  EXPECT_THROW(points(e), Error);
}

TEST(Experiment, TheReproducingCommandSurvivesTheShell) {
  Experiment e = parse_experiment("[sweep]\nscene.name = [\"it's a $cene.gltf\"]\n", "my exp.toml");
  EXPECT_EQ(reproduce_command(e, point_of(e, 0)),
            R"(noonmark render 'my exp.toml' --set 'scene.name=it'\''s a $cene.gltf')");
}

// Control bytes, which a terminal would obey, and bytes that are not UTF-8 are written as text. So the printed line can
// be pasted without a change.
TEST(Experiment, AWordWithControlBytesIsQuotedAsText) {
  EXPECT_EQ(shell_quoted("a\x1b[0m"), R"($'a\033[0m')");
  EXPECT_EQ(shell_quoted("it's\n\\"), R"($'it\'s\012\\')");
  EXPECT_EQ(shell_quoted("\xff"
                         "1"),
            R"($'\3771')");
  EXPECT_EQ(shell_quoted("\u202e"), R"($'\342\200\256')");
  EXPECT_EQ(shell_quoted("Größe 1"), "'Größe 1'");
}

TEST(Experiment, TheFingerprintTellsWhatChangesResultsOnly) {
  const std::string file =
      "title = \"a\"\n[map]\nformat = 24\n[sweep]\nmap.resolution = [512, 1024]\n[curve]\nacne_bound = 0.1\n";
  const auto print = [](const std::string& toml) { return fingerprint(parse(toml), {}); };
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string toml = file;
    return print(toml.replace(toml.find(from), from.size(), to));
  };
  EXPECT_EQ(changed("\"a\"", "\"b\""), print(file));
  EXPECT_EQ(print(file + "[plot]\nmetrics = [\"acne\"]\n[[bound]]\nmetric = \"acne\"\nmax = 1\n"), print(file));
  EXPECT_NE(changed("24", "16"), print(file));
  EXPECT_NE(changed("512, 1024", "1024, 512"), print(file)) << "ids follow the order";
  EXPECT_NE(changed("1024", "2048"), print(file));
  EXPECT_NE(changed("0.1", "0.2"), print(file));
  EXPECT_NE(changed("acne_bound = 0.1", "enabled = false"), print(file));
  const std::pair<std::string, std::string> gl[] = {{"gl_renderer", "llvmpipe"}};
  EXPECT_NE(fingerprint(parse(file), gl), print(file));
}

TEST(Experiment, SharesAreReadInPercentToo) {
  const auto bound_of = [](const std::string& max) {
    return parse_experiment("scene = \"plate\"\n[[bound]]\nmetric = \"acne\"\nmax = " + max, "x.toml");
  };
  EXPECT_EQ(bound_of("\"0.5%\"").bounds.at(0).max, 0.005);
  EXPECT_EQ(bound_of("\"0.1 %\"").bounds.at(0).max, 0.001) << "the double of 0.001 itself";
  EXPECT_EQ(bound_of("\"1e-1%\"").bounds.at(0).max, 0.001);
  EXPECT_EQ(bound_of("\"0.5%\"").notes.size(), 0u);
  const Experiment curve = parse_experiment(
      "scene = \"plate\"\n[curve]\nacne_bound = \"0.3%\"\n[phase]\npeter_panning_bound = \"2%\"", "x.toml");
  EXPECT_EQ(curve.curve.acne_bound, 0.003);
  EXPECT_EQ(curve.phase.peter_panning_bound, 0.02);
}

TEST(Experiment, ALimitAboveEveryShareIsWarnedOf) {
  const auto notes_of = [](const std::string& limit, const char* metric) {
    return parse_experiment(std::string("scene = \"plate\"\n[[bound]]\nmetric = \"") + metric + "\"\n" + limit,
                            "x.toml")
        .notes;
  };
  ASSERT_EQ(notes_of("max = 5", "acne").size(), 1u);
  EXPECT_EQ(
      notes_of("max = 5", "acne").front(),
      "x.toml:4:7: the bound on acne can never be broken: max = 5 is above every share, which is at most 1 (100%); "
      "did you mean 0.05 or \"5%\"?");
  EXPECT_EQ(notes_of("max = \"500%\"", "acne").size(), 1u);
  EXPECT_EQ(notes_of("max = 1", "acne").size(), 0u);
  EXPECT_EQ(notes_of("max = 5", "peter_panning_gap_m").size(), 0u) << "metres";
  const Experiment parts = parse_experiment(
      "[[part]]\nname = \"a\"\n[[part.bound]]\nmetric = \"acne\"\nmax = 5\n[[part]]\nname = \"b\"\n"
      "[[part.bound]]\nmetric = \"acne\"\nmax = 2",
      "x.toml");
  EXPECT_EQ(parts.notes.size(), 2u) << "each once";
}

struct Mistake {
  std::string toml;
  std::string place;  // line:column
  std::string says;   // a part of the message
};

TEST(Experiment, EveryMistakeNamesItsPlaceAndWhatWasMeant) {
  const Mistake mistakes[] = {
      {"title = ", "1:9", ""},
      {"\ntitle = 3", "2:9", "title must be a string"},
      {"titel = \"x\"", "1:1", "did you mean 'title'?"},
      {"[mpa]\nresolution = 1", "1:2", "did you mean 'map'?"},
      {"bound = 3", "1:9", "[[bound]]"},
      {"map = 3", "1:7", "[map] must be a table"},
      {"pictures = \"frist\"", "1:12", "did you mean 'first'?"},
      {"scene = 3", "1:9", "[scene] must be a table"},
      {"phase = 3", "1:9", "[phase] must be a table"},
      {"[phase]\nenabeld = true", "2:1", "did you mean 'phase.enabled'?"},
      {"[phase]\nenabled = 1", "2:11", "phase.enabled must be true or false"},
      {"[phase]\nacne_bound = 2", "2:14",
       "phase.acne_bound = 2 is above every share, which is at most 1 (100%); did you mean 0.02 or \"2%\"?"},
      {"[curve]\nacne_bound = \"0.5 percent\"", "2:14", "must be a number, or a text such as \"0.5%\""},
      {"[[bound]]\nmetric = \"map_bytes\"\nmax = \"5%\"", "3:7", "map_bytes is no share"},
      {"[phase]\nplacements = 65", "2:14", "phase.placements must be an integer, 1 ... 64"},
      {"[phase]\ntexel_sizes = 1", "2:15", "phase.texel_sizes must be an integer, 2 ... 200"},
      {"[phase]\nwidth_px = 3.5", "2:12", "phase.width_px must be an integer, 1 ... 8192"},
      {"[[bound]]\nmetric = \"acne\"\nmax = 1\nplacement = \"all\"", "4:13", "worst | first"},
      {"[map]\nresolutoin = 512", "2:1", "did you mean 'map.resolution'?"},
      {"[map]\nresolution = 0", "2:14", "1 ... 16384"},
      {"[map]\nresolution = 512.5", "2:14", "1 ... 16384"},
      {"[map]\nresolution = \"512\"", "2:14", "without quotes"},
      {"[map]\nresolution = [512]", "2:14", "1 ... 16384; [sweep] takes a list"},
      {"[map]\nextent_m = nan", "2:12", "map.extent_m = 'nan' is not allowed"},
      {"[map]\nextent_m = inf", "2:12", "is not allowed"},
      {"[map]\nwrap = 1\nformat = 1", "2:8", "map.wrap = '1'"},  // the first mistake in the file is reported
      {"[map]\nlit_beyond_far = 1", "2:18", "true | false"},
      {"[map]\nwrap = \"repaet\"", "2:8", "repeat | clamp_to_edge"},
      {"[view]\neye_m = [1, 2]", "2:9", "x,y,z"},
      {"[view]\neye_m = [1, 2, 3, 4]", "2:9", "x,y,z"},
      {"[view]\neye_m = [1, 2, true]", "2:16", "finite number"},
      {"[filter]\nkind = \"box\"\nsize = 4", "3:8", "filter.size = 4 is even"},
      {"[map]\nnear_m = 5\nfar_m = 1", "2:10", "not less than map.far_m"},
      {"[filter]\nkind = \"box\"\n[sweep]\nfilter.size = [3, 4]", "4:15", "point 1 (filter.size = 4)"},
      {"[sweep]\nmap.resolution = []", "2:18", "empty list"},
      {"[over]\nview.fov_deg = 40", "2:16", "[over] view.fov_deg must be a list"},
      {"[over]\nview.fov_deg = [40]\n[sweep]\nview.fov_deg = [50]", "4:16", "view.fov_deg is swept twice"},
      {"[answer]\ncost = \"shadow_mss\"", "2:8", "did you mean 'shadow_ms'?"},
      {"[answer]\nspeed = \"error\"", "2:1", "speed"},
      {"[sweep]\nmap.resolution = 512", "2:18", "must be a list or a range"},
      {"[sweep]\nmap.resolution = [512, 1024, 512]", "2:30", "map.resolution = 512 is swept twice"},
      {"[sweep]\nmap.extent_m = [20, 20.0]", "2:21", "swept twice"},
      {"[sweep]\nmap.resolution = [512]\n\"map.resolution\" = [1024]", "3:20", "map.resolution is swept twice"},
      {"[sweep]\nmap.resolution = [512]\nmap.resolution = [1024]", "3:18", "redefine"},
      {"[map]\nresolution = 512\n[sweep]\nmap.resolution = [512, 1024]", "4:18", "both fixed and swept"},
      {"[sweep]\nmap.resolutoin = [512]", "2:5", "did you mean 'map.resolution'?"},
      {"[sweep]\nmap = [512]", "2:7", "name one, such as map.resolution"},
      {"[sweep]\nresolution = [512]", "2:1", "did you mean 'map.resolution'?"},
      {"[sweep]\nmap.resolution = [512, 99999]", "2:24", "1 ... 16384"},
      {"[sweep]\nmap.extent_m = {min = 1, max = 2}", "2:16", "needs min, max and steps"},
      {"[sweep]\nmap.extent_m = {min = 1, max = 2, step = 3}", "2:35", "did you mean 'map.extent_m.steps'?"},
      {"[sweep]\nmap.extent_m = {min = 2, max = 1, steps = 3}", "2:16", "not below max"},
      {"[sweep]\nmap.extent_m = {min = 1, max = 2, steps = 1}", "2:43", "2 ... 100000"},
      {"[sweep]\nmap.extent_m = {min = 1, max = 2, steps = 3.5}", "2:43", "integer"},
      {"[sweep]\nbias.constant = {min = 0, max = 1, steps = 3, scale = \"log\"}", "2:17", "min above 0"},
      {"[sweep]\nbias.constant = {min = 0, max = 1, steps = 3, scale = \"lgo\"}", "2:55", "did you mean 'log'?"},
      {"[sweep]\nmap.resolution = {min = 1, max = 4, steps = 3}", "2:18", "takes integers, and the range gives 2.5"},
      {"[sweep]\nmap.wrap = {min = 1, max = 4, steps = 3}", "2:12", "list its values"},
      {"[sweep]\nbias.constant = {min = 0, max = 1, steps = 400}\nbias.slope = {min = 0, max = 1, steps = 400}", "1:1",
       "more than 100000 points"},
      {"[plot]\nmetrics = [\"acme\"]", "2:12", "did you mean 'acne'?"},
      {"[plot]\nmetrics = [\"acne\", \"acne\"]", "2:20", "twice"},
      {"[plot]\nmetric = [\"acne\"]", "2:1", "did you mean 'plot.metrics'?"},
      {"[curve]\nenabeld = true", "2:1", "did you mean 'curve.enabled'?"},
      {"[curve]\nenabled = 1", "2:11", "true or false"},
      {"[curve]\nacne_bound = 2", "2:14", "did you mean 0.02"},
      {"[curve]\nacne_bound = -1", "2:14", "0 ... 1"},
      {"[curve]\nbias_depth = [0.1, 0.1]", "2:14", "ascend"},
      {"[curve]\nbias_depth = [-0.1, 0.1]", "2:14", "0 or more"},
      {"[curve]\nover = \"lookup.vmin\"", "2:8", "did you mean 'lookup.v_min'?"},
      {"[curve]\nover = \"lookup.v_min\"", "2:8", "no point has a lookup.kind that reads it"},
      {"[lookup]\nkind = \"msm\"\n[curve]\nover = \"lookup.v_min\"", "4:8", "no point has a lookup.kind that reads it"},
      {"[lookup]\nkind = \"vsm\"\n[curve]\nenabled = false\nover = \"lookup.v_min\"", "5:8", "curve.enabled is false"},
      {"[curve]\nover_values = [0, 1]", "2:15", "curve.over, which is not given"},
      {"[lookup]\nkind = \"vsm\"\n[sweep]\nlookup.v_min = [0, 1e-6]\n[curve]\nover = \"lookup.v_min\"", "6:8",
       "lookup.v_min is swept too"},
      {"[lookup]\nkind = \"vsm\"\n[curve]\nover = \"lookup.v_min\"\n[[part]]\nname = \"a\"\n[part.sweep]\n"
       "lookup.v_min = [0, 1e-6]",
       "4:8", "lookup.v_min is swept too"},
      {"[lookup]\nkind = \"vsm\"\n[curve]\nover = \"lookup.v_min\"\nover_values = [1e-7, 1e-7]", "5:15", "ascend"},
      {"[lookup]\nkind = \"vsm\"\n[curve]\nover = \"lookup.v_min\"\nover_values = [1e-7, 2]", "5:15", "lookup.v_min"},
      {"[[bound]]\nmax = 1", "1:1", "needs a metric"},
      {"[[bound]]\nmetric = \"acne\"", "1:1", "neither max nor min"},
      {"[[bound]]\nmetric = \"acen\"\nmax = 1", "2:10", "did you mean 'acne'?"},
      {"[[bound]]\nmetric = \"acne\"\nmxa = 1", "3:1", "did you mean 'bound.max'?"},
      {"[[bound]]\nmetric = \"acne\"\nmax = nan", "3:7", "finite"},
      {"[[bound]]\nmetric = \"acne\"\nmax = 1\nmin = 2", "1:1", "above max"},
      {"[[bound]]\nmetric = \"acne\"\nmax = 1\njoin = \"men\"", "4:8", "did you mean 'mean'?"},
      {"[[bound]]\nmetric = \"acne\"\nmax = 1\nwhere = {\"map.resolutio\" = 512}", "4:10",
       "did you mean 'map.resolution'?"},
      {"[[bound]]\nmetric = \"acne\"\nmax = 1\nwhere = {map.resolution = 512}", "4:27",
       "no point has map.resolution = 512; it is 1024"},
      {"[sweep]\nmap.resolution = [256, 512]\n[[bound]]\nmetric = \"acne\"\nmax = 1\nwhere.map.resolution = [512, "
       "1024]",
       "6:30", "it is 256 | 512"},
      {"[curve]\nenabled = false\n[[bound]]\nmetric = \"best_error\"\nmax = 1", "4:10", "curve.enabled is false"},
  };
  for (const Mistake& mistake : mistakes) {
    const std::string what = refusal_of(ErrorKind::usage, [&] { parse(mistake.toml); });
    EXPECT_TRUE(what.starts_with("folder/x.toml:" + mistake.place + ": ")) << what << "\n" << mistake.toml;
    EXPECT_NE(what.find(mistake.says), std::string::npos) << what << "\n" << mistake.toml;
    EXPECT_EQ(what.find("folder/x.toml", 1), std::string::npos) << "the message names the place twice: " << what;
  }
}

TEST(Experiment, AFileThatIsNotThereIsAnError) {
  const TemporaryFolder folder;
  EXPECT_THROW(load_experiment(folder.file("none.toml")), Error);
  EXPECT_THROW(load_experiment(folder.path().string()), Error);
}

TEST(Experiment, HostileFilesAreErrors) {
  EXPECT_THROW(parse(std::string(100000, '[')), Error);
  EXPECT_THROW(parse("x = " + std::string(100000, '[')), Error);
  EXPECT_THROW(parse("title = \"\xff\""), Error);
  EXPECT_THROW(parse(std::string("title\0= 1", 9)), Error);
}

// What goes together is asked of the settings as `--set` leaves them.
TEST(Experiment, IsCheckedAfterWhatTheCommandLineSets) {
  const auto error = [](const std::string& toml, const std::vector<std::string>& sets) {
    return refusal_of(ErrorKind::usage, [&] { points(parse_experiment(toml, "x.toml", sets)); });
  };
  const std::string over = "[curve]\nover = \"lookup.v_min\"\n";
  EXPECT_NE(error(over, {}).find("no point has a lookup.kind"), std::string::npos);
  EXPECT_EQ(error(over, {"lookup.kind=vsm", "filter.kind=box"}), "");
  EXPECT_NE(error("[lookup]\nkind = \"vsm\"\n" + over, {"lookup.kind=compare"}).find("no point has a lookup.kind"),
            std::string::npos);
  const std::string swept = "[lookup]\nkind = \"vsm\"\n[sweep]\nlookup.v_min = [0, 1e-6]\n" + over;
  EXPECT_NE(error(swept, {}).find("is swept too"), std::string::npos);
  EXPECT_EQ(error(swept, {"lookup.v_min=0"}), "") << "it is swept no longer";
  EXPECT_EQ(error("[lookup]\nkind = \"vsm\"\n[[part]]\nname = \"a\"\n[part.sweep]\nlookup.v_min = [0, 1e-6]\n" + over,
                  {"lookup.v_min=0"}),
            "");
  const std::string cascades = "[map]\nfit = \"scene\"\n[cascades]\ncount = 4\n";
  EXPECT_NE(error(cascades, {}), "");
  EXPECT_EQ(error(cascades, {"map.fit=sphere"}), "");
  EXPECT_NE(error(cascades, {"map.fit=tight"}).find("map.fit = tight"), std::string::npos);
}

TEST(Experiment, AMetricThatIsGoneNamesTheSame) {
  for (const std::string asks : {"[[bound]]\nmetric = \"pcf_error\"\nmax = 1", "[plot]\nmetrics = [\"pcf_error\"]"})
    expect_refused(ErrorKind::usage, {"'error' at every point"}, [&] { parse(asks); });
}

}  // namespace
}  // namespace noonmark
