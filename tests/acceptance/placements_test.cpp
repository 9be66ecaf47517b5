// All placements of the map's grid: every number equals that of measuring each placement by itself.
#include "technique/placements.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "scenes/builtin.h"
#include "scenes/surfaces.h"
#include "tests/support/measured.h"

namespace noonmark::acceptance {
namespace {

struct Case {
  std::string name, scene;
  std::vector<Assignment> set;
  int side = 3;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

std::vector<Case> cases() {
  std::vector<Case> all;
  const auto named = [](std::string name) {
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
  };
  // Shifted where edges of the scene would pass exactly through centres of texels: a verdict there is a tie, which
  // rounding decides. In layers and crease the light shines straight down on edges at whole metres, and a metre is 27.5 texels.
  const std::vector<Assignment> beside_edges = {{"map.shift_u_texels", "0.013"}, {"map.shift_v_texels", "0.029"}};
  for (const BuiltinScene& scene : builtin_scenes()) {
    if (scene.name == "point-room") continue;
    const bool ties = scene.name == "layers" || scene.name == "crease";
    all.push_back(
        {named(std::string(scene.name)), std::string(scene.name), ties ? beside_edges : std::vector<Assignment>{}});
  }
  // Turns of a cube.
  const Assignment lamp{"light.kind", "point"};
  all.push_back({"point_room", "point-room", {}, 2});
  all.push_back({"point_room_disk", "point-room", {{"filter.kind", "cube_disk"}, {"map.format", "16"}}, 2});
  all.push_back({"point_room_grid",
                 "point-room",
                 {{"filter.kind", "cube_grid"}, {"view.width_px", "80"}, {"view.height_px", "45"}},
                 2});
  all.push_back({"point_room_turned", "point-room", {{"map.turn_deg", "20,-30,50"}, {"bias.slope", "0.01"}}, 2});
  all.push_back({"point_room_axes", "point-room", {{"bias.normal_offset_axes", "1.2"}, {"map.cull", "back"}}, 2});
  all.push_back({"point_room_casters", "point-room", {{"bias.caster_offset", "1.2"}, {"map.near_m", "3"}}, 2});
  all.push_back({"point_room_in_texels", "point-room", {{"bias.unit", "texel"}, {"bias.constant", "0.5"}}, 2});
  all.push_back({"lamp_in_cube_room", "cube-room", {lamp, {"light.position_m", "0.3,4,0.2"}}, 2});
  all.push_back({"lamp_at_fence", "fence", {lamp, {"light.position_m", "1,4,2"}}, 2});
  for (const char* name : {"FlightHelmet", "Lantern"}) all.push_back({name, model(name), {}});
  const std::vector<std::pair<std::string, std::vector<Assignment>>> techniques = {
      {"box", {{"filter.kind", "box"}}},
      {"gaussian", {{"filter.kind", "gaussian"}}},
      {"hardware", {{"filter.kind", "hardware"}, {"map.format", "16"}}},
      {"poisson", {{"filter.kind", "poisson"}}},
      {"vogel", {{"filter.kind", "vogel"}, {"filter.rotate", "true"}}},
      {"small_map", {{"map.extent_scale", "0.4"}, {"map.wrap", "repeat"}, {"filter.kind", "box"}}},
      {"clamped_map", {{"map.extent_scale", "0.4"}, {"map.wrap", "clamp_to_edge"}, {"map.lit_beyond_far", "false"}}},
      {"beside_the_map", {{"map.extent_scale", "0.4"}, {"filter.kind", "box"}}},
      {"beyond_far", {{"map.far_m", "7"}, {"filter.kind", "box"}}},
      {"dark_beyond_far", {{"map.far_m", "7"}, {"map.lit_beyond_far", "false"}, {"filter.kind", "box"}}},
      {"shifted", {{"map.shift_u_texels", "0.3"}, {"map.shift_v_texels", "-0.45"}}},
      {"slope", {{"bias.slope", "0.01"}, {"bias.constant", "0.0005"}}},
      {"in_texels", {{"bias.unit", "texel"}, {"bias.constant", "0.5"}}},
      {"normal_offset", {{"bias.normal_offset", "1.3"}, {"filter.kind", "box"}}},
      {"receiver_plane", {{"bias.reference", "receiver_plane"}, {"filter.kind", "box"}}},
      {"texel_plane", {{"bias.reference", "texel_plane"}}},
      {"polygon_offset", {{"bias.polygon_factor", "1.5"}, {"bias.polygon_units", "4"}}},
      {"moved_casters", {{"bias.caster_offset", "1.2"}, {"bias.caster_normal_offset", "0.7"}}},
      {"front_faces", {{"map.cull", "front"}}},
      {"beyond_near", {{"map.near_m", "4"}}},
  };
  for (const char* scene : {"cube-room", "spot-room"})
    for (const auto& [name, set] : techniques) all.push_back({named(std::string(scene) + "_" + name), scene, set});
  // Half a texel puts edges of the cubes there too.
  all.push_back({"even_number", "cube-room", beside_edges, 4});
  return all;
}

class EveryPlacement : public testing::TestWithParam<Case> {};

struct Series {
  const char* name;
  std::vector<double> BiasCurve::*of_one;
  Band BiasCurve::*band;
};
constexpr Series series[] = {
    {"acne", &BiasCurve::acne, &BiasCurve::acne_band},
    {"peter_panning", &BiasCurve::peter_panning, &BiasCurve::peter_panning_band},
};

// The sums of blended weights are added in another order, and shares of a receiver are floats in the ladder (2^-24). A
// tap more or less is a difference of 7e-6 and more.
constexpr double rounding = 0x1p-24;

TEST_P(EveryPlacement, HasTheNumbersOfMeasuringItByItself) {
  const Case& c = GetParam();
  if (c.scene.ends_with(".gltf") && !std::filesystem::exists(c.scene)) GTEST_SKIP() << c.scene << " does not exist";
  std::vector<Assignment> common = {{"map.resolution", "220"}, {"map.format", "32f"}, {"bias.constant", "0.002"}};
  common.insert(common.end(), c.set.begin(), c.set.end());
  const Settings settings = with(common, small(c.scene, 160, 90));
  Workbench bench(gl::DebugMode::fatal);
  const LightFrame placement_0 = make_light_frame(bench.scene(settings.scene), settings);
  const bool turns = placement_0.map_shape() == MapShape::cube;
  // A turn changes the texel's width at the median receiver, and so the curve's biases, if they are in texels.
  const bool same_biases = !turns || settings.bias.unit != BiasUnit::texel;
  const auto options = same_biases ? std::optional(CurveOptions{{0.02, 0.02}, {}}) : std::nullopt;

  Settings all = settings;
  all.map.placements = c.side;
  const Measurement together = bench.measure(all, options);
  const std::map<std::string, double> metrics = together.record.metrics;
  const std::optional<BiasCurve> bands = together.record.curve;
  const std::vector<float> map_0 = together.map().exact.depth;  // the next measurement replaces it
  EXPECT_EQ(metrics.at("placement_disagreements"), 0);

  const Placements placements(c.side);
  glm::dvec3 worst_turn(0);
  int worst_met = 0;
  if (turns)
    worst_turn = {metrics.at("worst_turn_x_deg"), metrics.at("worst_turn_y_deg"), metrics.at("worst_turn_z_deg")};
  std::vector<BiasCurve> curves;
  std::map<std::string, std::vector<double>> of_each;
  for (int p = 0; p < placements.count(); ++p) {
    Settings one = settings;
    if (turns) {
      one.map.turn_deg = placements.frame(placement_0, p).turn_deg;
    } else {
      one.map.shift_u_texels += placements.shift_texels(p).x;
      one.map.shift_v_texels += placements.shift_texels(p).y;
    }
    const Measurement m = bench.measure(one, options);
    if (turns) {  // the turn is the map's alone
      for (const char* name : {"receivers", "facing", "counted", "ambiguous", "lit", "filter", "light_size"})
        EXPECT_EQ(m.record.metrics.at(name), metrics.at(name)) << name;
      EXPECT_EQ(m.ladder.truth().pixels, together.ladder.truth().pixels);
      if (p > 0) {
        EXPECT_NE(m.map().exact.depth, map_0) << "another map";
      }
      if (const glm::dvec3 t = *one.map.turn_deg; t == worst_turn) {
        EXPECT_EQ(m.record.metrics.at("error"), metrics.at("error_worst_shown"));
        ++worst_met;
      }
    }
    if (m.record.curve) curves.push_back(*m.record.curve);
    for (const char* name : {"undecided", "acne", "peter_panning", "aliasing", "aliasing_dark", "aliasing_light",
                             "aliasing_rms", "coverage", "coverage_dark", "coverage_light"})
      of_each[name].push_back(m.record.metrics.at(name));
    if (settings.map.format == DepthFormat::d32f) of_each["error"].push_back(error_on_exact_map(m.ladder));
  }
  // Where a texel's centre lies on a silhouette within double's rounding, it is not known whether the tap is undecided:
  // that depends on the origin of the light's frame, which each placement has for itself and all together share.
  const double unsure = std::max(metrics.at("undecided_worst"),
                                 *std::max_element(of_each["undecided"].begin(), of_each["undecided"].end()));
  for (const auto& [name, values] : of_each) {
    const double allowed = rounding + (name == "aliasing_rms" ? std::sqrt(unsure) : unsure);
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    EXPECT_NEAR(metrics.at(name + "_mean"), mean, allowed) << name;
    EXPECT_NEAR(metrics.at(name + "_worst"), *std::max_element(values.begin(), values.end()), allowed) << name;
  }

  EXPECT_EQ(worst_met, turns ? 1 : 0);
  EXPECT_EQ(metrics.contains("worst_turn_x_deg"), turns);
  EXPECT_EQ(metrics.contains("worst_shift_u_texels"), !turns);

  ASSERT_EQ(bands.has_value(), !curves.empty());
  if (!bands) return;
  EXPECT_EQ(bands->placements, static_cast<uint64_t>(placements.count()));
  for (const Series& s : series)
    for (size_t i = 0; i < bands->bias_depth.size(); ++i) {
      double sum = 0, worst = 0, best = 1;
      for (const BiasCurve& curve : curves) {
        const double value = (curve.*s.of_one)[i];
        sum += value;
        worst = std::max(worst, value);
        best = std::min(best, value);
      }
      const double at = bands->bias_depth[i];
      ASSERT_NEAR((*bands.*s.band).mean[i], sum / placements.count(), rounding) << s.name << " at " << at;
      ASSERT_NEAR((*bands.*s.band).worst[i], worst, rounding) << s.name << " at " << at;
      ASSERT_NEAR((*bands.*s.band).best[i], best, rounding) << s.name << " at " << at;
    }

  // The window at every placement is the intersection of their windows, less than two edges narrower.
  double from = 0, to = std::numeric_limits<double>::infinity();
  for (const BiasCurve& curve : curves) {
    from = std::max(from, curve.window_min_depth.value_or(std::numeric_limits<double>::infinity()));
    to = std::min(to, curve.window_max_depth.value_or(0));
  }
  const double step = std::exp2(1.0 / 16) * (1 + 1e-6);
  if (bands->window_min_worst_depth) {
    EXPECT_GE(*bands->window_min_worst_depth * (1 + 1e-6), from);
    EXPECT_LE(*bands->window_max_worst_depth, to * (1 + 1e-6));
    if (from > 1e-7) {
      EXPECT_LE(*bands->window_min_worst_depth, from * step);
    }
    if (to < 1) {
      EXPECT_GE(*bands->window_max_worst_depth * step, to);
    }
  } else {
    EXPECT_GT(from * step * step, to);
  }
}
INSTANTIATE_TEST_SUITE_P(Cases, EveryPlacement, testing::ValuesIn(cases()),
                         [](const auto& test) { return test.param.name; });

// Two sheets that cross and are nowhere further apart than a few float steps. A float ray meets either of them first. The
// exact map and the lattice are both computed in double, and both have the one that is nearer.
TEST(Placements, SheetsWithinTheErrorOfARayAreNoDisagreement) {
  struct Sheets : Pipeline {
    SceneStage load_scene(gl::Renderer& renderer, const Settings& settings) override {
      SceneStage loaded = Pipeline::load_scene(renderer, settings);
      auto scene = std::make_unique<Scene>(*loaded.scene);
      const size_t first = scene->positions.size();
      const float apart = 6e-7f;  // metres, at the corners
      for (const auto& [x, z] :
           {std::pair(-3.f, -3.f), std::pair(3.f, -3.f), std::pair(3.f, 3.f), std::pair(-3.f, 3.f)})
        for (float sign : {1.f, -1.f}) scene->positions.emplace_back(x, 1.5f + sign * (x * z > 0 ? apart : -apart), z);
      for (uint32_t sheet : {0u, 1u}) {
        const auto corner = [&](uint32_t i) { return static_cast<uint32_t>(first) + 2 * i + sheet; };
        scene->triangles.emplace_back(corner(0), corner(2), corner(1));
        scene->triangles.emplace_back(corner(0), corner(3), corner(2));
      }
      scene->parts.clear();
      if (!scene->single_sided.empty()) scene->single_sided.resize(scene->triangles.size());
      auto tracer = std::make_unique<raytrace::Tracer>(*scene);
      renderer.load_scene(*scene);
      const uint64_t open_edges = tracer->open_edges();
      std::vector<uint32_t> surfaces = surfaces_of(*scene);
      return {std::move(scene), "sheets", std::move(tracer), open_edges, std::move(surfaces)};
    }
  };
  Workbench bench(gl::DebugMode::fatal, {}, std::make_unique<Sheets>());
  Settings settings = small("cube-room", 320, 180);
  settings.map.placements = 4;
  const Measurement m = bench.measure(settings, std::nullopt);
  EXPECT_EQ(metric(m, "placement_disagreements"), 0);
}

// The middle of cube-room's map lies under an edge of a box, and at one placement of these a texel's centre lies there.
// Which side of the edge it lies on is rounding; 247 and 9,811 taps differed before that was known.
TEST(Placements, TexelsWithTheirCentreOnAnEdgeAreNoDisagreement) {
  Workbench bench(gl::DebugMode::fatal);
  for (const std::vector<Assignment>& set : {std::vector<Assignment>{{"map.resolution", "16"}},
                                             {{"map.resolution", "1"}},
                                             {{"map.resolution", "2"}, {"map.cull", "front"}}}) {
    Settings settings = with(set, small("cube-room", 160, 90));
    settings.map.format = DepthFormat::d32f;
    settings.bias.unit = BiasUnit::texel;
    settings.map.placements = 4;
    EXPECT_EQ(metric(bench.measure(settings, std::nullopt), "placement_disagreements"), 0) << set.front().second;
  }
}

}  // namespace
}  // namespace noonmark::acceptance
