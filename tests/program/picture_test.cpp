// render --picture: a picture that another program made is judged in place of R5. Here the "other program" is a
// measurement of the same point in this process, changed as each test needs it.
#include <limits>
#include <nlohmann/json.hpp>

#include "app/pictures/image_file.h"
#include "tests/program/fixture.h"
#include "tests/support/measured.h"

namespace noonmark::acceptance {
namespace {

constexpr int width = 160, height = 90;

class GivenPicture : public Program {
 protected:
  // The point without a picture: its R5 and what is counted.
  void measure(const std::string& filter) {
    filter_ = filter;
    Workbench bench(gl::DebugMode::off);
    Settings settings = small("cube-room", width, height);
    find_setting("filter.kind").set(settings, filter);
    const Measurement m = bench.measure(settings, {});
    ladder_ = m.ladder;
    metrics_ = m.record.metrics;
  }
  std::string exr(const Image<float>& picture) {
    write_exr((folder_ / "engine.exr").string(), {{"Y", picture}});
    return "engine.exr";
  }
  int render(const std::string& picture) {
    return run({"render", "--set", "scene.name=cube-room", "--set", "view.width_px=160", "--set", "view.height_px=90",
                "--set", "filter.kind=" + filter_, "--picture", picture, "--out", "out"});
  }
  nlohmann::json point() const { return nlohmann::json::parse(text("out/point.json")); }

  std::string filter_ = "none";
  Ladder ladder_;
  std::map<std::string, double> metrics_;
};

TEST_F(GivenPicture, ThatEqualsR5AddsNothing) {
  measure("box");
  ASSERT_GT(metrics_.at("error"), 0.1);
  ASSERT_EQ(render(exr(ladder_.shown())), 0) << output_;
  const nlohmann::json json = point();
  EXPECT_EQ(json.at("metrics").at("elsewhere"), 0);
  for (const char* name : {"error", "wrong", "acne", "filter", "aliasing", "precision", "shaded_rmse", "residual"})
    EXPECT_EQ(json.at("metrics").at(name), metrics_.at(name)) << name;
  EXPECT_EQ(json.at("rungs").back(), "R6");
  EXPECT_EQ(json.at("rungs").size(), 7u);
  EXPECT_EQ(json.at("causes").back(), "elsewhere");
  EXPECT_EQ(json.at("rungs_on_top").at(0).at("cause"), "elsewhere");
  EXPECT_FALSE(json.contains("bias_curve"));
  EXPECT_TRUE(says("R6 is judged in place of R5")) << output_;
  EXPECT_TRUE(says("the causes other than elsewhere are those of the settings' technique (R0 to R5)")) << output_;
  EXPECT_TRUE(says("elsewhere" + std::string(27, ' ') + "0.00000%")) << output_;
}

TEST_F(GivenPicture, WithABlockOfWrongPixelsHasThatShareElsewhere) {
  measure("none");
  Image<float> picture = ladder_.shown();
  const auto whole_block = [&](int left, int top) {
    for (int y = top; y < top + 6; ++y)
      for (int x = left; x < left + 8; ++x)
        if (!is_counted(ladder_, picture.index(x, y)) || ladder_.truth().at(x, y) != picture.at(x, y)) return false;
    return true;
  };
  int left = -1, top = -1;
  for (int y = 0; y + 6 <= height && left < 0; ++y)
    for (int x = 0; x + 8 <= width && left < 0; ++x)
      if (whole_block(x, y)) left = x, top = y;
  ASSERT_GE(left, 0) << "no block of 8 x 6 pixels is right at R5";
  for (int y = top; y < top + 6; ++y)
    for (int x = left; x < left + 8; ++x) picture.at(x, y) = 1 - picture.at(x, y);
  ASSERT_EQ(render(exr(picture)), 0) << output_;
  const nlohmann::json json = point();
  EXPECT_EQ(json.at("metrics").at("elsewhere"), 48 / metrics_.at("counted"));
  EXPECT_DOUBLE_EQ(json.at("metrics").at("error").get<double>(), metrics_.at("error") + 48 / metrics_.at("counted"));
  EXPECT_EQ(json.at("metrics").at("acne"), metrics_.at("acne")) << "the rungs below must stay";
  EXPECT_LE(json.at("metrics").at("residual").get<double>(), 1e-6);
}

TEST_F(GivenPicture, MayBeAPngWhoseValuesAreTakenAsTheyAre) {
  measure("none");
  Image<Color> grey(width, height);
  for (size_t i = 0; i < grey.size(); ++i) grey[i] = Color(static_cast<uint8_t>(255 * ladder_.truth()[i]));
  write_png((folder_ / "truth.png").string(), grey);
  ASSERT_EQ(render("truth.png"), 0) << output_;
  EXPECT_EQ(point().at("metrics").at("error"), 0);
  EXPECT_EQ(point().at("metrics").at("wrong"), 0);
  EXPECT_EQ(point().at("metrics").at("elsewhere"), metrics_.at("error"));
  for (Color& color : grey.pixels) color = Color(51);  // 0.2 as a number, 0.03 as sRGB
  write_png((folder_ / "fifth.png").string(), grey);
  ASSERT_EQ(render("fifth.png"), 0) << output_;
  const double lit = metrics_.at("lit");
  EXPECT_NEAR(point().at("metrics").at("error").get<double>(), 0.8 * lit + 0.2 * (1 - lit), 1e-6);
}

TEST_F(GivenPicture, MayHaveAnAlphaChannelThatIsOneEverywhere) {
  measure("none");
  const Image<float>& grey = ladder_.shown();
  Image<float> alpha(width, height, 1);
  const auto with_alpha = [&](const std::string& file, const std::vector<const char*>& colours) {
    std::vector<Channel> channels;
    for (const char* name : colours) channels.push_back({name, grey});
    channels.push_back({"A", alpha});
    write_exr((folder_ / file).string(), channels);
    return render(file);
  };
  for (const std::vector<const char*>& colours : {std::vector<const char*>{"Y"}, {"R", "G", "B"}}) {
    ASSERT_EQ(with_alpha("alpha.exr", colours), 0) << output_;
    EXPECT_EQ(point().at("metrics").at("elsewhere"), 0);
    EXPECT_EQ(point().at("metrics").at("error"), metrics_.at("error"));
  }
  alpha.at(5, 5) = 0.5f;
  for (const std::vector<const char*>& colours : {std::vector<const char*>{"Y"}, {"R", "G", "B"}}) {
    EXPECT_EQ(with_alpha("alpha.exr", colours), 3) << output_;
    EXPECT_TRUE(says("alpha.exr: has an alpha channel that is not 1 everywhere; remove the alpha channel")) << output_;
  }
}

TEST_F(GivenPicture, OfAnExperimentWithBoundsSaysWhoJudgesThem) {
  measure("none");
  write("bound.toml", "[view]\nwidth_px = 160\nheight_px = 90\n[[bound]]\nmetric = \"error\"\nmax = 0.5\n");
  const std::string note = "render judges no bounds and no laws; noonmark check does";
  ASSERT_EQ(run({"render", "bound.toml", "--picture", exr(ladder_.shown()), "--out", "out"}), 0) << output_;
  EXPECT_TRUE(says(note)) << output_;
  ASSERT_EQ(render("engine.exr"), 0) << output_;
  EXPECT_FALSE(says(note)) << output_;
}

TEST_F(GivenPicture, ThatCannotBeJudgedEndsWithOneError) {
  const auto refused = [&](const std::string& file, const std::vector<std::string>& words) {
    EXPECT_EQ(render(file), 3) << file << output_;
    EXPECT_TRUE(output_.starts_with("noonmark: " + file + ": ")) << output_;
    for (const std::string& word : words) EXPECT_TRUE(says(word)) << word << "\n" << output_;
    EXPECT_EQ(std::count(output_.begin(), output_.end(), '\n'), 1) << output_;
    EXPECT_FALSE(fs::exists(folder_ / "out")) << file << ": something was written";
  };
  const Image<float> whole(width, height, 1);
  const auto with = [&](float value) {
    Image<float> picture = whole;
    picture.at(7, 3) = value;
    return exr(picture);
  };
  const std::string place = "x = 7, y = 3 (row 0 on top) is ", remedy = "from 0 (shadowed) to 1 (lit)";
  refused(with(std::numeric_limits<float>::quiet_NaN()), {place + "nan", remedy});
  refused(with(std::numeric_limits<float>::infinity()), {place + "inf", remedy});
  refused(with(1.5f), {place + "1.5", remedy});
  refused(with(-0.25f), {place + "-0.25", remedy});
  refused(exr(Image<float>(width, height + 1, 1)), {"has 160 x 91 pixels", "160 x 90", "view.width_px"});
  write_exr((folder_ / "two.exr").string(), {{"Y", whole}, {"Z", whole}});
  refused("two.exr", {"has 2 channels", "one grey channel"});
  write_png((folder_ / "red.png").string(), Image<Color>(width, height, Color(255, 0, 0)));
  refused("red.png", {"has colours", "one grey channel"});
  for (const char* file : {"engine.exr", "red.png"}) {
    with(1);
    const std::string bytes = text(file);
    write("half", bytes.substr(0, bytes.size() / 2));
    for (const size_t length : {bytes.size() / 2, size_t{20}}) {
      write("half", bytes.substr(0, length));
      refused("half", {"cannot be decoded", "write it again"});
      for (const char* inside : {"picture.exr", "picture.png", ".;"}) EXPECT_FALSE(says(inside)) << output_;
    }
  }
  write("notes.png", "no picture");
  refused("notes.png", {"is neither a PNG nor an EXR"});
  refused("nowhere.exr", {"cannot be read", "check the path"});
  EXPECT_EQ(render(""), 2);
  EXPECT_TRUE(says("--picture")) << output_;
}

}  // namespace
}  // namespace noonmark::acceptance
