// A frame as a good renderer would deliver it, made from the truth itself: R1 at every pixel's centre, blurred a little as a
// filter does. Tests spoil it in known ways.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "frames/judge.h"
#include "scenes/camera_fit.h"
#include "scenes/library.h"
#include "technique/settings.h"

namespace noonmark::test {

inline constexpr float no_surface = std::numeric_limits<float>::quiet_NaN();

struct Delivered {
  std::unique_ptr<Scene> scene;
  std::unique_ptr<raytrace::Tracer> tracer;
  GivenFrame frame;
  ReceiverTruth truth;
  ReceiverImage receivers;

  FrameVerdict judged(const JudgeRules& rules = {}) const { return judge_frame(*scene, *tracer, frame, rules); }
};

inline ViewMatrix view_of(const Scene& scene, int width, int height) {
  ViewSettings settings;
  settings.width_px = width;
  settings.height_px = height;
  return ViewMatrix(make_camera_frame(effective_camera(scene, settings), width, height).clip_from_world());
}

// The mean of the values of facing pixels of the same plane within `reach`: a lookup's filter does not reach over an outline.
inline Image<float> blurred(const Image<float>& values, const ReceiverTruth& truth, const ReceiverImage& receivers,
                            int reach) {
  Image<float> result = values;
  for (int y = 0; y < values.height; ++y)
    for (int x = 0; x < values.width; ++x) {
      const size_t i = values.index(x, y);
      if (!truth.facing[i]) continue;
      float sum = 0, count = 0;
      for (int v = std::max(0, y - reach); v <= std::min(values.height - 1, y + reach); ++v)
        for (int u = std::max(0, x - reach); u <= std::min(values.width - 1, x + reach); ++u) {
          const size_t j = values.index(u, v);
          const glm::vec3 way = receivers.position[j] - receivers.position[i];
          if (!truth.facing[j] || std::abs(glm::dot(receivers.normal[i], way)) > 1e-3f * (1 + glm::length(way)))
            continue;
          sum += values[j];
          count += 1;
        }
      result[i] = sum / count;
    }
  return result;
}

inline Delivered good_frame(const std::string& scene_name, int width, int height, int blur = 1) {
  auto scene = std::make_unique<Scene>(make_scene({.name = scene_name}));
  auto tracer = std::make_unique<raytrace::Tracer>(*scene);
  GivenFrame frame{.name = "frame",
                   .visibility = Image<float>(width, height, 0),
                   .positions = {},
                   .view = view_of(*scene, width, height),
                   .light = scene->light};
  const FrameVerdict of_black = judge_frame(*scene, *tracer, frame, {});
  Image<float> lit(width, height, 0);
  for (size_t i = 0; i < lit.size(); ++i) lit[i] = of_black.truth.lit[i];
  frame.visibility = blurred(lit, of_black.truth, of_black.receivers, blur);
  for (size_t i = 0; i < lit.size(); ++i)
    if (of_black.receivers.primitive[i] == no_primitive) {
      frame.visibility[i] = no_surface;
      frame.marks_no_surface = true;
    }
  return {std::move(scene), std::move(tracer), std::move(frame), of_black.truth, of_black.receivers};
}

inline const CheckResult& check_named(const FrameVerdict& verdict, std::string_view name) {
  return *std::find_if(verdict.checks.begin(), verdict.checks.end(),
                       [&](const CheckResult& check) { return check.name == name; });
}

}  // namespace noonmark::test
