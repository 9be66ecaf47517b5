// noonmark judge with the frame's own shadow map: its causes are those that the ladder finds for the same map.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>

#include "app/pictures/given_frame.h"
#include "app/pictures/image_file.h"
#include "base/error.h"
#include "measure/given_lookup.h"
#include "measure/workbench.h"
#include "raytrace/tracer.h"
#include "tests/program/fixture.h"
#include "tests/support/kind_thrown.h"

namespace noonmark::acceptance {
namespace {

// Draws the map without one part of the scene.
class MapWithout : public Pipeline {
 public:
  explicit MapWithout(std::string part) : part_(std::move(part)) {}
  MapStage draw_maps(gl::Renderer& renderer, const Scene& scene, std::span<const Technique> techniques) override {
    Scene drawn = scene;
    for (const Part& one : scene.parts)
      for (uint32_t t = one.first_triangle; one.name == part_ && t < one.first_triangle + one.triangle_count; ++t)
        drawn.triangles[t] = glm::uvec3(drawn.triangles[t].x);
    renderer.load_scene(drawn);
    return Pipeline::draw_maps(renderer, drawn, techniques);
  }

 private:
  std::string part_;
};

// A frame whose own shadow map is handed over: what `render` wrote of a point, as another renderer would deliver it.
class JudgeWithMap : public Program {
 protected:
  int width = 320, height = 180;
  // top_row_first, zero_to_one, reversed, mirrored: how the other renderer has its map.
  struct Convention {
    bool top_row_first = false, zero_to_one = false, reversed = false, mirrored = false;
  };
  void measure(const std::map<std::string, std::string>& settings,
               std::unique_ptr<Pipeline> stages = std::make_unique<Pipeline>()) {
    Workbench bench(gl::DebugMode::fatal, {}, std::move(stages));
    Settings all;
    all.view.width_px = width;
    all.view.height_px = height;
    all.map.resolution = 512;
    for (const auto& [name, value] : settings) find_setting(name).set(all, value);
    const Measurement m = bench.measure(all, {});
    metrics_ = m.record.metrics;
    for (const Ladder::CauseImage& cause : m.ladder.causes) causes_.push_back(cause.name);
    visibility_ = m.ladder.shown();
    positions_ = m.receivers.position;
    for (size_t i = 0; i < visibility_.size(); ++i)
      if (m.receivers.primitive[i] == no_primitive) visibility_[i] = -1;
    stored_ = m.map().stored_rows(0, all.map.rows());
    map_from_world_ = m.technique.frame.clip_from_world(0);
    settings_ = settings;
    const Light light = effective_light(m.scene, all);
    const glm::dvec3 way = light.target_m - light.position_m, at = light.position_m;
    light_ = {{"kind", light.kind == LightKind::spot ? "spot" : "directional"},
              {"position", {at.x, at.y, at.z}},
              {"direction", {way.x, way.y, way.z}}};
    if (light.kind == LightKind::spot) light_["cone_deg"] = light.cone_deg;
  }
  nlohmann::json deliver(const Convention& as) {
    write_exr((folder_ / "V.exr").string(), {{"Y", visibility_}});
    std::vector<Channel> channels;
    for (int axis = 0; axis < 3; ++axis) {
      Image<float> values(width, height, std::numeric_limits<float>::quiet_NaN());
      for (size_t i = 0; i < values.size(); ++i)
        if (visibility_[i] != -1) values[i] = positions_[i][axis];
      channels.push_back({std::string(1, static_cast<char>('X' + axis)), values});
    }
    write_exr((folder_ / "P.exr").string(), channels);
    Image<float> map = stored_;
    const bool turned = as.top_row_first != as.mirrored;
    for (int y = 0; y < map.height; ++y)
      for (int x = 0; x < map.width; ++x) {
        const float depth = stored_.at(x, turned ? map.height - 1 - y : y);
        map.at(x, y) = as.reversed ? 1 - depth : depth;
      }
    write_exr((folder_ / "map.exr").string(), {{"Z", map}});
    glm::dmat4 clip(1);
    if (as.mirrored) clip[1][1] = -1;
    if (as.zero_to_one) clip[2][2] = as.reversed ? -0.5 : 0.5, clip[3][2] = 0.5;
    if (as.reversed && !as.zero_to_one) clip[2][2] = -1;
    const glm::dmat4 m = clip * map_from_world_;
    std::vector<double> numbers;
    for (int i = 0; i < 16; ++i) numbers.push_back(m[i / 4][i % 4]);
    nlohmann::json technique = nlohmann::json::object();
    for (const auto& [name, value] : settings_)
      if (!name.starts_with("scene.")) technique[name] = value;
    return {{"noonmark_frame", 1},
            {"scene", settings_.contains("scene.name") ? settings_.at("scene.name") : "cube-room"},
            {"visibility", {{"file", "V.exr"}}},
            {"positions", {{"file", "P.exr"}}},
            {"light", light_},
            {"map",
             {{"file", "map.exr"},
              {"first_row", as.top_row_first ? "top" : "bottom"},
              {"clip_from_world", numbers},
              {"order", "column"},
              {"depth_range", as.zero_to_one ? "0..1" : "-1..1"},
              {"reversed", as.reversed},
              {"technique", technique}}}};
  }
  nlohmann::json judged(const nlohmann::json& frame, int code = 0) {
    write("frame.json", frame.dump());
    EXPECT_EQ(run({"judge", "frame.json", "--out", "out"}), code) << output_;
    return nlohmann::json::parse(read_file((folder_ / "out/judge.json").string()));
  }
  // What the failed check of the map says, and the settings that it advises to declare; null without them.
  static std::pair<std::string, nlohmann::json> advised(const nlohmann::json& said) {
    std::string says;
    for (const auto& check : said["checks"])
      if (check["name"] == "map") says = check["says"];
    const size_t begin = says.find('{'), end = says.find('}');
    if (begin == std::string::npos || end == std::string::npos) return {says, {}};
    return {says, nlohmann::json::parse(says.substr(begin, end + 1 - begin))};
  }
  // The causes are those of the point.
  void expect_causes(const nlohmann::json& said) {
    for (const std::string& cause : causes_) {
      if (metrics_.contains(cause)) {
        EXPECT_NEAR(said["metrics"][cause], metrics_.at(cause), 1e-9) << cause;
      }
    }
    EXPECT_NEAR(said["metrics"]["frame_lookup"], 0, 1e-9);
    EXPECT_EQ(said["metrics"]["frame_lookup_differs"], 0);
  }

  Image<float> channel(const std::string& name) {
    const DecodedImage exr = read_image((folder_ / "out/frame.exr").string());
    const auto at = std::find(exr.channels.begin(), exr.channels.end(), name);
    EXPECT_NE(at, exr.channels.end()) << name;
    Image<float> values(exr.width, exr.height);
    for (size_t i = 0; i < values.size(); ++i) values[i] = exr.at(i, static_cast<size_t>(at - exr.channels.begin()));
    return values;
  }

  std::map<std::string, double> metrics_;
  std::vector<std::string> causes_;
  std::map<std::string, std::string> settings_;
  nlohmann::json light_;
  Image<float> visibility_, stored_;
  Image<glm::vec3> positions_;
  glm::dmat4 map_from_world_{1};
};

TEST_F(JudgeWithMap, FindsTheCausesOfThePoint) {
  measure({{"bias.constant", "0.002"}, {"bias.normal_offset", "0.5"}, {"filter.kind", "box"}, {"map.format", "32f"}});
  settings_.erase("map.format");
  ASSERT_GT(metrics_.at("acne") + metrics_.at("filter"), 0.001);
  expect_causes(judged(deliver({})));
  EXPECT_TRUE(says("Peter Panning")) << output_;
  EXPECT_TRUE(fs::exists(folder_ / "out/frame-causes.png"));
}

TEST_F(JudgeWithMap, ReadsAMapThatIsNotSquare) {
  for (const char* const aspect : {"2", "0.5"}) {
    measure({{"bias.constant", "0.002"}, {"map.format", "32f"}, {"map.fit", "tight"}, {"map.aspect", aspect}});
    ASSERT_NE(stored_.width, stored_.height);
    for (const char* const follows : {"map.format", "map.fit", "map.aspect"}) settings_.erase(follows);
    for (const bool top : {false, true}) expect_causes(judged(deliver({.top_row_first = top})));
  }
}

TEST_F(JudgeWithMap, ReadsTheMapsOfOtherConventions) {
  measure({{"scene.name", "spot-room"}, {"bias.constant", "0.0005"}, {"map.format", "32f"}});
  settings_.erase("map.format");
  for (const bool top : {false, true})
    for (const bool mirrored : {false, true}) {
      SCOPED_TRACE(top);
      SCOPED_TRACE(mirrored);
      expect_causes(judged(deliver({top, true, false, mirrored})));
    }
  // 1 - (1 - d) rounds d to a step of 2^-24, so verdicts of a few texels may change.
  const nlohmann::json reversed = judged(deliver({.reversed = true}));
  EXPECT_NEAR(reversed["metrics"]["acne"], metrics_.at("acne"), 1e-3);
  EXPECT_LT(reversed["metrics"]["frame_lookup_differs"], 1e-3);
}

TEST_F(JudgeWithMap, TheCausesSumToTheErrorWhateverTheFrameShows) {
  measure({{"bias.constant", "0.001"}});
  int drawn = 0;
  for (int y = height - 30; y < height; ++y)
    for (int x = 40; x < 90; ++x)
      if (float& v = visibility_.at(x, y); v >= 0) v = 1 - v, ++drawn;
  write("frame.json", deliver({}).dump());
  ASSERT_EQ(run({"judge", "frame.json", "--out", "out", "--accept", "map"}), 0) << output_;
  const nlohmann::json said = nlohmann::json::parse(read_file((folder_ / "out/judge.json").string()));
  EXPECT_NEAR(said["metrics"]["frame_lookup"], drawn / said["metrics"]["counted"].get<double>(), 1e-6);
  const Image<float> error = channel("error"), truth = channel("R1"), shown = channel("V");
  std::vector<Image<float>> steps;
  for (const std::string& cause : causes_)
    if (cause != "none") steps.push_back(channel("step." + cause));
  steps.push_back(channel("step.frame_lookup"));
  const Image<float> flags = channel("flags");
  for (size_t i = 0; i < error.size(); ++i) {
    if (!(static_cast<int>(flags[i]) & 2)) continue;
    double sum = 0;
    for (const Image<float>& step : steps) sum += step[i];
    ASSERT_NEAR(sum, shown[i] - truth[i], 1e-6) << i;
    ASSERT_NEAR(std::abs(sum), error[i], 1e-6) << i;
  }
}

TEST_F(JudgeWithMap, AMapOfAnotherSceneOrUpsideDownIsNamed) {
  measure({{"bias.constant", "0.002"}});
  nlohmann::json frame = deliver({});
  frame["map"]["first_row"] = "top";
  const nlohmann::json said = judged(frame, 3);
  EXPECT_TRUE(says("map         FAILED")) << output_;
  EXPECT_TRUE(says("first_row")) << output_;
  EXPECT_TRUE(said["metrics"].empty());
  EXPECT_EQ(run({"judge", "frame.json", "--out", "out", "--accept", "map"}), 0) << output_;
  const auto refused = [&](const char* key, const nlohmann::json& value, const char* words) {
    nlohmann::json wrong = deliver({});
    wrong["map"][key] = value;
    write("frame.json", wrong.dump());
    expect_run({"judge", "frame.json", "--out", "out"}, 3, {words});
    EXPECT_FALSE(fs::exists(folder_ / "out/judge.json")) << key;
  };
  refused("technique", {{"bias.constnt", 1}}, "did you mean 'bias.constant'");
  refused("technique", {{"map.extent_m", 1}}, "follows from matrix and file");
  refused("technique", {{"bias.constant", -1}}, "it takes 0");
  refused("technique", {{"filter.kind", "cube_grid"}}, "the technique of this map");
  refused("reversed", true, "180 degrees");
  stored_.at(5, 7) = 1.5f;
  refused("first_row", "bottom", "the texel x = 5, y = 7 of the file is 1.5");
}

// The map's pass has the window's viewport: the scene fills a corner of the map, and the lookup reads all of it.
TEST_F(JudgeWithMap, AMapThatIsNotTheScenesIsACauseOfItsOwn) {
  measure({{"bias.constant", "0.002"}});
  const nlohmann::json right = judged(deliver({}));
  EXPECT_EQ(right["metrics"]["frame_map"], 0);
  EXPECT_FALSE(right["causes"].contains("frame_map"));
  const Image<float> drawn = stored_;
  for (int y = 0; y < drawn.height; ++y)
    for (int x = 0; x < drawn.width; ++x)
      stored_.at(x, y) = 2 * x < drawn.width && 2 * y < drawn.height ? drawn.at(2 * x, 2 * y) : 1.0f;
  write("frame.json", deliver({}).dump());
  expect_run({"judge", "frame.json", "--out", "out", "--accept", "map"}, 0, {"fills only a part of its texels"});
  const nlohmann::json said = nlohmann::json::parse(read_file((folder_ / "out/judge.json").string()));
  EXPECT_EQ(said["metrics"]["precision"], 0);
  EXPECT_GT(said["metrics"]["frame_map"], 0.01);
  EXPECT_TRUE(says("Map (it is not the scene's)")) << output_;
  double parts = 0;
  for (const auto& [name, cause] : said["causes"].items()) parts += cause["part"].get<double>();
  EXPECT_NEAR(parts, said["metrics"]["frame_error"], 1e-7);
  EXPECT_EQ(run({"judge", "frame.json", "--out", "out", "--accept", "map", "--max", "frame_map=0.1%"}), 1) << output_;
  judged(deliver({}), 3);
}

TEST_F(JudgeWithMap, AMapOfAPointLightIsRefused) {
  measure({{"bias.constant", "0.002"}});
  nlohmann::json frame = deliver({});
  frame["light"] = {{"kind", "point"}, {"position", {0, 9, 0}}};
  write("frame.json", frame.dump());
  expect_run({"judge", "frame.json", "--out", "out"}, 3,
             {"frame.json: 'map': the six maps of a point light are not read; leave the map out"});
  EXPECT_FALSE(fs::exists(folder_ / "out/judge.json"));
}

// A receiver whose numbers are no numbers makes the measurement contradict itself; it does not pass as having no error.
TEST(GivenLookupOfNaN, Fails) {
  Workbench bench(gl::DebugMode::fatal);
  Settings all;
  all.view.width_px = 64;
  all.view.height_px = 36;
  all.map.resolution = 64;
  const Measurement m = bench.measure(all, {});
  const raytrace::Tracer tracer(m.scene);
  const ReceiverTruth truth =
      tracer.receiver_truth(m.receivers, m.technique.frame, {effective_light(m.scene, all), 0.01});
  GivenPoint point{
      .receivers = m.receivers,
      .eye_m = m.camera.eye_m,
      .truth = truth,
      .technique = m.technique,
      .depth = m.map().stored_rows(0, all.map.resolution),
      .frame = {.name = "frame", .picture = m.ladder.shown(), .cause = "frame_lookup", .label = "Lookup", .help = ""}};
  GivenLookup lookup(m.scene, tracer);
  EXPECT_NO_THROW(lookup.climb(point));
  const auto facing = std::find(truth.facing.pixels.begin(), truth.facing.pixels.end(), 1);
  ASSERT_NE(facing, truth.facing.pixels.end());
  point.frame.picture[static_cast<size_t>(facing - truth.facing.pixels.begin())] =
      std::numeric_limits<float>::quiet_NaN();
  expect_refused(ErrorKind::defect, {"residual = nan"}, [&] { lookup.climb(point); });
}

// A caster that is not in the map: its shadow is missing, and that is no precision of the map's.
TEST_F(JudgeWithMap, ACasterThatTheMapLacksIsACause) {
  measure({{"bias.constant", "0.01"}, {"map.format", "32f"}}, std::make_unique<MapWithout>("standing cube"));
  settings_.erase("map.format");
  nlohmann::json frame = deliver({});
  const nlohmann::json unnamed = judged(frame);
  EXPECT_EQ(unnamed["metrics"]["frame_missing"], 0);
  EXPECT_FALSE(says("frame_missing")) << output_;
  const double lost = unnamed["causes"]["precision"]["part"];
  ASSERT_GT(lost, 0.003);
  frame["not_in_map"] = {"standing cube"};
  const nlohmann::json named = judged(frame);
  EXPECT_GT(named["metrics"]["frame_missing"], 0.95 * lost);
  EXPECT_NEAR(
      named["causes"]["frame_missing"]["part"].get<double>() + named["causes"]["precision"]["part"].get<double>(), lost,
      1e-9);
  EXPECT_LT(named["causes"]["precision"]["part"], 0.05 * lost);
  EXPECT_TRUE(says("frame_missing")) << output_;
  EXPECT_EQ(named["metrics"]["frame_error"], unnamed["metrics"]["frame_error"]);
  frame["not_in_map"] = {"floating cube"};  // it is in the map
  EXPECT_LT(judged(frame)["metrics"]["frame_missing"], 0.1 * lost);
}

// A square map sees beyond the cone of its spot light. Of a light whose cone is declared wider than that map, the same pixels
// are judged alike, if those that the map does not reach are marked.
TEST_F(JudgeWithMap, AWiderConeThanTheMapsIsNoCoverage) {
  measure({{"scene.name", "spot-room"}, {"bias.constant", "0.0005"}, {"map.format", "32f"}});
  settings_.erase("map.format");
  const double cone_deg = light_["cone_deg"];
  const glm::dvec3 at(light_["position"][0], light_["position"][1], light_["position"][2]),
      along(light_["direction"][0], light_["direction"][1], light_["direction"][2]);
  size_t marked = 0;
  for (size_t i = 0; i < visibility_.size(); ++i) {
    if (visibility_[i] < 0) continue;
    const glm::dvec3 way = glm::dvec3(positions_[i]) - at;
    if (glm::degrees(std::acos(glm::dot(glm::normalize(way), glm::normalize(along)))) < cone_deg / 2) continue;
    visibility_[i] = -2;
    ++marked;
  }
  ASSERT_GT(marked, 1000u);
  light_["cone_deg"] = 170;
  expect_causes(judged(deliver({})));
}

TEST_F(JudgeWithMap, ALookupThatIsNotTheFramesIsNamed) {
  measure({{"bias.constant", "0.002"}});
  nlohmann::json frame = deliver({});
  frame["map"].erase("technique");  // no bias
  judged(frame, 3);
  EXPECT_TRUE(says("it is not the frame's own; check bias")) << output_;
  EXPECT_FALSE(says("Peter Panning")) << "no cause is printed";
  EXPECT_FALSE(fs::exists(folder_ / "out/frame-causes.png")) << "or drawn";
  frame["map"]["technique"] = {{"bias.constant", 10}};
  judged(frame, 3);
}

// A visibility that was read from a picture of 8 bits, in which the light makes 30 steps: the lookup is the frame's own as soon as the
// step is declared, and a lookup without the bias is not.
TEST_F(JudgeWithMap, ALookupIsTheFramesWithinTheStepOfThePicture) {
  measure({{"bias.constant", "0.002"}, {"filter.kind", "box"}, {"map.format", "32f"}});
  settings_.erase("map.format");
  for (float& v : visibility_.pixels) v = v < 0 ? v : std::floor(30 * v) / 30;
  nlohmann::json frame = deliver({});
  judged(frame, 3);
  EXPECT_TRUE(says("it is not the frame's own")) << output_;
  frame["visibility"]["step"] = 1.0 / 30;
  EXPECT_NEAR(judged(frame)["metrics"]["acne"], metrics_.at("acne"), 1e-9);
  EXPECT_TRUE(says("within 0.0333, the step of the visibility")) << output_;
  frame["map"]["technique"].erase("bias.constant");
  judged(frame, 3);
  frame["visibility"]["step"] = 2;
  write("frame.json", frame.dump());
  EXPECT_EQ(run({"judge", "frame.json"}), 3) << output_;
  EXPECT_TRUE(says("visibility.step")) << output_;
}

// Without a declaration it is that of the file's pixels.
TEST_F(JudgeWithMap, TheStepOfAPictureIsThatOfItsPixels) {
  measure({});
  nlohmann::json frame = deliver({});
  write_png((folder_ / "V.png").string(), Image<Color>(width, height, Color(255)));
  const auto step = [&] {
    write("frame.json", frame.dump());
    const FrameFile file = read_frame_file((folder_ / "frame.json").string());
    return given_frame(file, scene_of(file)).step;
  };
  EXPECT_EQ(step(), 0);
  frame["visibility"]["file"] = "V.png";
  EXPECT_EQ(step(), 1.0 / 255);
  frame["visibility"]["encoding"] = "srgb";
  EXPECT_NEAR(step(), 2.27 / 255, 0.01 / 255);  // the slope of its curve at 1
}

// A polygon offset lies in the map that is handed over. Not declared, R4 and R5 have two causes that cancel. The last
// two are so large that the map looks like another one.
TEST_F(JudgeWithMap, AnOffsetThatIsNotDeclaredIsNamed) {
  struct Case {
    const char *factor, *units, *bias;
  };
  for (const Case& one : {Case{"4", "10", "0"}, Case{"0", "20000", "0"}, Case{"1.1", "4", "0"}, Case{"-1", "-1", "0"},
                          Case{"0", "-20000", "0.001"}, Case{"8", "0", "0"}, Case{"0", "1000000", "0"}}) {
    SCOPED_TRACE(fmt::format("{} {}", one.factor, one.units));
    measure({{"bias.polygon_factor", one.factor},
             {"bias.polygon_units", one.units},
             {"bias.constant", one.bias},
             {"map.format", "24"}});
    nlohmann::json frame = deliver({});
    expect_causes(judged(frame));
    nlohmann::json& technique = frame["map"]["technique"];
    for (const char* key : {"bias.polygon_factor", "bias.polygon_units", "map.format"}) technique.erase(key);
    const nlohmann::json said = judged(frame, 3);
    EXPECT_TRUE(said["metrics"].empty());
    // What it says to add is JSON; added, the frame is judged, and its causes are those of the point.
    const auto& [says, add] = advised(said);
    ASSERT_TRUE(add.is_object()) << says;
    EXPECT_NEAR(add["bias.polygon_factor"], std::atof(one.factor), 0.125) << says;  // what the grid alone can do
    if (std::abs(std::atof(one.units)) > 1000) {
      EXPECT_NEAR(add["bias.polygon_units"].get<double>() / std::atof(one.units), 1, 0.02) << says;
    }
    technique.update(add);
    const nlohmann::json with = judged(frame);
    for (const char* cause : {"acne", "peter_panning", "precision"})
      EXPECT_NEAR(with["metrics"][cause], metrics_.at(cause), with["metrics"]["frame_error"].get<double>() / 10)
          << cause;
  }
}

// Depths of floats have no unit of one size, so a constant is said as casters that are moved.
TEST_F(JudgeWithMap, AConstantOffsetInAMapOfFloatsCanBeDeclared) {
  measure({{"bias.caster_offset", "12"}, {"map.format", "32f"}});
  nlohmann::json frame = deliver({});
  nlohmann::json& technique = frame["map"]["technique"];
  technique.erase("bias.caster_offset");
  const nlohmann::json said = judged(frame, 3);
  const auto& [says, add] = advised(said);
  ASSERT_TRUE(add.is_object()) << says;
  ASSERT_TRUE(add.contains("bias.caster_offset")) << says;
  EXPECT_NEAR(add["bias.caster_offset"], 12, 0.125) << says;  // what the grid alone can do
  technique.update(add);
  judged(frame);
}

// Of depths that do not tell their format, where most of the map is empty: the floor's front is not drawn.
TEST_F(JudgeWithMap, AnOffsetThatIsNotDeclaredIsNamedInItsOwnFormat) {
  measure({{"bias.polygon_units", "-20000"}, {"map.cull", "front"}, {"map.format", "24"}, {"filter.kind", "hardware"}});
  nlohmann::json frame = deliver({});
  for (const char* key : {"bias.polygon_units", "map.format"}) frame["map"]["technique"].erase(key);
  judged(frame, 3);
  EXPECT_TRUE(says("\"bias.polygon_units\": -2e+04, \"map.format\": \"24\"")) << output_;
}

// Also where the frame is full of acne, so that the declared lookup is nearer to it than to the truth.
TEST_F(JudgeWithMap, ABiasThatIsLeftOutIsNamedWhateverTheFramesError) {
  using Set = std::map<std::string, std::string>;
  for (const char* scene : {"cube-room", "spot-room"})
    for (const Set& bias : {Set{{"bias.constant", "0.0005"}, {"map.format", "16"}},
                            Set{{"bias.slope", "1"}, {"bias.unit", "texel"}, {"filter.kind", "box"}}}) {
      SCOPED_TRACE(scene + bias.begin()->first);
      Set settings = bias;
      settings["scene.name"] = scene;
      measure(settings);
      nlohmann::json frame = deliver({});
      const nlohmann::json said = judged(frame);
      EXPECT_EQ(said["metrics"]["frame_lookup_differs"], 0);
      for (const char* key : {"bias.constant", "bias.slope", "bias.unit"}) frame["map"]["technique"].erase(key);
      judged(frame, 3);
      EXPECT_TRUE(says("it is not the frame's own; check bias")) << output_;
    }
}

// The light is square to the floor, and no bias is there: what a receiver of the floor compares with its texel is the same depth
// but for rounding. So a frame may show each of them lit or dark. No
// cube stands beyond 4 m.
TEST_F(JudgeWithMap, VerdictsThatRoundingCanTurnAreTheLookups) {
  measure({{"light.position_m", "0,20,0"}, {"light.target_m", "0,0,0"}, {"map.format", "32f"}});
  settings_.erase("light.position_m"), settings_.erase("light.target_m");
  size_t turned = 0;
  for (size_t i = 0; i < visibility_.size(); ++i)
    if (visibility_[i] == 1 && positions_[i].y == -0.5f && std::abs(positions_[i].x) > 4) visibility_[i] = 0, ++turned;
  ASSERT_GT(turned, 1000u);
  EXPECT_GT(judged(deliver({}))["metrics"]["frame_lookup"], 0.01);
}

// The depths tell the format, on which the size of polygon units hangs.
TEST_F(JudgeWithMap, TheFormatIsThatOfTheDepths) {
  for (const char* format : {"16", "24"}) {
    SCOPED_TRACE(format);
    causes_.clear();
    measure({{"bias.polygon_units", format == std::string("16") ? "80" : "20000"}, {"map.format", format}});
    nlohmann::json frame = deliver({});
    frame["map"]["technique"].erase("map.format");
    expect_causes(judged(frame));
    frame["map"]["technique"]["map.format"] = format == std::string("16") ? "24" : "16";
    write("frame.json", frame.dump());
    expect_run({"judge", "frame.json", "--out", "out"}, 3, {"were not drawn in the map.format"});
  }
}

TEST_F(JudgeWithMap, CastersThatAreDrawnOtherwiseAreNamed) {
  measure({{"map.cull", "front"}});
  nlohmann::json frame = deliver({});
  expect_causes(judged(frame));
  frame["map"]["technique"].erase("map.cull");  // then the exact map has 47% acne, and the handed one takes it away
  judged(frame, 3);
  EXPECT_TRUE(says("map         FAILED")) << output_;
}

TEST_F(JudgeWithMap, ThePartsOfTheCausesSumToTheError) {
  measure({{"bias.constant", "0.002"}, {"filter.kind", "box"}});
  const nlohmann::json said = judged(deliver({}));
  double parts = 0, sizes = 0;
  for (const auto& [name, cause] : said["causes"].items()) {
    parts += cause["part"].get<double>();
    sizes += cause["size"].get<double>();
    EXPECT_LE(std::abs(cause["part"].get<double>()), cause["size"].get<double>() + 1e-9) << name;
  }
  const double error = said["metrics"]["frame_error"];
  EXPECT_NEAR(parts, error, 1e-7);
  EXPECT_GT(sizes, error) << "or the test shows nothing";
}

TEST_F(JudgeWithMap, CheckKnowsTheCausesToo) {
  measure({{"bias.constant", "0.002"}});
  nlohmann::json frame = deliver({});
  write("frame.json", frame.dump());
  frame.erase("map");
  write("without.json", frame.dump());
  const std::string bound = "[[bound]]\nmetric = \"acne\"\nmax = 1e-6\nwhere = {\"given.frame\" = \"frame.json\"}\n";
  write("frames.toml", "[[frame]]\nfile = \"frame.json\"\n[[frame]]\nfile = \"without.json\"\n" + bound);
  EXPECT_EQ(run({"check", "frames.toml", "--out", "out"}), 1) << output_;
  const std::string both = text("out/report.html");
  const size_t second = both.find("without.json", both.find("<i class=\"c-acne\""));
  ASSERT_NE(second, std::string::npos);
  const std::string report = both.substr(0, second);
  EXPECT_NE(report.find("Acne (too dark)"), std::string::npos);
  EXPECT_NE(report.find("<i class=\"c-acne\""), std::string::npos) << "the bar has its causes";
  EXPECT_EQ(report.find("<i class=\"c-frame_"), std::string::npos) << "and not its classes by place, too";
  EXPECT_NE(both.find("<i class=\"c-frame_", second), std::string::npos) << "those of the frame without a map";
  EXPECT_TRUE(fs::exists(folder_ / "out/images/p0000-causes.png"));

  // A map that is refused has no causes.
  frame = deliver({});
  frame["map"]["first_row"] = "top";
  write("frame.json", frame.dump());
  write("refused.toml", "[[frame]]\nfile = \"frame.json\"\n");
  EXPECT_EQ(run({"run", "refused.toml", "--out", "refused"}), 3) << output_;
  EXPECT_EQ(text("refused/report.html").find("<i class=\"c-acne\""), std::string::npos);
}

TEST_F(JudgeWithMap, WithoutOpenGLItSaysHowToJudgeByPlace) {
  measure({{"bias.constant", "0.01"}});
  write("frame.json", deliver({}).dump());
  const auto no_driver = [] { setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent.json", 1); };
  EXPECT_EQ(run({"judge", "frame.json", "--out", "out"}, no_driver), 4) << output_;
  EXPECT_TRUE(says("the causes of a frame with its own map need OpenGL")) << output_;
  EXPECT_TRUE(says("--without-map")) << output_;
  EXPECT_EQ(run({"judge", "frame.json", "--without-map", "--out", "out"}, no_driver), 0) << output_;
  EXPECT_TRUE(says("frame_acne")) << output_;
  EXPECT_FALSE(says("by cause")) << output_;
  expect_run({"judge", "frame.json", "--without-map", "--max", "acne=1%", "--out", "out"}, 2,
             {"leave out --without-map"});
  write("frames.toml",
        "[[frame]]\nfile = \"frame.json\"\nwithout_map = true\n[[bound]]\nmetric = "
        "\"frame_error\"\nmax = 0\n");
  EXPECT_EQ(run({"check", "frames.toml", "--out", "checked"}, no_driver), 1) << output_;
  EXPECT_TRUE(says("reproduce: noonmark judge frame.json --without-map --max frame_error=0")) << output_;
}

}  // namespace
}  // namespace noonmark::acceptance
