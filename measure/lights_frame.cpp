#include "measure/lights_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/srgb.h"
#include "compare/ladder/flip.h"
#include "measure/view_shading.h"
#include "technique/light_power.h"

namespace noonmark {
namespace {

// What is shown as white is the light that this share of the pixels that are lit in truth does not exceed: a few pixels beside
// a lamp would otherwise make the rest black.
constexpr double below_white = 0.95;

double lux_of_all(std::span<const LightPart> parts, size_t i) {
  double sum = 0;
  for (const LightPart& part : parts) sum += part.lux[i];
  return sum;
}

bool counts(std::span<const LightPart> parts, size_t i) {
  return lux_of_all(parts, i) > 0 &&
         std::none_of(parts.begin(), parts.end(), [&](const LightPart& part) { return part.ambiguous[i] != 0; });
}

// The lux that is shown as white; 1 if no pixel is lit.
double white_lux(std::span<const LightPart> parts) {
  std::vector<double> lux;
  for (size_t i = 0; i < parts[0].lux.size(); ++i) {
    double lit = 0;
    for (const LightPart& part : parts) lit += static_cast<double>(part.truth[i]) * part.lux[i];
    if (lit > 0 && counts(parts, i)) lux.push_back(lit);
  }
  if (lux.empty()) return 1;
  const auto at = lux.begin() + static_cast<std::ptrdiff_t>(below_white * static_cast<double>(lux.size() - 1));
  std::nth_element(lux.begin(), at, lux.end());
  return *at;
}

// Linear light, 1 is white. The ambient light is that of view_shading.h.
glm::dvec3 shaded(std::span<const LightPart> parts, Image<float> LightPart::*visibility, double white, size_t i) {
  glm::dvec3 light(Clay::ambient);
  for (const LightPart& part : parts)
    light += part.color * (static_cast<double>((part.*visibility)[i]) * part.lux[i] / white);
  return Clay::albedo * light;
}

Image<glm::u8vec3> shown_as(std::span<const LightPart> parts, Image<float> LightPart::*visibility, double white) {
  const LightPart& first = parts[0];
  Image<glm::u8vec3> picture(first.lux.width, first.lux.height,
                             {background_srgb[0], background_srgb[1], background_srgb[2]});
  for (size_t i = 0; i < picture.size(); ++i) {
    if (!first.surface[i]) continue;
    const glm::dvec3 color = shaded(parts, visibility, white, i);
    picture[i] = {srgb_encoded(color.x), srgb_encoded(color.y), srgb_encoded(color.z)};
  }
  return picture;
}

}  // namespace

LightPart light_part(const Measurement& m) {
  const Settings& settings = m.technique.settings;
  const Light light = effective_light(m.scene, settings);
  const double scale = luminance(light.power.color);
  const int width = m.receivers.width(), height = m.receivers.height();
  LightPart part{scale > 0 ? light.power.color / scale : glm::dvec3(1),
                 {width, height, 0},
                 {width, height, 0},
                 {width, height, 0},
                 {width, height, 0},
                 {width, height, 0},
                 {width, height, 0}};
  for (size_t i = 0; i < part.lux.size(); ++i) {
    part.surface[i] = m.receivers.primitive[i] != no_primitive;
    if (!part.surface[i] || !(m.ladder.flags[i] & flag_facing)) continue;
    part.lux[i] = static_cast<float>(
        scale * illuminance_lux(light, m.technique.frame, m.receivers.position[i], glm::dvec3(m.receivers.normal[i])));
    if (part.lux[i] == 0) continue;
    part.ambiguous[i] = !is_counted(m.ladder, i);
    part.shown[i] = m.ladder.shown()[i];
    part.truth[i] = m.ladder.truth()[i];
    part.soft_truth[i] = m.ladder.soft_truth()[i];
  }
  return part;
}

LightsFrame measure_lights(std::span<const LightPart> parts) {
  if (parts.empty()) throw std::logic_error("a frame without lights");
  for (const LightPart& part : parts)
    if (part.lux.width != parts[0].lux.width || part.lux.height != parts[0].lux.height)
      throw std::logic_error("the lights of a frame are of different sizes");
  LightsFrame frame;
  frame.most_wrong = {parts[0].lux.width, parts[0].lux.height, glm::u8vec3(0)};
  frame.of_light.resize(parts.size());
  std::vector<double> errors(parts.size(), 0), weights(parts.size(), 0);
  double error = 0, error_soft = 0, squares = 0;  // in the pixels' order, so that they are the same on every machine
  uint64_t counted = 0, ambiguous = 0;
  const double white = white_lux(parts);
  for (size_t i = 0; i < parts[0].lux.size(); ++i) {
    const double all = lux_of_all(parts, i);
    if (!(all > 0)) continue;
    if (!counts(parts, i)) {
      ++ambiguous;
      continue;
    }
    ++counted;
    double hard = 0, soft = 0, most = 0;
    for (size_t l = 0; l < parts.size(); ++l) {
      const LightPart& part = parts[l];
      const double w = part.lux[i] / all, wrong = w * (static_cast<double>(part.shown[i]) - part.truth[i]);
      weights[l] += w;
      errors[l] += std::abs(wrong);
      hard += wrong;
      soft += w * (static_cast<double>(part.shown[i]) - part.soft_truth[i]);
      if (std::abs(wrong) > most) {
        most = std::abs(wrong);
        frame.most_wrong[i] = most_wrong_color(l).srgb;
      }
    }
    error += std::abs(hard);
    error_soft += std::abs(soft);
    const glm::dvec3 d = shaded(parts, &LightPart::shown, white, i) - shaded(parts, &LightPart::truth, white, i);
    squares += glm::dot(d, d) / 3;
  }
  frame.shown = shown_as(parts, &LightPart::shown, white);
  frame.truth = shown_as(parts, &LightPart::truth, white);
  const auto mean = [&](double sum) {
    return counted == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / static_cast<double>(counted);
  };
  double sum_of_parts = 0;
  for (const double one : errors) sum_of_parts += one;
  frame.metrics = {
      {"lights_error", mean(error)},
      {"lights_error_soft", mean(error_soft)},
      {"lights_rmse", std::sqrt(mean(squares))},
      {"lights_flip", counted == 0 ? std::numeric_limits<double>::quiet_NaN() : flip(frame.truth, frame.shown).mean},
      {"lights_counted", static_cast<double>(counted)},
      {"lights_ambiguous", static_cast<double>(ambiguous)}};
  for (size_t l = 0; l < parts.size(); ++l)
    frame.of_light[l] = {{"light_error", mean(errors[l])},
                         {"light_share", sum_of_parts > 0 ? errors[l] / sum_of_parts
                                         : counted == 0   ? std::numeric_limits<double>::quiet_NaN()
                                                          : 0},
                         {"light_weight", mean(weights[l])}};
  return frame;
}

double light_error(std::span<const LightPart> frame, const LightPart& light) {
  double error = 0;
  uint64_t counted = 0;
  for (size_t i = 0; i < light.lux.size(); ++i) {
    if (!counts(frame, i)) continue;
    ++counted;
    error += light.lux[i] / lux_of_all(frame, i) * std::abs(static_cast<double>(light.shown[i]) - light.truth[i]);
  }
  return counted == 0 ? std::numeric_limits<double>::quiet_NaN() : error / static_cast<double>(counted);
}

LightPart without_shadow(LightPart light) {
  for (size_t i = 0; i < light.lux.size(); ++i) light.shown[i] = light.lux[i] > 0;
  return light;
}

const LightColor& most_wrong_color(size_t light) {
  static const LightColor colors[] = {
      {"orange", {230, 159, 0}}, {"sky blue", {86, 180, 233}}, {"green", {0, 158, 115}},   {"yellow", {240, 228, 66}},
      {"blue", {0, 114, 178}},   {"red", {213, 94, 0}},        {"purple", {204, 121, 167}}};
  return colors[light % std::size(colors)];
}

}  // namespace noonmark
