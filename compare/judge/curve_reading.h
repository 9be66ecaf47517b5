// Reads a point's bias curve at any bias.
//
//   std::optional<double> acne = curve_value(*point.curve, "acne", depth);
//   double metres = depth * parameter_per_depth(point);     // with bias.unit = m
#pragma once
#include <optional>
#include <string>

#include "base/interval.h"
#include "compare/results/records.h"

namespace noonmark {

// The value of a curve's series at a bias in window depth. The series is named by its metric ("error", "acne",
// "aliasing" = dark + light ...). It is linear between the curve's entries and constant beyond the last. Empty if the
// curve has no such series.
std::optional<double> curve_value(const BiasCurve& curve, const std::string& metric, double bias_depth);

// The parameter's own value, in bias.unit, of 1 of window depth; the settings give the unit. Not finite if they do not.
double parameter_per_depth(const PointRecord& point);

// The amount, in window depth, with which the point was rendered, of the parameter that its curve varies. Empty if the
// settings do not give it.
std::optional<double> bias_as_set(const PointRecord& point);

// The usable window of the curve: at every placement of the grid if the point has placements, otherwise at its own.
// In window depth. Empty if no bias is good enough.
std::optional<Interval> usable_window(const BiasCurve& curve);

// Whether the curve gives the metric at any bias. If not, metric_at gives it as rendered.
bool has_curve_of(const PointRecord& point, const std::string& metric);

// A metric of the point as it would be with this bias; without a bias, or if the curve has no series of it, as it was
// rendered. With placements it is the worst of them if that is known. NaN if the point does not have it. A light without
// a size has the same error against its size as against its centre.
double metric_at(const PointRecord& point, const std::string& metric, std::optional<double> bias_depth);

}  // namespace noonmark
