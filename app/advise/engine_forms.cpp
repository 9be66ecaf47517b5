#include "app/advise/engine_forms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "app/advise/recommend_filtered.h"
#include "technique/lookups.h"
#include "technique/spread_blur.h"

namespace noonmark {
namespace {

// light.shadow.radius and blurSamples. Where the taps stand a texel apart, a linear fetch between two texels blends no deviations;
// 8 samples of radius 1 are three.js's defaults; one sample is no blur.
struct SpreadChoice {
  double radius;
  int samples;
};
constexpr SpreadChoice spread_choices[] = {{1, 1}, {1, 3}, {1, 8}, {2, 5}, {3, 7}, {4, 9}};

void take_three(Settings& settings, const SpreadChoice& blur) {
  bias_levels().front().apply(settings);
  settings.lookup = LookupSettings("three_vsm", {{"v_min", 1e-7}, {"reduction", 0.3}, {"reduction_span", 0.65}});
  settings.lookup["radius"] = blur.radius;
  settings.lookup["samples"] = blur.samples;
  settings.map.moments = MomentFormat::f16;
}

std::string spread_text(double radius, int samples) {
  return samples == 1 ? "no blur (blurSamples = 1)"
                      : fmt::format("radius = {:g} and blurSamples = {}", radius, samples);
}

// The field for a slope is normalBias: on every slope one deviation of the blur along the normal gives more depth than law 17
// asks for, sigma tan(theta).
BiasLevel three_level(const SpreadChoice& blur, bool with_bias) {
  BiasLevel level;
  level.name = fmt::format("three_vsm with {}, {}", spread_text(blur.radius, blur.samples),
                           with_bias ? "with a normal bias of the blur's deviation" : "without a bias");
  level.lookup = "three_vsm";
  level.blurs = {{"none", {}}};
  level.apply = [blur, with_bias](Settings& settings) {
    take_three(settings, blur);
    if (!with_bias) return;
    settings.bias.unit = BiasUnit::texel;
    settings.bias["normal_offset"] = short_deviation(spread_blur(settings.lookup).kernel_u);
  };
  return level;
}

// The boxes of blurBoxOffset 1 to 3 and the Gaussians of blurKernel 5 and 9 (engines/babylon.cpp), in the order of their reach.
std::vector<FilterSettings> babylon_blurs() {
  const auto gaussian = [](int size) {
    return FilterSettings("gaussian", {{"size", size}, {"sigma_texels", (size - 1) / 6.0}});
  };
  return {{"none", {}},           gaussian(5),           {"box", {{"size", 3}}}, gaussian(9),
          {"box", {{"size", 5}}}, {"box", {{"size", 7}}}};
}

// depthScale: Babylon.js's default, and the largest that floats hold (lookup.exponent).
constexpr double depth_scales[] = {50, 87};

BiasLevel babylon_level(const std::string& lookup, double depth_scale, const std::string& bias_name,
                        void (*bias)(Settings&, double darkness), double darkness) {
  BiasLevel level;
  level.name = fmt::format("{} with depthScale = {:g}, {}", lookup, depth_scale, bias_name);
  level.lookup = lookup;
  level.blurs = babylon_blurs();
  level.apply = [=](Settings& settings) {
    bias_levels().front().apply(settings);
    settings.lookup = LookupSettings(lookup, {{"exponent", depth_scale}});
    bias(settings, darkness);
  };
  return level;
}

void no_bias(Settings&, double) {}

void bias_of_deviation(Settings& settings, double) {
  settings.bias.unit = BiasUnit::texel;
  settings.bias["constant"] = short_deviation(find_filter(settings.filter.kind).blur(settings.filter));
}

void bias_that_lights(Settings& settings, double darkness) {
  settings.bias.unit = BiasUnit::depth;
  settings.bias["constant"] = std::ceil(-std::log(darkness) / settings.lookup["exponent"] * 1e4) / 1e4;
}

}  // namespace

bool reduction_is_free(std::string_view lookup) { return find_lookup(lookup).bound; }

std::vector<BiasLevel> engine_form_levels(const std::string& lookup, const CurveOptions& searched) {
  std::vector<BiasLevel> levels;
  if (lookup == "three_vsm") {
    for (const bool with_bias : {false, true})
      for (const SpreadChoice& blur : spread_choices) levels.push_back(three_level(blur, with_bias));
  } else if (lookup == "babylon_close_esm") {
    for (const double scale : depth_scales)
      levels.push_back(babylon_level(lookup, scale, "without a bias", no_bias, 0));
    for (const double scale : depth_scales)
      levels.push_back(babylon_level(lookup, scale, "with a bias of the blur's deviation", bias_of_deviation, 0));
  } else if (lookup == "babylon_esm") {
    for (const double scale : depth_scales)
      levels.push_back(babylon_level(lookup, scale, "with a bias that lights what is in the map", bias_that_lights,
                                     searched.acne_bound));
  } else {
    throw std::logic_error("a form of an engine without its levels");
  }
  return levels;
}

std::string engine_form_text(std::string_view lookup) {
  if (lookup == "three_vsm")
    return "three_vsm is three.js's VSMShadowMap. Searched are mapSize, radius with blurSamples (1 with 3 and 8, 2 "
           "with 5, 3 with 7, 4 with "
           "9; and one sample), and normalBias (0, or the blur's deviation). Its reduction of 0.3 over a span of 0.65 "
           "and its "
           "least variance of 1e-7 are fixed. It is measured with half floats (map.moments = 16f), which three.js "
           "stores.";
  return fmt::format(
      "{} is Babylon.js's use{}ExponentialShadowMap. Searched are the size of the map, depthScale (50 and 87), the "
      "blur (none, boxes "
      "of blurBoxOffset 1 to 3, blurKernel 5 and 9, with blurScale = 1), and {}. It has no reduction of light "
      "bleeding. It is "
      "measured with floats of 32 bits (map.moments = 32f).",
      lookup, lookup == "babylon_close_esm" ? "BlurClose" : "Blur",
      lookup == "babylon_close_esm" ? "bias (0, or the blur's deviation)"
                                    : "the bias that lights what is in the map within the bound on acne");
}

std::string engine_form_name(const Settings& settings) {
  const LookupSettings& lookup = settings.lookup;
  if (lookup.kind == "three_vsm")
    return fmt::format("VSMShadowMap of three.js with {}", spread_text(lookup["radius"], lookup.whole("samples")));
  const bool blurred = settings.filter.kind != "none";
  std::string text =
      fmt::format("use{}{}ExponentialShadowMap of Babylon.js with depthScale = {:g}", blurred ? "Blur" : "",
                  lookup.kind == "babylon_close_esm" ? "Close" : "", lookup["exponent"]);
  if (blurred) text += fmt::format(" and a {} of {} texels", settings.filter.kind, settings.filter.whole("size"));
  return text;
}

}  // namespace noonmark
