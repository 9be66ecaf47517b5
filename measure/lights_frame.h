// One frame with several lights: each light is measured with its own map and ladder (Workbench::measure), and what they
// give together is compared with the truth. KHR_lights_punctual weighs them (technique/light_power.h).
//
//   std::vector<LightPart> parts;
//   for (const Settings& light : lights) parts.push_back(light_part(bench.measure(light, std::nullopt)));
//   const LightsFrame frame = measure_lights(parts);
//   use(frame.metrics.at("lights_error"), frame.of_light[0].at("light_share"));
#pragma once
#include <map>
#include <span>
#include <string>
#include <vector>

#include "measure/workbench.h"

namespace noonmark {

// What one light gives to each pixel of the frame.
struct LightPart {
  glm::dvec3 color;  // linear RGB of its light, of luminance 1
  Image<float> lux;  // the luminance of its light there without a shadow; 0 where it does not face the light
  Image<float> shown, truth, soft_truth;  // R5, R1 and R0 of its ladder, 0 where lux is 0
  Image<uint8_t> ambiguous;               // lux is not 0, and its ladder does not count the receiver
  Image<uint8_t> surface;                 // the pixel sees a surface
};
LightPart light_part(const Measurement& m);

// Of all lights together. At a pixel, w of a light is its share of the lux of all of them. A pixel counts if a light
// reaches it and its truth is ambiguous to none that does.
struct LightsFrame {
  std::map<std::string, double> metrics;                // lights_error and others (compare/results/metrics.cpp)
  std::vector<std::map<std::string, double>> of_light;  // light_error, light_share, light_weight of each, in order
  // As they are shown: diffuse clay, 8-bit sRGB. The frame that the maps make, the true one, and the light that makes the
  // largest part of a pixel's error, in its colour of most_wrong_color(), black where nothing is wrong.
  Image<glm::u8vec3> shown, truth, most_wrong;
};
// Throws std::logic_error if the parts are none or of different sizes.
LightsFrame measure_lights(std::span<const LightPart> parts);

// Mean of w |R5 - R1| of one light over the frame's counted pixels. frame: all lights, of which only lux and ambiguous are read; light:
// one of them, perhaps with another map. NaN if no pixel counts.
double light_error(std::span<const LightPart> frame, const LightPart& light);
// The same light without a map: lit wherever it faces.
LightPart without_shadow(LightPart light);

// One for each light, repeating after the last: apart for people with colour-vision deficiencies (Okabe and Ito 2008).
struct LightColor {
  const char* name;
  glm::u8vec3 srgb;
};
const LightColor& most_wrong_color(size_t light);

}  // namespace noonmark
