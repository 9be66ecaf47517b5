// noonmark section: the file, the words and the mistakes.
#include <filesystem>
#include <string>
#include <vector>

#include "tests/program/fixture.h"

namespace noonmark::acceptance {
namespace {

class SectionVerb : public Program {
 protected:
  int section(const std::vector<std::string>& more) {
    return run(Words{"section", "--set", "view.width_px=96", "--set", "view.height_px=54"} + more);
  }
};

TEST_F(SectionVerb, DrawsTheWorstPixelAndSaysWhyItIsWrong) {
  ASSERT_EQ(section({"--out", "made/acne.svg"}), 0) << output_;
  EXPECT_TRUE(says("in the middle of the largest patch of acne, the largest cause of error: ")) << output_;
  EXPECT_TRUE(says("Acne (too dark)")) << output_;
  EXPECT_TRUE(says("more bias would light the tap")) << output_;
  const std::string svg = text("made/acne.svg");
  EXPECT_NE(svg.find("data-cause=\"acne\""), std::string::npos);
  EXPECT_NE(svg.find("prefers-color-scheme:dark"), std::string::npos);
}

TEST_F(SectionVerb, NamesTheOffsetOfTheCasters) {
  const std::vector<std::string> plane = {"--set", "scene.name=plane",        "--set", "scene.theta_deg=0",
                                          "--set", "bias.polygon_units=-1e6", "--set", "map.format=32f"};
  ASSERT_EQ(section(plane), 0) << output_;
  EXPECT_TRUE(says("casters are moved or offset before the map is drawn")) << output_;
  ASSERT_EQ(section({"--set", "scene.name=plane", "--overwrite"}), 0) << output_;
  EXPECT_TRUE(says("one depth stands for the whole texel")) << output_;
}

TEST_F(SectionVerb, SaysThatRoundingDecidesMuchOfThePicture) {
  ASSERT_EQ(section({"--set", "scene.move_m=1e7,0,0"}), 0) << output_;
  EXPECT_TRUE(says("note: the truth of ") && says("have no area there")) << output_;
}

TEST_F(SectionVerb, DrawsTheSameFileTwice) {
  ASSERT_EQ(section({"--pixel", "40,30"}), 0) << output_;
  const std::string once = text("section.svg");
  ASSERT_EQ(section({"--pixel", "40,30", "--overwrite", "--threads", "1"}), 0) << output_;
  EXPECT_EQ(text("section.svg"), once);
}

// Some pixels of this picture alias; nearly all of its error is Peter Panning.
TEST_F(SectionVerb, ExplainsTheLargestCauseWithoutAWish) {
  ASSERT_EQ(section({"--set", "bias.constant=0.15"}), 0) << output_;
  EXPECT_TRUE(says("the largest patch of peter_panning")) << output_;
  EXPECT_TRUE(says("Peter Panning (too light)")) << output_;
}

TEST_F(SectionVerb, DrawsThePixelThatIsWorstByAMetric) {
  ASSERT_EQ(section({"--set", "bias.constant=0.15", "--worst", "peter_panning", "--theme", "light"}), 0) << output_;
  EXPECT_TRUE(says("the pixel with the largest peter_panning")) << output_;
  EXPECT_TRUE(says("Peter Panning (too light)")) << output_;
  EXPECT_EQ(text("section.svg").find("var("), std::string::npos);
}

TEST_F(SectionVerb, KeepsAFileThatIsThere) {
  ASSERT_EQ(section({"--pixel", "40,30"}), 0) << output_;
  EXPECT_EQ(section({"--pixel", "40,31"}), 2);
  EXPECT_TRUE(says("section.svg is there already; choose another --out, or pass --overwrite")) << output_;
}

TEST_F(SectionVerb, RefusesWhatIsNoPixel) {
  EXPECT_EQ(section({"--pixel", "40"}), 2);
  EXPECT_TRUE(says("--pixel 40 is no pixel; give its column and its row")) << output_;
  EXPECT_EQ(section({"--pixel", "40,30,2"}), 2);
  EXPECT_EQ(section({"--pixel", "96,0"}), 2);
  EXPECT_TRUE(says("pixel 96,0 lies outside the picture, whose pixels are 0,0 (top left) to 95,53")) << output_;
  EXPECT_EQ(section({"--pixel", "40,30", "--worst", "acne"}), 2);
  EXPECT_TRUE(says("--pixel and --worst both choose the pixel")) << output_;
  EXPECT_EQ(section({"--out", "section.png"}), 2);
  EXPECT_TRUE(says("section.png does not end in .svg")) << output_;
  EXPECT_EQ(section({"--worst", "acme"}), 2);
  EXPECT_TRUE(says("acne")) << output_;
  EXPECT_EQ(section({"--worst", "undecided"}), 2);
  EXPECT_TRUE(says("no pixel of this picture has any undecided")) << output_;
  EXPECT_EQ(section({"--worst", "map_used"}), 2);
  EXPECT_TRUE(says("map_used is a number of the whole picture, of no pixel")) << output_;
  EXPECT_FALSE(fs::exists(folder_ / "section.svg"));
}

}  // namespace
}  // namespace noonmark::acceptance
