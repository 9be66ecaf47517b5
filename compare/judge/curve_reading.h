// Reads a point's own curve at any value of its free setting.
//
// The *free setting* of a point costs nothing to change, and the curve says what another value would give. For a lookup
// that compares depths it is a part of the bias (PointRecord::curve). For a filtered map it is the light-bleed reduction,
// lookup.reduction (PointRecord::lookup_curve). The usable window is all of its values that keep the bounds on causes. A
// `bias_depth` is a place on the axis of the curve: of a bias in window depth, of a reduction the reduction itself. The word
// bias stands for both in names.
//
//   std::optional<double> acne = curve_value(*point.curve, "acne", depth);
//   double metres = depth * parameter_per_depth(point);     // with bias.unit = m
//   std::optional<Interval> window = usable_window(point);  // of a bias or of a reduction
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/interval.h"
#include "compare/results/records.h"

namespace noonmark {

// Which setting is free. none: the point has no curve.
enum class FreeSetting { none, bias, reduction };
FreeSetting free_setting(const PointRecord& point);
inline bool has_curve(const PointRecord& point) { return free_setting(point) != FreeSetting::none; }
// "bias.constant", "lookup.reduction"; empty without a curve.
std::string curve_parameter(const PointRecord& point);
// Of the parameter: the text of bias.unit; empty of a reduction.
std::string curve_unit(const PointRecord& point);
// In words for a reader: "bias", "light-bleed reduction". Of points that differ: "bias or light-bleed reduction"; "bias" if
// none has a curve.
std::string free_setting_words(std::span<const FreeSetting> settings);
std::string free_setting_words(std::span<const PointRecord> points);
inline std::string free_setting_words(const PointRecord& point) { return free_setting_words({&point, 1}); }
// The bounds of the usable window. The point must have a curve.
const CauseBounds& curve_bounds(const PointRecord& point);
// The entries of the curve, ascending.
std::vector<double> curve_depths(const PointRecord& point);
// Where the point errs least, and the error there (against R1). Of a bias exactly, on the exact map. Of a reduction of the
// entries of its curve, with the error that OpenGL shows: what the exact map has is the metrics best_reduction and
// best_reduction_error. The point must have a curve.
double best_depth(const PointRecord& point);
double best_error(const PointRecord& point);
// The entry of a curve over a setting of the lookup at which OpenGL shows the least error; of equal ones the first. The curve
// must not be empty.
const LookupCurvePoint& least_shown(const std::vector<LookupCurvePoint>& curve);

// The value of a curve's series at a bias in window depth. The series is named by its metric ("error", "acne",
// "aliasing" = dark + light ...). It is linear between the curve's entries and constant beyond the last. Empty if the
// curve has no such series.
std::optional<double> curve_value(const BiasCurve& curve, const std::string& metric, double bias_depth);

// The same of a point's curve over its free setting. A reduction's causes are those of the exact map, and its errors what
// OpenGL shows. Where a point has several placements of the map's grid, its curve over the reduction is of one of them and
// gives no value, because a choice is judged by the worst one.
std::optional<double> curve_value(const PointRecord& point, const std::string& metric, double bias_depth);

// The parameter's own value, in bias.unit, of 1 of window depth; the settings give the unit. Not finite if they do not. 1 of a
// reduction.
double parameter_per_depth(const PointRecord& point);

// A value of the parameter with its unit, for a sentence about all of the points, of which the first has a curve: "2 texels". Window
// depth says little, so metres stand before it where they are the same at every point: "3.1 mm (0.00012 of the depth)".
std::string amount_of_bias(std::span<const PointRecord* const> points, double value);
// The same with its name: "bias of 2 texels", "bias.slope of 2 texels".
std::string named_bias(std::span<const PointRecord* const> points, double value);

// The amount, in window depth, with which the point was rendered, of the parameter that its curve varies. Empty if the
// settings do not give it.
std::optional<double> bias_as_set(const PointRecord& point);

// The usable window of the curve: at every placement of the grid if the point has placements, otherwise at its own.
// In window depth. Empty if no bias is good enough.
std::optional<Interval> usable_window(const BiasCurve& curve);
// Whether the point has a curve, but so many receivers are ambiguous that its usable window is not known (hides_bounds(),
// compare/judge/undecided.h).
bool hides_window(const PointRecord& point);
// The point's curve, of which all numbers are known: empty without one and where it hides_window().
inline const std::optional<BiasCurve>& known_curve(const PointRecord& point) {
  static const std::optional<BiasCurve> none;
  return hides_window(point) ? none : point.curve;
}
// The window of the point's free setting. Empty also without a curve, and where it hides_window().
std::optional<Interval> usable_window(const PointRecord& point);
// Whether the point has a curve, and no value of its free setting is usable.
inline bool lacks_window(const PointRecord& point) {
  return has_curve(point) && !hides_window(point) && !usable_window(point);
}
// What is said of a point that hides_window() in place of its window.
inline constexpr std::string_view window_not_known = "not known, because too much is ambiguous";

// Of a lookup in a filtered map whose reduction has a fixed form, as three.js's with lookup.reduction_span: it has no curve
// that says what another value would give.
bool has_fixed_reduction(const PointRecord& point);

// Whether the rounding of what the map stores alone errs by more than the bound on acne (points whose reduction is free). Then no
// reduction is usable. The metrics reduction_min and reduction_max do not know that, because they are of the exact map.
bool rounds_too_much(const PointRecord& point);

// Of a point whose reduction is free and that lacks a window: what breaks it, as the end of a sentence: "over-darkening is
// 0.15% without any reduction". Otherwise empty.
std::string why_no_usable_reduction(const PointRecord& point);
// What may help there, as the end of a sentence: "a larger lookup.exponent; or a smaller blur or a finer map". Otherwise empty.
std::string cures_of_reduction(const PointRecord& point);
// Both: "the leak is 2% even with the largest reduction, more than 1%. What may help: a smaller blur". Otherwise empty.
std::string no_reduction_text(const PointRecord& point);

// If more than half of the point's error is the rounding of what a filtered map stores: a clause that says so and names what may
// help. Otherwise empty.
std::string cures_of_precision(const PointRecord& point);

// Whether the curve gives the metric at any bias. If not, metric_at gives it as rendered.
bool has_curve_of(const PointRecord& point, const std::string& metric);

// A metric of the point as it would be with this bias; without a bias, or if the curve has no series of it, as it was
// rendered. With placements it is the worst of them if that is known. NaN if the point does not have it. A light without
// a size has the same error against its size as against its centre.
double metric_at(const PointRecord& point, const std::string& metric, std::optional<double> bias_depth);

}  // namespace noonmark
