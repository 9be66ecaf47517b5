// A visibility that is flipped or shifted beside its own receivers is named, and bad shadows are not taken for it.
#include "frames/alignment.h"

#include <gtest/gtest.h>

#include <tuple>

#include "base/error.h"
#include "tests/frames/wrong_delivery.h"

namespace noonmark::test {
namespace {

GivenFrame beside_positions(const Image<float>& visibility) {
  GivenFrame frame = with_positions([](glm::dvec3 p) { return p; });
  frame.visibility = visibility;
  return frame;
}

// One mistake is one failure: the checks below it say why they were not made.
void expect_named_once(const GivenFrame& frame, std::string_view check, std::string_view words) {
  expect_named(frame, check, words);
  for (const CheckResult& one : judge_frame(*good().scene, *good().tracer, frame, {}).checks)
    EXPECT_EQ(one.state == CheckState::failed, one.name == check) << one.name << ": " << one.says;
}

TEST(Alignment, TheVisibilityAloneIsFlipped) {
  for (const auto& [x_too, y_too, words] : {std::tuple{true, false, "flipped left to right"},
                                            {false, true, "flipped upside down"},
                                            {true, true, "turned by 180 degrees"}}) {
    const Image<float> turned = flipped_picture(good().frame.visibility, x_too, y_too);
    expect_named_once(beside_positions(turned), "alignment", words);
    // Without a pixel that says that it has no surface, the values alone tell it.
    Image<float> filled = turned;
    for (float& v : filled.pixels) v = std::isnan(v) ? 1 : v;
    expect_named_once(beside_positions(filled), "alignment", words);
  }
}

// What leaves the picture comes in at its other side.
Image<float> rolled(const Image<float>& v, int dx, int dy) {
  Image<float> result = v;
  for (int y = 0; y < v.height; ++y)
    for (int x = 0; x < v.width; ++x)
      result.at((x + dx + v.width) % v.width, (y + dy + v.height) % v.height) = v.at(x, y);
  return result;
}

TEST(Alignment, TheVisibilityLiesAPixelBesideItsReceivers) {
  for (const auto& [dx, dy, words] :
       {std::tuple{1, 0, "(+1, +0)"}, {-1, 0, "(-1, +0)"}, {0, 1, "(+0, +1)"}, {1, -1, "(+1, -1)"}})
    expect_named_once(beside_positions(rolled(good().frame.visibility, dx, dy)), "alignment", words);
}

// Further than a pixel, or of another frame: what it is cannot be told, but not that all is well.
TEST(Alignment, SurfacesThatDoNotAgreeAreNamed) {
  for (const auto& [dx, dy] : {std::pair{2, 0}, {0, 3}, {-10, 0}})
    expect_named_once(beside_positions(rolled(good().frame.visibility, dx, dy)), "alignment",
                      "neither a flip nor a shift by a pixel explains it");
  Image<float> holed = good().frame.visibility;
  for (size_t i = 0, made = 0; i < holed.size() && made < 40; i += 97)
    if (!std::isnan(holed[i])) holed[i] = no_surface, ++made;
  expect_named_once(beside_positions(holed), "alignment", "40 pixels have a surface");
}

TEST(Alignment, NoPixelHasAVisibility) {
  const Image<float> none(width, height, no_surface);
  GivenFrame by_rays = with(none);
  by_rays.marks_no_surface = true;
  for (const GivenFrame& frame : {beside_positions(none), by_rays}) {
    const FrameVerdict verdict = judge_frame(*good().scene, *good().tracer, frame, {});
    for (const CheckResult& check : verdict.checks)
      EXPECT_EQ(check.state == CheckState::failed, check.name == "values") << check.name << ": " << check.says;
    EXPECT_NE(check_named(verdict, "values").says.find("no pixel has a visibility"), std::string::npos);
    EXPECT_THROW(judge_frame(*good().scene, *good().tracer, frame, {.accepted = {"values"}}), Error)
        << "there is nothing to judge, whatever is accepted";
  }
}

// A wall that fills the picture, in the shadow of a board above the picture; before the wall plates that the board's shadow
// passes behind. So each outline of a plate lies between a lit surface and a shadowed one, and no shadow edge is near.
struct Plates {
  Scene scene;
  std::unique_ptr<raytrace::Tracer> tracer;
  GivenFrame frame;
};

void add_rectangle(Scene& scene, glm::vec3 corner, glm::vec3 a, glm::vec3 b) {
  const auto first = static_cast<uint32_t>(scene.positions.size());
  for (const glm::vec3& p : {corner, corner + a, corner + a + b, corner + b}) scene.positions.push_back(p);
  scene.triangles.emplace_back(first, first + 1, first + 2);
  scene.triangles.emplace_back(first, first + 2, first + 3);
}

// Every pixel has this visibility. From z = 5, across this height.
GivenFrame frame_along_z(const Scene& scene, double height_m, float visibility) {
  return frame_through({.projection = Projection::orthographic,
                        .eye_m = {0, 0, 5},
                        .target_m = {0, 0, 0},
                        .height_m = height_m,
                        .near_m = 0.1,
                        .far_m = 12},
                       scene, visibility);
}

std::unique_ptr<Plates> plates() {
  Scene scene;
  add_rectangle(scene, {-20, -20, 0}, {40, 0, 0}, {0, 40, 0});
  for (int i = -2; i <= 2; ++i)
    for (int j = -1; j <= 1; ++j)
      add_rectangle(scene, {1.2f * static_cast<float>(i) - 0.27f, 1.2f * static_cast<float>(j) - 0.23f, 1},
                    {0.5f, 0, 0}, {0, 0.5f, 0});
  // The light falls steeply. Through a point of the wall it passes z = 1/2 five metres higher, where the picture has ended.
  add_rectangle(scene, {-20, 2.5f, 0.5f}, {40, 0, 0}, {0, 6, 0});
  scene.light.position_m = {0, 10, 1};
  scene.light.target_m = {0, 0, 0};
  const GivenFrame frame = frame_along_z(scene, 4, 0);
  std::unique_ptr<Plates> made(new Plates{std::move(scene), nullptr, frame});
  made->tracer = std::make_unique<raytrace::Tracer>(made->scene);
  const FrameVerdict black = judge_frame(made->scene, *made->tracer, made->frame, {});
  for (size_t i = 0; i < black.error.size(); ++i) made->frame.visibility[i] = black.truth.lit[i];
  return made;
}

CheckResult alignment_in(const Plates& plates, const Image<float>& visibility) {
  GivenFrame frame = plates.frame;
  frame.visibility = visibility;
  return check_named(judge_frame(plates.scene, *plates.tracer, frame, {}), "alignment");
}

// A roof with its ridge towards the camera, whose larger side faces away from the light. A shader that looks nothing up where N.L is
// below 0 writes 1 there, and is right on the side that faces the light.
TEST(Match, BackFacesMayBeLit) {
  Scene scene;
  add_rectangle(scene, {-3, -3, -1.5f}, {3.6f, 0, 1.8f}, {0, 6, 0});
  add_rectangle(scene, {0.6f, -3, 0.3f}, {2.4f, 0, -3}, {0, 6, 0});
  scene.light.position_m = {10, 0, 3};
  scene.light.target_m = {0, 0, 0};
  const raytrace::Tracer tracer(scene);
  const GivenFrame frame = frame_along_z(scene, 3, 1);
  const FrameVerdict verdict = judge_frame(scene, tracer, frame, {});
  size_t away = 0;
  for (size_t i = 0; i < verdict.truth.facing.size(); ++i) away += !verdict.truth.facing[i];
  ASSERT_GT(2 * away, frame.visibility.size());
  EXPECT_EQ(verdict.metrics.at("frame_error"), 0);
  EXPECT_NE(check_named(verdict, "match").state, CheckState::failed) << check_named(verdict, "match").says;
}

TEST(Alignment, AFullPictureIsShifted) {
  const std::unique_ptr<Plates> made = plates();
  const CheckResult straight = alignment_in(*made, made->frame.visibility);
  EXPECT_EQ(straight.state, CheckState::passed) << straight.says;
  for (const auto& [dx, dy, words] : {std::tuple{1, 0, "(+1, +0)"},
                                      {-1, 0, "(-1, +0)"},
                                      {0, 1, "(+0, +1)"},
                                      {-1, -1, "(-1, -1)"},
                                      {2, 0, "(+1, +0)"}}) {
    const CheckResult found = alignment_in(*made, rolled(made->frame.visibility, dx, dy));
    EXPECT_EQ(found.state, CheckState::failed) << words << ": " << found.says;
    EXPECT_NE(found.says.find(words), std::string::npos) << found.says;
  }
}

// Along one side of each outline the shadow is lost, or light is: the picture is not shifted by that.
TEST(Alignment, ALeakAlongOutlinesIsNoShift) {
  const std::unique_ptr<Plates> made = plates();
  const Image<float>& v = made->frame.visibility;
  for (const bool lit : {true, false}) {
    Image<float> leaking = v;
    for (int y = 0; y < height; ++y)
      for (int x = 1; x < width; ++x)
        if (v.at(x - 1, y) == static_cast<float>(lit) && v.at(x, y) != static_cast<float>(lit))
          leaking.at(x, y) = static_cast<float>(lit);
    ASSERT_NE(leaking.pixels, v.pixels);
    const CheckResult found = alignment_in(*made, leaking);
    EXPECT_EQ(found.state, CheckState::passed) << found.says;
  }
}

TEST(Alignment, WhereNoOutlineTellsAShiftIsNotChecked) {
  const std::unique_ptr<Plates> made = plates();
  const glm::dmat4 wall_alone = [] {
    glm::dmat4 m(1);
    m[0][0] = m[1][1] = 8;
    m[3][0] = 1;
    return m;
  }();
  GivenFrame frame = made->frame;
  frame.view = ViewMatrix(wall_alone * frame.view.clip_from_world());
  const CheckResult found = check_named(judge_frame(made->scene, *made->tracer, frame, {}), "alignment");
  EXPECT_EQ(found.state, CheckState::not_checked) << found.says;
  EXPECT_NE(found.says.find("20 are needed"), std::string::npos) << found.says;
}

}  // namespace
}  // namespace noonmark::test
