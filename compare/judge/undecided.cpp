#include "compare/judge/undecided.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "compare/results/number_text.h"
#include "compare/results/quantities.h"

namespace noonmark {
namespace {

// The metrics to which an undecided tap may belong.
constexpr std::array<std::string_view, 11> causes = {
    "filter",        "displacement", "aliasing",      "aliasing_dark",  "aliasing_light",   "acne",
    "peter_panning", "coverage",     "coverage_dark", "coverage_light", "peter_panning_lit"};

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
      "undecided is {:.3g}% where the error is {:.3g}%: that much is wrong at taps whose truth changes within float "
      "error, and the causes' shares may be off by it (the edges of neighbouring faces differ by rounding, or the "
      "scene is far from the "
      "origin)",
      100 * metric_of(*worst, "undecided"), 100 * metric_of(*worst, "error"));
}

std::string undecided_note(const BoundResult& bound, const PointRecord& point) {
  if (!bound.held || !bound.max || bound.join != "worst") return "";
  if (std::find(causes.begin(), causes.end(), bound.metric) == causes.end()) return "";
  const double undecided = metric_of(point, bound.placement == "worst" ? "undecided_worst" : "undecided");
  if (!(bound.found + undecided > *bound.max)) return "";
  return fmt::format("it would be broken if all that is undecided there, {}, were {}",
                     quantity_text(undecided, "fraction"), bound.metric);
}

}  // namespace noonmark
