// The numbers of a frame: classes by place, each planted where it must be found.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "tests/frames/good_frame.h"
#include "tests/support/kind_thrown.h"

namespace noonmark::test {
namespace {

// A plate of one metre's height above a floor: each pixel of the floor knows its distance from the shadow's edge.
const Delivered& plate() {
  static const Delivered made = good_frame("plate", 320, 180, 0);
  return made;
}

std::vector<size_t> counted_with(const FrameVerdict& verdict, bool lit) {
  std::vector<size_t> pixels;
  for (size_t i = 0; i < verdict.counted.size(); ++i)
    if (verdict.counted[i] && (verdict.truth.lit[i] != 0) == lit) pixels.push_back(i);
  return pixels;
}

double sum_of_classes(const FrameVerdict& verdict) {
  double sum = 0;
  for (const FrameClassRow& row : frame_classes) sum += verdict.metrics.at(std::string(row.metric));
  return sum;
}

TEST(Judge, TheTruthItselfHasNoError) {
  const FrameVerdict verdict = plate().judged();
  EXPECT_EQ(verdict.metrics.at("frame_error"), 0);
  EXPECT_EQ(verdict.metrics.at("frame_wrong"), 0);
  EXPECT_GT(verdict.metrics.at("counted"), 10000);
  EXPECT_EQ(sum_of_classes(verdict), 0);
}

TEST(Judge, ABlackFrameIsWrongWhereverTheTruthIsLit) {
  Delivered black = good_frame("plate", 320, 180, 0);
  for (float& v : black.frame.visibility.pixels)
    if (!std::isnan(v)) v = 0;
  const FrameVerdict verdict = black.judged();
  const double lit = static_cast<double>(counted_with(verdict, true).size());
  EXPECT_DOUBLE_EQ(verdict.metrics.at("frame_error"), lit / verdict.metrics.at("counted"));
  EXPECT_DOUBLE_EQ(verdict.metrics.at("frame_wrong"), verdict.metrics.at("frame_error"));
  EXPECT_NEAR(sum_of_classes(verdict), verdict.metrics.at("frame_error"), 1e-12);
  EXPECT_EQ(verdict.metrics.at("frame_contact") + verdict.metrics.at("frame_leak"), 0);
}

// Grey everywhere: the mean error is a tenth, and nothing is wrong by more than a half.
TEST(Judge, GreyIsAnErrorThatIsNowhereWrong) {
  Delivered grey = good_frame("plate", 320, 180, 0);
  for (float& v : grey.frame.visibility.pixels)
    if (!std::isnan(v)) v = v > 0.5f ? 0.9f : 0.1f;
  const FrameVerdict verdict = grey.judged();
  EXPECT_NEAR(verdict.metrics.at("frame_error"), 0.1, 1e-6);
  EXPECT_EQ(verdict.metrics.at("frame_wrong"), 0);
  EXPECT_NEAR(sum_of_classes(verdict), 0.1, 1e-6);
}

TEST(Judge, AnEdgeIsNearWithinItsDistanceAndNotBeyond) {
  Delivered black = good_frame("plate", 320, 180, 0);
  for (float& v : black.frame.visibility.pixels)
    if (!std::isnan(v)) v = 0;
  constexpr double reach = 0.05;
  const FrameVerdict verdict = black.judged({.edge_m = reach});
  // The other receivers of the floor tell where an edge is: between a lit and a dark one there is one.
  const auto on_floor = [&](size_t i) { return std::abs(verdict.receivers.position[i].y) < 1e-4f; };
  const auto place = [&](size_t i) { return glm::dvec2(verdict.light.to_light(verdict.receivers.position[i])); };
  int near = 0, far = 0;
  const std::vector<size_t> lit = counted_with(verdict, true), dark = counted_with(verdict, false);
  for (size_t k = 0; k < lit.size(); k += 5) {
    if (!on_floor(lit[k])) continue;
    double nearest = 1e9;
    for (const size_t j : dark)
      if (on_floor(j)) nearest = std::min(nearest, glm::length(place(lit[k]) - place(j)));
    if (nearest < 0.9 * reach) {
      EXPECT_EQ(verdict.classes[lit[k]], FrameClass::edge) << nearest;
      ++near;
    } else if (nearest > 2 * reach) {
      far += verdict.classes[lit[k]] == FrameClass::acne;
      EXPECT_NE(verdict.classes[lit[k]], FrameClass::leak);
    }
  }
  EXPECT_GT(near, 20);
  EXPECT_GT(far, 200);
}

// A pixel that is near an edge within one distance is near it within any larger one. Wires are thinner than what the places on a
// ring of a large radius tell apart.
TEST(Judge, WhatIsNearAnEdgeIsNearItWithinAnyLargerDistance) {
  Delivered inverted = good_frame("fence", 80, 45, 0);
  for (float& v : inverted.frame.visibility.pixels)
    if (!std::isnan(v)) v = 1 - v;
  std::vector<uint8_t> before(inverted.frame.visibility.size(), 0);
  size_t near_before = 0;
  for (const double pixels : {0.1, 0.3, 0.7, 1.0, 1.3, 2.0, 2.9, 5.0, 11.0, 30.0}) {
    const FrameVerdict verdict =
        inverted.judged({.edge_pixels = pixels, .accepted = {"inverted", "match", "alignment", "coverage"}});
    size_t near = 0;
    for (size_t i = 0; i < before.size(); ++i) {
      const bool is_edge = verdict.classes[i] == FrameClass::edge;
      EXPECT_TRUE(is_edge || !before[i]) << "pixel " << i << " at " << pixels;
      before[i] = is_edge;
      near += is_edge;
    }
    EXPECT_GE(near, near_before);
    near_before = near;
  }
  EXPECT_GT(near_before, 300u);
}

// All of the shadow is lit: the occluder is half a metre and more above the floor.
TEST(Judge, ALeakIsAContactWhereItsOccluderIsNear) {
  Delivered leaking = good_frame("plate", 320, 180, 0);
  for (float& v : leaking.frame.visibility.pixels)
    if (!std::isnan(v)) v = 1;
  const FrameVerdict far = leaking.judged({.edge_m = 0.01, .contact_m = 0.01}),
                     near = leaking.judged({.edge_m = 0.01, .contact_m = 100});
  EXPECT_GT(far.metrics.at("frame_leak"), 0.9 * far.metrics.at("frame_error"));
  EXPECT_EQ(far.metrics.at("frame_contact"), 0);
  EXPECT_DOUBLE_EQ(near.metrics.at("frame_contact"), far.metrics.at("frame_leak"));
  EXPECT_EQ(near.metrics.at("frame_leak"), 0);
  // The plate's faces are 0.4 m and 0.5 m above the floor, so an occluder is the lower one, along the light's ray.
  const glm::dvec3 to_light = glm::normalize(leaking.frame.light.position_m - leaking.frame.light.target_m);
  const double way = 0.4 / to_light.y;
  const FrameVerdict below = leaking.judged({.edge_m = 0.01, .contact_m = 0.98 * way}),
                     above = leaking.judged({.edge_m = 0.01, .contact_m = 1.4 * way});
  EXPECT_LT(below.metrics.at("frame_contact"), 0.02 * far.metrics.at("frame_leak"));
  EXPECT_GT(above.metrics.at("frame_contact"), 0.98 * far.metrics.at("frame_leak"));
}

// Two plates, one above the other in a part, over a floor; the light comes from straight above, and the frame has no shadow.
TEST(Judge, OnlyWhatTheMapLacksIsAMissingCaster) {
  Scene scene;
  const auto add = [&](const char* name, double low, double high, double y) {
    const auto first = static_cast<uint32_t>(scene.positions.size());
    scene.parts.push_back({name, static_cast<uint32_t>(scene.triangles.size()), 2});
    for (const glm::dvec2 at : {glm::dvec2(low, -3), {low, 3}, {high, 3}, {high, -3}})
      scene.positions.emplace_back(at.x, y, at.y);
    scene.triangles.insert(scene.triangles.end(), {{first, first + 1, first + 2}, {first, first + 2, first + 3}});
  };
  add("floor", -6, 6, 0);
  add("lost", -4, 1, 0.5);
  add("kept", -1, 4, 1);
  scene.light.position_m = {0, 10, 0};
  scene.light.target_m = {0, 0, 0};
  const raytrace::Tracer tracer(scene);
  Camera camera{.projection = Projection::orthographic, .eye_m = {0, 0.4, 0}, .target_m = {0, 0, 0}, .up = {0, 0, 1}};
  camera.height_m = 2;
  camera.near_m = 0.01;
  camera.far_m = 5;
  GivenFrame frame{.name = "frame",
                   .visibility = Image<float>(240, 40, 1),
                   .positions = {},
                   .view = ViewMatrix(make_camera_frame(camera, 240, 40).clip_from_world()),
                   .light = scene.light};
  frame.not_in_map = {"lost"};
  const FrameVerdict verdict = judge_frame(scene, tracer, frame, {.contact_m = 0.1});
  size_t missing = 0;
  for (size_t i = 0; i < verdict.classes.size(); ++i) {
    if (!verdict.counted[i]) continue;
    const float x = verdict.receivers.position[i].x;
    if (std::abs(x + 4) < 0.15f || std::abs(x + 1) < 0.15f || std::abs(x - 1) < 0.15f || std::abs(x - 4) < 0.15f)
      continue;
    EXPECT_EQ(verdict.classes[i], x < -4 || x > 4 ? FrameClass::none
                                  : x < -1        ? FrameClass::missing
                                                  : FrameClass::leak)
        << x;
    missing += verdict.classes[i] == FrameClass::missing;
  }
  EXPECT_GT(missing, 1000u);
  EXPECT_NEAR(verdict.metrics.at("frame_missing"), 3. / 12, 0.005);
  frame.not_in_map = {"lots"};
  expect_refused(ErrorKind::file, {"did you mean 'lost'"}, [&] { judge_frame(scene, tracer, frame, {}); });
}

// A filter errs on both sides of an edge.
TEST(Judge, BothSidesOfAnEdgeAreItsOwn) {
  const FrameVerdict verdict = good_frame("plate", 320, 180, 1).judged();
  double dark = 0;
  for (const size_t i : counted_with(verdict, false)) dark += verdict.error[i];
  ASSERT_GT(dark, 10);
  // Beside the plate's outline the blur mixes surfaces that lie far from each other.
  EXPECT_GT(verdict.metrics.at("frame_edge"), 0.98 * verdict.metrics.at("frame_error"));
}

// A floor below half a roof, seen from between them, under a light from straight above: the middle column of pixels lies
// exactly below the roof's edge.
TEST(Judge, AnAmbiguousTruthIsNotCounted) {
  Scene scene;
  scene.positions = {{-4, 0, -4}, {4, 0, -4}, {4, 0, 4}, {-4, 0, 4}, {0, 1, -4}, {4, 1, -4}, {4, 1, 4}, {0, 1, 4}};
  scene.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 6, 5}, {4, 7, 6}};
  scene.light.position_m = {0, 10, 0};
  scene.light.target_m = {0, 0, 0};
  Camera camera{.projection = Projection::orthographic,
                .eye_m = {0, 0.5, 0},
                .target_m = {0, 0, 0},
                .up = {0, 0, -1},
                .height_m = 4,
                .near_m = 0.1,
                .far_m = 2};
  constexpr int width = 65, height = 65;
  const raytrace::Tracer tracer(scene);
  const GivenFrame frame{.name = "frame",
                         .visibility = Image<float>(width, height, 1),
                         .positions = {},
                         .view = ViewMatrix(make_camera_frame(camera, width, height).clip_from_world()),
                         .light = scene.light};
  const FrameVerdict verdict = judge_frame(scene, tracer, frame, {});
  EXPECT_EQ(verdict.metrics.at("facing"), width * height);
  EXPECT_EQ(verdict.metrics.at("counted"), width * height - height);
  EXPECT_DOUBLE_EQ(verdict.metrics.at("ambiguous"), 1.0 / width);
  EXPECT_DOUBLE_EQ(verdict.metrics.at("frame_error"), 0.5) << "half of the floor is in shadow";
}

TEST(Judge, APenumbraIsItsOwnClass) {
  Delivered soft = good_frame("plate", 160, 90, 0);
  soft.frame.light.angular_diameter_deg = 5;
  const FrameVerdict verdict = soft.judged({.accepted = {"encoding"}});
  EXPECT_GT(verdict.metrics.at("frame_penumbra"), 0);
  for (size_t i = 0; i < verdict.classes.size(); ++i) {
    const float truth = verdict.truth_at(i);
    if (verdict.error[i] > 0) {
      EXPECT_EQ(verdict.classes[i] == FrameClass::penumbra, truth > 0 && truth < 1);
    }
  }
  EXPECT_NEAR(sum_of_classes(verdict), verdict.metrics.at("frame_error"), 1e-9);
}

TEST(Judge, PixelsThatTheFrameLeavesOutAreNotCounted) {
  Delivered holed = good_frame("plate", 160, 90, 0);
  const double all = holed.judged().metrics.at("counted");
  int holes = 0;
  const FrameVerdict before = holed.judged();
  for (int x = 60; x < 80; ++x)
    if (const size_t i = holed.frame.visibility.index(x, 60); before.counted[i]) {
      holed.frame.visibility[i] = no_surface;
      ++holes;
    }
  ASSERT_GT(holes, 10);
  holed.frame.marks_no_surface = true;
  EXPECT_EQ(holed.judged({.accepted = {"coverage"}}).metrics.at("counted"), all - holes);
}

// The same pixels as surfaces that are not judged: the coverage is whole, and nothing else changes.
TEST(Judge, ASurfaceThatIsNotJudgedCountsForTheCoverageAlone) {
  Delivered marked = good_frame("plate", 160, 90, 0);
  const FrameVerdict before = marked.judged();
  int marks = 0;
  for (int y = 30; y < 80; ++y)
    for (int x = 60; x < 80; ++x)
      if (const size_t i = marked.frame.visibility.index(x, y); before.receivers.primitive[i] != no_primitive) {
        marked.frame.visibility[i] = -2;
        marks += before.counted[i];
      }
  ASSERT_GT(marks, 100);
  take_marks(marked.frame);
  const FrameVerdict verdict = marked.judged();
  EXPECT_FALSE(verdict.refused());
  for (const char* const check : {"values", "coverage"})
    EXPECT_EQ(check_named(verdict, check).state, CheckState::passed) << check_named(verdict, check).says;
  EXPECT_EQ(verdict.metrics.at("counted"), before.metrics.at("counted") - marks);
  EXPECT_EQ(verdict.metrics.at("frame_error"), 0);
  for (const float error : verdict.error.pixels) EXPECT_EQ(error, 0);
}

// A light from below the floor: no number would say anything.
TEST(Judge, AFrameWithoutAReceiverThatFacesTheLightIsRefused) {
  Delivered below = good_frame("plate", 160, 90, 0);
  below.frame.light.target_m = below.frame.light.position_m + glm::dvec3(0, 1, 0);
  JudgeRules all_accepted;
  for (const FrameCheck& check : frame_checks()) all_accepted.accepted.emplace(check.name);
  expect_refused(ErrorKind::file, {"of which 0 face the light"}, [&] { below.judged(all_accepted); });
}

TEST(Judge, SizesMustAgree) {
  Delivered other = good_frame("plate", 160, 90, 0);
  other.frame.receivers = GivenReceivers::positions;
  other.frame.positions = Image<glm::dvec3>(80, 45, glm::dvec3(0));
  EXPECT_THROW(other.judged(), Error);
}

}  // namespace
}  // namespace noonmark::test
