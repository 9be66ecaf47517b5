#include "technique/lookups.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string>

#include "base/find_row.h"
#include "technique/filters/patterns.h"
#include "technique/lookup_formulas.h"
#include "technique/spread_blur.h"

namespace noonmark {
namespace {

// The parameters.

constexpr KindParameter v_min{.setting = "lookup.v_min",
                              .unit = "depth^2",
                              .max = 1,
                              .initial = 1e-7,
                              .help = "least variance of the depths; a larger one lifts shadows off their casters."};

constexpr KindParameter variance_floor{
    .setting = "lookup.floor",
    .unit = "depth",
    .max = 1,
    .help =
        "s: the least variance is (s c W)^2, with the exponent c and the warped depth W of the receiver. So it is "
        "about a "
        "distance in the depth from -1 to 1; a larger one lifts shadows off their casters."};

// The largest c for which float holds both e^c and e^-c without a loss: above 87.33 e^-c is below the normal floats, which
// GLSL allows a device to take as 0 (GLSL 4.50, 4.7.1), and llvmpipe does.
constexpr double most_exponent = 87;

constexpr KindParameter exponent{.setting = "lookup.exponent",
                                 .unit = "",
                                 .min = 0.01,
                                 .max = most_exponent,
                                 .initial = 40,
                                 .help = "c of the warp e^(c z)."};

constexpr KindParameter negative_exponent{.setting = "lookup.negative_exponent",
                                          .unit = "",
                                          .min = 0.01,
                                          .max = most_exponent,
                                          .initial = 5,
                                          .help = "c of the second warp, -e^(-c z)."};

constexpr KindParameter moment_bias{.setting = "lookup.moment_bias",
                                    .unit = "fraction",
                                    .max = 1,
                                    .initial = 3e-7,
                                    .help =
                                        "how much of a fixed distribution is mixed into the moments, so that rounding "
                                        "leaves them possible; 3e-7 for 32 bits, 6e-5 for 16."};

constexpr std::string_view moment_forms[] = {"plain", "2017", "2015", "plain_01"};
constexpr KindParameter moments{.setting = "lookup.moments",
                                .unit = "",
                                .type = ValueType::choice,
                                .help =
                                    "how the four moments are stored. plain: of the depth from -1 to 1; plain_01: of "
                                    "the depth from 0 to 1; 2017: of the "
                                    "depth from -1 to 1, transformed for 16 bits (Peters et al. 2017); 2015: of the "
                                    "depth from 0 to 1, transformed for 16 "
                                    "bits (Peters, Klein 2015).",
                                .choices = moment_forms};

constexpr KindParameter level{.setting = "lookup.level",
                              .unit = "",
                              .type = ValueType::integer,
                              .max = 3,
                              .help =
                                  "mip level of the map of moments that is blurred and read: each of its texels is the "
                                  "mean of 2^level x 2^level texels of the map, whose size must be a multiple of that. "
                                  "Filter sizes are in texels of the level. 1 is Babylon.js's blurScale = 2.",
                              .of_blur = true};

constexpr KindParameter reduction{
    .setting = "lookup.reduction",
    .unit = "fraction",
    .max = 0.99,
    .help =
        "light-bleed reduction r: the lit fraction p becomes (p − r) / (1 − r), at least 0. It removes every leak up "
        "to r and darkens the edges of shadows."};

// 0.35 + 0.65 is 1 to a reader, but its doubles may sum to the next number above 1.
constexpr double rounding_of_decimals = 2 * std::numeric_limits<double>::epsilon();

constexpr KindParameter reduction_span{
    .setting = "lookup.reduction_span",
    .unit = "fraction",
    .max = 1,
    .help =
        "the lit fraction p becomes (p − r) / span instead, at most 1, as three.js does with 0.3 and 0.65; 0: 1 − r. "
        "At most 1 − r, because all light would be less than 1 above it."};

std::string darkens_all(const LookupSettings& settings) {
  const double r = settings["reduction"], span = settings["reduction_span"];
  if (span <= 1 - r || span - (1 - r) <= rounding_of_decimals) return "";
  return fmt::format(
      "lookup.reduction_span = {}: with lookup.reduction = {} all light becomes (1 - {}) / {} = {:.3g}, so that "
      "nothing is "
      "fully lit; lower one of them, so that their sum is at most 1",
      span, r, r, span, (1 - r) / span);
}

// e^(2 c) is the square of the largest warped depth.
template <const KindParameter& of>
std::string beyond_float(const LookupSettings& settings) {
  const double most = 44.36;
  if (settings[of.name()] <= most) return "";
  return fmt::format("{} = {}: above {} the squares of lookup.kind = {} overflow 32-bit floats", of.setting,
                     settings[of.name()], most, settings.kind);
}

constexpr KindParameter radius{.setting = "lookup.radius",
                               .unit = "texels",
                               .max = 15,
                               .initial = 1,
                               .help =
                                   "shadow.radius: the taps of each pass of the blur stand evenly from this far on one "
                                   "side to this far on the other.",
                               .of_blur = true};

constexpr KindParameter samples{.setting = "lookup.samples",
                                .unit = "taps",
                                .type = ValueType::integer,
                                .min = 1,
                                .max = 25,
                                .initial = 8,
                                .help = "shadow.blurSamples: taps of each pass of the blur.",
                                .of_blur = true};

bool always(const LookupSettings&) { return true; }
bool within_one(const LookupSettings& settings) { return moment_forms[settings.whole("moments")] != "plain"; }

// The operations of a lit fraction: one number, or one for each form of the moments.
template <int count>
int operations(const LookupSettings&) {
  return count;
}
template <int plain, int of_2017, int of_2015, int plain_01>
int operations(const LookupSettings& settings) {
  constexpr int counts[] = {plain, of_2017, of_2015, plain_01};
  static_assert(std::size(counts) == std::size(moment_forms));
  return counts[settings.whole("moments")];
}

#define FORMULAS(name, ...)                                                                                     \
  LookupFormulas {                                                                                              \
    in_float::name##_stored, in_float::name##_lit, name##_truth, in_bounds::name##_lit, operations<__VA_ARGS__> \
  }

std::vector<LookupKind> make_lookups() {
  return {
      {.name = "compare", .help = "each tap of the filter compares depths", .law = "laws 1 to 8"},
      {.name = "vsm",
       .help = "variance shadow map (Donnelly, Lauritzen 2006): from the blurred depth and its square, Chebyshev's "
               "bound of "
               "how much of the depths is behind the receiver",
       .law = "never darker than the comparison (law 13); leak at most (a / (a + 2b))² (law 15); no bias on planes "
              "(law 17)",
       .reads = {{&v_min}, {&level}, {&reduction}, {&reduction_span, darkens_all}},
       .formulas = FORMULAS(vsm, 9),
       .channels = 2,
       .within_one = always},
      {.name = "esm",
       .help = "exponential shadow map (Annen et al. 2008, Salvi 2008): from the blurred e^(c z) of the depth z from 0 "
               "to 1, "
               "Markov's bound",
       .law = "never darker than the comparison (law 13); a lit gap of ln 2 / c at a contact (law 19)",
       .reads = {{&exponent}, {&level}, {&reduction}, {&reduction_span, darkens_all}},
       .formulas = FORMULAS(esm, 4),
       .channels = 1,
       .warp_power = 1},
      {.name = "evsm2",
       .help = "exponential variance shadow map with one warp (Lauritzen, McCool 2008): Chebyshev's bound of e^(c z), "
               "with z "
               "from -1 to 1",
       .law = "never darker than the comparison (law 13); leak at most 1 / (2 e^(c b) − 1)² (law 15)",
       .reads = {{&exponent, beyond_float<exponent>},
                 {&variance_floor},
                 {&level},
                 {&reduction},
                 {&reduction_span, darkens_all}},
       .formulas = FORMULAS(evsm2, 17),
       .channels = 2,
       .warp_power = 2},
      {.name = "evsm4",
       .help = "exponential variance shadow map with two warps, e^(c z) and −e^(−c z); the lesser of both bounds holds",
       .law = "never darker than the comparison (law 13); darkens lit slopes by up to a fifth (law 17)",
       .reads = {{&exponent, beyond_float<exponent>},
                 {&negative_exponent, beyond_float<negative_exponent>},
                 {&variance_floor},
                 {&level},
                 {&reduction},
                 {&reduction_span, darkens_all}},
       .formulas = FORMULAS(evsm4, 35),
       .channels = 4,
       .warp_power = 2},
      {.name = "msm",
       .help =
           "moment shadow map (Peters, Klein 2015): from four blurred moments, the sharp bound over all distributions "
           "(Hamburger's problem)",
       .law = "never darker than the comparison (law 13); leak at most 1 / (2 (1 + 2b/a)² − 1)² (law 15); lit planes "
              "need a "
              "bias of one standard deviation (law 17)",
       .reads = {{&moment_bias}, {&moments}, {&level}, {&reduction}, {&reduction_span, darkens_all}},
       .formulas = FORMULAS(msm, 92, 102, 121, 92),
       .channels = 4,
       .within_one = within_one},
      {.name = "msm_hausdorff",
       .help = "moment shadow map over the distributions within the map's range (Hausdorff's problem)",
       .law = "never darker than the comparison (law 13), nor lighter than msm",
       .reads = {{&moment_bias}, {&moments}, {&level}, {&reduction}, {&reduction_span, darkens_all}},
       .formulas = FORMULAS(msm_hausdorff, 151, 161, 160, 131),
       .channels = 4,
       .within_one = within_one},
      {.name = "babylon_esm",
       .help = "Babylon.js's exponential shadow map (useBlurExponentialShadowMap): from the blurred e^(-c z), the lit "
               "fraction 1 - e^(c d) E[e^(-c z)]. What is in the map itself is dark without a bias",
       .law = "no bound: a receiver in the map is lit by 1 - e^(-c b) with the bias b",
       .reads = {{&exponent}, {&level}, {&reduction}, {&reduction_span, darkens_all}},
       .formulas = FORMULAS(babylon_esm, 8),
       .channels = 1,
       .warp_power = 1,
       .within_one = always,
       .bound = false},
      {.name = "babylon_close_esm",
       .help = "Babylon.js's close exponential shadow map (useBlurCloseExponentialShadowMap): e^(-c (d - z)) of the "
               "blurred depth z",
       .law = "no bound: shadows grow with the gap between caster and receiver; a caster that covers ln 2 / (c gap) of "
              "the blur makes half shade",
       .reads = {{&exponent}, {&level}, {&reduction}, {&reduction_span, darkens_all}},
       .formulas = FORMULAS(babylon_close_esm, 7),
       .channels = 1,
       .within_one = always,
       .bound = false},
      {.name = "three_vsm",
       .help = "three.js's variance shadow map (VSMShadowMap): Chebyshev's bound of a mean and a standard deviation, "
               "which two passes of its own blur; set lookup.reduction = 0.3, lookup.reduction_span = 0.65, "
               "map.moments = 16f and filter.kind = none for what three.js shows",
       .law = "as vsm where the taps stand on texels; between them a linear fetch blends deviations, which is less "
              "variance, and it is no bound",
       .reads = {{&v_min}, {&radius}, {&samples}, {&reduction}, {&reduction_span, darkens_all}},
       .formulas = LookupFormulas{in_float::three_vsm_stored, in_float::three_vsm_lit, LookupTruth{},
                                  in_bounds::three_vsm_lit, operations<8>},
       .spread =
           SpreadFormulas{in_bounds::three_vsm_add_stored, in_bounds::three_vsm_spread, in_extended::three_vsm_lit},
       .channels = 2,
       .within_one = always,
       .bound = false},
  };
}

#undef FORMULAS

}  // namespace

std::span<const LookupKind> lookups() {
  static const std::vector<LookupKind> all = make_lookups();
  return all;
}

const LookupKind& find_lookup(std::string_view name) { return find_row(lookups(), name, "lookup"); }

int stored_bytes(const Settings& settings) {
  return (settings.map.moments == MomentFormat::f32 ? 4 : 2) * find_lookup(settings.lookup.kind).channels;
}

std::span<const KindParameter* const> LookupTable::parameters() {
  static const std::vector<const KindParameter*> all = parameters_of(lookups());
  return all;
}

TapPattern tap_pattern(const Settings& settings) {
  if (compares(settings)) return tap_pattern(settings.filter);
  TapPattern pattern;
  if (find_lookup(settings.lookup.kind).spread) {
    SpreadBlur blur = spread_blur(settings.lookup);
    pattern = fetches_of(std::move(blur.kernel_u));
    pattern.kernel_v = std::move(blur.kernel_v);
  } else {
    pattern = fetches_of(find_filter(settings.filter.kind).blur(settings.filter), texel_block(settings));
  }
  pattern.blurred = true;
  return pattern;
}

double blur_deviation_texels(std::span<const double> weights) {
  const double middle = (static_cast<double>(weights.size()) - 1) / 2;
  double variance = 0.25;  // of a linear fetch half way between two texels, the most
  for (size_t i = 0; i < weights.size(); ++i)
    variance += weights[i] * (static_cast<double>(i) - middle) * (static_cast<double>(i) - middle);
  return std::sqrt(variance);
}

double blur_deviation_texels(const Settings& settings) {
  const double block = texel_block(settings);  // a texel of the level is a box of so many
  return std::hypot(block * blur_deviation_texels(find_filter(settings.filter.kind).blur(settings.filter)),
                    std::sqrt((block * block - 1) / 12));
}

int texel_block(const Settings& settings) {
  for (const auto& read : find_lookup(settings.lookup.kind).reads)
    if (read.parameter == &level) return 1 << settings.lookup.whole(level.name());
  return 1;
}

const BiasPart* curve_part(const Settings& settings) {
  return compares(settings) ? curve_part(settings.bias) : nullptr;
}

bool has_reduction_curve(const Settings& settings) {
  return !compares(settings) && settings.lookup["reduction_span"] == 0 && !mixes_maps(settings);
}

bool mixes_maps(const Settings& settings) { return settings.maps() > 1 && settings.cascades.blend > 0; }

}  // namespace noonmark
