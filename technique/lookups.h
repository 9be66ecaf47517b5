// How a lookup answers from what it reads in the map. A lookup that compares depths is the row `compare`. The others read
// moments of the depth, which a pass over the map stores and blurs before the lookup. Each of them is one file in
// technique/lookups/ and one row of the table in lookups.cpp: the formulas of what a texel stores and of the lit fraction,
// which the shader and the host compile. The settings lookup.<name> and the uniforms are made from the rows.
//
//   for (const LookupKind& lookup : lookups()) print(lookup.name, lookup.help);
//   TapPattern pattern = tap_pattern(settings);      // of the filter, or of the blur and the fetch of a map of moments
#pragma once
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "technique/bias.h"
#include "technique/filters.h"
#include "technique/lookup_parameters.h"
#include "technique/lookup_truth.h"
#include "technique/settings.h"
#include "technique/tap_pattern.h"

namespace noonmark {

// The formulas of one file, in each type of number that asks for them (technique/lookup_formulas.h).
struct LookupFormulas {
  glm::vec4 (*stored)(float depth, in_float::LookupParameters);
  float (*lit)(glm::vec4 moments, float depth, in_float::LookupParameters);
  // From the depths themselves (technique/lookup_truth.h).
  LookupTruth truth;
  Bounded (*bounded_lit)(in_bounds::vec4 moments, Bounded depth, in_bounds::LookupParameters);
  // Of <name>_lit, as LookupCost::operations (technique/cost.h).
  int (*operations)(const LookupSettings&);
};

// The two passes of a lookup that blurs by itself and stores the spread of what it reads (technique/spread_blur.h).
struct SpreadFormulas {
  in_bounds::vec4 (*bounded_added)(in_bounds::vec4 sums, in_bounds::vec4 stored);
  in_bounds::vec4 (*bounded_spread)(in_bounds::vec4 sums, Bounded taps);
  // From the mean and the deviation without rounding; `truth` is then null.
  long double (*truth)(in_extended::vec4 fetched, long double depth, in_extended::LookupParameters);
};

struct LookupKind {
  std::string_view name;  // a choice of lookup.kind
  std::string_view help;
  std::string_view law;  // what the laws say of it, for the table in docs/reference/techniques.md
  std::vector<KindRead<LookupSettings>> reads = {};
  // Of a lookup in a filtered map; empty: it compares depths.
  std::optional<LookupFormulas> formulas = {};
  std::optional<SpreadFormulas> spread = {};
  int channels = 0;  // numbers that a texel stores: 1, 2 or 4
  // Above 0: a texel stores exponentials, which the device and the host may round differently. The largest is e^(warp_power c)
  // for the exponent c, or 1 if within_one.
  int warp_power = 0;
  // Whether all that it stores lies in [0, 1], so that map.moments = 16 can hold it; null: never.
  bool (*within_one)(const LookupSettings&) = nullptr;
  // True if it is never darker than the comparison of the same depths (law 13). False for forms of engines that can be.
  bool bound = true;

  bool compares() const { return !formulas; }
};

std::span<const LookupKind> lookups();

// Throws std::logic_error if no row has that name.
const LookupKind& find_lookup(std::string_view name);

// Whether the lookup compares depths. Otherwise it reads a filtered map.
inline bool compares(const Settings& settings) { return find_lookup(settings.lookup.kind).compares(); }

// Bytes of what a texel of a filtered map stores, in map.moments; 0 if the lookup compares depths.
int stored_bytes(const Settings& settings);

// The texels that a lookup reads: the taps of the filter; of a map of moments the texels of the blur around the four that the
// fetch blends.
TapPattern tap_pattern(const Settings& settings);

// The standard deviation of the depths of a plane that a blurred texel and its linear fetch hold, divided by the tangent of the slope,
// in texels (law 17). In double. The first form takes the weights of a blur. The second takes the blur of these settings, for a lookup
// that compares no depths; its texels are those of the map, also if a mip level is blurred (lookup.level).
double blur_deviation_texels(std::span<const double> weights);
double blur_deviation_texels(const Settings& settings);

// Texels of the map along a side of a texel of the mip level that the lookup reads (lookup.level); 1 if it reads the map's own.
int texel_block(const Settings& settings);

// The part of the bias whose curve is exact in one pass: none of a lookup in a map of moments, which has no verdicts of taps.
const BiasPart* curve_part(const Settings& settings);
// Whether lookup.reduction alone turns the bound of a map of moments into its result, so that the results at other reductions
// follow from it. Not where a span is given, nor where a result may be a mix of two maps' lookups.
bool has_reduction_curve(const Settings& settings);
// Whether a result may be a mix of the lookups in two maps.
bool mixes_maps(const Settings& settings);

}  // namespace noonmark
