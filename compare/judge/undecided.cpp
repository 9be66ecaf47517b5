#include "compare/judge/undecided.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compare/judge/curve_reading.h"
#include "compare/results/causes.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"

namespace noonmark {
namespace {

// Whether an undecided tap may belong to the metric.
bool may_hold_undecided(std::string_view metric) {
  return metric == "peter_panning_lit" || std::any_of(cause_rows.begin(), cause_rows.end(), [&](const CauseRow& row) {
           return row.place == CausePlace::technique && row.name == metric;
         });
}

double many_ambiguous_of(const PointRecord& point) {
  const double facing = metric_of(point, "facing");
  return many_ambiguous(metric_of(point, "ambiguous") * facing, facing);
}

double many_ambiguous_of_lights(const PointRecord& point) {
  const double ambiguous = metric_of(point, "lights_ambiguous");
  return many_ambiguous(ambiguous, ambiguous + metric_of(point, "lights_counted"));
}

// Of what is counted over two frames' points: those that are left out because the truth of either frame is ambiguous, if many are.
double many_ambiguous_of_motion(const PointRecord& point) {
  const double facing = metric_of(point, "facing"), next = metric_of(point, "flicker_ambiguous"),
               left_out = metric_of(point, "ambiguous") * facing + (std::isfinite(next) ? next : 0);
  return many_ambiguous(left_out, facing) > 0 ? left_out : 0;
}

bool is_brought(const PointRecord& point, std::string_view name) {
  return std::any_of(point.causes.begin(), point.causes.end(), [&](const RungCause& one) { return one.name == name; });
}

}  // namespace

std::string undecided_note(std::span<const PointRecord> points) {
  double most = 0;
  const PointRecord* worst = nullptr;
  for (const PointRecord& point : points) {
    const double undecided = metric_of(point, "undecided"), error = metric_of(point, "error");
    if (!(undecided > 0) || !(undecided >= much_undecided * error)) continue;
    const double share = undecided / error;  // infinite if the taps' errors cancel in their pixels
    if (worst && !(share > most)) continue;
    most = share;
    worst = &point;
  }
  if (!worst) return "";
  return fmt::format(
      "undecided is {} where the error is {}: that much is wrong at taps whose truth changes within float "
      "error, and the causes' shares may be off by it (the edges of neighbouring faces differ by rounding, or the "
      "scene is far from the "
      "origin)",
      share_text(metric_of(*worst, "undecided")), share_text(metric_of(*worst, "error")));
}

std::string undecided_note(const BoundResult& bound, const PointRecord& point) {
  if (!bound.held || !bound.max || bound.join != "worst") return "";
  if (!may_hold_undecided(bound.metric)) return "";
  const double undecided = metric_of(point, bound.placement == "worst" ? "undecided_worst" : "undecided");
  if (!(bound.found + undecided > *bound.max)) return "";
  return fmt::format("it would be broken if all that is undecided there, {}, were {}",
                     quantity_text(undecided, "fraction"), bound.metric);
}

bool hides_bounds(const PointRecord& point) { return many_ambiguous_of(point) > 0; }

double many_ambiguous(double ambiguous, double receivers) {
  const double usual = much_ambiguous * receivers;
  return ambiguous > usual + 3 * std::sqrt(usual) ? ambiguous / receivers : 0;
}

double ambiguous_room(const PointRecord& point, std::string_view quantity) {
  constexpr double any = std::numeric_limits<double>::infinity();
  if (quantity.starts_with("flicker") && quantity != "flicker_ambiguous") {
    const double left_out = many_ambiguous_of_motion(point);
    if (left_out == 0 || find_quantity(std::string(quantity), {&point, 1}).unit == "count") return left_out;
    return left_out / (metric_of(point, "flicker_points") + left_out);
  }
  const double share = is_of_lights(quantity) ? many_ambiguous_of_lights(point) : many_ambiguous_of(point);
  if (share == 0) return 0;
  const double of_curve = hides_window(point) ? any : 0;
  if (cascade_number(point, quantity)) {
    if (is_cascade_bias(quantity)) return of_curve;
    quantity.remove_prefix(quantity.rfind('.') + 1);
  }
  for (const CurveQuantity& row : curve_quantities())
    if (row.name == quantity) return of_curve;
  for (const Metric& row : metrics_table())
    if (row.name == quantity) {  // what is not plotted is a count or a check, and map_ is a share of texels
      if (row.of_any_size) return any;
      return row.unit == "fraction" && row.plotted && !quantity.starts_with("map_") ? share : 0;
    }
  return is_brought(point, quantity) ? share : 0;
}

std::string text_with_room(double value, double room, std::string_view unit, int digits) {
  if (std::isinf(room)) return "not known";
  const std::string text = quantity_text(value, unit, digits);
  return room > 0 && std::isfinite(value) ? fmt::format("{} ± {}", text, quantity_text(room, unit)) : text;
}

std::string ambiguous_note(const PointRecord& point) {
  const double share = std::max(many_ambiguous_of(point), many_ambiguous_of_lights(point));
  if (share == 0) return "";
  return fmt::format(
      "the truth of {} of the receivers that face the light is ambiguous and left out, because rounding of floats "
      "decides it: the light or the scene is too far away for its size, or shapes overlap; a bound that as many wrong "
      "receivers would break is not known to hold; move the light nearer (light.position_m), or the scene to the "
      "origin",
      share_text(share));
}

}  // namespace noonmark
