// A good frame, and the wrong deliveries that several tests make of it.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string_view>

#include "tests/frames/good_frame.h"

namespace noonmark::test {

inline constexpr int width = 480, height = 270;

inline const Delivered& good() {
  static const Delivered made = good_frame("cube-room", width, height);
  return made;
}

inline Image<float> flipped_picture(const Image<float>& v, bool x_too, bool y_too) {
  Image<float> result = v;
  for (int y = 0; y < v.height; ++y)
    for (int x = 0; x < v.width; ++x) result.at(x, y) = v.at(x_too ? v.width - 1 - x : x, y_too ? v.height - 1 - y : y);
  return result;
}

inline Image<float> each_value(const Image<float>& v, const std::function<float(float)>& f) {
  Image<float> result = v;
  for (float& value : result.pixels)
    if (!std::isnan(value)) value = f(value);
  return result;
}

inline void expect_named(const GivenFrame& frame, std::string_view check, std::string_view words) {
  const FrameVerdict verdict = judge_frame(*good().scene, *good().tracer, frame, {});
  EXPECT_TRUE(verdict.refused());
  const CheckResult& found = check_named(verdict, check);
  EXPECT_EQ(found.state, CheckState::failed) << found.says;
  EXPECT_NE(found.says.find(words), std::string::npos) << found.says;
  const FrameVerdict accepted = judge_frame(*good().scene, *good().tracer, frame,
                                            {.accepted = {"values", "alignment", "coverage", "inverted", "shaded",
                                                          "intensity", "match", "encoding", "positions", "samples"}});
  EXPECT_FALSE(accepted.refused());
  EXPECT_TRUE(check_named(accepted, check).accepted) << "and the report says so";
}

inline GivenFrame with(const Image<float>& visibility) {
  GivenFrame frame = good().frame;
  frame.visibility = visibility;
  return frame;
}

// Every pixel has this visibility.
inline GivenFrame frame_through(const Camera& camera, const Scene& scene, float visibility = 0) {
  return {.name = "frame",
          .visibility = Image<float>(width, height, visibility),
          .positions = {},
          .view = ViewMatrix(make_camera_frame(camera, width, height).clip_from_world()),
          .light = scene.light};
}

// A frame of the same scene through another camera, delivered as one of the first.
inline GivenFrame with_picture_through(const glm::dmat4& moved, const Delivered& base = good()) {
  GivenFrame seen = base.frame;
  seen.view = ViewMatrix(moved * base.frame.view.clip_from_world());
  seen.visibility = Image<float>(width, height, 0);
  const FrameVerdict black = judge_frame(*base.scene, *base.tracer, seen, {});
  for (size_t i = 0; i < black.error.size(); ++i)
    seen.visibility[i] =
        black.receivers.primitive[i] == no_primitive ? no_surface : static_cast<float>(black.truth.lit[i]);
  seen.visibility = blurred(seen.visibility, black.truth, black.receivers, 1);
  seen.view = base.frame.view;
  return seen;
}

inline glm::dmat4 shifted_by(double x_px, double y_px) {
  glm::dmat4 m(1);
  m[3][0] = 2 * x_px / width;
  m[3][1] = -2 * y_px / height;
  return m;
}

inline Image<glm::dvec3> positions_of(const Delivered& from) {
  Image<glm::dvec3> positions(width, height, glm::dvec3(no_surface));
  for (size_t i = 0; i < positions.size(); ++i)
    if (from.receivers.primitive[i] != no_primitive) positions[i] = from.receivers.position[i];
  return positions;
}

inline GivenFrame with_positions(const std::function<glm::dvec3(glm::dvec3)>& f) {
  GivenFrame frame = good().frame;
  frame.receivers = GivenReceivers::positions;
  frame.positions = positions_of(good());
  for (glm::dvec3& p : frame.positions.pixels)
    if (!std::isnan(p.x)) p = f(p);
  return frame;
}

}  // namespace noonmark::test
