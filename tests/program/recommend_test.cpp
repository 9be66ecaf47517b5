// noonmark recommend: what it recommends holds where it was not searched, and it says so where nothing does.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/program/fixture.h"

namespace noonmark::acceptance {
namespace {

using nlohmann::json;

class Recommend : public Program {
 protected:
  int recommend(const std::string& what, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = {"recommend", what, "--quiet", "--out", "out"};
    for (const std::string& size :
         {"view.width_px=" + std::to_string(width_), "view.height_px=" + std::to_string(height_)})
      words.insert(words.end(), {"--set", size});
    if (std::find(more.begin(), more.end(), "--edges") == more.end() &&
        std::find(more.begin(), more.end(), "--patch") == more.end())
      words.insert(words.end(), any_eye_.begin(), any_eye_.end());
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }
  // Whether out/recommended.txt has this.
  bool tells(const char* words) { return text("out/recommended.txt").find(words) != std::string::npos; }
  json found() { return json::parse(text("out/recommended.json")); }
  std::string setting(const char* name) { return found()["answer"]["settings"][name]; }
  double bias() { return found()["answer"]["bias"]["value"]; }

  int width_ = 160, height_ = 90;  // pixels
  // In so small a picture a pixel is a large patch, and edges lie within few of them.
  const std::vector<std::string> any_eye_ = {"--edges", "100", "--patch", "100%"};
};

// The file is judged again at other placements of the grid and in views between those that were searched.
TEST_F(Recommend, WhatItWritesPassesWhereItWasNotSearched) {
  ASSERT_EQ(recommend("cube-room"), 0) << output_;
  EXPECT_TRUE(tells("Verified under the worst condition at 64 other placements, 16 of them rendered by OpenGL"))
      << output_;
  EXPECT_TRUE(says("Next: noonmark check out/recommended.toml")) << output_;
  const json first = found();
  EXPECT_EQ(first["answer"]["verified"]["conditions"], 5);
  const double low = first["answer"]["bias"]["from"], high = first["answer"]["bias"]["to"];
  EXPECT_GE(bias(), 1.05 * low);
  EXPECT_LE(bias(), high / 1.05);
  std::string experiment = text("out/recommended.toml");
  const size_t eyes = experiment.find("view.eye_m"), end = experiment.find('\n', eyes);
  ASSERT_NE(eyes, std::string::npos) << experiment;
  experiment.replace(eyes, end - eyes, "view.eye_m = [[-2.9, 2.8, 5.6], [0.6, 2.8, 6.9]]");
  experiment.resize(experiment.find("[[bound]]  # for the eye"));  // they are about the given view
  write("between.toml", experiment);
  EXPECT_EQ(run({"check", "between.toml", "--set", "map.shift_u_texels=0.29", "--set", "map.shift_v_texels=0.41"}), 0)
      << output_;
  // The answer does not depend on what the machine does besides.
  ASSERT_EQ(recommend("cube-room", {"--threads", "1"}), 0) << output_;
  EXPECT_EQ(found(), first);
}

// The plates of `layers` leak, so its answer is a reduction. Without it, and with more than its window has, a bound breaks.
TEST_F(Recommend, AFilteredMapHoldsByItsReduction) {
  ASSERT_EQ(
      recommend("layers", {"--lookups", "vsm", "--views", "1", "--peter-panning", "0.015%", "--set",
                           "map.resolution=256", "--set", "scene.gap_m=0.3", "--set", "light.angular_diameter_deg=0"}),
      0)
      << output_;
  EXPECT_TRUE(says("VSM without a blur, and lookup.reduction = ")) << output_;
  EXPECT_TRUE(says("All answers keep leak (light where shadows overlap) and Peter Panning")) << output_;
  EXPECT_FALSE(says(" acne")) << output_;
  EXPECT_TRUE(tells("The error to expect is the larger of two")) << output_;
  EXPECT_EQ(found()["lookups"], json::array()) << "one was asked for";
  EXPECT_TRUE(tells("16 other placements, rendered by OpenGL")) << output_;
  EXPECT_NE(text("out/engines.txt").find("There are no lines for lookup.kind = vsm."), std::string::npos);
  const json answer = found()["answer"];
  EXPECT_EQ(answer["settings"]["lookup.kind"], "vsm");
  const double reduction = answer["reduction"]["value"], low = answer["reduction"]["from"],
               high = answer["reduction"]["to"];
  EXPECT_GT(low, 0);
  EXPECT_GE(reduction, low);
  EXPECT_LE(reduction, high);
  EXPECT_FALSE(answer.contains("bias"));
  EXPECT_GT(answer["verified"]["worst_reduction"], 0);
  EXPECT_LE(answer["verified"]["worst_leak"], 1.5e-4);
  const auto check = [&](const std::string& set) { return run({"check", "out/recommended.toml", "--set", set}); };
  EXPECT_EQ(check("lookup.reduction=" + std::to_string(reduction)), 0) << output_;
  EXPECT_EQ(check("lookup.reduction=0"), 1) << output_;
  EXPECT_TRUE(says("broken: leak <= 0.015%")) << output_;
  EXPECT_EQ(check("lookup.reduction=0.9"), 1) << output_;
  EXPECT_TRUE(says("broken: reduction <= 0.1%")) << output_;
}

// A sun outside of a closed room: no bias is too small there, and an answer would fail on the first lit surface. With bounds for the
// eye a leak along the room's edges breaks one first, which is no answer either.
TEST_F(Recommend, RefusesWhereNothingIsLitAndNamesWhatEnclosesTheLight) {
  for (const std::vector<std::string>& eye : {std::vector<std::string>{}, {"--edges", "1"}}) {
    if (!eye.empty()) width_ = 320, height_ = 180;  // in fewer pixels the leak is none
    std::vector<std::string> words = {"--set", "light.kind=directional", "--set", "light.position_m=9,20,3",
                                      "--set", "light.target_m=0,0,0"};
    words.insert(words.end(), eye.begin(), eye.end());
    EXPECT_EQ(recommend("point-room", words), 2) << output_;
    EXPECT_TRUE(says("in no view is anything lit")) << output_;
    EXPECT_TRUE(says("the light meets the mesh 'room' first on its way to 100% of it")) << output_;
    EXPECT_FALSE(says("Next: ")) << output_;
    EXPECT_FALSE(fs::exists(folder_ / "out/recommended.toml"));
  }
}

// What a search of lookups cannot be combined with is said.
TEST_F(Recommend, LookupsAreChosenByTheSearch) {
  EXPECT_EQ(recommend("layers", {"--lookups", "four_vsm"}), 2);
  EXPECT_EQ(recommend("layers", {"--lookups", "vsm,vsm"}), 2);
  EXPECT_TRUE(says("--lookups names 'vsm' twice")) << output_;
  EXPECT_EQ(recommend("layers", {"--lookups", "vsm", "--lookups", "esm,vsm"}), 2);
  EXPECT_TRUE(says("--lookups names 'vsm' twice")) << output_;
  for (const char* list : {"vsm,", ",vsm", "vsm,,esm"}) {
    EXPECT_EQ(recommend("layers", {"--lookups", list}), 2);
    EXPECT_TRUE(says("has a comma without a name beside it")) << output_;
  }
  EXPECT_EQ(recommend("layers", {"--lookups", "vsm", "--cascades"}), 2);
  EXPECT_TRUE(says("--lookups searches one map")) << output_;
  EXPECT_EQ(recommend("layers", {"--lookups", "vsm", "--set", "bias.constant=0.1"}), 2);
  EXPECT_TRUE(says("--lookups chooses the lookup, its blur and its bias itself")) << output_;
  EXPECT_EQ(recommend("layers", {"--set", "lookup.kind=vsm"}), 2);
  EXPECT_TRUE(says("name it with --lookups")) << output_;
  EXPECT_EQ(recommend("point-room", {"--lookups", "vsm"}), 2);
  EXPECT_TRUE(says("a point light's cube map")) << output_;
}

// A wide sun has soft shadows, which a filter comes nearer to. Under a sun without a size blur is an error.
TEST_F(Recommend, AFilterOnlyWhereTheLightHasASize) {
  ASSERT_EQ(recommend("cube-room", {"--views", "1", "--set", "light.angular_diameter_deg=0"}), 0) << output_;
  EXPECT_EQ(setting("filter.kind"), "none");
  ASSERT_EQ(recommend("cube-room", {"--views", "1", "--set", "light.angular_diameter_deg=4"}), 0) << output_;
  EXPECT_NE(setting("filter.kind"), "none");
}

TEST_F(Recommend, HoldsAnErrorWithTheLeastWork) {
  width_ = 112, height_ = 63;  // for its time: it is the longest search of all
  ASSERT_EQ(recommend("cube-room", {"--views", "1", "--error", "0.001"}), 0) << output_;
  EXPECT_LE(found()["answer"]["error"], 0.001);
  EXPECT_LE(found()["answer"]["verified"]["worst_error"], 0.001) << "at every placement that was judged";
  const double work = found()["answer"]["texel_work"];
  for (const json& other : found()["tried"])
    if (other.contains("error") && other["texel_work"] < work && other["error"] <= 0.001) {
      // What holds as far as is known is worse than the answer only by its cost.
      EXPECT_NE(other["why_not"].get<std::string>().rfind("it has", 0), 0u) << other.dump(1);
    }
}

TEST_F(Recommend, HoldsABudgetWithTheLeastError) {
  ASSERT_EQ(recommend("cube-room", {"--views", "1", "--budget", "500000"}), 0) << output_;
  EXPECT_LE(found()["answer"]["texel_work"], 500000);
}

// Each answer is judged again: what it promises holds, and so do the definitions of the three.
TEST_F(Recommend, GivesThreeAnswersBetweenCostAndError) {
  width_ = 240, height_ = 135;
  ASSERT_EQ(recommend("cube-room", {"--views", "1", "--edges", "1.5"}), 0) << output_;
  EXPECT_FALSE(says("No shadow map is needed")) << output_;
  EXPECT_TRUE(tells("so it removes 9")) << output_;
  const json all = found(), three = all["answers"];
  const auto number = [&](const char* answer, const char* name) { return three[answer][name].get<double>(); };
  for (const char* name : {"texel_work", "screened_error"}) EXPECT_GT(number("least", name), 0);
  EXPECT_LE(number("least", "texel_work"), number("balanced", "texel_work"));
  EXPECT_LT(number("least", "texel_work"), number("best", "texel_work")) << "the edges leave no one answer";
  EXPECT_LE(number("best", "texel_work"), 4 * number("least", "texel_work"));
  EXPECT_LT(number("best", "screened_error"), number("least", "screened_error"));
  EXPECT_EQ(all["answer"]["kind"], "least");
  for (const char* kind : {"least", "balanced", "best"}) {
    EXPECT_LE(three[kind]["eye"]["edge_displacement_p95_pixels"], 1.5);
    EXPECT_LE(three[kind]["eye"]["wrong_patch"], 0.0002);
    EXPECT_LE(three[kind]["verified"]["worst_acne"], 0.001);
  }
  // No cheaper one that holds comes near the balanced one.
  for (const json& other : all["tried"])
    if (other["texel_work"] < number("balanced", "texel_work") &&
        other["why_not"].get<std::string>().rfind("it has", 0) == 0) {
      EXPECT_GT(other["screened_error"], 1.5 * number("balanced", "screened_error")) << other.dump(1);
    }
  EXPECT_EQ(run({"check", "out/recommended.toml", "--out", "least"}), 0) << output_;
  EXPECT_TRUE(says("edge_displacement_p95_pixels <= 1.5") && says("wrong_patch <= 0.02%")) << output_;
  const bool same = three["balanced"] == three["best"];
  const std::string other = same ? "recommended-balanced" : "recommended-best";
  EXPECT_EQ(run({"check", "out/" + other + ".toml", "--out", "best"}), 0) << output_;
  EXPECT_TRUE(fs::exists(folder_ / "out" / (other + "-map.png")));
  // Another of the three is the same one when it is asked for.
  ASSERT_EQ(recommend("cube-room", {"--views", "1", "--edges", "1.5", "--answer", "best"}), 0) << output_;
  EXPECT_EQ(found()["answer"]["settings"], three["best"]["settings"]);
  EXPECT_EQ(found()["answers"]["least"]["settings"], three["least"]["settings"]);
  EXPECT_FALSE(fs::exists(folder_ / "out" / (other + ".toml"))) << "of the run before";
  EXPECT_EQ(recommend("cube-room", {"--answer", "bset"}), 2) << output_;
  EXPECT_TRUE(says("best")) << output_;
}

// Edges that may lie further off are had with less texels.
TEST_F(Recommend, HoldsWhatTheEyeSees) {
  // A map of the casters alone has fine texels at the least resolution already.
  const std::vector<std::string> one = {
      "--views", "1",           "--set", "filter.kind=none", "--set", "bias.constant=0.1",
      "--set",   "bias.unit=m", "--set", "map.extent_m=20"};
  const auto texels = [&](const std::string& edges) {
    std::vector<std::string> words = one;
    words.insert(words.end(), {"--edges", edges});
    EXPECT_EQ(recommend("cube-room", words), 0) << output_;
    return std::stoi(setting("map.resolution"));
  };
  const int coarse = texels("3"), fine = texels("0.5");
  EXPECT_LT(coarse, fine);
  std::vector<std::string> words = one;
  words.insert(words.end(), {"--patch", "0.00001%", "--set", "map.resolution=256"});
  EXPECT_EQ(recommend("cube-room", words), 1) << output_;
  EXPECT_TRUE(says("of the picture is wrong")) << output_;
}

// What an experiment leaves open is searched as if the file did not give it.
TEST_F(Recommend, ChoosesWhatAnExperimentLeavesOpen) {
  const std::string scene =
      "scene = \"plate\"\n[bias]\nunit = \"texel\"\nconstant = 0.25\n[filter]\nkind = \"box\"\nsize = 7\n"
      "[map]\nfit = \"tight\"\nextent_m = 200\n[sweep]\nmap.resolution = [64, 128]\n";
  write("free.toml", scene + "[answer]\nchoose = [\"map.resolution\", \"map.fit\", \"bias\", \"filter\"]\n");
  width_ = 96, height_ = 54;
  ASSERT_EQ(recommend("plate", {"--views", "1"}), 0) << output_;
  const json alone = found()["answers"];
  ASSERT_EQ(recommend("free.toml", {"--views", "1"}), 0) << output_;
  EXPECT_EQ(found()["answers"], alone) << "the same conditions, the same answer";
  EXPECT_FALSE(says("bias.constant = 0.25")) << output_;
  // The command line has the last word.
  ASSERT_EQ(recommend("free.toml", {"--views", "1", "--set", "map.resolution=1024"}), 0) << output_;
  EXPECT_EQ(setting("map.resolution"), "1024");
  EXPECT_TRUE(says("map.resolution = 1024. For the scene alone it can be another one.")) << output_;
  write("tied.toml", scene);
  ASSERT_EQ(recommend("tied.toml",
                      {"--views", "1", "--edges", "100", "--patch", "100%", "--acne", "5%", "--peter-panning", "5%"}),
            0)
      << output_;
  EXPECT_EQ(setting("filter.kind"), "box");
  EXPECT_EQ(setting("map.extent_m"), "200");
}

TEST_F(Recommend, NothingWorksIsAnAnswerWithAReason) {
  const std::vector<std::string> one = {
      "--views", "1", "--set", "map.resolution=256", "--set", "filter.kind=none", "--set", "bias.constant=0.1"};
  ASSERT_EQ(recommend("cube-room", one), 0) << output_;
  EXPECT_EQ(setting("map.resolution"), "256");
  std::vector<std::string> exact = one;
  exact.insert(exact.end(), {"--error", "0"});
  ASSERT_EQ(recommend("cube-room", exact), 1) << output_;
  EXPECT_TRUE(says("Nothing that was tried keeps")) << output_;
  EXPECT_TRUE(says("What would have to change")) << output_;
  EXPECT_TRUE(found()["answer"].is_null());
  for (const char* stale : {"out/recommended.toml", "out/engines.txt", "out/recommended-map.png"})
    EXPECT_FALSE(std::filesystem::exists(folder_ / stale)) << stale << " of the run before must not stay";
}

// The conditions and the bias of an experiment are kept; its choices are searched.
TEST_F(Recommend, KeepsTheBiasAndTheConditionsOfAnExperiment) {
  write("mine.toml",
        "scene = \"plate\"\n[bias]\nunit = \"texel\"\ntan = 0.5\n[over]\nview.fov_deg = [30, 40]\n"
        "[sweep]\nmap.resolution = [64, 128]\n");
  width_ = 96, height_ = 54;
  ASSERT_EQ(recommend("mine.toml"), 0) << output_;
  EXPECT_EQ(found()["answer"]["bias"]["parameter"], "bias.tan");
  EXPECT_EQ(found()["answer"]["verified"]["conditions"], 2);
  for (const char* relied : {"format = \"24\"", "cull = \"none\"", "extent_m = ", "kind = ", "wrap = "})
    EXPECT_NE(text("out/recommended.toml").find(relied), std::string::npos)
        << "a default that the answer relies on: " << relied;
  EXPECT_EQ(run({"check", "out/recommended.toml", "--out", "checked"}), 0) << output_;
  EXPECT_FALSE(says("note: ")) << "nothing of it is set in vain: " << output_;
  EXPECT_EQ(found()["engines"].size(), 8u);
  EXPECT_NE(text("out/engines.txt").find("% with these lines (recommended: "), std::string::npos);
}

// three.js's map has no reduction to choose: what the engine has fields for is searched, and the lines give what was found. Text, JSON
// and the written experiment say what became of the other lookup.
TEST_F(Recommend, ThreesOwnMapIsSearchedOverItsFields) {
  ASSERT_EQ(recommend("layers", {"--lookups", "three_vsm,babylon_esm", "--views", "1", "--acne", "0.15%", "--lines",
                                 "three", "--set", "map.resolution=512"}),
            0)
      << output_;
  EXPECT_TRUE(says("VSMShadowMap of three.js with ")) << output_;
  EXPECT_TRUE(says("renderer.shadowMap.type = THREE.VSMShadowMap;")) << output_;
  EXPECT_TRUE(says("measured with map.moments = 16f")) << output_;
  const json advice = found(), answer = advice["answer"];
  EXPECT_EQ(answer["settings"]["lookup.reduction"], "0.3");
  EXPECT_FALSE(answer.contains("reduction"));
  const json three = advice["engines"][0];
  EXPECT_EQ(three["promise"]["error"], answer["error"]);
  EXPECT_NEAR(three["promise"]["reduction"].get<double>(), answer["verified"]["worst_reduction"].get<double>(), 1e-3);
  ASSERT_EQ(advice["lookups"].size(), 2u);
  EXPECT_EQ(advice["lookups"][0]["outcome"], "answer");
  const json other = advice["lookups"][1];
  EXPECT_EQ(other["lookup"], "babylon_esm");
  EXPECT_NE(other["outcome"], "answer");
  const std::string why = other["why"];
  EXPECT_FALSE(why.empty());
  EXPECT_TRUE(says("  babylon_esm: ") && says(why.c_str())) << output_;
  EXPECT_NE(text("out/recommended.toml").find(why), std::string::npos);
  EXPECT_EQ(run({"check", "out/recommended.toml"}), 0) << output_;
}

// What recommend says is what the report of its file says: the bias in the file.
TEST_F(Recommend, TheReportOfItsAnswerSpeaksOfItsBias) {
  width_ = 96, height_ = 54;
  ASSERT_EQ(recommend("cube-room", {"--views", "2", "--acne", "0.5%", "--peter-panning", "0.5%"}), 0) << output_;
  ASSERT_EQ(run({"check", "out/recommended.toml", "--json", "--quiet", "--out", "judged"}), 0) << output_;
  const json answer = json::parse(output_).at("experiments").at(0).at("answer");
  EXPECT_EQ(answer.at("bias").at("value"), bias());
  EXPECT_EQ(answer.at("bias").at("as_set"), true);
  EXPECT_EQ(answer.at("bias").at("parameter"), found()["answer"]["bias"]["parameter"]);
  const std::string page = text("judged/report.html");
  EXPECT_NE(page.find("Held: your bias"), std::string::npos);
  EXPECT_NE(page.find("What is set is good enough under all 2 conditions"), std::string::npos);
}

TEST_F(Recommend, PrintsTheLinesOfOneEngine) {
  width_ = 96, height_ = 54;
  const std::vector<std::string> quick = {"--views", "1", "--acne", "5%", "--peter-panning", "5%"};
  ASSERT_EQ(recommend("plate", quick), 0) << output_;
  EXPECT_FALSE(says("renderer.shadowMap.enabled") || says("new BABYLON.ShadowGenerator")) << output_;
  EXPECT_TRUE(says("Lines for three.js (three), Babylon.js (babylon), ") && says("out/engines.txt, or --lines NAME"))
      << output_;
  EXPECT_NE(text("out/engines.txt").find("new BABYLON.ShadowGenerator"), std::string::npos);
  EXPECT_TRUE(says("bounds: the options")) << output_;
  EXPECT_NE(text("out/recommended.txt").find("That is the answer"), std::string::npos);
  std::vector<std::string> other = quick;
  other.insert(other.end(), {"--lines", "babylon"});
  ASSERT_EQ(recommend("plate", other), 0) << output_;
  EXPECT_TRUE(says("What to type into Babylon.js (") && says("new BABYLON.ShadowGenerator")) << output_;
  EXPECT_FALSE(says("renderer.shadowMap.enabled")) << output_;
  EXPECT_EQ(recommend("plate", {"--lines", "babilon"}), 2);
  EXPECT_TRUE(says("babylon")) << output_;
}

// One number for all cascades is too much for the near ones: what holds here does not hold in such an engine.
TEST_F(Recommend, HoldsInTheEngineThatItIsFor) {
  width_ = 320, height_ = 180;
  const auto for_engine = [&](const std::vector<std::string>& more) {
    std::vector<std::string> options = {"--views", "1", "--edges", "9", "--patch", "1"};
    for (const char* set : {"cascades.count=3", "cascades.splits=manual", "cascades.bounds_m=6,20", "map.reach_m=78",
                            "map.fit=sphere", "map.snap=true", "map.resolution=1024", "filter.kind=none"})
      options.insert(options.end(), {"--set", set});
    options.insert(options.end(), more.begin(), more.end());
    return recommend("street", options);
  };
  const auto of_engine = [&](const std::string& name) {
    const nlohmann::json engines = found()["engines"];
    return *std::find_if(engines.begin(), engines.end(), [&](const auto& one) { return one["engine"] == name; });
  };
  ASSERT_EQ(for_engine({}), 0) << output_;
  EXPECT_FALSE(of_engine("three.js").contains("broken"));
  EXPECT_GT(of_engine("three.js")["promise"]["error"], 0);
  EXPECT_NE(of_engine("Bevy")["broken"].get<std::string>().find("Peter Panning"), std::string::npos);
  ASSERT_EQ(for_engine({"--for", "three"}), 0) << output_;
  EXPECT_TRUE(says("with the lines of three.js too")) << output_;
  // With one constant bias Bevy does not hold it; with its normal bias, in texels of each cascade, it does.
  ASSERT_EQ(for_engine({"--for", "bevy"}), 0) << output_;
  EXPECT_FALSE(of_engine("Bevy").contains("broken"));
  EXPECT_GT(std::stod(of_engine("Bevy")["settings"]["bias.normal_offset"].get<std::string>()), 0);
  EXPECT_EQ(for_engine({"--for", "bevy, three", "--set", "bias.constant=2"}), 1) << output_;
  EXPECT_TRUE(says("in Bevy these lines are not an answer: Peter Panning")) << output_;
  EXPECT_TRUE(says("without --for and --engine these settings hold")) << output_;
  EXPECT_EQ(for_engine({"--for", "unreal"}), 2);
  EXPECT_EQ(for_engine({"--for", "godot"}), 2);
  EXPECT_TRUE(says("the engine lays 2, 4 cascades, and cascades.count = 3; choose another")) << output_;
}

// A model and the experiment that init writes for it have one folder. Another model of the same name does not take it.
TEST_F(Recommend, AModelsFolderIsNamedAfterItsFile) {
  ASSERT_EQ(run({"export", "plate", "--out", "a/model.glb"}), 0) << output_;
  ASSERT_EQ(run({"export", "wall", "--out", "b/model.glb"}), 0) << output_;
  std::vector<std::string> quick = {"--quiet", "--views", "1", "--edges", "100", "--patch", "100%"};
  for (const char* set : {"view.width_px=96", "view.height_px=54", "filter.kind=none"})
    quick.insert(quick.end(), {"--set", set});
  const auto answer = [&](const std::string& what) {
    std::vector<std::string> words = {"recommend", what};
    words.insert(words.end(), quick.begin(), quick.end());
    return run(words);
  };
  ASSERT_EQ(answer("a/model.glb"), 0) << output_;
  EXPECT_TRUE(fs::exists(folder_ / "out/recommend-model/recommended.toml")) << output_;
  const std::string before = text("out/recommend-model/recommended.json");
  EXPECT_EQ(answer("b/model.glb"), 2) << output_;
  EXPECT_TRUE(says("out/recommend-model: holds the recommendation for another scene") && says("a/model.glb"))
      << output_;
  EXPECT_EQ(text("out/recommend-model/recommended.json"), before);
  write("model.toml", "scene = \"a/model.glb\"\n");
  EXPECT_EQ(answer("model.toml"), 0) << "it is about the same model: " << output_;
  quick.insert(quick.end(), {"--out", "out/recommend-model"});
  EXPECT_EQ(answer("b/model.glb"), 0) << "who names a folder means it: " << output_;
}

TEST_F(Recommend, AnswersForOnePartOfAnExperiment) {
  write("parts.toml",
        "[map]\nresolution = 128\n[filter]\nkind = \"none\"\n[[part]]\nname = \"a\"\nscene = \"plate\"\n"
        "[[part]]\nname = \"b\"\nscene = \"wall\"\n[part.over]\nview.fov_deg = [30, 40]\n");
  ASSERT_EQ(recommend("parts.toml", {"--part", "b"}), 0) << output_;
  EXPECT_EQ(setting("scene.name"), "wall");
  EXPECT_EQ(setting("map.resolution"), "128");
  EXPECT_EQ(found()["answer"]["verified"]["conditions"], 2) << "those of the part";
}

// Settings that make no error are the cheapest ones that do, so nothing dearer is measured. No map at all does as well.
TEST_F(Recommend, SaysThatASceneWithoutShadowsNeedsNoMap) {
  ASSERT_EQ(run({"recommend", "plane", "--views", "1", "--out", "out", "--set", "view.width_px=240", "--set",
                 "view.height_px=135"}),
            0)
      << output_;
  EXPECT_TRUE(says("No shadow map is needed here")) << output_;
  EXPECT_GT(bias(), 0) << "what needs no bias here can need one with another rasteriser";
  EXPECT_EQ(setting("map.resolution"), "256");
  EXPECT_EQ(found()["tried"].size(), 0u);
}

TEST_F(Recommend, NamesThePixelTheCauseAndTheWaysOut) {
  ASSERT_EQ(
      recommend("cube-room", {"--views", "1", "--acne", "1e-7", "--peter-panning", "1e-7", "--set", "map.resolution=64",
                              "--set", "map.extent_m=20", "--set", "filter.kind=none", "--set", "bias.constant=0.1"}),
      1)
      << output_;
  EXPECT_TRUE(says("Its worst pixel is x = ")) << output_;
  EXPECT_TRUE(says("by acne.") || says("by peter_panning.")) << output_;
  EXPECT_TRUE(says(fmt::format("y = {} (row 0", found()["nearest"]["worst"]["y"].get<int>()))) << output_;
  EXPECT_GT(found()["wrong_without_shadows"], 0.01);
  for (const char* way :
       {"Larger bounds: from about --acne ", "Finer texels: a resolution above 64", "Another kind of bias"})
    EXPECT_TRUE(says(way)) << way << "\n" << output_;
  // What it says of the bounds is true.
  const size_t at = output_.find("--acne ");
  double acne = 0, peter_panning = 0;
  ASSERT_EQ(std::sscanf(output_.c_str() + at, "--acne %lf%% --peter-panning %lf%%", &acne, &peter_panning), 2)
      << output_;
  EXPECT_EQ(recommend("cube-room", {"--views", "1", "--acne", fmt::format("{}%", 1.01 * acne), "--peter-panning",
                                    fmt::format("{}%", 1.01 * peter_panning), "--set", "map.resolution=64", "--set",
                                    "map.extent_m=20", "--set", "filter.kind=none", "--set", "bias.constant=0.1"}),
            0)
      << output_;
}

TEST_F(Recommend, RefusesWhatItCannotAnswer) {
  write("parts.toml", "[[part]]\nname = \"a\"\n[[part]]\nname = \"b\"\n");
  EXPECT_EQ(recommend("parts.toml"), 2);
  EXPECT_TRUE(says("parts.toml has 2 parts, and recommend answers for one: give --part NAME ('a', 'b')")) << output_;
  EXPECT_EQ(recommend("parts.toml", {"--part", "c"}), 2) << output_;
  EXPECT_EQ(recommend("no-such-scene"), 2) << output_;
  EXPECT_EQ(recommend("cube-room", {"--error", "2"}), 2) << output_;
  EXPECT_EQ(recommend("cube-room", {"--set", "view.target_m=0,100,0", "--set", "view.eye_m=0,90,0"}), 2) << output_;
}

}  // namespace
}  // namespace noonmark::acceptance
