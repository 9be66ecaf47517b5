// All numbers of a point that a bound, a column or a table can name: the metrics (metrics.h) and the quantities of the
// bias curve.
//
//   std::optional<double> width = quantity(point, "window_width_depth");
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compare/results/metrics.h"
#include "compare/results/records.h"

namespace noonmark {

// Made from the rows of curve_fields() and curve_widths() (curve_fields.h): each number itself, and each depth also in
// metres and in texels.
struct CurveQuantity {
  std::string name;
  std::string unit;
  std::string help;  // one sentence
  // Empty if the curve has no such number, for example the ends of an empty window.
  std::function<std::optional<double>(const BiasCurve&)> value;
  std::string sql;  // the same as SQL over the store's table `curves` as c
};
std::span<const CurveQuantity> curve_quantities();
// Null if there is none of this name.
const CurveQuantity* curve_quantity(std::string_view name);

struct QuantityInfo {
  std::string_view name, unit, help;
  bool of_curve = false;  // known only if the point has a curve
};
// points: their own causes (PointRecord::causes) have names too; the result refers to them. Throws Error(usage) that
// suggests the nearest name.
QuantityInfo find_quantity(std::string_view name, std::span<const PointRecord> points = {});
// The unit of a metric or quantity, or `otherwise` if no row has the name.
std::string_view quantity_unit(std::string_view name, std::string_view otherwise = "");

// The causes that rungs on top of R5 brought at any of these points: each name once, in the order in which the points
// have them. The pointers are to the points' own.
std::vector<const RungCause*> brought_causes(std::span<const PointRecord> points);
// metrics_table(), of frames only the metrics that they have, followed by the metrics of brought_causes(points), whose texts
// the rows refer to.
std::vector<Metric> metrics_of(std::span<const PointRecord> points);
// Whether a cause can have this name, as a metric and as a column: lower-case letters, digits and _, and no metric of
// the table or quantity of the curve, except for the classes of given frames (Metric::of_frames), which are causes too.
bool is_free_name(std::string_view name);
// The rung of the causes of a point that is a frame of another renderer.
inline constexpr std::string_view frame_rung = "the frame";
// The cause of a frame with its own map that the map does not explain, and its metric.
inline constexpr std::string_view frame_lookup = "frame_lookup";
// Of casters that the map lacks: a class by place, and with a map the cause of its receivers' step from an exact map to it.
inline constexpr std::string_view frame_missing = "frame_missing";
// Where that map is not the scene's: what an exact one would show otherwise. It is then no precision.
inline constexpr std::string_view frame_map = "frame_map";
constexpr bool is_cause_of_own_map(std::string_view cause) { return cause == frame_lookup || cause == frame_map; }
// The share of its receivers at which the frame is not what its declared lookup gives.
inline constexpr std::string_view frame_lookup_differs = "frame_lookup_differs";
// Whether the points are frames of another renderer (frames/judge.h). All points of a store are, or none.
bool judges_frames(std::span<const PointRecord> points);
// Whether the causes of the ladder are known at a point: everywhere but in frames without their own map.
bool knows_causes(std::span<const PointRecord> points);
// Whether this is one of the parts that sum to the point's error. Of a frame these are the classes by place, or with its own
// map the causes of the ladder; the other ones are metrics only.
bool has_cause(const PointRecord& point, std::string_view cause);
// The metric that is the error of a point: "error", or of a frame "frame_error".
std::string error_metric(std::span<const PointRecord> points);
// The name of the rung that is judged: "R5", or that of the rung on top of it.
std::string_view judged_rung(const PointRecord& point);

// Empty if the point does not have it: its curve is off, its window is empty, or its metric was not recorded.
std::optional<double> quantity(const PointRecord& point, std::string_view name);

// The quantities of a point with map.placements that together say how large a quantity is at its worst placement: the
// largest of `largest`, and how small at any: the least of `least`. The metric itself is among them, because OpenGL drew
// it, and the others are those of the exact map. Empty if the quantity is measured once for all placements.
struct PlacedNames {
  std::vector<std::string> largest, least;
};
PlacedNames placed_names(std::string_view name);
// Whether the point was measured at several placements of the map's grid.
bool has_placements(const PointRecord& point);
// The metric at the worst of the point's placements. Of a metric that is measured once for all of them, and of a point with one
// placement: the metric. A NaN stays one.
double worst_placed(const PointRecord& point, const std::string& metric);

// The pixel of the picture that is worst by a metric, as rendered; of a metric over all placements (acne_worst) that of
// the metric itself. Empty if no pixel is.
std::optional<PointRecord::WorstOf> worst_pixel_of(const PointRecord& point, std::string_view metric);

// A number of one cascade, as formulas name it: "cascades.2.texel_m". Cascades count from 1, near ones first. The names are:
// - begin_m and end_m: the depths along the view at which the slice begins and ends;
// - bias_needed: in the curve's own unit (PointRecord::Cascade);
// - each metric of cascade_metrics, over the receivers of that cascade alone.
// Empty if the point has no such cascade, if its bias_needed is not known, and for every other name.
std::optional<double> cascade_number(const PointRecord& point, std::string_view name);
// All such names, of as many cascades as a point can have.
std::span<const std::string> cascade_number_names();
// Whether the name is that of a cascade's bias_needed, which is known only if the point has a curve.
bool is_cascade_bias(std::string_view name);

// The metric, or NaN if the point has no metric of that name.
double metric_of(const PointRecord& point, const std::string& name);
// The setting's canonical text, or empty.
std::string setting_of(const PointRecord& point, const std::string& name);

// The number that a setting's text is. Empty if it is not one, or not finite.
std::optional<double> number_of(const std::string& text);
// The distinct values of a setting over the points, sorted as numbers if all are numbers, otherwise in order of appearance.
std::vector<std::string> values_of(std::span<const PointRecord> points, const std::string& setting);
inline std::vector<std::string> values_of(const Results& results, const std::string& setting) {
  return values_of(results.points, setting);
}

// Whether no pixel could be judged, so that the point gives no information about the method. False for a record without
// the number of counted receivers.
bool nothing_judged(const PointRecord& point);

// The text for a number that is NaN, because there was nothing to measure.
inline constexpr std::string_view not_measured = "not measured";

// The reason why a point has no bias curve, as the end of a sentence ("bias.normal_offset moves ..."). Empty if it has
// a curve, and if its settings do not give the reason.
std::string why_no_curve(const PointRecord& point);

}  // namespace noonmark
