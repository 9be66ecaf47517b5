// noonmark map: the files, the words and the mistakes.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/program/fixture.h"

namespace noonmark::acceptance {
namespace {

class Map : public Program {
 protected:
  int map(const std::string& scene, const std::vector<std::string>& more = {}, const std::string& finest = "512",
          const std::string& placements = "2") {
    std::vector<std::string> words = {"map",          scene,
                                      "--from",       "64",
                                      "--to",         finest,
                                      "--rows",       "4",
                                      "--placements", placements,
                                      "--set",        "view.width_px=96",
                                      "--set",        "view.height_px=54",
                                      "--out",        "out"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }
};

TEST_F(Map, WritesThePageAndEveryNumber) {
  ASSERT_EQ(map("cube-room", {"--acne", "0.01", "--peter-panning", "0.01"}), 0) << output_;
  const std::string csv = text("out/phase.csv"), page = text("out/phase.html");
  const auto lines = std::count(csv.begin(), csv.end(), '\n');
  EXPECT_TRUE(csv.starts_with("resolution,texel_m,bias_m,error,"));
  EXPECT_EQ((lines - 1) % 4, 0) << "every texel size has the same biases";
  EXPECT_GT((lines - 1) / 4, 16 * 8) << "at least 16 biases an octave, over many octaves";
  for (const char* resolution : {"\n64,", "\n128,", "\n256,", "\n512,"})
    EXPECT_NE(csv.find(resolution), std::string::npos) << resolution;
  EXPECT_NE(page.find("id=\"chart-phase\""), std::string::npos);
  EXPECT_NE(page.find("noonmark render --set view.width_px=96"), std::string::npos);
  EXPECT_EQ(page.find("http-equiv=\"refresh\""), std::string::npos);
  EXPECT_TRUE(says("at every placement of the texel grid")) << output_;
  EXPECT_TRUE(says("a constant bias from ")) << output_;
}

// The numbers of a cell are those of the same point, rendered.
TEST_F(Map, ACellIsThePointThatItsCommandRenders) {
  ASSERT_EQ(map("cube-room", {"--set", "map.format=32f"}, "512", "1"), 0) << output_;
  const std::string csv = text("out/phase.csv");
  std::istringstream rows(csv.substr(csv.find("\n256,") + 1));
  std::string row;
  for (int i = 0; i < 120; ++i) std::getline(rows, row);
  std::vector<std::string> cells;
  std::istringstream fields(row);
  for (std::string cell; std::getline(fields, cell, ',');) cells.push_back(cell);
  ASSERT_EQ(cells.at(0), "256") << row;
  ASSERT_EQ(run({"render", "--set", "scene.name=cube-room", "--set", "view.width_px=96", "--set", "view.height_px=54",
                 "--set", "map.format=32f", "--set", "bias.unit=m", "--set", "map.resolution=256", "--set",
                 "bias.constant=" + cells.at(2), "--out", "point"}),
            0)
      << output_;
  const nlohmann::json metrics = nlohmann::json::parse(text("point/point.json")).at("metrics");
  EXPECT_NEAR(std::stod(cells.at(5)), metrics.at("acne").get<double>(), 1e-9);
  EXPECT_NEAR(std::stod(cells.at(7)), metrics.at("peter_panning").get<double>(), 1e-9);
  EXPECT_NEAR(std::stod(cells.at(9)), metrics.at("aliasing").get<double>(), 1e-9);
  EXPECT_NEAR(std::stod(cells.at(3)), metrics.at("error").get<double>(), metrics.at("precision").get<double>() + 1e-9);
}

// All placements of one point: what render prints of them, and the worst one rendered by itself.
TEST_F(Map, RenderPrintsWhatHoldsOverAllPlacements) {
  const std::vector<std::string> point = {
      "render",         "--set", "view.width_px=96",   "--set", "view.height_px=54", "--set",
      "map.format=32f", "--set", "bias.constant=0.003"};
  const auto render = [&](std::vector<std::string> more) {
    EXPECT_EQ(run(point + more), 0) << output_;
    return nlohmann::json::parse(text("out/point.json")).at("metrics");
  };
  const nlohmann::json all = render({"--set", "map.placements=4", "--out", "out"});
  EXPECT_TRUE(says("over 16 placements, exact map")) << output_;
  EXPECT_TRUE(says("texels from this point; OpenGL shows")) << output_;
  EXPECT_FALSE(says("acne_mean")) << output_;
  const auto shift = [&](const char* name) { return fmt::format("{}", all.at(name).get<double>()); };
  const nlohmann::json worst = render({"--set", "map.shift_u_texels=" + shift("worst_shift_u_texels"), "--set",
                                       "map.shift_v_texels=" + shift("worst_shift_v_texels"), "--out", "out"});
  EXPECT_EQ(worst.at("error"), all.at("error_worst_shown"));
  EXPECT_FALSE(says("placements")) << output_;
}

// The same of a point light: the turn of the worst placement as it is printed and stored.
TEST_F(Map, RenderNamesTheWorstTurnOfACube) {
  const auto render = [&](const std::string& name, const std::string& value) {
    EXPECT_EQ(run({"render", "--set", "scene.name=point-room", "--set", "view.width_px=96", "--set",
                   "view.height_px=54", "--set", "map.resolution=128", "--set", name + "=" + value, "--out", "out"}),
              0)
        << output_;
    return nlohmann::json::parse(text("out/point.json"));
  };
  const nlohmann::json all = render("map.placements", "2").at("metrics");
  const auto turn = [&](const char* axis) {
    return fmt::format("{}", all.at(fmt::format("worst_turn_{}_deg", axis)).get<double>());
  };
  const std::string worst = turn("x") + "," + turn("y") + "," + turn("z");
  EXPECT_TRUE(says("over 4 placements, exact map")) << output_;
  EXPECT_TRUE(says("the worst is map.turn_deg=" + worst + "; OpenGL shows")) << output_;
  EXPECT_FALSE(all.contains("worst_shift_u_texels"));
  const nlohmann::json one = render("map.turn_deg", worst);
  EXPECT_EQ(one.at("metrics").at("error"), all.at("error_worst_shown"));
  EXPECT_EQ(one.at("light").at("turn_deg")[0], all.at("worst_turn_x_deg"));
  EXPECT_EQ(one.at("light").at("cube_y").size(), 3u);
}

TEST_F(Map, SaysWhatItCannotDraw) {
  EXPECT_EQ(map("point-room"), 2);
  EXPECT_TRUE(says("light.kind")) << output_;
  EXPECT_EQ(map("cube-rom"), 2);
  EXPECT_TRUE(says("cube-room")) << output_;
  EXPECT_EQ(map("missing.gltf"), 3) << output_;
  EXPECT_EQ(map("cube-room", {}, "32"), 2);
  EXPECT_TRUE(says("--from")) << output_;
  EXPECT_EQ(map("cube-room", {"--set", "bias.slope=0.01"}), 2);
  EXPECT_TRUE(says("bias.unit = m")) << output_;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out")) << "nothing half-written stays";
}

}  // namespace
}  // namespace noonmark::acceptance
