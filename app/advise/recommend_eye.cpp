#include "app/advise/recommend_eye.h"

#include <fmt/format.h>

#include <string_view>

#include "compare/results/number_text.h"
#include "compare/results/quantities.h"

namespace noonmark {

std::vector<Bound> default_eye_bounds() {
  Bound edges, patch;
  edges.metric = edge_metric, edges.max = most_edge_pixels;
  patch.metric = patch_metric, patch.max = most_wrong_patch;
  return {edges, patch};
}

bool is_eye_bound(const Bound& bound) {
  const std::string_view metric = bound.metric;
  const bool edges = metric.starts_with("edge_displacement_") && metric.ends_with("pixels");
  return bound.max && bound.level == "error" && (edges || metric == patch_metric || metric == "flip");
}

EyeErrors eye_errors(const PointRecord& point) {
  return {metric_of(point, "edge_displacement_mean_pixels"), metric_of(point, edge_metric),
          metric_of(point, patch_metric), metric_of(point, "flip")};
}

std::string eye_bound_text(const Bound& bound) {
  if (bound.metric == edge_metric)
    return fmt::format("95% of the pixels at shadow edges within {:g} pixel{}", *bound.max, *bound.max == 1 ? "" : "s");
  const std::string most = quantity_text(*bound.max, find_quantity(bound.metric).unit);
  if (bound.metric == patch_metric) return fmt::format("every patch of wrong pixels within {} of the picture", most);
  return fmt::format("{} within {}", bound.metric, most);
}

std::string why_not_for_eye(const PointRecord& point, const std::vector<Bound>& bounds) {
  std::string why;
  for (const Bound& bound : bounds) {
    const double value = metric_of(point, bound.metric);
    if (!matches(point, bound.where) || value <= *bound.max) continue;
    const std::string_view unit = find_quantity(bound.metric).unit;
    const std::string found = quantity_text(value, unit, digits_to_tell(value, *bound.max));
    if (!why.empty()) why += "; ";
    if (bound.metric == edge_metric)
      why += fmt::format("5% of the pixels at its shadow edges lie {} off or more", found);
    else if (bound.metric == patch_metric)
      why += fmt::format("a patch of {} of the picture is wrong", found);
    else
      why += fmt::format("its {} is {}, above {}", bound.metric, found, quantity_text(*bound.max, unit));
  }
  return why;
}

}  // namespace noonmark
