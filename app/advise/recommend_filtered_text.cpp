#include "app/advise/recommend_filtered_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "app/advise/engine_forms.h"
#include "app/advise/recommend_filtered.h"
#include "base/text.h"
#include "compare/judge/recommendation.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"

namespace noonmark {
namespace {}  // namespace

std::string lookup_text(const Settings& settings) {
  if (!reduction_is_free(settings.lookup.kind)) return engine_form_name(settings);
  std::string name = settings.lookup.kind;
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c; });
  if (name == "MSM_HAUSDORFF") name = "MSM (lookup.kind = msm_hausdorff)";
  std::string text = settings.filter.kind == "none" ? name + " without a blur"
                                                    : fmt::format("{} with a {} of {} texels", name,
                                                                  settings.filter.kind, settings.filter.whole("size"));
  if (settings.lookup.kind.starts_with("evsm")) text += fmt::format(", lookup.floor = {:g}", settings.lookup["floor"]);
  return text;
}

std::string filtered_bounds_text(const CurveOptions& bounds) {
  return fmt::format(
      "leak and Peter Panning each within {}, over-darkening and what the reduction darkens each within {}",
      share_text(bounds.peter_panning_bound), share_text(bounds.acne_bound));
}

std::string glossed_filtered_bounds_text(const CurveOptions& bounds) {
  return fmt::format(
      "leak (light where shadows overlap) and Peter Panning (a shadow leaves its object) each within {}, "
      "over-darkening (shade on what is lit) and what lookup.reduction darkens each within {}",
      share_text(bounds.peter_panning_bound), share_text(bounds.acne_bound));
}

std::string filtered_beside_compared(const CurveOptions& bounds) {
  return fmt::format(
      "A filtered map has no acne. It keeps its leak (light where shadows overlap) and its Peter Panning each within "
      "{}, and its over-darkening and what its reduction darkens each within {}.",
      share_text(bounds.peter_panning_bound), share_text(bounds.acne_bound));
}

std::string shares_text(const FilteredShares& shares) {
  return fmt::format("{} leak, {} Peter Panning, {} over-darkening, {} darkened by the reduction",
                     share_text(shares.leak), share_text(shares.peter_panning), share_text(shares.over_darkening),
                     share_text(shares.reduction));
}

std::string allowed_text(const Tried& tried) {
  return tried.filtered() && !tried.usable() ? fmt::format(" A search allows {}.", searched_filtered_text()) : "";
}

std::string enough_bounds_text(const PointRecord& worst, const CurveOptions& bounds) {
  const FilteredShares left = filtered_shares(worst);
  // Of the bounds only a share is used up while searching.
  const auto enough = [](double bound, double found, double share) { return std::max(bound, found / share); };
  return fmt::format(
      "Larger bounds: from about --acne {} --peter-panning {} on these settings do.",
      share_text(enough(bounds.acne_bound, std::max(left.over_darkening, left.reduction), searched_acne)),
      share_text(enough(bounds.peter_panning_bound, std::max(left.leak, left.peter_panning), searched_peter_panning)));
}

std::string kept_filtered_text(const Answer& answer, const CurveOptions& bounds) {
  const Tried& tried = answer.tried;
  const CurveOptions searched = searched_bounds(bounds);
  const std::string where = fmt::format(
      "under {} and at all {} placements of the map's grid that were searched, on the exact map. That is "
      "{}, because conditions that were not searched may be a little worse.",
      counted(answer.conditions, "condition"), answer.placements, searched_filtered_text());
  if (tried.as_is)
    return fmt::format("It keeps {} {} {}", filtered_bounds_text(searched), where,
                       engine_form_text(tried.settings.lookup.kind));
  if (!tried.reduction) return "";
  return fmt::format("lookup.reduction keeps the leak within {} and what it darkens within {} from {} {}",
                     share_text(searched.peter_panning_bound), share_text(searched.acne_bound),
                     window_text(*tried.reduction), where);
}

std::string promise_of_both(const Answer& answer) {
  const std::optional<PointRecord>& shown = answer.verified.worst;
  if (!answer.tried.filtered() || !shown || !answer.tried.worst) return "";
  const double searched = answer.tried.error, rendered = answer.verified.worst_error;
  const bool placed = searched == worst_placed(*answer.tried.worst, "error");
  return fmt::format(
      "The error to expect is the larger of two, {}: {} {}, and {} of OpenGL's own map at the other placements. At the "
      "worst of these OpenGL's map differs from the exact one by {} (depth format and rasteriser) and {} (rounding of "
      "the moments).",
      share_text(std::max(searched, rendered)), share_text(searched),
      placed ? "at the worst of the searched placements of the exact map" : "with the grid where the settings put it",
      share_text(rendered), share_text(metric_of(*shown, "precision")),
      share_text(metric_of(*shown, "moment_precision")));
}

}  // namespace noonmark
