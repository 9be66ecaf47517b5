// The report opens at one bias: where it recommends one, with the point's picture at that bias.
#include "app/sweep/recommended_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "app/advise/recommend_judge.h"
#include "app/definition/experiment_file.h"
#include "app/pictures/pictures.h"
#include "app/sweep/judging.h"
#include "app/sweep/sweep.h"
#include "base/file.h"
#include "compare/judge/curve_reading.h"
#include "compare/judge/recommendation.h"
#include "compare/report/opening.h"
#include "compare/results/point_settings.h"
#include "compare/results/quantities.h"
#include "tests/app/read_image.h"
#include "tests/compare/report/browser.h"
#include "tests/support/measured.h"
#include "tests/support/sample_results.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

class RecommendedPicture : public Browser {
 protected:
  SweepOutcome run(const std::string& more = "", const std::string& pictures = "first") {
    const Experiment experiment = parse_experiment("times = false\npictures = \"" + pictures + "\"\n" + R"(
[scene]
name = "cube-room"
[view]
width_px = 96
height_px = 54
[map]
resolution = 256
)" + more,
                                                   folder.file("x.toml"));
    return run_sweep(experiment, ResultsFolder(out, experiment.path), {.command = "test", .quiet = true});
  }
  static std::vector<PictureRecord> at_bias(const PointRecord& point) {
    std::vector<PictureRecord> found;
    for (const PictureRecord& picture : point.pictures)
      if (report::bias_in_name(picture.name)) found.push_back(picture);
    return found;
  }
  std::set<std::string> files() const {
    std::set<std::string> found = files_in(out + "/images");
    std::erase_if(found, [](const std::string& name) { return name.find("recommended") == name.npos; });
    return found;
  }
  TemporaryFolder folder;
  const std::string out = folder.file("out");
};

const std::set<std::string> both{"p0000-recommended-classes.png", "p0000-recommended-map.png"};

TEST_F(RecommendedPicture, IsThePointRenderedAtThatBiasWithTheErrorOfTheCurve) {
  const Results results = run().results;
  const Recommendation found = recommend(results);
  ASSERT_TRUE(found.bias);
  ASSERT_FALSE(found.bias->as_set);
  const PointRecord& point = results.points.at(0);
  const std::vector<PictureRecord> pictures = at_bias(point);
  ASSERT_EQ(pictures.size(), 2u);
  EXPECT_EQ(report::bias_in_name(pictures[0].name)->picture, "map");
  EXPECT_EQ(report::bias_in_name(pictures[1].name)->picture, "classes");
  for (const PictureRecord& picture : pictures)
    EXPECT_EQ(report::bias_in_name(picture.name)->bias, found.bias->value) << picture.name << " says it exactly";
  EXPECT_EQ(files(), both);

  Workbench bench(gl::DebugMode::fatal);
  Settings settings = settings_of(point);
  // The same curve with an entry at that bias, so that nothing is read between two entries.
  const double depth = found.bias->value / parameter_per_depth(point);
  const double of_curve = bench.measure(settings, CurveOptions{{}, {0, depth}}).record.curve->error.at(1);
  find_setting(found.bias->parameter).set(settings, fmt::format("{}", found.bias->value));
  const Measurement m = bench.measure(settings, std::nullopt);
  EXPECT_DOUBLE_EQ(m.record.metrics.at("error"), of_curve);
  EXPECT_GT(of_curve, 0) << "a picture without an error tests nothing";
  EXPECT_NE(m.record.metrics.at("error"), point.metrics.at("error")) << "the bias as set is another one";
  EXPECT_EQ(read_png(out + "/" + pictures[0].path).pixels, shown_picture(m).pixels);
  EXPECT_EQ(read_png(out + "/" + pictures[1].path).pixels, causes_picture(m).pixels);
}

TEST_F(RecommendedPicture, IsKeptByALaterRunAndReplacedWithTheBias) {
  const PictureRecord first = at_bias(run().results.points.at(0)).at(0);
  const auto written = fs::last_write_time(out + "/" + first.path);
  const SweepOutcome again = run();
  EXPECT_EQ(again.measured, 0);
  EXPECT_EQ(at_bias(again.results.points.at(0)).at(0).name, first.name);
  EXPECT_EQ(fs::last_write_time(out + "/" + first.path), written) << "what is there is not drawn again";

  const Results other = run("[curve]\nacne_bound = 0.05\npeter_panning_bound = 1e-5\n").results;
  const std::vector<PictureRecord> now = at_bias(other.points.at(0));
  ASSERT_EQ(now.size(), 2u);
  EXPECT_NE(now[0].name, first.name) << "another window has another bias";
  EXPECT_EQ(report::bias_in_name(now[0].name)->bias, recommend(other).bias->value);
  EXPECT_NE(now[0].digest, first.digest);

  // A broken bound is judged, and shown, with the bias as set.
  EXPECT_TRUE(at_bias(run("[[bound]]\nmetric = \"error\"\nmax = 0\n").results.points.at(0)).empty());
  EXPECT_EQ(files(), std::set<std::string>{}) << "what is shown no more is removed";
  run();
  EXPECT_EQ(files(), both);
  run("", "none");
  EXPECT_EQ(files(), std::set<std::string>{});
}

TEST_F(RecommendedPicture, OpensThePageWithTheNumbersAtThatBias) {
  Results results = run().results;
  const double error =
      metric_at(results.points[0], "error", recommend(results).bias->value / parameter_per_depth(results.points[0]));
  open(read_file(out + "/report.html"), "opening_probe.js");
  if (IsSkipped() || HasFatalFailure()) return;
  EXPECT_EQ(saw_["opened"]["bias"], "recommended");
  EXPECT_EQ(saw_["opened"]["whole"], "map as recommended");
  EXPECT_FALSE(saw_["opened"]["canvas"]) << "the small live picture is not shown";
  const std::string facts = saw_["opened"]["facts"];
  EXPECT_NE(facts.find(", recommended · error " + fmt::format("{:.3g}\u202f%", 100 * error)), facts.npos) << facts;
  EXPECT_EQ(saw_["causes"]["whole"], "classes as recommended");
  EXPECT_EQ(saw_["truth"]["whole"], "truth");
  EXPECT_NE(saw_["set"]["facts"].get<std::string>().find(", as set · error "), std::string::npos);
  EXPECT_EQ(saw_["set"]["whole"], "truth");

  // A page shows the picture only while its bias is the recommended one: here a store says another one.
  for (PictureRecord& picture : results.points[0].pictures)
    if (const auto at = report::bias_in_name(picture.name))
      picture.name = report::name_at_bias(at->picture, std::nextafter(at->bias, 1));
  write_report(results, out);
  open(read_file(out + "/report.html"), "opening_probe.js");
  EXPECT_EQ(saw_["opened"]["bias"], "recommended") << "the live picture is at this bias too";
  EXPECT_EQ(saw_["opened"]["whole"], "");
  EXPECT_TRUE(saw_["opened"]["canvas"]);
  for (const std::string name : saw_["pictures"]) EXPECT_EQ(name.find("recommended"), name.npos) << name;
}

TEST(PictureAtABias, HasTheBiasInItsName) {
  for (const double bias : {0.0, 3.7, 1e-7, 0.1 + 0.2}) {
    const auto read = report::bias_in_name(report::name_at_bias("classes", bias));
    ASSERT_TRUE(read);
    EXPECT_EQ(read->picture, "classes");
    EXPECT_EQ(read->bias, bias);
  }
  for (const std::string_view name : picture_names) EXPECT_FALSE(report::bias_in_name(std::string(name))) << name;
  const auto edited = report::bias_in_name("map at noon");
  EXPECT_TRUE(edited && std::isnan(edited->bias)) << "no bias is equal to it";
}

}  // namespace
}  // namespace noonmark
