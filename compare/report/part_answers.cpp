#include "compare/report/part_answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <unordered_set>
#include <vector>

#include "compare/judge/curve_reading.h"
#include "compare/judge/recommendation.h"
#include "compare/report/blocks.h"
#include "compare/report/speed.h"
#include "compare/report/text.h"
#include "compare/results/quantities.h"

namespace noonmark::report {
namespace {

using Window = ComparedChoice::Window;

struct PartRows {
  const Results& results;
  const ShownPoints& shown;
  ChoiceNames choice_names;
  GroupNames group_names;
  std::unordered_set<int64_t> on_page = {};

  // Opens the point at the bias that the row names.
  Markup link(const ComparedChoice& one) const {
    const std::string name = choice_names.of(one.choice, AtBias::best);
    const PointRecord* const point = point_on_page(one, shown.error_first, on_page);
    return point ? element("a", Attribute("href", fmt::format("#p{}", point->id)),
                           Attribute("data-show", "recommended"), name)
                 : Markup(name);
  }

  std::string error_text(const ComparedChoice& one) const {
    return cell(value_of(one, shown.error_first).worst, find_metric(shown.error_first).unit);
  }

  Markup good_row(const Markup& head, const ComparedChoice& one) const {
    const Recommendation& good = *one.good;
    Markup cells = row_head(css("text"), head) + td(css("text"), link(one));
    if (good.bias)
      cells +=
          td(css("text"), fmt::format("{} {}", good.bias->parameter, bias_in_unit(good.bias->value, good.bias->unit))) +
          td(bias_in_unit(good.bias->window.low, good.bias->unit)) +
          td(bias_in_unit(good.bias->window.high, good.bias->unit));
    else
      cells += td(css("text"), Attribute("colspan", 3), "as set: the bounds hold");
    return tr(cells + td(cell(good.cost.middle, find_metric(results.info.cost).unit)) + td(error_text(one)));
  }

  // A point of the choice that has no usable window; otherwise its first one.
  static const PointRecord& failing(const ComparedChoice& one) {
    const auto& points = one.choice.points;
    const auto found =
        std::find_if(points.begin(), points.end(), [](const auto* point) { return lacks_window(*point); });
    return found == points.end() ? *points.front() : **found;
  }

  // Why the choice is not good enough, and what may help: sentences.
  std::string why_not(const ComparedChoice& one) const {
    const PointRecord& point = failing(one);
    if (one.window == Window::unknown) return fmt::format("What is usable is {}.", window_not_known);
    if (one.window == Window::usable) return "No value in its usable window meets every bound.";
    if (one.window == Window::no_curve) {
      const std::string why = why_no_curve(point);
      return fmt::format("{}{}", one.judged ? "It breaks a bound." : "It is held to no bound, and stands as set.",
                         why.empty() ? "" : fmt::format(" It has no curve: {}.", why));
    }
    if (free_setting(point) == FreeSetting::bias) {
      const CauseBounds& bounds = curve_bounds(point);
      return fmt::format("No value of {} keeps acne within {} and Peter Panning within {}{}.", curve_parameter(point),
                         quantity(bounds.acne_bound, "fraction"), quantity(bounds.peter_panning_bound, "fraction"),
                         one.choice.points.size() > 1 ? " under every condition" : "");
    }
    std::string why = no_reduction_text(point);
    if (why.empty()) return "No reduction is usable under every condition.";
    why[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(why[0])));
    return why + ".";
  }

  Markup bad_row(const Markup& head, const ComparedChoice& one, size_t choices) const {
    return tr(css(one.judged ? "broken" : ""), row_head(css("text"), head),
              td(css("text"), Attribute("colspan", 4),
                 prose("{}{}: {}",
                       choices == 1 ? ""
                       : one.judged ? "None is good enough. Of least error "
                                    : "Nothing says what is good enough. Of least error ",
                       link(one), why_not(one))),
              td(cell(cost_of(one, results.info.cost).middle, find_metric(results.info.cost).unit)),
              td(error_text(one)));
  }

  Markup row(const Markup& head, const std::vector<const ComparedChoice*>& choices) const {
    std::vector<Recommendation> good;
    for (const ComparedChoice* one : choices)
      if (one->good) good.push_back(*one->good);
    if (const Recommendation* const best = cheapest(good))
      for (const ComparedChoice* one : choices)
        if (&one->choice.first() == &best->choice.first()) return good_row(head, *one);
    const auto error_of = [&](const ComparedChoice* one) {
      const double error = value_of(*one, shown.error_first).worst;
      return std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
    };
    return bad_row(
        head,
        **std::min_element(choices.begin(), choices.end(), [&](auto* a, auto* b) { return error_of(a) < error_of(b); }),
        choices.size());
  }
};

}  // namespace

bool has_parts(const Results& results) { return !results.points.empty() && !results.points.front().part.empty(); }

const ComparedChoice* answer_of_parts(const Results& results, const std::vector<ComparedGroup>& groups) {
  if (groups.empty() || is_incomplete(results)) return nullptr;
  const ComparedGroup& group = groups[group_shown_first(groups)];
  if (group.choices.size() < 2 || !group.recommended) return nullptr;
  const ComparedChoice& best = group.choices[*group.recommended];
  return best.window == Window::usable ? &best : nullptr;
}

Markup part_answers(const ShownPoints& shown) {
  if (!has_parts(shown.all) || !shown.all.laws.empty()) return "";
  if (judges_frames(shown.all.points) || is_incomplete(shown.all)) return "";
  if (std::none_of(shown.all.points.begin(), shown.all.points.end(), has_curve)) return "";
  PartRows rows{shown.all, shown, ChoiceNames(shown.all), GroupNames(shown.all, shown.groups)};
  for (const PointRecord& point : shown.results.points) rows.on_page.insert(point.id);
  Markup body;
  size_t count = 0;
  for (const ComparedGroup& group : shown.groups) {
    std::vector<std::pair<std::string, std::vector<const ComparedChoice*>>> parts;
    for (const ComparedChoice& one : group.choices) {
      const std::string& part = one.choice.first().part;
      if (parts.empty() || parts.back().first != part) parts.push_back({part, {}});
      parts.back().second.push_back(&one);
    }
    const std::string of = rows.group_names.of(group);
    for (const auto& [part, choices] : parts) body += rows.row(with_small(part, of), choices), ++count;
  }
  const auto unit = [](const std::string& metric) { return head_unit(find_metric(metric).unit); };
  const Markup head = th(css("text"), "Part") + th(css("text"), "Cheapest that is good enough") +
                      th(css("text"), "At") + heads({"Usable from", "to"}) +
                      th(with_small(metric_label(shown.all.info.cost), unit(shown.all.info.cost))) +
                      th(with_small(error_label(shown.error_first), unit(shown.error_first)));
  return element("h3", "What to set in each part") + "\n" +
         folded("", count <= open_rows, prose("{} rows", count),
                div(css("scroll"), table("numbers parts", head, body)) + "\n");
}

}  // namespace noonmark::report
