// An experiment as the text of a file (--print-config): read again, it is the same experiment.
#include "app/definition/experiment_text.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <tuple>

#include "app/definition/definition.h"
#include "app/definition/experiment_file.h"
#include "app/definition/experiment_keys.h"
#include "base/error.h"
#include "tests/support/source_dir.h"

namespace noonmark {
namespace {

auto facts_of(const Bound& b) { return std::tuple(b.metric, b.max, b.min, b.where, b.join, b.placement, b.level); }
auto facts_of(const Law& l) {
  return std::tuple(l.name, l.says, l.found, l.measured, l.predicted, l.relation, l.within, l.slack, l.join, l.over,
                    l.where, l.against, l.let);
}
auto facts_of(const PhaseRequest& p, const CurveOptions& c) {
  return std::tuple(p.enabled, p.acne_bound.value_or(c.acne_bound),
                    p.peter_panning_bound.value_or(c.peter_panning_bound), p.placements, p.texel_sizes, p.width_px);
}

void expect_same(const Experiment& a, const Experiment& b) {
  EXPECT_EQ(fingerprint(a, {}), fingerprint(b, {}));
  EXPECT_EQ(std::tie(a.title, a.plot, a.cost, a.accuracy, a.choose, a.pictures, a.part),
            std::tie(b.title, b.plot, b.cost, b.accuracy, b.choose, b.pictures, b.part));
  EXPECT_EQ(facts_of(a.phase, a.curve), facts_of(b.phase, b.curve));
  ASSERT_EQ(a.bounds.size(), b.bounds.size());
  for (size_t i = 0; i < a.bounds.size(); ++i) EXPECT_EQ(facts_of(a.bounds[i]), facts_of(b.bounds[i]));
  ASSERT_EQ(a.laws.size(), b.laws.size());
  for (size_t i = 0; i < a.laws.size(); ++i) EXPECT_EQ(facts_of(a.laws[i]), facts_of(b.laws[i]));
  ASSERT_EQ(a.swept.size(), b.swept.size());
  for (size_t i = 0; i < a.swept.size(); ++i)
    EXPECT_EQ(std::tie(a.swept[i].name, a.swept[i].values, a.swept[i].condition),
              std::tie(b.swept[i].name, b.swept[i].values, b.swept[i].condition));
  ASSERT_EQ(a.parts.size(), b.parts.size());
  for (size_t i = 0; i < a.parts.size(); ++i) expect_same(a.parts[i], b.parts[i]);
}

TEST(ExperimentText, EveryExperimentComesBack) {
  const std::filesystem::path root = std::filesystem::path(noonmark::test::source_dir()) / "experiments";
  int read = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    if (entry.path().extension() != ".toml") continue;
    SCOPED_TRACE(entry.path());
    ++read;
    const Experiment experiment = load_experiment(entry.path().string());
    const std::string text = experiment_text(experiment);
    const Experiment again = parse_experiment(text, experiment.path);
    expect_same(again, experiment);
    EXPECT_EQ(experiment_text(again), text);
  }
  EXPECT_GE(read, 10);
}

TEST(ExperimentText, TextAndPathsComeBack) {
  for (const char* path : {"x.toml", "folder/x.toml", "/absolute/x.toml"}) {
    SCOPED_TRACE(path);
    const Experiment experiment = parse_experiment(
        "title = 'a \"b\" \\ ü'\nscene = \"../models/my \\\"house\\\".glb\"\n[over]\nview.eye_m = [[1, 2, 3], [4, 5, "
        "6e-9]]\n"
        "[sweep]\nbias.tan_cap = [1, \"auto\"]\nmap.format = [16, \"32f\"]\n[curve]\nbias_depth = [0, 1e-7, 0.1]\n"
        "[let]\na = 0.1\nb = \"2 * a\"\n[[law]]\nname = \"l\"\nmeasured = \"acne\"\nat_least = \"b\"\nwithin = 0.25\n"
        "where = {\"map.format\" = 16}\nagainst.map.format = \"32f\"\n[[bound]]\nmetric = \"aliasing*\"\nmin = 1e-300\n"
        "level = \"warn\"\nwhere.view.eye_m = [1, 2, 3]\n",
        path);
    expect_same(parse_experiment(experiment_text(experiment), path), experiment);
  }
}

TEST(ExperimentText, OverridesAndPartsAreInIt) {
  Experiment experiment = load_experiment(noonmark::test::source_dir() + "/experiments/techniques.toml");
  const std::string part = experiment.parts.at(1).part;
  choose_parts(experiment, {part});
  apply_override(experiment, "view.width_px=77");
  const Experiment again = parse_experiment(experiment_text(experiment), experiment.path);
  ASSERT_EQ(again.parts.size(), 1u);
  EXPECT_EQ(again.parts[0].part, part);
  EXPECT_EQ(points(again).at(0).view.width_px, 77);
}

// A `where` that no point meets any more is broken in a run, but a file that says so is refused.
TEST(ExperimentText, WhatNoFileCanSayIsRefused) {
  Experiment experiment = parse_experiment(
      "[sweep]\nmap.resolution = [64, 128]\n[[bound]]\nmetric = \"acne\"\nmax = 1\nwhere = {\"map.resolution\" = 64}\n",
      "x.toml");
  apply_override(experiment, "map.resolution=256");
  EXPECT_THROW(experiment_text(experiment), Error);
}

// Any legal value of any setting, fixed or swept.
RC_GTEST_PROP(ExperimentTextProperty, EveryValueComesBack, ()) {
  Experiment experiment;
  experiment.path = "x.toml";
  experiment.title = *rc::gen::container<std::string>(rc::gen::inRange<char>(1, 127));
  for (const Setting& row : settings_table()) {
    std::string text = row.get(experiment.base);
    if (row.type == ValueType::flag) text = *rc::gen::element<std::string>("true", "false");
    if (row.type == ValueType::integer)
      text = std::to_string(*rc::gen::inRange(static_cast<int>(row.min), static_cast<int>(row.max)));
    if (row.type == ValueType::real && std::isfinite(row.max)) {
      const double share = *rc::gen::inRange(0, 1 << 30) / static_cast<double>(1 << 30);
      text = std::to_string(row.min + (row.max - row.min) * share);
    }
    if (row.type == ValueType::point) text = std::to_string(*rc::gen::inRange(-9, 9)) + ",0.1,-1e-7";
    Experiment one = experiment;
    try {
      row.set(one.base, text);
      points(one);
    } catch (const Error&) {
      continue;  // it conflicts with a setting before it
    }
    if (*rc::gen::inRange(0, 8) == 0)
      experiment.swept.push_back({std::string(row.name), {row.get(one.base)}, *rc::gen::arbitrary<bool>()});
    experiment.base = one.base;
  }
  std::stable_partition(experiment.swept.begin(), experiment.swept.end(), [](const Swept& s) { return s.condition; });
  const Experiment again = parse_experiment(experiment_text(experiment), "x.toml");
  RC_ASSERT(fingerprint(again, {}) == fingerprint(experiment, {}));
  RC_ASSERT(again.title == experiment.title);
}

TEST(ExperimentDefinition, NamesScenesFromTheFolderOfTheExperiment) {
  EXPECT_EQ(scene_path_in("/home/ann/models/a.glb", "/home/ann/sets/x.toml"), "../models/a.glb");
  EXPECT_EQ(scene_path_in("/home/ann/sets/a.glb", "/home/ann/sets/x.toml"), "a.glb");
  EXPECT_EQ(scene_path_in("/data/a.glb", "/home/ann/sets/x.toml"),
            "/data/a.glb");  // the root alone is no common folder
  EXPECT_EQ(scene_path_in("/data/a.glb", "sets/x.toml"), "/data/a.glb");
  EXPECT_EQ(scene_path_in("sets/models/a.glb", "sets/x.toml"), "models/a.glb");
}

TEST(ExperimentDefinition, AMovedSceneIsWhatTheMovedFileNames) {
  const std::string text = "scene = \"../models/a.glb\"\n";
  for (const std::string from : {"/home/ann/sets/x.toml", "/srv/x.toml", "here/sets/x.toml"})
    for (const std::string to : {"/mnt/bob/sets/x.toml", "x.toml", "there/sets/x.toml"}) {
      SCOPED_TRACE(from + " to " + to);
      const auto scene_in = [&](const std::string& path) { return parse_experiment(text, path).base.scene.name; };
      EXPECT_EQ(moved_scene(scene_in(from), from, to), from == "/srv/x.toml" ? "/models/a.glb" : scene_in(to));
    }
  EXPECT_EQ(moved_scene("plate", "/home/ann/x.toml", "x.toml"), "plate");
}

TEST(ExperimentDefinition, HasNoFolderOfItsHost) {
  const std::string text = "scene = \"models/a.glb\"\n[[bound]]\nmetric = \"acne\"\nmax = 1\n";
  const std::string one = definition_text(parse_experiment(text, "/home/ann/x.toml"));
  const std::string other = definition_text(parse_experiment(text, "/mnt/bob/x.toml"));
  EXPECT_EQ(definition_path(one), "/home/ann/x.toml");
  EXPECT_EQ(without_host_path(one), without_host_path(other));
  EXPECT_EQ(without_host_path(one).find("/home"), std::string::npos);
  EXPECT_EQ(experiment_of(one, "x").base.scene.name, "/home/ann/models/a.glb");
}

TEST(Experiment, EveryFileInTheRepositoryIsGood) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(noonmark::test::source_dir() + "/experiments"))
    if (entry.path().extension() == ".toml") {
      EXPECT_GT(points(load_experiment(entry.path().string())).size(), 0u);
      ++files;
    }
  EXPECT_GT(files, 0);
}

// `cascades.count = 4` works by itself: a fit that nobody gave becomes one that cascades can have. One that is given stays.
TEST(ExperimentText, CascadesHaveAFitWhereNoneIsGiven) {
  using Texts = std::vector<std::string>;
  const auto parse = [](const std::string& toml) { return parse_experiment(toml, "folder/x.toml"); };
  const auto fits = [](const Experiment& e) {
    Texts texts;
    for (const Settings& settings : points(e)) texts.push_back(find_setting("map.fit").get(settings));
    return texts;
  };
  const std::string chosen(fit_of_cascades);
  EXPECT_EQ(fits(parse("cascades.count = 4")), Texts{chosen});
  EXPECT_EQ(fits(parse("cascades.count = 4\nmap.fit = \"view\"")), Texts{"view"});
  EXPECT_EQ(fits(parse("[sweep]\ncascades.count = [1, 4]")), (Texts{"scene", chosen}));
  EXPECT_EQ(fits(parse("[[part]]\nname = \"a\"\ncascades.count = 2\n[[part]]\nname = \"b\"")),
            (Texts{chosen, "scene"}));
  EXPECT_THROW(parse("cascades.count = 4\nmap.fit = \"scene\""), Error);
  EXPECT_THROW(parse("map.fit = \"scene\"\n[[part]]\nname = \"a\"\ncascades.count = 2"), Error);
  EXPECT_THROW(parse("cascades.count = 4\n[sweep]\nmap.fit = [\"scene\", \"view\"]"), Error);

  Experiment typed = parse("");
  EXPECT_FALSE(fits_cascades(typed));
  apply_override(typed, "cascades.count=4");
  EXPECT_TRUE(fits_cascades(typed));
  EXPECT_EQ(fits(typed), Texts{chosen});
  EXPECT_EQ(fits(parse_experiment(experiment_text(typed), typed.path)), Texts{chosen}) << "--print-config gives a fit";
  apply_override(typed, "map.fit=scene");
  EXPECT_FALSE(fits_cascades(typed));
  EXPECT_THROW(points(typed), Error);
}

// A new row is copied from a neighbour, and its member with it.
TEST(ExperimentKeys, EachFillsAMemberOfItsOwn) {
  Experiment experiment;
  FrameRequest frame;
  Bound bound;
  Law law;
  RangeOfValues range;
  for (const std::vector<ExperimentKey>& keys :
       {keys_of(experiment), plot_keys(experiment), answer_keys(experiment), curve_keys(experiment),
        keys_of(experiment.phase), keys_of(frame), keys_of(bound), keys_of(law), keys_of(range)}) {
    std::vector<ExperimentKey::Place> filled;
    for (const ExperimentKey& key : keys) {
      if (std::holds_alternative<std::monostate>(key.place)) continue;
      EXPECT_EQ(std::count(filled.begin(), filled.end(), key.place), 0) << key.name;
      filled.push_back(key.place);
    }
  }
}

}  // namespace
}  // namespace noonmark
