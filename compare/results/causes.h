// The causes of a wrong pixel: one row for each. From the row come its name in every file, its metric, its image in the
// ladder, its colour in pictures, charts and pages, and its legend. How a cause is booked says compare/ladder/ladder.h.
//
//   cause_name(Cause::acne);                                  // "acne"
//   for (const CauseRow& row : cause_rows) print(row.label, row.color);
//
// To add a cause: its value in Cause, its row here, and its booking.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace noonmark {

// In the order of their steps, first those of a lookup that compares depths. They are the first of Ladder::causes.
enum class Cause : uint8_t {
  none,
  light_size,  // R1 - R0
  filter,      // R2 - R1, without the taps that are undecided at their exact place
  displacement,
  aliasing_dark,
  aliasing_light,
  acne,
  peter_panning,
  coverage_dark,
  coverage_light,
  undecided,  // at taps whose truth float error can change
  precision,  // after R4: the format, the rasteriser, float arithmetic
  // Of a lookup in a map of moments alone (compare/ladder/moment_climb.h).
  leak,
  over_darkening,
  reduction,
  moment_precision,
};
inline constexpr int compared_cause_count = 12;  // of a lookup that compares depths
inline constexpr int cause_count = 16;           // of a lookup in a map of moments, and of any

// What a cause does to a pixel. Of a lookup that compares depths, a cause that only darkens, or only lightens, is booked tap
// by tap at R4.
enum class CauseEffect : uint8_t { darkens, lightens, either };

// Which part of the result a cause belongs to.
enum class CausePlace : uint8_t {
  light,      // the light's size: before the hard truth R1, so it is no part of the error
  technique,  // from R1 to R4: the filter, the lookup's place, and the taps
  doubt,      // the same, where the truth of a tap is not known
  device,     // after R4
};

// Whether only a lookup in a map of moments books the cause. The ladders of other lookups have no image and no metric of it.
constexpr bool is_of_moments(Cause cause) { return static_cast<int>(cause) >= compared_cause_count; }

struct CauseRow {
  // Empty: the sum of two causes of one kind that darken and lighten. It has a metric and a colour, and no image.
  std::optional<Cause> cause;
  std::string_view name;         // of the metric, the image, the class of a page's style: lower-case letters and _
  std::string_view label;        // for legends
  std::string_view help;         // of the metric: one sentence or more
  std::array<uint8_t, 3> color;  // sRGB
  CauseEffect effect;
  CausePlace place;
  std::string_view sum;  // the name of the sum that the cause is a part of; empty: of none
  int legend;            // its place in legends, in charts and in the styles of a page, from 0; each place once
};

// In the order of the table of metrics. Warm colours mean falsely dark, cool ones falsely lit, greys and pinks neither. The
// hues are Okabe and Ito's ("Color Universal Design", 2008) and two of Paul Tol's. They differ under the common
// colour-vision deficiencies, on a white and on a near-black page.
inline constexpr std::array<CauseRow, 17> cause_rows{{
    {Cause::light_size,
     "light_size",
     "Light size",
     "Mean |R1 - R0|: the error of a hard shadow, which ignores the size of the light.",
     {202, 186, 60},
     CauseEffect::either,
     CausePlace::light,
     "",
     10},
    {Cause::filter,
     "filter",
     "Filter (blur by design)",
     "Mean |R2 - R1| without the taps whose truth is undecided at their exact place: the blur that the filter makes on "
     "purpose.",
     {150, 155, 162},
     CauseEffect::either,
     CausePlace::technique,
     "",
     6},
    {Cause::displacement,
     "displacement",
     "Displacement (moved lookup)",
     "Mean |change of visibility| because the lookup is moved (normal offset), at the exact places of the taps: how "
     "far shadows are moved.",
     {136, 84, 56},
     CauseEffect::either,
     CausePlace::technique,
     "",
     7},
    {std::nullopt,
     "aliasing",
     "Aliasing",
     "Weight of the wrong taps that give the true answer for their texel's centre, but not for their exact place; dark "
     "and light.",
     {158, 170, 117},
     CauseEffect::either,
     CausePlace::technique,
     "",
     11},
    {Cause::aliasing_dark,
     "aliasing_dark",
     "Aliasing, too dark",
     "The part of aliasing that is too dark.",
     {230, 159, 0},
     CauseEffect::darkens,
     CausePlace::technique,
     "aliasing",
     2},
    {Cause::aliasing_light,
     "aliasing_light",
     "Aliasing, too light",
     "The part of aliasing that is too light.",
     {86, 180, 233},
     CauseEffect::lightens,
     CausePlace::technique,
     "aliasing",
     3},
    {Cause::acne,
     "acne",
     "Acne (too dark)",
     "Weight of the taps that are falsely dark although no shadow edge lies between the pixel and the texel's centre.",
     {213, 94, 0},
     CauseEffect::darkens,
     CausePlace::technique,
     "",
     0},
    {Cause::peter_panning,
     "peter_panning",
     "Peter Panning (too light)",
     "Weight of the taps that are falsely lit because the bias reaches past the occluder.",
     {0, 114, 178},
     CauseEffect::lightens,
     CausePlace::technique,
     "",
     1},
    {std::nullopt,
     "coverage",
     "Coverage",
     "Weight of the wrong taps outside the map, beyond its far plane, or whose blocker lies before its near plane.",
     {0, 158, 115},
     CauseEffect::either,
     CausePlace::technique,
     "",
     12},
    {Cause::coverage_dark,
     "coverage_dark",
     "Coverage, too dark",
     "The part of coverage that is too dark.",
     {170, 51, 119},
     CauseEffect::darkens,
     CausePlace::technique,
     "coverage",
     4},
    {Cause::coverage_light,
     "coverage_light",
     "Coverage, too light",
     "The part of coverage that is too light.",
     {0, 158, 115},
     CauseEffect::lightens,
     CausePlace::technique,
     "coverage",
     5},
    {Cause::precision,
     "precision",
     "Precision",
     "Mean |R5 - R4|: the error of the depth format, the rasteriser and float arithmetic.",
     {204, 121, 167},
     CauseEffect::either,
     CausePlace::device,
     "",
     8},
    {Cause::undecided,
     "undecided",
     "Undecided (truth of a tap unsure)",
     "Error at taps whose truth changes within float error. It belongs to the filter or to one of the causes, and it "
     "is not known to which.",
     {240, 228, 66},
     CauseEffect::either,
     CausePlace::doubt,
     "",
     9},
    {Cause::leak,
     "leak",
     "Leak (moments, too light)",
     "Mean |change of visibility| because the moments of a map cannot tell several depths from one spread of depths: "
     "light "
     "where shadows of several casters overlap. Only lookups in a map of moments have it.",
     {132, 0, 252},
     CauseEffect::lightens,
     CausePlace::technique,
     "",
     13},
    {Cause::over_darkening,
     "over_darkening",
     "Over-darkening (moments, too dark)",
     "Mean |change of visibility| because the moments of a map, or their floors, darken what the depths themselves "
     "leave "
     "lit: in lit creases and on steep surfaces. It is what acne becomes without a comparison of depths.",
     {96, 60, 48},
     CauseEffect::darkens,
     CausePlace::technique,
     "",
     14},
    {Cause::reduction,
     "reduction",
     "Light-bleed reduction",
     "Mean |change of visibility| by lookup.reduction, which darkens the edges of shadows to remove leaks, and by "
     "lookup.reduction_span.",
     {108, 96, 84},
     CauseEffect::either,
     CausePlace::technique,
     "",
     15},
    {Cause::moment_precision,
     "moment_precision",
     "Precision of the moments",
     "Mean |change of visibility| because OpenGL stores, blurs and reads the moments of the exact map in the format of "
     "map.moments and in float arithmetic, and not in exact numbers.",
     {132, 24, 132},
     CauseEffect::either,
     CausePlace::device,
     "",
     16},
}};

// The row of a cause. Cause::none has none.
constexpr const CauseRow* find_cause(Cause cause) {
  for (const CauseRow& row : cause_rows)
    if (row.cause == cause) return &row;
  return nullptr;
}

// "none" for Cause::none.
constexpr std::string_view cause_name(Cause cause) {
  const CauseRow* const row = find_cause(cause);
  return row ? row->name : "none";
}

// Whether it darkens, or lightens, or is the sum of two that do: what a lookup that compares depths books tap by tap.
constexpr bool is_of_taps(const CauseRow& row) { return !row.cause || row.effect != CauseEffect::either; }

// Whether only a lookup in a map of moments books the row's cause.
constexpr bool is_of_moments(const CauseRow& row) { return row.cause && is_of_moments(*row.cause); }

// What a row has of something that each cause has an amount of: of a sum that of its parts together.
double sum_of(const CauseRow& row, const auto& amount) {
  if (row.cause) return amount(*row.cause);
  double sum = 0;
  for (const CauseRow& part : cause_rows)
    if (part.sum == row.name) sum += amount(*part.cause);
  return sum;
}

// The rows in the order of legends.
inline constexpr std::array<CauseRow, cause_rows.size()> causes_as_in_legends = [] {
  std::array<CauseRow, cause_rows.size()> rows = cause_rows;
  std::sort(rows.begin(), rows.end(), [](const CauseRow& a, const CauseRow& b) { return a.legend < b.legend; });
  return rows;
}();

// A value of Cause without a row, or a row whose place is taken, does not compile.
static_assert([] {
  for (int cause = 1; cause < cause_count; ++cause)
    if (!find_cause(static_cast<Cause>(cause))) return false;
  for (size_t place = 0; place < cause_rows.size(); ++place)
    if (causes_as_in_legends[place].legend != static_cast<int>(place)) return false;
  return true;
}());

}  // namespace noonmark
