// Cascades: the splits of the view (law 28), the least sphere of a slice (law 29), and the frames.
#include "technique/cascades.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <set>
#include <sstream>

#include "base/error.h"
#include "scenes/camera_fit.h"
#include "scenes/camera_frame.h"
#include "scenes/shapes.h"
#include "technique/cascade_blends.h"
#include "technique/cascade_selections.h"
#include "technique/cascade_splits.h"
#include "technique/light_frame.h"
#include "technique/map_fit.h"
#include "tests/support/kind_thrown.h"

namespace noonmark {
namespace {

std::vector<double> bounds_of(const char* split, const CascadeSettings& settings, int count = 4, double near_m = 0.1,
                              double far_m = 100) {
  return find_cascade_split(split).bounds({near_m, far_m, count, settings});
}

void expect_near(const std::vector<double>& found, const std::vector<double>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-12 * expected[i]) << i;
}

TEST(CascadeSplits, HaveTheirClosedForms) {
  CascadeSettings s;
  expect_near(bounds_of("logarithmic", s, 3), {1, 10});  // 0.1, 1, 10, 100
  s.lambda = 1;
  expect_near(bounds_of("practical", s, 3), {1, 10});
  s.lambda = 0;
  expect_near(bounds_of("practical", s, 4, 2, 10), {4, 6, 8});
  s.lambda = 0.5;
  expect_near(bounds_of("practical", s, 2), {0.5 * std::sqrt(10.0) + 0.5 * 50.05});
  s.exponent = 1;
  expect_near(bounds_of("exponent", s, 4, 2, 10), {4, 6, 8});
  s.exponent = 2;
  expect_near(bounds_of("exponent", s, 3, 1, 8), {2, 4});  // 1, 2 and 4 of 7
  s.first_m = 4;
  expect_near(bounds_of("first_bound", s, 3, 0.1, 64), {4, 16});
  s.first_m = {};
  expect_near(bounds_of("first_bound", s, 2), {10});
  s.bounds_m = {5, 15, 50};
  expect_near(bounds_of("manual", s), {5, 15, 50});
}

TEST(CascadeSplits, AscendBetweenNearAndFar) {
  std::mt19937 random(61);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int n = 0; n < 2000; ++n) {
    CascadeSettings s;
    s.lambda = unit(random);
    s.exponent = 1 + 15 * unit(random);
    const double near_m = std::pow(10, -2 + 3 * unit(random)), far_m = near_m * (2 + std::pow(10, 4 * unit(random)));
    s.first_m = near_m + (far_m - near_m) * (0.01 + 0.9 * unit(random));
    const int count = 2 + static_cast<int>(random() % 7);
    for (const CascadeSplit& split : cascade_splits()) {
      if (split.name == "manual") continue;
      double before = near_m;
      const std::vector<double> bounds = bounds_of(std::string(split.name).c_str(), s, count, near_m, far_m);
      ASSERT_EQ(bounds.size(), static_cast<size_t>(count) - 1) << split.name;
      for (const double bound : bounds) {
        EXPECT_GT(bound, before) << split.name;
        before = bound;
      }
      EXPECT_LT(before, far_m) << split.name;
    }
  }
}

// A floor of 60 m with a box, seen along it from 2 m above.
Scene floor_scene() {
  Scene scene;
  add_quad(scene, "floor", {-30, 0, 30}, {60, 0, 0}, {0, 0, -60});
  add_box(scene, "box", {-1, 0, -10}, {1, 3, -8});
  scene.light.position_m = {10, 20, 5};
  scene.light.target_m = {0, 0, 0};
  scene.camera.eye_m = {0, 2, 28};
  scene.camera.target_m = {1, 1.5, 0};
  scene.camera.near_m = 0.2;
  scene.camera.far_m = 70;
  return scene;
}

Settings cascaded(int count, MapFit fit = MapFit::sphere) {
  Settings s;
  s.map.fit = fit;
  s.map.resolution = 512;
  s.cascades.count = count;
  return s;
}

TEST(Cascades, SliceTheViewFromNearToReach) {
  const Scene scene = floor_scene();
  Settings s = cascaded(3);
  s.cascades.splits = "logarithmic";
  s.map.reach_m = 0.2 * 64;
  const std::vector<ViewSlice> slices = view_slices(scene, s);
  ASSERT_EQ(slices.size(), 3u);
  for (size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(slices[k].begin_m, 0.2 * std::pow(4, k), 1e-12);
    EXPECT_NEAR(slices[k].end_m, 0.2 * std::pow(4, k + 1), 1e-12);
  }
  s.map.reach_m = {};
  EXPECT_EQ(view_slices(scene, s).back().end_m, 70) << "the camera's far plane";
}

TEST(Cascades, RefuseBoundsThatDoNotAscend) {
  const Scene scene = floor_scene();
  const auto refused = [&](const Settings& s) -> std::string {
    return refusal_of(ErrorKind::usage, [&] { view_slices(scene, s); });
  };
  Settings s = cascaded(3);
  s.cascades.splits = "manual";
  s.cascades.bounds_m = {5, 80};
  EXPECT_NE(refused(s).find("70 m, the camera's far plane; change cascades.bounds_m"), std::string::npos) << refused(s);
  s.cascades.bounds_m = {0.1, 5};
  EXPECT_NE(refused(s).find("0.2 m, the camera's near plane"), std::string::npos) << refused(s);
  s.cascades.bounds_m = {5, 20};
  EXPECT_EQ(refused(s), "");
  s.cascades.splits = "first_bound";
  s.cascades.first_m = 70;
  EXPECT_NE(refused(s).find("cascades.first_m"), std::string::npos) << refused(s);
  s.cascades.first_m = 7;
  s.map.reach_m = 0.1;
  EXPECT_NE(refused(s).find("map.reach_m"), std::string::npos) << refused(s);
}

// Law 29: the sphere holds the slice, and no smaller sphere with its middle on the axis does.
TEST(Cascades, FitTheLeastSphereOfASlice) {
  std::mt19937 random(62);
  std::uniform_real_distribution<double> unit(0, 1);
  Scene scene = floor_scene();
  int beyond_far = 0;
  for (int n = 0; n < 300; ++n) {
    Settings s = cascaded(2);
    s.view.width_px = 100 + static_cast<int>(random() % 200);
    s.view.height_px = 100 + static_cast<int>(random() % 200);
    scene.camera.fov_y_deg = 10 + 100 * unit(random);
    const double begin = 0.2 + 30 * unit(random);
    const ViewSlice slice{begin, begin + 30 * unit(random) + 0.5};
    const LightFrame frame = make_light_frame(scene, s, &slice);
    const CameraFrame camera = make_camera_frame(effective_camera(scene, s.view), s.view.width_px, s.view.height_px);
    const auto radius_around = [&](double along) {  // of the slice's corners, seen from a point of the axis
      double radius = 0;
      for (const double depth : {slice.begin_m, slice.end_m})
        radius = std::max(radius, std::hypot(depth - along, depth * std::hypot(camera.half_width, camera.half_height)));
      return radius;
    };
    double least = radius_around(slice.begin_m);
    for (int k = 0; k <= 4000; ++k)
      least = std::min(least, radius_around(slice.begin_m + k / 4000.0 * (slice.end_m - slice.begin_m)));
    // The square is one texel wider than the sphere, with the margin of a fit.
    const double radius = frame.extent_m / 2 / (1 + 1e-3);
    EXPECT_GE(frame.extent_m / 2, least * (1 - 1e-6));
    EXPECT_LE(radius, least * (1 + 2.5 / 512) + 1e-3) << n;
    beyond_far += std::hypot(camera.half_width, camera.half_height) >= 1;
    // All corners lie in the map, and the map's middle is the light's side of the sphere's.
    for (int corner = 0; corner < 8; ++corner) {
      const double depth = corner & 1 ? slice.end_m : slice.begin_m;
      const glm::dvec3 world =
          camera.eye_m + depth * (camera.forward + (corner & 2 ? 1.0 : -1.0) * camera.half_width * camera.right +
                                  (corner & 4 ? 1.0 : -1.0) * camera.half_height * camera.up);
      const glm::dvec2 at = frame.map_texels(frame.to_light(world));
      EXPECT_TRUE(at.x >= 0 && at.y >= 0 && at.x <= 512 && at.y <= 512);
    }
  }
  EXPECT_GT(beyond_far, 20);
  EXPECT_LT(beyond_far, 280);
}

TEST(Cascades, RoundTheRadiusUp) {
  const Scene scene = floor_scene();
  Settings s = cascaded(2);
  const ViewSlice slice{1, 20};
  const double plain = make_light_frame(scene, s, &slice).extent_m;
  s.cascades.radius_round_m = 4;
  const double rounded = make_light_frame(scene, s, &slice).extent_m;
  EXPECT_GT(rounded, plain);
  // The sphere's own radius is below plain / 2; with the texel and the margin of the fit the ratio to a multiple stays.
  const double per_metre = plain / (2 * plain * 0.5);
  EXPECT_NEAR(std::remainder(rounded / 2 / (1 + 1.0 / 511) / per_metre, 4.0), 0, 0.05);
}

// One cascade is the map of the settings; several have the light's position as origin, and the same texels as the map whose
// origin is in its middle.
TEST(Cascades, HaveTheMapsOfTheirSlices) {
  const Scene scene = floor_scene();
  for (const MapFit fit : {MapFit::sphere, MapFit::view})
    for (const bool snap : {false, true}) {
      Settings s = cascaded(1, fit);
      s.map.snap = snap;
      s.map.reach_m = 40;
      const std::vector<Technique> one = techniques_of(scene, s);
      ASSERT_EQ(one.size(), 1u);
      EXPECT_FALSE(one[0].cascade);
      EXPECT_EQ(one[0].frame, make_light_frame(scene, s));

      Settings four = s;
      four.cascades.count = 4;
      const std::vector<Technique> cascades = techniques_of(scene, four);
      ASSERT_EQ(cascades.size(), 4u);
      const std::vector<ViewSlice> slices = view_slices(scene, four);
      std::mt19937 random(63);
      std::uniform_real_distribution<double> unit(-1, 1);
      for (size_t k = 0; k < 4; ++k) {
        const LightFrame& frame = cascades[k].frame;
        ASSERT_TRUE(cascades[k].cascade);
        EXPECT_EQ(cascades[k].cascade->index, static_cast<int>(k));
        EXPECT_EQ(frame.origin_m, scene.light.position_m);
        const LightFrame apart = make_light_frame(scene, s, &slices[k]);  // its origin is in its middle
        EXPECT_EQ(apart.centre_m, glm::dvec2(0));
        EXPECT_EQ(frame.extent_m, apart.extent_m);
        EXPECT_EQ(frame.near_m, apart.near_m);
        EXPECT_EQ(frame.far_m, apart.far_m);
        if (k > 0) {
          EXPECT_GT(frame.extent_m, cascades[k - 1].frame.extent_m);
        }
        for (int n = 0; n < 100; ++n) {
          const glm::dvec3 p(30 * unit(random), 3 * unit(random), 30 * unit(random));
          const glm::dvec2 at = frame.map_texels(frame.to_light(p)), same = apart.map_texels(apart.to_light(p));
          EXPECT_LT(glm::length(at - same), 1e-9);
          EXPECT_NEAR(frame.window_depth(frame.to_light(p)), apart.window_depth(apart.to_light(p)), 1e-12);
          const glm::dvec4 clip = frame.clip_from_world(0) * glm::dvec4(p, 1),
                           other = apart.clip_from_world(0) * glm::dvec4(p, 1);
          EXPECT_LT(glm::length(clip - other), 1e-9);
          const glm::dvec4 drawn = frame.drawn_clip_from_world(frame.tile(0)) * glm::dvec4(p, 1),
                           other_drawn = apart.drawn_clip_from_world(apart.tile(0)) * glm::dvec4(p, 1);
          EXPECT_LT(glm::length(drawn - other_drawn), 1e-9);
        }
      }
    }
}

// map.fit = view has nothing to fit the map of an empty slice to. The notes say it; a sphere is there without a surface too.
TEST(Cascades, SayWhichSliceIsEmpty) {
  const Scene scene = floor_scene();
  Settings s = cascaded(3, MapFit::view);
  s.cascades.splits = "manual";
  s.cascades.bounds_m = {1, 65};  // nothing is nearer than 2 m, and the floor ends at 58 m
  const auto notes = [&] {
    std::string all;
    for (const std::string& note : light_notes(scene, s)) all += note + '\n';
    return all;
  };
  EXPECT_NE(notes().find(
                "no part of the scene lies in the slice of cascade 1 (0.2 to 1 m), 3 (65 to 70 m), so their maps are "
                "laid over the whole scene"),
            std::string::npos)
      << notes();
  EXPECT_EQ(techniques_of(scene, s)[0].frame.extent_m, techniques_of(scene, s)[2].frame.extent_m)
      << "of the whole scene";
  s.cascades.bounds_m = {10, 65};
  EXPECT_NE(notes().find("cascade 3 (65 to 70 m), so its map is laid"), std::string::npos) << notes();
  s.cascades.bounds_m = {10, 30};
  EXPECT_EQ(notes(), "");
  s.cascades.bounds_m = {1, 65};
  s.map.fit = MapFit::sphere;
  EXPECT_EQ(notes(), "");
}

// Snapped texels flicker in a zoom, unless the maps are fitted to one angle; an angle that is less than the camera's does nothing.
TEST(Cascades, SayWhatAZoomDoes) {
  const Scene scene = floor_scene();
  Settings s = cascaded(3, MapFit::sphere);
  s.view.near_m = 0.2, s.map.reach_m = 70;
  s.map.snap = true;
  const auto says = [&](const char* part) {
    const std::vector<std::string> notes = light_notes(scene, s);
    return std::any_of(notes.begin(), notes.end(),
                       [&](const std::string& note) { return note.find(part) != note.npos; });
  };
  const char* const changes = "motion.zoom changes the angle that the maps are fitted to";
  EXPECT_FALSE(says(changes));
  s.view.motion.zoom = 1.004;
  EXPECT_TRUE(says(changes));
  s.map.fit_fov_deg = 120;
  EXPECT_FALSE(says(changes));
  s.view.motion.zoom = 1;
  EXPECT_FALSE(says("map.fit_fov_deg = "));
  s.map.fit_fov_deg = 5;
  EXPECT_TRUE(says("map.fit_fov_deg = 5 has no effect: the camera's own angle"));
}

// Three cascades that end at these depths.
CascadePlace by_depth(double first, double second) {
  CascadePlace place;
  place.slices = {{0.5, first}, {first, second}, {second, 100}};
  place.selection = &find_cascade_selection("depth");
  place.shape = &find_cascade_blend("linear");
  place.depths = {{0.5, first}, {first, second}};
  place.view_forward = {0, 0, -1};
  return place;
}

TEST(Cascades, AreChosenByTheDepthAlongTheView) {
  const CascadePlace place = by_depth(2, 8);
  const glm::dvec3 eye(1, 2, 3);
  const auto at = [&](double depth) { return cascade_at(place, eye, eye + glm::dvec3(5, -4, -depth)); };
  EXPECT_EQ(at(0.25), 0);
  EXPECT_EQ(at(2), 0) << "a bound belongs to the nearer cascade";
  EXPECT_EQ(at(2.001), 1);
  EXPECT_EQ(at(8.001), 2);
  EXPECT_EQ(at(1000), 2);
}

TEST(Cascades, BlendIntoTheNextEvenly) {
  CascadePlace place = by_depth(2, 8);
  place.blend = 0.25f;
  const glm::dvec3 eye(1, 2, 3);
  const auto at = [&](double depth) { return choose_cascade(place, eye, eye + glm::dvec3(5, -4, -depth)); };
  EXPECT_EQ(at(6.4).next, 0);
  EXPECT_NEAR(at(7.25).next, 0.5, 1e-12) << "half of the last quarter of 6 m";
  EXPECT_EQ(at(7.25).cascade, 1);
  EXPECT_NEAR(at(8).next, 1, 1e-12);
  EXPECT_EQ(at(8.01).next, 0) << "the next one has begun";
  EXPECT_EQ(at(90).next, 0) << "the last blends into none";
}

TEST(CascadeBlends, AreTheirClosedForms) {
  for (const double way : {0.0, 0.1, 0.25, 0.5, 0.875, 1.0}) {
    EXPECT_EQ(find_cascade_blend("linear").in_double(way), way);
    EXPECT_NEAR(find_cascade_blend("smooth").in_double(way), 3 * way * way - 2 * way * way * way, 1e-15);
  }
  for (const CascadeBlend& blend : cascade_blends()) {
    EXPECT_EQ(blend.in_double(0), 0) << blend.name;
    EXPECT_EQ(blend.in_double(0.5), 0.5) << blend.name << ": as much before the middle as after it";
    EXPECT_EQ(blend.in_double(1), 1) << blend.name;
  }
}

// The weights that a shader makes in float stay within their bound, also from a place that is in error itself.
TEST(CascadeBlends, FloatArithmeticStaysWithinItsBound) {
  std::mt19937 random(65);
  std::uniform_real_distribution<float> unit(0, 1);
  for (const CascadeBlend& blend : cascade_blends()) {
    double largest = 0;
    for (int n = 0; n < 20000; ++n) {
      const float way = unit(random);
      const double off = 1e-6 * static_cast<double>(unit(random));
      float made = way;
      if (blend.name == "smooth") {
        const float square = way * way, falling = 3.0f - 2.0f * way;
        made = square * falling;
      }
      const Bounded bounds = blend.in_bounds(Bounded(static_cast<double>(way) + off / 2, off));
      EXPECT_EQ(bounds.value, blend.in_double(static_cast<double>(way) + off / 2)) << blend.name;
      largest = std::max(largest, std::abs(static_cast<double>(made) - bounds.value) / bounds.error);
    }
    EXPECT_LE(largest, 1) << blend.name;
    EXPECT_GT(largest, 0.3) << blend.name << ": the bound says nothing";
  }
}

TEST(Cascades, AreChosenByTheFirstMapOrSphereThatHoldsThePoint) {
  CascadePlace place = by_depth(2, 8);
  place.middles = {{0, 0, -1}, {0, 0, -5}};
  place.halves = {{2, 1, 3}, {4, 4, 10}};
  place.light_axes = glm::mat3({1, 0, 0}, {0, 0, 1}, {0, -1, 0});
  const glm::dvec3 eye(0);
  place.selection = &find_cascade_selection("map");
  EXPECT_EQ(cascade_at(place, eye, {1.9, 0, -1.9}), 0);
  EXPECT_EQ(cascade_at(place, eye, {2.1, 0, -1}), 1) << "beside the first";
  EXPECT_EQ(cascade_at(place, eye, {0, 0, -2.1}), 1) << "above the first";
  EXPECT_EQ(cascade_at(place, eye, {0, -3.1, -1}), 1) << "beyond the first";
  EXPECT_EQ(cascade_at(place, eye, {0, 9, -1}), 0) << "before it: it is still drawn and looked up there";
  EXPECT_EQ(cascade_at(place, eye, {0, 0, -9.5}), 2);
  place.selection = &find_cascade_selection("sphere");
  EXPECT_EQ(cascade_at(place, eye, {1.2, 1.2, -2}), 0);
  EXPECT_EQ(cascade_at(place, eye, {1.3, 1.3, -2}), 1);
  EXPECT_EQ(cascade_at(place, eye, {0, 0, -9.1}), 2);
  place.blend = 0.5f;
  EXPECT_NEAR(choose_cascade(place, eye, {0, 0, -2.5}).next, 0.5, 1e-12) << "three quarters of the radius";
}

// A choice in float stays within the bound of its error, by every selection, and where it does not, the excess says so.
TEST(Cascades, FloatArithmeticStaysWithinItsBound) {
  std::mt19937 random(64);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (const CascadeSelection& selection : cascade_selections()) {
    double largest = 0;
    for (int n = 0; n < 20000; ++n) {
      const auto vector = [&](float x, float y, float z) {
        return glm::vec3(x * unit(random), y * unit(random), z * unit(random));
      };
      CascadePlace place = by_depth(2, 8);
      place.selection = &selection;
      place.view_forward = glm::normalize(vector(1, 1, 1));
      place.middles = {vector(50, 5, 50), vector(50, 5, 50)};
      place.halves = {glm::vec3(2 + unit(random), 3, 4), glm::vec3(12 + unit(random), 13, 14)};
      const glm::dvec3 eye(100.0 * unit(random), 5.0 * unit(random), 1e3 * unit(random));
      const glm::vec3 p = vector(20, 3, 50), e(eye);
      const auto dot = [](glm::vec3 a, glm::vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; };
      const glm::vec3 way = p - place.middles[0];
      float made = 0;
      if (selection.name == "depth")
        made = (dot(p - e, place.view_forward) - place.depths[0].x) / (place.depths[0].y - place.depths[0].x);
      else if (selection.name == "sphere")
        made = std::sqrt(dot(way, way)) / place.halves[0].x;
      else
        made = std::max(
            {std::abs(way.x) / place.halves[0].x, std::abs(way.y) / place.halves[0].y, way.z / place.halves[0].z});
      const Bounded bounds = selection.place_in_bounds(place, 0, eye, p);
      EXPECT_NEAR(bounds.value, selection.place_in_double(place, 0, eye, p), 1e-9 * (1 + std::abs(bounds.value)));
      largest = std::max(largest, std::abs(static_cast<double>(made) - bounds.value) / bounds.error);
    }
    EXPECT_LE(largest, 1) << selection.name;
    EXPECT_GT(largest, 0.05) << selection.name << ": the bound says nothing";
  }
}

TEST(Cascades, TheExcessOfAChoiceCountsEveryWrongSide) {
  CascadePlace place = by_depth(2, 8);
  const glm::dvec3 eye(0);
  const glm::vec3 first(0, 0, -1), second(0, 0, -5);
  EXPECT_EQ(choice_excess(place, eye, first, {0, 0}), 0);
  EXPECT_GT(choice_excess(place, eye, first, {1, 0}), 1e5);
  EXPECT_GT(choice_excess(place, eye, second, {0, 0}), 1e5);
  EXPECT_GT(choice_excess(place, eye, second, {2, 0}), 1e5);
  EXPECT_EQ(choice_excess(place, eye, second, {3, 0}), std::numeric_limits<double>::infinity());
  EXPECT_EQ(choice_excess(place, eye, second, {1, std::nan("")}), std::numeric_limits<double>::infinity());
  // Just beyond a bound both choices are within float's error.
  const glm::vec3 near_bound(0, 0, std::nextafter(-2.0f, -3.0f));
  EXPECT_EQ(cascade_at(place, eye, near_bound), 1);
  EXPECT_LE(choice_excess(place, eye, near_bound, {0, 0}), 1);
  place.blend = 0.5f;
  EXPECT_GT(choice_excess(place, eye, {0, 0, -7}, {1, 0.5}), 1e5);
  EXPECT_LE(choice_excess(place, eye, {0, 0, -7}, {1, static_cast<double>(2.0f / 3)}), 1);
}

// The map of the next cascade holds the band in which it is blended in, unless it is not to.
// The square about the corners, because in a wide picture the least sphere stands on the slice's far end alone.
TEST(Cascades, CoverTheBandInWhichTheyAreBlendedIn) {
  Settings s;
  s.scene.name = "street";
  s.map.fit = MapFit::corner_square;
  s.map.reach_m = 80;
  s.cascades.count = 3;
  s.cascades.blend = 0.2;
  const Scene scene = make_scene(s.scene);
  const std::vector<ViewSlice> slices = view_slices(scene, s);
  for (const CascadeBlendOf of : {CascadeBlendOf::slice, CascadeBlendOf::end})
    for (const bool cover : {true, false}) {
      s.cascades.blend_of = of;
      s.cascades.cover_band = cover;
      const std::vector<Technique> cascades = techniques_of(scene, s);
      for (size_t k = 1; k < slices.size(); ++k) {
        const double begin = slices[k - 1].begin_m, end = slices[k - 1].end_m;
        const double band = of == CascadeBlendOf::slice ? 0.2 * (end - begin) : 0.2 * end;
        const ViewSlice fitted{cover ? end - band : end, slices[k].end_m};
        EXPECT_EQ(cascades[k].frame, make_light_frame(scene, s, &fitted)) << k;
        EXPECT_NEAR(cascades[0].cascade->depths[k - 1].x, of == CascadeBlendOf::slice ? begin : 0, 1e-5);
      }
    }
}

// three.js's CSM with fade: CSMShader.js blends over 0.25 (end / far)^2 of the way from near to far, half of it before the end
// and half after it, and CSM.js makes the square of each map, the last one too, wider by that.
TEST(Cascades, BlendOverABandOfTheSquareOfTheEnd) {
  Settings s;
  s.scene.name = "street";
  s.map.fit = MapFit::corner_square;
  s.view.near_m = 2;
  s.map.reach_m = 82;
  s.cascades.count = 3;
  s.cascades.splits = "manual";
  s.cascades.bounds_m = {20, 40};
  s.cascades.blend = 0.25;
  s.cascades.blend_of = CascadeBlendOf::square;
  const Scene scene = make_scene(s.scene);
  const double widths[] = {0.25 * 400 / 80, 0.25 * 1600 / 80, 0.25 * 82 * 82 / 80};
  const auto weight = [&](double depth) {
    const CascadePlace place = *techniques_of(scene, s).front().cascade;
    const glm::dvec3 eye = effective_camera(scene, s.view).eye_m;
    const CascadeChoice chosen = choose_cascade(place, eye, eye + depth * glm::dvec3(place.view_forward));
    return chosen.cascade + chosen.next;
  };
  for (const int k : {0, 1}) {
    const double end = s.cascades.bounds_m[static_cast<size_t>(k)], half = widths[k] / 2;
    EXPECT_EQ(weight(end - half - 0.001), k);
    EXPECT_NEAR(weight(end - half / 2), k + 0.25, 1e-4);
    EXPECT_NEAR(weight(end), k + 0.5, 1e-4);
    EXPECT_NEAR(weight(end + half / 2), k + 0.75, 1e-4);
    EXPECT_EQ(weight(end + half + 0.001), k + 1);
  }
  const std::vector<Technique> wider = techniques_of(scene, s);
  s.cascades.cover_band = false;
  const std::vector<Technique> own = techniques_of(scene, s);
  for (size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(wider[k].frame.extent_m - own[k].frame.extent_m, widths[k], 1e-9);
    EXPECT_EQ(wider[k].cascade->slices[k].end_m, k < 2 ? s.cascades.bounds_m[k] : 82);
  }
  // Other fits hold the slice with both of its bands.
  s.cascades.cover_band = true;
  s.map.fit = MapFit::sphere;
  const ViewSlice fitted{20 - widths[0] / 2, 40 + widths[1] / 2};
  EXPECT_EQ(techniques_of(scene, s)[1].frame, make_light_frame(scene, s, &fitted));
}

// A picture of 2 x 2 pixels that shows points at these depths, one of them of no surface.
TEST(Cascades, ReachFromTheNearestToTheFarthestVisiblePoint) {
  Settings s = cascaded(3, MapFit::sphere);
  const Scene scene = floor_scene();
  const Camera camera = effective_camera(scene, s.view);
  const CameraFrame frame = make_camera_frame(camera, 2, 2);
  ReceiverImage seen{Image<glm::vec3>(2, 2), Image<glm::vec3>(2, 2), Image<uint32_t>(2, 2, 0)};
  const double depths[] = {7, 0.5, 3, 31};
  for (size_t i = 0; i < 4; ++i) seen.position[i] = glm::vec3(frame.to_world({0.1 * depths[i], -0.2, depths[i]}));
  seen.primitive[1] = no_primitive;
  EXPECT_FALSE(visible_depths(s, seen, camera)) << "the planes";
  s.cascades.depths = CascadeDepths::visible;
  const std::optional<ViewSlice> visible = visible_depths(s, seen, camera);
  ASSERT_TRUE(visible);
  EXPECT_NEAR(visible->begin_m, 3, 1e-5);
  EXPECT_NEAR(visible->end_m, 31, 1e-5);
  // As if these depths were given.
  Settings by_hand = s;
  by_hand.cascades.depths = CascadeDepths::planes;
  by_hand.view.near_m = visible->begin_m;
  by_hand.map.reach_m = visible->end_m;
  for (const MapFit fit : {MapFit::sphere, MapFit::corner_square, MapFit::view}) {
    s.map.fit = by_hand.map.fit = fit;
    const std::vector<Technique> found = techniques_of(scene, s, visible), given = techniques_of(scene, by_hand);
    for (size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(found[k].frame, given[k].frame) << k;
      EXPECT_EQ(found[k].cascade->depths, given[k].cascade->depths) << k;
    }
    EXPECT_NE(found[0].frame, techniques_of(scene, s)[0].frame) << "the planes' are others";
  }
  s.map.reach_m = 20;
  EXPECT_EQ(visible_depths(s, seen, camera)->end_m, 20);
  s.map.reach_m = 2;
  EXPECT_FALSE(visible_depths(s, seen, camera)) << "nothing is visible before the reach";
  s.cascades.count = 1;
  EXPECT_FALSE(visible_depths(s, seen, camera));
}

// Law 29: the radius reads the picture's angle. With one that all frames share it stays, however the camera zooms.
TEST(Cascades, KeepTheirSizesUnderAZoomWithAnAngleToFitTo) {
  const Scene scene = floor_scene();
  for (const MapFit fit : {MapFit::sphere, MapFit::corner_sphere, MapFit::corner_square})
    for (const bool given : {false, true}) {
      Settings s = cascaded(3, fit);
      s.view.near_m = 0.5;
      s.map.reach_m = 50;
      s.view.fov_deg = 60;
      const std::vector<Technique> widest = techniques_of(scene, s);
      if (given) s.map.fit_fov_deg = 60;
      s.view.motion.zoom = 1.3;
      s.view.motion.frame = 2;
      const std::vector<Technique> zoomed = techniques_of(scene, s);
      for (size_t k = 0; k < 3; ++k) EXPECT_EQ(zoomed[k].frame.extent_m == widest[k].frame.extent_m, given) << k;
      if (given) {
        for (size_t k = 0; k < 3; ++k) EXPECT_EQ(zoomed[k].frame, widest[k].frame) << k;
        // A camera that zooms out further is still covered.
        s.view.motion.zoom = 0.8;
        EXPECT_GT(techniques_of(scene, s)[0].frame.extent_m, widest[0].frame.extent_m);
      }
    }
}

// Only the choice by the map asks a map for room for the taps.
TEST(Cascades, NeedRoomForTheTapsWhereTheMapIsChosenByIt) {
  Settings s;
  s.scene.name = "street";
  s.map.fit = MapFit::sphere;
  s.map.resolution = 4;
  s.filter.kind = "box";
  s.filter["size"] = 7;
  s.cascades.count = 3;
  EXPECT_EQ(techniques_of(make_scene(s.scene), s).size(), 3u);
  s.cascades.select = "map";
  expect_refused(ErrorKind::usage, {"the map of 4 texels holds no receiver with all of them"},
                 [&] { techniques_of(make_scene(s.scene), s); });
}

TEST(Cascades, MayHaveAResolutionEach) {
  Settings s;
  s.scene.name = "street";
  s.map.fit = MapFit::sphere;
  s.cascades.count = 3;
  s.cascades.resolutions = {1024, 512, 256};
  const std::vector<Technique> cascades = techniques_of(make_scene(s.scene), s);
  for (size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(cascades[k].frame.resolution, s.cascades.resolutions[k]);
    EXPECT_EQ(cascades[k].settings.map.resolution, s.cascades.resolutions[k]);
  }
}

// A setting of cascades that is said to have no effect has none: with other values of it the maps, and the choice of a cascade with
// its weight anywhere in the view, are the same.
TEST(Cascades, SettingsThatAreIdleChangeNothing) {
  const Scene scene = floor_scene();
  const std::vector<std::pair<std::string, std::vector<std::string>>> values = {
      {"cascades.select", {"depth", "map", "sphere"}},
      {"map.fit", {"sphere", "corner_square", "view"}},
      {"cascades.blend", {"0", "0.2"}},
      {"cascades.cover_band", {"true", "false"}},
      {"cascades.splits", {"practical", "exponent"}},
  };
  const std::vector<std::pair<std::string, std::vector<std::string>>> changed = {
      {"cascades.blend_of", {"slice", "end", "square"}},
      {"cascades.cover_band", {"true", "false"}},
      {"cascades.blend_shape", {"linear", "smooth"}},
      {"cascades.lambda", {"0.2", "0.8"}},
      {"cascades.exponent", {"2", "3"}},
  };
  const auto seen = [&](const Settings& s) {
    std::ostringstream text;
    const std::vector<Technique> all = techniques_of(scene, s);
    const Camera camera = effective_camera(scene, s.view);
    for (const Technique& one : all)
      text << one.frame.extent_m << ' ' << one.frame.centre_m.x << ' ' << one.frame.centre_m.y << ' ' << one.frame.far_m
           << ';';
    for (double depth = 0.3; depth < 60; depth *= 1.07)
      for (const double aside : {-0.4, 0.0, 0.3}) {
        const glm::dvec3 way = glm::normalize(camera.target_m - camera.eye_m) + aside * glm::dvec3(1, 0, 0);
        const CascadeChoice chosen = choose_cascade(*all.front().cascade, camera.eye_m, camera.eye_m + depth * way);
        text << chosen.cascade << ' ' << chosen.next << ';';
      }
    return text.str();
  };
  int idle = 0, read = 0;
  const std::function<void(Settings, size_t)> each = [&](Settings s, size_t n) {
    if (n < values.size()) {
      for (const std::string& value : values[n].second) {
        find_setting(values[n].first).set(s, value);
        each(s, n + 1);
      }
      return;
    }
    if (s.cascades.select == "sphere" && s.map.fit != MapFit::sphere) return;
    for (const auto& [name, all] : changed) {
      const Setting& row = find_setting(name);
      const bool is_idle = !row.why_idle(s, LightKind::directional).empty();
      std::set<std::string> different;
      for (const std::string& value : all) {
        row.set(s, value);
        different.insert(seen(s));
      }
      row.set(s, all.front());
      if (is_idle) {
        EXPECT_EQ(different.size(), 1u) << name << " with " << s.cascades.select << ", blend " << s.cascades.blend;
      }
      ++(is_idle ? idle : read);
    }
  };
  each(cascaded(3), 0);
  EXPECT_GT(idle, 50);
  EXPECT_GT(read, 50);
}

}  // namespace
}  // namespace noonmark
