// The exact map: depths at texel centres against closed forms and brute force in double; clipping, culling, wrapping.
#include <gtest/gtest.h>

#include "scenes/builtin.h"
#include "tests/raytrace/fixture.h"
#include "tests/support/bias_of.h"

namespace noonmark::raytrace {
namespace {

using namespace test;

// Looks up exactly these texels, one receiver for each.
LookupTruth look_up_texels(const Scene& scene, const LightFrame& frame, const std::vector<glm::ivec2>& texels,
                           const MapSettings& map, int kernel = 1, const Bias& bias = {}, double offset_unit = 0) {
  const std::vector<Placed> points(texels.size(), points_on(scene, frame.direction_to_light(), true, 1, 1)[0]);
  const ReceiverImage receivers = receivers_at(scene, points, frame.direction_to_light(), true);
  LookupProbe probe = probe_of(receivers, frame, box(kernel));
  for (size_t i = 0; i < texels.size(); ++i) probe.map_texels[i] = glm::vec2(texels[i]) + 0.5f;
  ReceiverTruth truth{Image<uint8_t>(receivers.width(), 1, 1),
                      Image<uint8_t>(receivers.width(), 1, 1),
                      Image<uint8_t>(receivers.width(), 1),
                      {}};
  return Tracer(scene).lookup_truth(receivers, truth, probe, frame, map, bias, offset_unit);
}

// Of a map of which every texel is asked for.
Image<float> whole_map(const Scene& scene, const LightFrame& frame, const MapSettings& map = {}, const Bias& bias = {},
                       double offset_unit = 0) {
  std::vector<glm::ivec2> texels;
  for (int y = 0; y < frame.resolution; ++y)
    for (int x = 0; x < frame.resolution; ++x) texels.push_back({x, y});
  const MapDepths depths = look_up_texels(scene, frame, texels, map, 1, bias, offset_unit).exact_map;
  Image<float> image(frame.resolution, frame.resolution);
  for (const glm::ivec2 texel : texels) image.at(texel.x, texel.y) = depths.at(texel);
  return image;
}

// Half a last place of a float below 1, and the double rounding of a depth of some metres.
constexpr double depth_rounding = 0x1p-25 + 1e-12;

using Expected = std::function<double(glm::dvec2)>;  // metres along the light; infinity: nothing
void expect_map(const Image<float>& map, const LightFrame& frame, const Expected& expected,
                double tolerance = depth_rounding) {
  int wrong = 0;
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const double z = expected(frame.texel_centre({x, y})),
                   depth = std::isfinite(z) && z <= frame.far_m ? frame.tile(0).window_depth(z) : 1;
      if (!(std::abs(map.at(x, y) - depth) <= tolerance) && ++wrong <= 3) {
        ADD_FAILURE() << "texel " << x << ' ' << y << ": " << map.at(x, y) << ", not " << depth;
      }
    }
  }
  EXPECT_EQ(wrong, 0);
}

TEST(ExactMap, PlaneIsItsFormula) {
  for (double theta : {0.0, 30.0, 75.0}) {
    for (double phi : {0.0, 33.0, 135.0}) {
      const Scene scene = make_scene({.name = "plane", .theta_deg = theta, .phi_deg = phi});
      const LightFrame frame = frame_of(scene, 50);
      const double tangent = std::tan(glm::radians(theta)), c = std::cos(glm::radians(phi)),
                   s = std::sin(glm::radians(phi));
      const double half = 3, corner_rounding = 1e-6 * (1 + tangent);  // corners are floats, 3 m out
      expect_map(
          whole_map(scene, frame), frame,
          [&](glm::dvec2 x) {
            const double down = (c * x.x + s * x.y) / std::cos(glm::radians(theta)), across = -s * x.x + c * x.y;
            const bool covered = std::abs(down) < half && std::abs(across) < half;
            return covered ? 10 + tangent * (c * x.x + s * x.y) : std::numeric_limits<double>::infinity();
          },
          corner_rounding / 10);
    }
  }
}

// OpenGL 4.5 core, 14.6.5: factor times the steeper of the two slopes, per texel, and units of the smallest difference.
TEST(ExactMap, PolygonOffsetOfAPlaneIsItsFormula) {
  for (double theta : {0.0, 30.0, 75.0}) {
    for (double phi : {0.0, 33.0, 135.0}) {
      const Scene scene = make_scene({.name = "plane", .theta_deg = theta, .phi_deg = phi});
      const LightFrame frame = frame_of(scene, 50);
      const Bias bias = bias_of({{"polygon_factor", 1.5}, {"polygon_units", 8}});
      const double unit = 0x1p-16;
      const double steepest = std::tan(glm::radians(theta)) *
                              std::max(std::abs(std::cos(glm::radians(phi))), std::abs(std::sin(glm::radians(phi))));
      const double offset = 1.5 * steepest * frame.texel_m(glm::dvec3(0)) / (frame.far_m - frame.near_m) + 8 * unit;
      const Image<float> plain = whole_map(scene, frame), moved = whole_map(scene, frame, {}, bias, unit);
      int covered = 0;
      for (size_t i = 0; i < plain.size(); ++i) {
        if (plain[i] == 1) continue;
        ++covered;
        // Corners of the plane are floats 3 m out, which tilts it by some 2^-24 of its slope; two maps are rounded.
        EXPECT_NEAR(moved[i], std::min(1.0, plain[i] + offset), 2 * depth_rounding + 1e-6 * offset)
            << theta << ' ' << phi << " texel " << i;
      }
      EXPECT_GT(covered, 100);
    }
  }
}

TEST(ExactMap, BoxOnAFloorInClosedForm) {
  Scene scene;
  add_quad(scene, "floor", {-4, 0, -4}, {0, 0, 8}, {8, 0, 0});
  add_box(scene, "box", glm::dvec3(-1, 0.5, -0.5), glm::dvec3(0.25, 2, 1.5));
  light_from_above(scene);
  scene.map = MapVolume{.extent_m = 10, .near_m = 2, .far_m = 12};
  const LightFrame frame = frame_of(scene, 61);
  const auto under_box = [](glm::dvec2 x) { return x.x > -1 && x.x < 0.25 && -x.y > -0.5 && -x.y < 1.5; };  // v is -z
  const auto on_floor = [](glm::dvec2 x) { return std::abs(x.x) < 4 && std::abs(x.y) < 4; };
  const double none = std::numeric_limits<double>::infinity();
  const auto expected = [&](double box_z) {
    return [=](glm::dvec2 x) { return under_box(x) ? box_z : on_floor(x) ? 10 : none; };
  };
  MapSettings map;
  expect_map(whole_map(scene, frame, map), frame, expected(8));
  map.cull = CulledFaces::back;
  expect_map(whole_map(scene, frame, map), frame, expected(8));
  map.cull = CulledFaces::front;  // the box's underside; the floor's front is gone
  expect_map(whole_map(scene, frame, map), frame, [&](glm::dvec2 x) { return under_box(x) ? 9.5 : none; });

  // The near plane cuts the box: what is behind it is seen, here the inside of the bottom.
  Settings cut;
  cut.map.resolution = 61;
  cut.map.near_m = 9;
  expect_map(whole_map(scene, make_light_frame(scene, cut)), make_light_frame(scene, cut), expected(9.5));
  cut.map.near_m = 9.75;  // the whole box is before it
  expect_map(whole_map(scene, make_light_frame(scene, cut)), make_light_frame(scene, cut), expected(10));
  map = {};
  map.depth_clamp = true;  // what is before near stays, at near's depth
  expect_map(whole_map(scene, make_light_frame(scene, cut), map), make_light_frame(scene, cut), expected(9.75));
  cut.map.near_m = 2;
  cut.map.far_m = 9;  // the floor is beyond it
  expect_map(whole_map(scene, make_light_frame(scene, cut)), make_light_frame(scene, cut), expected(8));
}

TEST(ExactMap, NearClippedTapsSayTheyAre) {
  Scene scene;
  add_quad(scene, "floor", {-4, 0, -4}, {0, 0, 8}, {8, 0, 0});
  add_quad(scene, "roof", {-4, 5, -4}, {0, 0, 8}, {4, 0, 0});  // z = 5 where u < 0
  light_from_above(scene);
  scene.map = MapVolume{.extent_m = 8, .near_m = 6, .far_m = 12};
  const LightFrame frame = frame_of(scene, 8);
  const LookupTruth truth = look_up_texels(scene, frame, {{1, 3}, {6, 3}}, {});
  EXPECT_TRUE(truth.taps.taps[0] & tap_near_clipped);
  EXPECT_FALSE(truth.taps.taps[1] & tap_near_clipped);
}

// The near plane of a cube's face is flat. Towards a corner it also cuts off surfaces that are further from the light
// than near.
TEST(ExactMap, ACubesNearPlaneIsAlongItsAxis) {
  Scene scene;
  add_quad(scene, "floor", {-2, -2, -2}, {0, 0, 4}, {4, 0, 0});
  add_quad(scene, "shelf", {-1, -1, -1}, {0, 0, 2}, {2, 0, 0});  // at most 1.73 m away, 1 m along the axis
  scene.light.kind = LightKind::point;
  scene.light.position_m = {0, 0, 0};
  for (const bool cut : {true, false}) {
    scene.map = MapVolume{.near_m = cut ? 1.2 : 0.8, .far_m = 10};
    const LightFrame frame = frame_of(scene, 32);
    const ReceiverImage receivers = receivers_at(scene, {{{1.6, -2, 0.1}, 0}, {{1.6, -2, 0.1}, 1}}, {0, 1, 0}, true);
    const Tracer tracer(scene);
    const LookupProbe probe = probe_of(receivers, frame);
    const LookupTruth truth =
        tracer.lookup_truth(receivers, tracer.receiver_truth(receivers, frame, {}), probe, frame, {});
    const glm::ivec2 texel = probe.texel(0, 0);
    const glm::dvec3 way = frame.texel_place(texel);
    EXPECT_EQ((truth.taps.taps[0] & tap_near_clipped) != 0, cut);
    EXPECT_NEAR(truth.exact_map.at(texel), (cut ? 2 : 1) * glm::length(way / way.y) / 10, depth_rounding);
  }
}

// Every built-in scene with its own map, with faces culled, and cut in two by the near plane.
TEST(ExactMap, BuiltinScenesAgreeWithBruteForce) {
  for (const BuiltinScene& given : builtin_scenes()) {
    const Scene scene = builtin(std::string(given.name));
    for (CulledFaces cull : {CulledFaces::none, CulledFaces::back, CulledFaces::front}) {
      for (bool cut : {false, true}) {
        Settings settings;
        settings.map.resolution = 65;  // odd; 25,350 texels of each scene
        settings.map.cull = cull;
        settings.light.kind = LightChoice::directional;  // LightBins supports parallel light only
        if (cut) settings.map.near_m = make_light_frame(scene, settings).to_light({0, 0.2, 0}).z;
        const LightFrame frame = make_light_frame(scene, settings);
        const LightBins brute(scene, frame);
        SCOPED_TRACE(std::string(given.name) + " culled " + std::to_string(static_cast<int>(cull)) +
                     (cut ? " cut" : ""));
        const auto kept = [&](uint32_t t) {
          return cull == CulledFaces::none || brute.front(t) == (cull == CulledFaces::back);
        };
        // Rays from the light miss the texel's centre by float rounding: 1e-6 of the scene's size, times its slopes.
        int wrong = 0;
        const Image<float> map = whole_map(scene, frame, settings.map);
        for (int y = 0; y < map.height; ++y) {
          for (int x = 0; x < map.width; ++x) {
            const glm::dvec2 centre = frame.texel_centre({x, y});
            const LightBins::Hit hit = brute.first_hit(centre, frame.near_m, kept);
            const double depth = hit.z <= frame.far_m ? frame.tile(0).window_depth(hit.z) : 1;
            if (std::abs(map.at(x, y) - depth) <= depth_rounding) continue;
            bool at_an_edge = false;  // within the ray's error of an edge the depth of either side is right
            const double reach = 1e-6 * brute.size_m();
            for (const glm::dvec2 way : {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)})
              at_an_edge |= brute.first_hit(centre + reach * way, frame.near_m, kept).triangle != hit.triangle;
            wrong += !at_an_edge;
          }
        }
        EXPECT_EQ(wrong, 0);
      }
    }
  }
}

TEST(ExactMap, HoldsOnlyTheTexelsLookedUp) {
  const Scene scene = make_scene({.name = "plane", .theta_deg = 20});
  const LightFrame frame = frame_of(scene, 32);
  const auto set_texels = [&](glm::ivec2 texel, Wrap wrap, int kernel) {
    MapSettings map;
    map.wrap = wrap;
    const MapDepths exact = look_up_texels(scene, frame, {texel}, map, kernel).exact_map;
    std::vector<glm::ivec2> set;
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x)
        if (exact.at({x, y}) != 1) set.push_back({x, y});
    return set;
  };
  using List = std::vector<glm::ivec2>;
  EXPECT_EQ(set_texels({16, 15}, Wrap::clamp_to_border, 1), (List{{16, 15}}));
  EXPECT_EQ(set_texels({16, 15}, Wrap::repeat, 3).size(), 9u);
  EXPECT_EQ(set_texels({16 + 32, 15 - 64}, Wrap::repeat, 1), (List{{16, 15}}));
  EXPECT_EQ(set_texels({-16, -17}, Wrap::repeat, 1), (List{{16, 15}}));
  EXPECT_EQ(set_texels({-16, -17}, Wrap::clamp_to_border, 3), List{});

  // A plane wider than the map, so that its edge texels hold a depth.
  Scene wide;
  add_quad(wide, "floor", {-40, 0, -40}, {0, 0, 80}, {80, 0, 0});
  light_from_above(wide);
  wide.map = MapVolume{.extent_m = 8, .near_m = 2, .far_m = 12};
  const LightFrame wide_frame = frame_of(wide, 8);
  MapSettings map;
  map.wrap = Wrap::clamp_to_edge;
  const MapDepths exact = look_up_texels(wide, wide_frame, {{-5, 3}, {40, 900}}, map).exact_map;
  int set = 0;
  for (float depth : exact.depth) set += depth != 1;
  EXPECT_EQ(set, 2);
  EXPECT_NE(exact.at({0, 3}), 1);
  EXPECT_NE(exact.at({7, 7}), 1);
}

}  // namespace
}  // namespace noonmark::raytrace
