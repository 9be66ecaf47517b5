#include "compare/judge/undecided.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

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

}  // namespace noonmark
