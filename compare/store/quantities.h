// Every number of a point that a bound, a column or a table can name: the metrics (metrics.h), and what is read off the
// bias curve.
//
//   std::optional<double> width = quantity(point, "window_width_depth");
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "compare/store/records.h"

namespace noonmark {

// Read off the rows of curve_fields() (curve_fields.h): each as it is, a depth also in metres and in texels; and the
// window's width.
struct CurveQuantity {
  std::string name;
  std::string unit;
  std::string help;  // one sentence
  // Empty where the curve has no such number: the ends of a window that is empty.
  std::function<std::optional<double>(const BiasCurve&)> value;
  std::string sql;  // the same, of the store's table `curves` as c
};
std::span<const CurveQuantity> curve_quantities();

struct QuantityInfo {
  std::string_view name, unit, help;
  bool of_curve = false;  // known only where the point has a curve
};
// Throws Error(usage) that suggests the nearest name.
QuantityInfo find_quantity(std::string_view name);

// Empty when the point does not have it (its curve is off, its window empty, its metric was not recorded).
std::optional<double> quantity(const PointRecord& point, std::string_view name);

// The metric, or NaN when the point has none of that name.
double metric_of(const PointRecord& point, const std::string& name);
// The setting's canonical text, or empty.
std::string setting_of(const PointRecord& point, const std::string& name);

// Whether no pixel could be judged, so that the point says nothing about the method. False for a record that lacks the
// number of counted receivers.
bool nothing_judged(const PointRecord& point);

// In text, for a number that is NaN: there was nothing to measure it on.
inline constexpr std::string_view not_measured = "not measured";

// Why a point has no bias curve, as a sentence's end ("bias.normal_offset moves ..."); empty when it has one, and when
// its settings do not say.
std::string why_no_curve(const PointRecord& point);

}  // namespace noonmark
