// Experiments with several lights in one frame: what the file says, what the frame is, and what a run keeps.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "app/advise/texel_budget.h"
#include "app/definition/experiment.h"
#include "app/definition/experiment_file.h"
#include "app/definition/experiment_text.h"
#include "app/sweep/sweep.h"
#include "base/error.h"
#include "base/file.h"
#include "compare/judge/tradeoff.h"
#include "compare/report/lights_section.h"
#include "compare/report/opening.h"
#include "measure/lights_frame.h"
#include "tests/scenes/gltf/files.h"
#include "tests/support/kind_thrown.h"

namespace noonmark {
namespace {

Experiment parse(const std::string& toml) {
  Experiment experiment = parse_experiment(toml, "folder/x.toml");
  take_all_lights(experiment);
  return experiment;
}

std::string refusal(const std::string& toml) {
  return refusal_of(ErrorKind::usage, [&] { parse(toml); });
}

std::vector<std::string> part_names(const Experiment& experiment) {
  std::vector<std::string> names;
  for (const Experiment& part : experiment.parts) names.push_back(part.part);
  return names;
}

TEST(Lights, AreAllOrListedOrTables) {
  const std::string start = "scene = \"lab\"\n", sweep = "[sweep]\nmap.resolution = [256, 512]\n",
                    bound = "[[bound]]\nmetric = \"acne\"\nmax = 0.1\n";
  const std::vector<std::string> three = {"sun", "spot", "lamp"}, two = {"lamp", "sun"};
  for (const auto& [text, names] :
       {std::pair("lights = \"all\"\n", three), std::pair("lights = [\"lamp\", \"sun\"]\n", two)}) {
    const Experiment e = parse(text + start + sweep + bound);
    EXPECT_TRUE(e.lights);
    EXPECT_FALSE(e.all_lights);
    EXPECT_EQ(part_names(e), names);
    EXPECT_TRUE(e.swept.empty() && e.bounds.empty());
    const std::vector<Settings> all = points(e);
    ASSERT_EQ(all.size(), 2 * names.size());
    for (size_t i = 0; i < all.size(); ++i) {
      EXPECT_EQ(all[i].light.name, names[i / 2]);
      EXPECT_EQ(all[i].map.resolution, i % 2 == 0 ? 256 : 512);
      EXPECT_EQ(part_of_point(e, static_cast<int64_t>(i)).bounds.size(), 1u);
    }
  }
  const Experiment e = parse(start +
                             "[bias]\nconstant = 0.001\n[[lights]]\nname = \"lamp\"\nmap.resolution = 300\n"
                             "bias.constant = 0.002\n[[lights]]\nname = \"spot\"\nfilter.kind = \"box\"\n");
  const std::vector<Settings> all = points(e);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].map.resolution, 300);
  EXPECT_EQ(all[0].bias["constant"], 0.002);
  EXPECT_EQ(all[0].filter.kind, "none");
  EXPECT_EQ(all[1].map.resolution, Settings().map.resolution);
  EXPECT_EQ(all[1].bias["constant"], 0.001);
  EXPECT_EQ(all[1].filter.kind, "box");
}

TEST(Lights, APartOfAFrameIsNoFrame) {
  Experiment e = parse(
      "scene = \"lab\"\nlights = \"all\"\n[[bound]]\nmetric = \"lights_error\"\nmax = 1\n[[bound]]\nmetric = "
      "\"light_size\"\n"
      "max = 1\n");
  choose_parts(e, {"sun", "spot", "lamp"});
  EXPECT_TRUE(e.lights);
  choose_parts(e, {"sun"});
  EXPECT_FALSE(e.lights);
  ASSERT_EQ(e.parts.at(0).bounds.size(), 1u);
  EXPECT_EQ(e.parts[0].bounds[0].metric, "light_size") << "of the light alone";
  EXPECT_NE(e.notes.back().find("and 1 bound on it not judged"), std::string::npos) << e.notes.back();
}

TEST(Lights, ABoundOnTheFrameIsJudgedOnce) {
  const Experiment e = parse(
      "scene = \"lab\"\nlights = \"all\"\n[[bound]]\nmetric = \"lights_error\"\nmax = 1\n[[bound]]\nmetric = "
      "\"light_error\"\n"
      "max = 1\n");
  EXPECT_EQ(e.parts[0].bounds.size(), 2u);
  EXPECT_EQ(e.parts[1].bounds.size(), 1u);
}

TEST(Lights, OfOneFrameCanBePartsAndAreWrittenSo) {
  const Experiment listed =
      parse("scene = \"lab\"\nlights = [\"sun\", \"lamp\"]\n[sweep]\nmap.resolution = [64, 128]\n");
  const std::string text = experiment_text(listed);
  EXPECT_NE(text.find("lights = \"parts\""), std::string::npos) << text;
  const Experiment read = parse(text);
  EXPECT_TRUE(read.lights);
  EXPECT_EQ(fingerprint(read, {}), fingerprint(listed, {}));
  const std::string parts =
      "scene = \"lab\"\n[[part]]\nname = \"a\"\nlight.name = \"sun\"\n[[part]]\nname = \"b\"\n"
      "light.name = \"lamp\"\n";
  EXPECT_FALSE(parse(parts).lights);
  EXPECT_TRUE(parse("lights = \"parts\"\n" + parts).lights);
  EXPECT_NE(fingerprint(parse(parts), {}), fingerprint(parse("lights = \"parts\"\n" + parts), {}));
}

TEST(Lights, WhatCannotBeIsRefused) {
  const auto has = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  has(refusal("lights = \"some\"\nscene = \"lab\"\n"), "folder/x.toml:1:10: lights = \"some\" is not \"all\"");
  has(refusal("lights = \"parts\"\nscene = \"lab\"\n"), "needs [[part]]s");
  has(refusal("lights = [\"sun\", \"sun\"]\nscene = \"lab\"\n"), "names 'sun' twice");
  has(refusal("lights = \"all\"\nscene = \"lab\"\nlight.name = \"sun\"\n"), "both choose what is measured");
  has(refusal("lights = \"all\"\n[sweep]\nscene.name = [\"lab\", \"wall\"]\n"), "needs one scene");
  has(refusal("scene = \"lab\"\n[[lights]]\nmap.resolution = 64\n"), "needs the name of a light");
  has(refusal(
          "scene = \"lab\"\n[sweep]\nmap.resolution = [64, 128]\n[[lights]]\nname = \"sun\"\nmap.resolution = 64\n"),
      "map.resolution is swept, and fixed for this light");
  has(refusal("scene = \"lab\"\n[[lights]]\nname = \"sun\"\nbound = 3\n"), "bound");
  has(refusal("scene = \"lab\"\nlights = \"parts\"\n[[part]]\nname = \"a\"\n[part.sweep]\nmap.resolution = [64, 128]\n"
              "[[part]]\nname = \"b\"\n"),
      "have not as many points");
  EXPECT_EQ(part_names(parse("lights = \"all\"\nscene = \"cube-room\"\n")), std::vector<std::string>{"the light"});
  // One frame has one scene, one view and each light once.
  has(refusal("scene = \"lab\"\n[[lights]]\nname = \"sun\"\nview.width_px = 100\n"),
      "view.width_px is one for all lights");
  has(refusal("scene = \"lab\"\n[[lights]]\nname = \"sun\"\nlight.name = \"lamp\"\n"), "leave it out");
  has(refusal("scene = \"lab\"\nlights = [\"auto\"]\n"), "cannot be named");
  const std::string parts =
      "lights = \"parts\"\n[[part]]\nname = \"a\"\nscene = \"lab\"\nlight.name = \"sun\"\n[[part]]\nname = \"b\"\n";
  has(refusal(parts + "scene = \"wall\"\n"), "the lights 'a' and 'b' of one frame differ in scene.name");
  has(refusal(parts + "scene = \"lab\"\nlight.name = \"lamp\"\nview.fov_deg = 20\n"), "differ in view.fov_deg");
  has(refusal(parts + "scene = \"lab\"\nlight.name = \"sun\"\n"), "are the same light");
  EXPECT_TRUE(parse(parts + "scene = \"lab\"\nlight.name = \"lamp\"\n").lights);
}

// Two lights on a picture of 2 x 2: every number by hand.
TEST(LightsFrame, WeighsEachLightByItsShareOfThePixelsLight) {
  const auto image = [](float a, float b, float c, float d) {
    Image<float> made(2, 2);
    made.pixels = {a, b, c, d};
    return made;
  };
  LightPart one{glm::dvec3(1),        image(3, 1, 0, 5), image(1, 1, 0, 0), image(0, 1, 0, 1),
                image(0, 0.5f, 0, 1), {2, 2, 0},         {2, 2, 1}};
  LightPart two{glm::dvec3(1),        image(1, 1, 2, 5), image(0, 0, 0, 1), image(1, 0, 1, 0),
                image(1, 0, 0.5f, 0), {2, 2, 0},         {2, 2, 1}};
  const LightsFrame frame = measure_lights(std::vector{one, two});
  // Pixel 0: 0.75 - 0.25; 1: right; 2: only the second, wholly wrong; 3: the two errors cancel.
  EXPECT_DOUBLE_EQ(frame.metrics.at("lights_error"), (0.5 + 0 + 1 + 0) / 4);
  EXPECT_DOUBLE_EQ(frame.metrics.at("lights_error_soft"), (0.5 + 0.25 + 0.5 + 0) / 4);
  EXPECT_DOUBLE_EQ(frame.of_light[0].at("light_error"), (0.75 + 0 + 0 + 0.5) / 4);
  EXPECT_DOUBLE_EQ(frame.of_light[1].at("light_error"), (0.25 + 0 + 1 + 0.5) / 4);
  EXPECT_DOUBLE_EQ(frame.of_light[0].at("light_share"), 1.25 / 3);
  EXPECT_DOUBLE_EQ(frame.of_light[0].at("light_weight"), (0.75 + 0.5 + 0 + 0.5) / 4);
  EXPECT_EQ(frame.metrics.at("lights_counted"), 4);
  EXPECT_EQ(frame.most_wrong[0], most_wrong_color(0).srgb);
  EXPECT_EQ(frame.most_wrong[1], glm::u8vec3(0));
  EXPECT_EQ(frame.most_wrong[2], most_wrong_color(1).srgb);

  two.ambiguous.pixels = {0, 0, 1, 0};
  const LightsFrame less = measure_lights(std::vector{one, two});
  EXPECT_EQ(less.metrics.at("lights_counted"), 3);
  EXPECT_EQ(less.metrics.at("lights_ambiguous"), 1);
  EXPECT_DOUBLE_EQ(less.metrics.at("lights_error"), 0.5 / 3);

  two.shown[1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(std::isnan(measure_lights(std::vector{one, two}).metrics.at("lights_error")));
  EXPECT_THROW(measure_lights({}), std::logic_error);
}

struct LightsRun : testing::Test {
  TemporaryFolder temporary;
  std::string folder = temporary.path().string();
  std::string path = folder + "/x.toml";
  SweepOutcome run(const std::string& toml) {
    Experiment experiment = parse_experiment(toml + "[view]\nwidth_px = 160\nheight_px = 90\n", path);
    take_all_lights(experiment);
    return run_sweep(experiment, ResultsFolder(folder + "/out", experiment.path), {.command = "test", .quiet = true});
  }
  static double metric(const Results& results, size_t point, const char* name) {
    return results.points.at(point).metrics.at(name);
  }
};

// A frame of one directional light is that light's own picture: every pixel that faces it has the weight 1.
TEST_F(LightsRun, OneSunIsItsOwnFrame) {
  const Results results = run("scene = \"cube-room\"\nlights = \"all\"\nbias.constant = 0.003\n").results;
  ASSERT_EQ(results.points.size(), 1u);
  EXPECT_GT(metric(results, 0, "error"), 0);
  EXPECT_NEAR(metric(results, 0, "lights_error"), metric(results, 0, "error"), 1e-12);
  EXPECT_NEAR(metric(results, 0, "light_error"), metric(results, 0, "error"), 1e-12);
  EXPECT_EQ(metric(results, 0, "lights_counted"), metric(results, 0, "counted"));
  EXPECT_EQ(metric(results, 0, "light_share"), 1);
  EXPECT_EQ(metric(results, 0, "light_weight"), 1);
}

TEST_F(LightsRun, ResumesWithTheLightsItHasNow) {
  const std::string start = "scene = \"lab\"\npictures = \"first\"\n";
  const Results all = run(start + "lights = \"all\"\n").results;
  ASSERT_EQ(all.points.size(), 3u);
  double shares = 0, parts = 0;
  for (size_t i = 0; i < 3; ++i) {
    shares += metric(all, i, "light_share");
    parts += metric(all, i, "light_error");
    EXPECT_EQ(metric(all, i, "lights_error"), metric(all, 0, "lights_error"));
    EXPECT_GT(metric(all, i, "light_weight"), 0);
  }
  EXPECT_NEAR(shares, 1, 1e-12);
  EXPECT_LE(metric(all, 0, "lights_error"), parts);
  EXPECT_TRUE(std::filesystem::exists(folder + "/out/images/p0000-lights-shown.png"));
  EXPECT_NE(read_file(folder + "/out/report.html").find("id=\"lights\""), std::string::npos);
  EXPECT_NE(report::lights_sentence(all).html().find("Together the 3 lights"), std::string::npos);

  // The page speaks of one light: that of the sentence, with the bias as set.
  const PointRecord* const largest = report::largest_light(all);
  ASSERT_NE(largest, nullptr);
  for (size_t i = 0; i < 3; ++i) EXPECT_LE(metric(all, i, "light_share"), largest->metrics.at("light_share"));
  EXPECT_NE(report::lights_sentence(all).html().find("<b>" + largest->part + "</b> makes"), std::string::npos)
      << report::lights_sentence(all).html();
  const report::Opening opened = report::opening(all);
  ASSERT_NE(opened.point, nullptr);
  EXPECT_EQ(opened.point->id, largest->id);
  EXPECT_FALSE(opened.bias);
  EXPECT_TRUE(report::opens_as_set(all));
  EXPECT_NE(largest->id, 0) << "then it would be the first one by chance";

  const SweepOutcome again = run(start + "lights = \"all\"\n");
  EXPECT_EQ(again.measured, 0);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(again.results.points[i].metrics, all.points[i].metrics) << i;
    EXPECT_EQ(again.results.points[i].pictures.size(), all.points[i].pictures.size()) << i;
  }
  // Without the spot, the frame is another, and nothing of the old one stays.
  const SweepOutcome fewer = run(start + "lights = [\"lamp\", \"sun\"]\n");
  EXPECT_EQ(fewer.measured, 0);
  ASSERT_EQ(fewer.results.points.size(), 2u);
  EXPECT_EQ(fewer.results.points[0].part, "lamp");
  EXPECT_NE(metric(fewer.results, 0, "lights_error"), metric(all, 2, "lights_error"));
  EXPECT_NEAR(metric(fewer.results, 0, "light_share") + metric(fewer.results, 1, "light_share"), 1, 1e-12);
  // An experiment without lights measures its point anew, so that its numbers have no frame.
  const SweepOutcome single = run(start + "light.name = \"lamp\"\n");
  EXPECT_EQ(single.measured, 1);
  EXPECT_FALSE(single.results.points[0].metrics.contains("lights_error"));
  EXPECT_TRUE(report::lights_section(single.results, {}).empty());
}

// A floor of 12 x 12 m, some boards over it, a sun, six lamps of 1 to 60 candela, and one below the floor that lights nothing.
std::string eight_lights() {
  using test::json;
  json d = test::square();
  d["extensionsUsed"] = {"KHR_lights_punctual"};
  // Looking down, turned about the vertical and then tilted, as a quaternion of glTF.
  const auto looking = [](double turn_deg, double tilt_deg) {
    const glm::dquat q = glm::angleAxis(glm::radians(turn_deg), glm::dvec3(0, 1, 0)) *
                         glm::angleAxis(glm::radians(tilt_deg - 90), glm::dvec3(1, 0, 0));
    return json{q.x, q.y, q.z, q.w};
  };
  json nodes = json::array(), lights = json::array();
  const auto board = [&](glm::dvec3 at, double side, double turn_deg) {
    nodes.push_back({{"mesh", 0},
                     {"rotation", looking(turn_deg, 0)},
                     {"scale", {side, side, 1}},
                     {"translation", {at.x, at.y, at.z}}});
  };
  board({-6, 0, 6}, 12, 0);
  for (int i = 0; i < 9; ++i) board({-4.5 + 3.3 * (i % 3), 0.5 + 0.1 * i, -3.0 + 3.3 * (i / 3)}, 0.8, 11 * i + 7);
  const auto light = [&](const char* name, const char* type, double intensity, glm::dvec3 at, double tilt_deg) {
    nodes.push_back({{"name", name},
                     {"rotation", looking(31, tilt_deg)},
                     {"translation", {at.x, at.y, at.z}},
                     {"extensions", {{"KHR_lights_punctual", {{"light", lights.size()}}}}}});
    lights.push_back({{"type", type}, {"intensity", intensity}});
    if (std::string(type) == "spot") lights.back()["spot"] = {{"outerConeAngle", 0.7}};
  };
  light("sun", "directional", 60, {0, 8, 0}, 35);
  for (int i = 0; i < 6; ++i)
    light(("lamp " + std::to_string(i)).c_str(), i % 2 ? "spot" : "point", std::pow(2.3, i),
          {-4 + 1.7 * i, 2.5, i % 3 ? -2.0 : 2.5}, 20);
  light("cellar", "point", 100, {0, -2, 0}, 0);
  nodes.push_back({{"camera", 0}, {"rotation", {-0.5, 0, 0, std::sqrt(0.75)}}, {"translation", {0, 9, 6}}});
  d["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.5}}}}};
  d["nodes"] = nodes;
  d["extensions"]["KHR_lights_punctual"]["lights"] = lights;
  for (size_t i = 0; i < nodes.size(); ++i) d["scenes"][0]["nodes"][i] = i;
  return d.dump();
}

TEST_F(LightsRun, ABudgetOfTexelsIsDividedByWhatEachLightDoes) {
  const std::string model = folder + "/eight.gltf";
  write_file_atomically(model, eight_lights());
  Experiment experiment =
      parse_experiment("scene = \"eight.gltf\"\nlights = \"all\"\n[view]\nwidth_px = 240\nheight_px = 135\n", path);
  take_all_lights(experiment);
  ASSERT_EQ(experiment.parts.size(), 8u);
  std::vector<std::pair<std::string, Settings>> lights;
  for (const Experiment& part : experiment.parts) lights.emplace_back(part.part, part.base);
  Workbench bench(gl::DebugMode::fatal);
  constexpr int64_t budget = 1 << 20;
  const TexelBudget found = divide_texels(bench, lights, budget, [](const std::string&) {});
  const auto texels_of = [](const TexelDivision& division) {
    int64_t sum = 0;
    for (const LightShare& light : division.lights) {
      const bool cube =
          light.name == "cellar" || light.name == "lamp 0" || light.name == "lamp 2" || light.name == "lamp 4";
      EXPECT_EQ(light.texels, (cube ? 6 : 1) * int64_t{light.resolution} * light.resolution) << light.name;
      sum += light.texels;
    }
    return sum;
  };
  EXPECT_EQ(texels_of(found.best), found.best.texels);
  EXPECT_LE(found.best.texels, budget);
  EXPECT_LE(texels_of(found.equal), budget);
  EXPECT_LT(found.best.error, 0.7 * found.equal.error);
  for (const LightShare& light : found.best.lights) {
    if (light.name != "cellar") continue;
    EXPECT_EQ(light.resolution, 0) << "its light reaches nothing that is seen";
    EXPECT_EQ(light.weight, 0);
    EXPECT_EQ(light.without, 0);
  }
  // The experiment that it writes is that frame.
  Experiment written = parse_experiment(budget_experiment(found, folder), path);
  EXPECT_TRUE(written.lights);
  size_t part = 0;
  for (const LightShare& light : found.best.lights) {
    if (light.resolution == 0) continue;
    const Settings& settings = written.parts.at(part++).base;
    EXPECT_EQ(settings.light.name, light.name);
    EXPECT_EQ(settings.map.resolution, light.resolution);
    EXPECT_EQ(settings.bias["constant"], light.settings.bias["constant"]);
  }
  EXPECT_EQ(part, written.parts.size());
  expect_refused(ErrorKind::usage, {"takes 114688"},
                 [&] { divide_texels(bench, lights, 1000, [](const std::string&) {}); });
}

TEST_F(LightsRun, ASharedRunIsRefused) {
  Experiment experiment = parse_experiment("scene = \"lab\"\nlights = [\"sun\", \"lamp\"]\n", path);
  SweepOptions options{.command = "test", .quiet = true};
  options.shard = Shard{1, 2};
  EXPECT_THROW(run_sweep(experiment, ResultsFolder(folder + "/out", experiment.path), options), Error);
}

}  // namespace
}  // namespace noonmark
