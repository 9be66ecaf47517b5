// Each wrong delivery is made from a good frame, and is named.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "base/error.h"
#include "frames/check_statistics.h"
#include "frames/frame.h"
#include "tests/frames/wrong_delivery.h"
#include "tests/support/kind_thrown.h"

namespace noonmark::test {
namespace {

// Rows moved down; the first row stays.
Image<float> a_row_down(const Image<float>& v) {
  Image<float> result = v;
  for (int y = 1; y < v.height; ++y)
    for (int x = 0; x < v.width; ++x) result.at(x, y) = v.at(x, y - 1);
  return result;
}

TEST(Checks, AGoodFramePassesAll) {
  for (const char* scene : {"cube-room", "spot-room", "point-room", "wall"}) {
    const Delivered frame = good_frame(scene, width, height);
    const FrameVerdict verdict = frame.judged();
    for (const CheckResult& check : verdict.checks)
      EXPECT_NE(check.state, CheckState::failed) << scene << ": " << check.name << ": " << check.says;
    EXPECT_FALSE(verdict.refused());
  }
}

// Acne over half of the picture is a bad shadow, not a bad delivery.
TEST(Checks, BadShadowsAreNoBadDelivery) {
  Delivered bad = good_frame("cube-room", width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (float& v = bad.frame.visibility.at(x, y); (x / 3 + y / 2) % 2 == 0 && !std::isnan(v)) v = 0;
  EXPECT_FALSE(bad.judged().refused());
  EXPECT_GT(bad.judged().metrics.at("frame_acne"), 0.3);
}

TEST(Checks, FlipsAreNamed) {
  expect_named(with(flipped_picture(good().frame.visibility, true, false)), "coverage", "flipped left to right");
  expect_named(with(flipped_picture(good().frame.visibility, false, true)), "coverage", "flipped upside down");
  expect_named(with(flipped_picture(good().frame.visibility, true, true)), "coverage", "turned by 180 degrees");
}

TEST(Checks, ARowOffIsNamed) { expect_named(with(a_row_down(good().frame.visibility)), "coverage", "rows or columns"); }

TEST(Checks, HalfAPixelIsNamedAsOneOfTwo) {
  const GivenFrame shifted = with_picture_through(shifted_by(-0.5, -0.5));
  expect_named(shifted, "coverage", "(+0.5, +0.5)");
  expect_named(shifted, "coverage", "one of these two");
}

TEST(Checks, AnotherCameraIsNamed) {
  glm::dmat4 zoomed(1);
  zoomed[0][0] = zoomed[1][1] = 1.05;
  expect_named(with_picture_through(zoomed), "coverage", "the camera or the scene is another one");
}

TEST(Checks, ExchangedLightAndShadowIsNamed) {
  expect_named(with(each_value(good().frame.visibility, [](float v) { return 1 - v; })), "inverted", "exchanged");
}

// Seven of sixteen taps are lit where all should be, and eight where none should: much acne, and much of the shadow lost.
TEST(Checks, LightAndShadowNearAHalfAreNotExchanged) {
  const GivenFrame frame =
      with(each_value(good().frame.visibility, [](float v) { return v > 0.5f ? 0.4375f : 0.502f; }));
  const CheckResult found = check_named(judge_frame(*good().scene, *good().tracer, frame, {}), "inverted");
  EXPECT_NE(found.state, CheckState::failed) << found.says;
}

TEST(Checks, AShadedFrameIsNamed) {
  expect_named(with(each_value(good().frame.visibility, [](float v) { return 0.1f + 0.43f * v; })), "shaded",
               "shaded frame");
}

// Times N.L, which is 1 where a surface faces the light.
TEST(Checks, AFrameThatIsShadedByItsCosineIsNamed) {
  GivenFrame frame = good().frame;
  const glm::dvec3 to_light = glm::normalize(frame.light.position_m - frame.light.target_m);
  for (size_t i = 0; i < frame.visibility.size(); ++i)
    frame.visibility[i] *=
        static_cast<float>(std::max(0.0, glm::dot(glm::dvec3(good().receivers.normal[i]), to_light)));
  expect_named(frame, "shaded", "shaded frame");
}

// A number in [0,1) that looks random.
float noise(size_t i) { return static_cast<float>((i * 2654435761u >> 8) % 1000) / 1000; }

// Acne that a filter has softened darkens every lit surface, as shading does.
TEST(Checks, AcneIsNeitherShadingNorSrgb) {
  GivenFrame everywhere = good().frame, weak = good().frame, half = good().frame;
  for (size_t i = 0; i < everywhere.visibility.size(); ++i) {
    if (std::isnan(everywhere.visibility[i]) || !good().truth.lit[i]) continue;
    everywhere.visibility[i] *= 0.6f + 0.3f * noise(i);
    if (i % 20 == 0) weak.visibility[i] *= 0.9f + 0.09f * noise(i);
    if (noise(i) < 0.5f) half.visibility[i] *= 0.85f;
  }
  for (const GivenFrame& frame : {everywhere, weak, half}) {
    const FrameVerdict verdict = judge_frame(*good().scene, *good().tracer, frame, {});
    for (const CheckResult& check : verdict.checks) EXPECT_NE(check.state, CheckState::failed) << check.says;
    EXPECT_GT(verdict.metrics.at("frame_acne"), 1e-3);
  }
}

// A bias moves the shadow's edge, so the dark side has more of the filter's values than the lit side.
TEST(Checks, AMovedEdgeIsNotSrgb) {
  GivenFrame frame = good().frame;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x + 2 < width; ++x) {
      const float from = good().frame.visibility.at(x + 2, y);
      if (!std::isnan(frame.visibility.at(x, y)) && !std::isnan(from)) frame.visibility.at(x, y) = from;
    }
  const FrameVerdict verdict = judge_frame(*good().scene, *good().tracer, frame, {});
  EXPECT_NE(check_named(verdict, "encoding").state, CheckState::failed) << check_named(verdict, "encoding").says;
  EXPECT_NE(check_named(verdict, "shaded").state, CheckState::failed) << check_named(verdict, "shaded").says;
}

TEST(Checks, AnIntensityBelowOneIsNamed) {
  expect_named(with(each_value(good().frame.visibility, [](float v) { return 0.5f + 0.5f * v; })), "intensity",
               "intensity");
}

// What is measured between all lit and all dark cannot be scaled, shaded or exchanged on its way here.
TEST(Checks, WhatIsNormalisedIsTheRenderersOwn) {
  for (const auto& [check, change] : std::vector<std::pair<const char*, float (*)(float)>>{
           {"intensity", [](float v) { return 0.5f + 0.5f * v; }}, {"inverted", [](float v) { return 1 - v; }}}) {
    GivenFrame frame = with(each_value(good().frame.visibility, change));
    const FrameVerdict refused = judge_frame(*good().scene, *good().tracer, frame, {});
    frame.normalised = true;
    const FrameVerdict verdict = judge_frame(*good().scene, *good().tracer, frame, {.accepted = {"alignment"}});
    EXPECT_TRUE(refused.refused() && !verdict.refused()) << check;
    EXPECT_EQ(check_named(verdict, check).state, CheckState::failed) << check;
    EXPECT_TRUE(check_named(verdict, check).accepted) << check;
    EXPECT_EQ(check_named(verdict, check).says.find(check_named(refused, check).says), 0u) << check;
  }
  GivenFrame outside = with(each_value(good().frame.visibility, [](float v) { return 2 * v; }));
  outside.normalised = true;
  EXPECT_TRUE(judge_frame(*good().scene, *good().tracer, outside, {}).refused()) << "values are the delivery's";
}

// A bias that is too large and a format that is too coarse lose all shadows. That is judged, because the delivery is right.
TEST(Checks, LostShadowsAreJudged) {
  const FrameVerdict verdict = judge_frame(*good().scene, *good().tracer,
                                           with(each_value(good().frame.visibility, [](float) { return 1.0f; })), {});
  EXPECT_FALSE(verdict.refused());
  EXPECT_EQ(check_named(verdict, "match").state, CheckState::not_checked) << check_named(verdict, "match").says;
  EXPECT_GT(verdict.metrics.at("frame_leak") + verdict.metrics.at("frame_contact"), 0.01);
}

TEST(Checks, AnotherLightIsNamed) {
  GivenFrame frame = good().frame;
  frame.light.position_m = {-frame.light.position_m.x, frame.light.position_m.y, -frame.light.position_m.z};
  expect_named(frame, "match", "inside shadows of the frame");
}

// A map of coarse texels that loses most shadows and puts the rest beside their places: no pixel of them lies a texel from a true one.
TEST(Checks, AShadowBesideItsPlaceIsNotAnotherLight) {
  const int texel = height / 16;
  const Image<float>& v = good().frame.visibility;
  const ReceiverTruth& truth = good().truth;
  const auto shadowed = [&](int x, int y) {
    const size_t i = v.index(x, y);
    return truth.facing[i] && !truth.ambiguous[i] && !truth.lit[i];
  };
  Image<float> beside = each_value(v, [](float) { return 1.0f; });
  size_t dark = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      bool near = false;
      for (int k = -texel; k <= texel; ++k) near = near || (x + k >= 0 && x + k < width && shadowed(x + k, y));
      if (near && v.at(x, y) == 1) beside.at(x, y) = 0, ++dark;
    }
  ASSERT_GT(dark, 1000U);
  const CheckResult found = check_named(judge_frame(*good().scene, *good().tracer, with(beside), {}), "match");
  EXPECT_EQ(found.state, CheckState::not_checked) << found.says;
}

TEST(Checks, ALightThatIsTurnedRoundIsNamed) {
  GivenFrame frame = good().frame;
  std::swap(frame.light.position_m, frame.light.target_m);
  const CheckResult found = check_named(judge_frame(*good().scene, *good().tracer, frame, {}), "match");
  EXPECT_EQ(found.state, CheckState::not_checked) << "it reaches nothing, so a shader of back faces may write 1";
  EXPECT_NE(found.says.find("turned round"), std::string::npos) << found.says;
}

TEST(Checks, ValuesOutsideAreNamed) {
  GivenFrame frame = good().frame;
  frame.visibility.at(7, 260) = 1.5f;
  expect_named(frame, "values", "x = 7, y = 260");
}

TEST(Checks, HalfAPixelBesidePositionsIsNamed) {
  GivenFrame frame = with_positions([](glm::dvec3 p) { return p; });
  frame.visibility = with_picture_through(shifted_by(-0.5, -0.5)).visibility;
  expect_named(frame, "alignment", "(+0.5, +0.5)");
  expect_named(frame, "alignment", "one of these two");
}

// Four samples of each pixel: one that sees no surface makes it none, or is left out. No shift is like what that does around a
// whole sphere.
TEST(Checks, MultisamplingBesidePositionsIsNamed) {
  const Delivered sphere = good_frame("sphere", width, height);
  for (const bool any : {true, false}) {
    GivenFrame frame = sphere.frame;
    frame.receivers = GivenReceivers::positions;
    frame.positions = positions_of(sphere);
    Image<float> sum(width, height, 0), count(width, height, 0);
    for (const auto& [x, y] : {std::pair(-0.125, -0.375), {0.375, -0.125}, {-0.375, 0.125}, {0.125, 0.375}}) {
      const GivenFrame sample = with_picture_through(shifted_by(x, y), sphere);
      for (size_t i = 0; i < sum.size(); ++i)
        if (!std::isnan(sample.visibility[i])) sum[i] += sample.visibility[i], ++count[i];
    }
    for (size_t i = 0; i < sum.size(); ++i)
      frame.visibility[i] = count[i] >= (any ? 1 : 4) ? sum[i] / count[i] : no_surface;
    const CheckResult found = check_named(judge_frame(*sphere.scene, *sphere.tracer, frame, {}), "alignment");
    EXPECT_EQ(found.state, CheckState::failed) << found.says;
    EXPECT_NE(found.says.find(any ? "too large there: multisampling" : "too small there: multisampling"),
              std::string::npos)
        << found.says;
  }
}

// Four samples of each pixel, of which -1 is one that saw no surface.
TEST(Checks, ResolvedMultisamplingIsNamed) {
  GivenFrame frame = good().frame;
  Image<float> sum(width, height, 0);
  for (const auto& [x, y] : {std::pair(-0.125, -0.375), {0.375, -0.125}, {-0.375, 0.125}, {0.125, 0.375}}) {
    const GivenFrame sample = with_picture_through(shifted_by(x, y));
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += std::isnan(sample.visibility[i]) ? -1 : sample.visibility[i];
  }
  for (size_t i = 0; i < sum.size(); ++i) frame.visibility[i] = sum[i] == -4 ? no_surface : sum[i] / 4;
  expect_named(frame, "values", "multisampling");
}

TEST(Checks, GivenPositionsPass) {
  const GivenFrame frame = with_positions([](glm::dvec3 p) { return p; });
  const FrameVerdict verdict = judge_frame(*good().scene, *good().tracer, frame, {});
  EXPECT_EQ(check_named(verdict, "positions").state, CheckState::passed) << check_named(verdict, "positions").says;
  EXPECT_EQ(verdict.receivers.primitive.pixels, good().receivers.primitive.pixels);
}

// Rounded to a half float: 11 bits, and multiples of 2^-24 where the value is small.
double as_half(double value) {
  int exponent = 0;
  std::frexp(value, &exponent);
  const int last = std::max(exponent - 11, -24);
  return std::ldexp(std::round(std::ldexp(value, -last)), last);
}

// Whether the near plane cuts the triangle of a pixel.
bool is_cut(const Delivered& from, size_t pixel) {
  const glm::uvec3 t = from.scene->triangles[from.receivers.primitive[pixel]];
  int before = 0;
  for (const uint32_t v : {t.x, t.y, t.z}) {
    const glm::dvec4 clip = from.frame.view.clip_from_world() * glm::dvec4(from.scene->positions[v], 1);
    before += clip.z < -clip.w;
  }
  return before == 1 || before == 2;
}

// The positions of pixels, each moved in its triangle's plane by so many pixels to the right, where `moves` says so.
GivenFrame with_moved(const std::function<bool(size_t)>& moves, double pixels) {
  GivenFrame frame = with_positions([](glm::dvec3 p) { return p; });
  const ViewMatrix beside(shifted_by(-pixels, 0) * frame.view.clip_from_world());
  const ReceiverImage moved = resolve_receivers(*good().scene, beside, good().receivers.primitive);
  for (size_t i = 0; i < frame.positions.size(); ++i)
    if (good().receivers.primitive[i] != no_primitive && moves(i)) frame.positions[i] = moved.position[i];
  return frame;
}

// A software rasteriser moves what it clips at the near plane, and nothing else. In this picture it is most of the pixels.
TEST(Checks, WhatTheNearPlaneCutsMayBeMoved) {
  size_t cut = 0, whole = 0;
  for (size_t i = 0; i < good().receivers.primitive.size(); ++i)
    if (good().receivers.primitive[i] != no_primitive) ++(is_cut(good(), i) ? cut : whole);
  ASSERT_GT(cut, whole);
  ASSERT_GT(whole, 100u);
  const GivenFrame clipped = with_moved([](size_t i) { return is_cut(good(), i); }, 0.24);
  const CheckResult found = check_named(judge_frame(*good().scene, *good().tracer, clipped, {}), "positions");
  EXPECT_EQ(found.state, CheckState::passed) << found.says;
  EXPECT_NE(found.says.find("near plane cuts"), std::string::npos) << "the surface is named: " << found.says;
  EXPECT_NE(found.says.find("(+0.24, "), std::string::npos) << found.says;
  expect_named(with_moved([](size_t) { return true; }, 0.24), "positions", "(+0.24, ");
  expect_named(with_moved([](size_t i) { return !is_cut(good(), i); }, 0.24), "positions", "(+0.24, ");
}

// The triangles of one part.
std::function<bool(uint32_t)> of_part(const std::string& name) {
  const Part part = *std::find_if(good().scene->parts.begin(), good().scene->parts.end(),
                                  [&](const Part& one) { return one.name == name; });
  return [part](uint32_t triangle) { return triangle - part.first_triangle < part.triangle_count; };
}

TEST(Checks, ASurfaceThatIsMovedInThePictureIsNamed) {
  const auto on_cube = of_part("standing cube");
  const GivenFrame frame = with_moved([&](size_t i) { return on_cube(good().receivers.primitive[i]); }, 0.24);
  expect_named(frame, "positions", "'standing cube' lie (+0.24, ");
  expect_named(frame, "positions", "other surfaces 0.000 at most");
}

// The frame of a scene in which one part stands elsewhere. All of its positions are in their own pixels.
TEST(Checks, AnObjectThatStandsElsewhereIsNamed) {
  const auto on_cube = of_part("turned cube");
  for (const glm::vec3 by :
       {glm::vec3(0.05f, 0, 0), glm::vec3(0, 0.03f, 0), glm::vec3(1, 0, 1), glm::vec3(0, 100, 0)}) {
    Scene moved = *good().scene;
    std::set<uint32_t> corners;
    for (uint32_t t = 0; t < moved.triangles.size(); ++t)
      if (on_cube(t)) corners.insert({moved.triangles[t].x, moved.triangles[t].y, moved.triangles[t].z});
    for (const uint32_t corner : corners) moved.positions[corner] += by;
    const raytrace::Tracer tracer(moved);
    GivenFrame frame = good().frame;
    const ReceiverImage receivers =
        resolve_receivers(moved, frame.view, tracer.seen_primitives(frame.view, width, height));
    frame.receivers = GivenReceivers::positions;
    frame.positions = Image<glm::dvec3>(width, height, glm::dvec3(no_surface));
    for (size_t i = 0; i < receivers.primitive.size(); ++i) {
      const bool seen = receivers.primitive[i] != no_primitive;
      if (seen) frame.positions[i] = receivers.position[i];
      frame.visibility[i] = !seen ? no_surface : std::isnan(frame.visibility[i]) ? 1.0f : frame.visibility[i];
    }
    expect_named(frame, "positions", "'turned cube'");
  }
}

TEST(Checks, HalfFloatPositionsAreNamed) {
  expect_named(with_positions([](glm::dvec3 p) { return glm::dvec3(as_half(p.x), as_half(p.y), as_half(p.z)); }),
               "positions", "half float");
}

TEST(Checks, PositionsInAnotherUnitAreNamed) {
  expect_named(with_positions([](glm::dvec3 p) { return 100.0 * p; }), "positions", "");
}

TEST(Checks, HalfIsKnownByItsBits) {
  for (const double value : {0.0, 1.0, 1 + 0x1p-10, 65504.0, 0x1p-24, -0.333251953125})
    EXPECT_TRUE(is_half(value)) << value;
  for (const double value : {1 + 0x1p-11, 65536.0 * 2, 0x1p-25, 1.0 / 3}) EXPECT_FALSE(is_half(value)) << value;
}

// Depths of a buffer whose matrix was declared with near and far exchanged.
TEST(Checks, ReversedDepthsAreNamed) {
  GivenFrame frame = with_positions([](glm::dvec3 p) { return p; });
  frame.receivers = GivenReceivers::depth;
  glm::dmat4 turned(1);
  turned[2][2] = -1;
  frame.view = ViewMatrix(turned * frame.view.clip_from_world());
  expect_named(frame, "positions", "'reversed'");
  for (const CheckResult& one : judge_frame(*good().scene, *good().tracer, frame, {}).checks)
    EXPECT_EQ(one.state == CheckState::failed, one.name == "positions") << one.name << ": " << one.says;
}

// A near plane of half a millimetre: a step of 24 bits is ten times wider at the scene than positions may be off.
TEST(Checks, TheStepsOfDepthsAreNoOtherPose) {
  const auto at_steps = [](double moved_m) {
    GivenFrame frame = good().frame;
    frame.receivers = GivenReceivers::depth;
    glm::dmat4 clip = frame.view.clip_from_world();
    for (int column = 0; column < 4; ++column) clip[column][2] = clip[column][3] - (column == 3 ? 2 * 0.0005 : 0);
    frame.view = ViewMatrix(clip);
    const ReceiverImage& receivers = good().receivers;
    frame.positions = Image<glm::dvec3>(frame.visibility.width, frame.visibility.height, glm::dvec3(no_surface));
    for (int y = 0; y < frame.visibility.height; ++y)
      for (int x = 0; x < frame.visibility.width; ++x) {
        const size_t i = frame.visibility.index(x, y);
        if (receivers.primitive[i] == no_primitive) continue;
        const glm::dvec3 p = glm::dvec3(receivers.position[i]) + moved_m * glm::dvec3(receivers.normal[i]);
        const double steps = 0x1p24 - 1,
                     depth = frame.view.pixel_of(p, frame.visibility.width, frame.visibility.height).z;
        frame.positions[i] = frame.view.world_at(x, y, 2 * (std::round((depth / 2 + 0.5) * steps) / steps) - 1,
                                                 frame.visibility.width, frame.visibility.height);
      }
    return check_named(judge_frame(*good().scene, *good().tracer, frame, {}), "positions");
  };
  EXPECT_EQ(at_steps(0).state, CheckState::passed) << at_steps(0).says;
  EXPECT_EQ(at_steps(0.2).state, CheckState::failed) << at_steps(0.2).says;
}

// Without a far plane such a camera's rays would begin at infinity.
TEST(Checks, ReversedDepthsWithoutAFarPlaneAreAnError) {
  GivenFrame frame = good().frame;
  const glm::dmat4 endless =
      glm::transpose(glm::dmat4(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0.2, 0, 0, -1, 0));  // z: w - 0.2
  frame.view = ViewMatrix(endless);
  EXPECT_TRUE(judge_frame(*good().scene, *good().tracer, frame, {}).refused());
}

// Nothing is shown but what is in shadow: what compares it with light has nothing to compare.
TEST(Checks, WhatHasTooFewPixelsIsNotChecked) {
  GivenFrame frame = good().frame;
  for (size_t i = 0; i < frame.visibility.size(); ++i)
    if (good().truth.lit[i]) frame.visibility[i] = no_surface;
  const FrameVerdict verdict = judge_frame(*good().scene, *good().tracer, frame, {});
  for (const char* name : {"inverted", "match"}) {
    EXPECT_EQ(check_named(verdict, name).state, CheckState::not_checked) << name;
    EXPECT_NE(check_named(verdict, name).says.find("0 pixels are deep in true light"), std::string::npos)
        << check_named(verdict, name).says;
  }
  for (const CheckResult& check : verdict.checks)
    EXPECT_EQ(check.says.find("nan"), std::string::npos) << check.name << ": " << check.says;
}

TEST(Checks, AFrameThatDoesNotFitIntoMemoryIsRefused) {
  require_frame_memory("V.exr", 100, 100, {1'000'000'000, "a test"});
  expect_refused(ErrorKind::file, {"V.exr", "100000 x 50000", "1.0 GB are available (a test)"}, [] {
    require_frame_memory("V.exr", 100'000, 50'000, {1'000'000'000, "a test"});
  });
}

TEST(Checks, AnUnknownNameSuggestsOne) {
  expect_refused(ErrorKind::usage, {"'coverage'"}, [&] { require_check("coverge"); });
}

}  // namespace
}  // namespace noonmark::test
