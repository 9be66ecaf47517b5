#include "compare/report/recommendation_box.h"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>

#include "compare/judge/bounds.h"
#include "compare/judge/curve_reading.h"
#include "compare/judge/poor_view.h"
#include "compare/judge/recommendation.h"
#include "compare/report/broken.h"
#include "compare/report/findings.h"
#include "compare/report/sections.h"
#include "compare/report/speed.h"
#include "compare/report/text.h"
#include "compare/results/quantities.h"

namespace noonmark::report {
namespace {

// A bias in the unit that a user sets and, if all curves share one scale, in the others.
std::string bias_of(const Recommendation& found, double value) {
  const PointRecord& first = found.choice.first();
  return found.choice.points.size() == 1 ? bias_phrase(value / parameter_per_depth(first), *first.curve)
                                         : bias_in_unit(value, found.bias->unit);
}

std::string point_links(const Choice& choice) {
  constexpr size_t most = 4;
  std::string out = choice.points.size() == 1 ? "point " : "points ";
  for (size_t i = 0; i < std::min(most, choice.points.size()); ++i)
    out += fmt::format("{}<a href=\"#p{}\" data-show=\"recommended\">{}</a>", i ? ", " : "", choice.points[i]->id,
                       choice.points[i]->id);
  return out + (choice.points.size() > most ? " …" : "");
}

// Opens the card of the choice's first point at the recommended bias, also where a bound is broken at the bias as set.
std::string recommended_link(const Choice& choice, const std::string& inner) {
  return fmt::format("<a href=\"#p{}\" data-show=\"recommended\">{}</a>", choice.first().id, inner);
}

// The swept settings that are chosen, but for the parameter of the curve, whose bias is the answer's own.
std::vector<std::string> chosen_settings(const Recommendation& found, const Results& results) {
  const std::vector<std::string> names = choice_settings(results.info);
  return found.bias ? without_curve_parameter(found.choice.first(), names) : names;
}

std::string chosen_phrase(const Recommendation& found, const Results& results) {
  return settings_phrase(found.choice.first(), chosen_settings(found, results));
}

size_t bound_count(const Results& results) {
  return static_cast<size_t>(
      std::count_if(results.bounds.begin(), results.bounds.end(), [](const auto& bound) { return !bound.warns; }));
}

std::string conditions_text(const Results& results, const Choice& choice) {
  if (results.info.over.empty()) return "";
  std::string names;
  for (const std::string& name : results.info.over) names += (names.empty() ? "" : ", ") + setting_label(name);
  return choice.points.size() == 1 ? fmt::format(" under the one condition ({})", html(names))
                                   : fmt::format(" under all {} conditions ({})", choice.points.size(), html(names));
}

// Where points have many placements of the map's grid, the error is that of the worst one; the points' own columns have
// the placement of the settings.
std::string_view at_worst_placement(const Recommendation& found) {
  return found.error.at && has_placements(*found.error.at) ? ", at the worst placement of the map's grid" : "";
}

// "a cost of 4.2 MB (Map bytes) and an error of 0.1 % (Error against the light's size)"
std::string cost_and_error(const Recommendation& found, const Results& results) {
  std::string over;
  if (found.choice.points.size() > 1)
    over = fmt::format(" (mean {}, 95th percentile {}; worst at <a href=\"#p{}\">point {}</a>)",
                       quantity(found.error.mean, find_metric(results.info.accuracy).unit),
                       quantity(found.error.p95, find_metric(results.info.accuracy).unit), found.error.at->id,
                       found.error.at->id);
  return fmt::format("a cost of <b>{}</b> (<i>{}</i>) and an error of <b>{}</b> (<i>{}</i>{}){}",
                     quantity(found.cost, find_metric(results.info.cost).unit), html(metric_label(results.info.cost)),
                     quantity(found.error.worst, find_metric(results.info.accuracy).unit),
                     html(error_label(results.info.accuracy)), at_worst_placement(found), over);
}

// What the noise of times means for the answer.
std::string noise_text(const CostNoise& noise, const Results& results) {
  if (find_metric(results.info.cost).unit != "ms") return " This cost is the same on every machine and in every run.";
  const std::string rule = fmt::format(
      " A time is a median with an interval that holds it with at least {:.0f}\u202f%; two differ only where these do "
      "not overlap.",
      100 * median_coverage);
  if (noise.meaningless())
    return rule + fmt::format(
                      " <b>Here the noise makes a ranking by time meaningless</b>: the times of all {} kinds of work "
                      "overlap with the shortest, so the answer is the most accurate of them. Time on a quiet machine, "
                      "or rank by a cost that does not depend on it.",
                      noise.costs);
  if (noise.least > 1)
    return rule + fmt::format(
                      " The times of {} of {} kinds of work cannot be told from the shortest; the answer is the most "
                      "accurate of these.",
                      noise.least, noise.costs);
  return rule + (noise.costs > 1 ? " All others are certainly longer." : "");
}

}  // namespace

std::string cause_sentence(std::span<const PointRecord* const> points, std::optional<double> bias) {
  std::string out;
  const std::vector<CauseShare> shares = cause_shares(points, bias);
  for (size_t i = 0; i < std::min<size_t>(shares.size(), 3); ++i)
    out += fmt::format("{}<span class=\"cause\">{}{} ({:.0f}{}%)</span>", i ? ", " : "", swatch(shares[i].name),
                       html(metric_label(shares[i].name)), 100 * shares[i].share, "\u202f");
  return out;
}

// Of points of several parts: the cheapest choice of the largest group that can be compared. Empty if no choice of it has a
// usable bias window, because a bound of a part alone can also demand an error.
std::string cheapest_of_parts(const Results& results, const ShownPoints& shown) {
  if (shown.groups.empty() || is_incomplete(results)) return "";
  const ComparedGroup& group = shown.groups[group_shown_first(shown.groups)];
  if (group.choices.size() < 2 || !group.recommended) return "";
  const ComparedChoice& best = group.choices[*group.recommended];
  if (best.window != ComparedChoice::Window::usable) return "";
  std::unordered_set<int64_t> on_page;
  for (const PointRecord& point : shown.results.points) on_page.insert(point.id);
  const std::string name = html(ChoiceNames(results).of(best.choice, AtBias::best)),
                    of = GroupNames(results, shown.groups).of(group);
  const PointRecord* const point = point_on_page(best, error_shown_first(results), on_page);
  return fmt::format(" Of the {} choices{} the cheapest that is good enough is {}.", group.choices.size(),
                     of.empty() ? "" : " for " + html(of),
                     point ? fmt::format("<a href=\"#p{}\">{}</a>", point->id, name) : name);
}

// What to set, or what is known instead.
static std::string what_to_set(const Results& results, const ShownPoints& shown) {
  // Points of different parts are not meant to be compared, so none of them is an answer.
  if (!results.points.front().part.empty()) {
    const auto kept = [](const auto& list) {
      return std::count_if(list.begin(), list.end(), [](const auto& one) { return one.held; });
    };
    std::string out;
    if (!results.laws.empty()) out = fmt::format("{} of {} laws hold", kept(results.laws), results.laws.size());
    if (!results.bounds.empty())
      out +=
          fmt::format("{}{} of {} bounds hold", out.empty() ? "" : ", ", kept(results.bounds), results.bounds.size());
    return fmt::format("{}{} points of several parts, which are compared only where they can be.{}",
                       out.empty() ? "" : out + ". ", results.points.size(), cheapest_of_parts(results, shown));
  }
  const Recommendation found = recommend(results);
  switch (found.outcome) {
    case Recommendation::Outcome::no_criterion:
      return "No bound and no bias curve says what is good enough, so no setting is recommended.";
    case Recommendation::Outcome::incomplete:
      return "Not all conditions are measured yet, so no setting is recommended.";
    case Recommendation::Outcome::none_holds:
      return "None of the swept settings is good enough.";
    case Recommendation::Outcome::found:
      break;
  }
  const char* const conditions = results.info.over.empty() ? "" : " under all conditions";
  const std::string error = quantity(found.error.worst, find_metric(results.info.accuracy).unit);
  const std::string bias =
      found.bias ? html(fmt::format("{} {}", found.bias->parameter, bias_in_unit(found.bias->value, found.bias->unit)))
                 : "";
  if (found.bias && found.bias->as_set)
    return fmt::format("What is set is good enough{}: {} with {}. Its error is {}{}.", conditions,
                       bound_count(results) == 1 ? "the bound holds" : "all bounds hold",
                       recommended_link(found.choice, bias), error, at_worst_placement(found));
  const std::string settings = chosen_phrase(found, results);
  return fmt::format(
      "Set {}{}: the cheapest setting that is good enough{}. Its error is {}{}.",
      recommended_link(found.choice, settings.empty() ? found.bias ? bias : "this point" : html(settings)),
      settings.empty() || bias.empty() ? "" : " and " + bias, conditions, error, at_worst_placement(found));
}

std::string answer_sentence(const Results& results, const ShownPoints& shown) {
  if (results.points.empty()) return "No point was measured.";
  if (std::all_of(results.points.begin(), results.points.end(), nothing_judged))
    return "Nothing was measured: " + html(poor_view_note(results.points)) + ".";
  const std::string broken = broken_sentence(results);
  return (broken.empty() ? "" : broken + " ") + what_to_set(results, shown);
}

std::string recommendation_box(const Results& results) {
  if (std::all_of(results.points.begin(), results.points.end(), nothing_judged))
    return fmt::format(
        "<div class=\"recommend broken\"><h3>What to set</h3><p><b>Nothing was measured</b>: {}. This gives no "
        "information about the method.</p></div>\n",
        html(poor_view_note(results.points)));
  const Recommendation found = recommend(results);
  using Outcome = Recommendation::Outcome;
  if (found.outcome == Outcome::no_criterion)
    return "<div class=\"recommend none\"><h3>What to set</h3><p>There is no criterion for good enough: set a bound, "
           "or have a bias curve measured.</p></div>\n";
  if (found.outcome == Outcome::incomplete)
    return "<div class=\"recommend none\"><h3>What to set</h3><p>Not all conditions are measured yet, so no setting is "
           "known to hold under all of them. The same command continues the sweep.</p></div>\n";
  if (found.outcome == Outcome::none_holds)
    return fmt::format(
        "<div class=\"recommend broken\"><h3>What to set</h3><p><b>None of the swept settings is good enough{}.</b> "
        "None has a usable bias window and meets every bound that applies to it. Sweep a higher resolution, a smaller "
        "extent or another part of the bias, or loosen a bound.</p></div>\n",
        results.info.over.empty() ? "" : " under all conditions");
  const std::vector<std::string> chosen = chosen_settings(found, results);
  std::string rows;
  for (const std::string& name : chosen)
    rows += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", html(name),
                        html(settings_phrase(found.choice.first(), {name}).substr(setting_label(name).size() + 1)));
  std::string more;
  if (found.bias) {
    const auto& [parameter, unit, value, window, narrow, as_set] = *found.bias;
    rows += fmt::format("<div class=\"key\"><dt>{}</dt><dd>{}</dd></div>\n", html(parameter), bias_of(found, value));
    rows += fmt::format("<div><dt>usable from</dt><dd>{}</dd></div>\n<div><dt>to</dt><dd>{}</dd></div>\n",
                        bias_of(found, window.low), bias_of(found, window.high));
    if (narrow && as_set)
      more = fmt::format(
          " The bias is closer than {:.0f}\u202f% to an end of its window, so a small change of the scene can break "
          "it.",
          100 * (bias_margin - 1));
    else if (narrow)
      more = fmt::format(
          " Its window is narrower than a margin of {:.0f}\u202f% to both ends, so a small change of the "
          "scene can break it.",
          100 * (bias_margin - 1));
    else if (window.low > 0)
      more = fmt::format(" Its window is a factor {} wide; the bias keeps at least {:.0f}\u202f% from its ends.",
                         number(window.high / window.low), 100 * (bias_margin - 1));
  }
  const std::string causes =
      cause_sentence(found.choice.points, found.bias ? found.bias->read_at() : std::optional<double>());
  const bool kept = found.bias && found.bias->as_set;
  const Recommendation accurate = recommend_accurate(results);
  std::string other;
  if (const std::string phrase = accurate.choice.points.empty() ? "" : chosen_phrase(accurate, results);
      &accurate.choice.first() != &found.choice.first())
    other = fmt::format(
        "<p>The most accurate setting that is good enough: {}{}{}, for {} ({}).</p>\n", html(phrase),
        phrase.empty() || !accurate.bias ? "" : ", ",
        accurate.bias ? fmt::format("{} {}", html(accurate.bias->parameter), bias_of(accurate, accurate.bias->value))
                      : "",
        cost_and_error(accurate, results), point_links(accurate.choice));
  return fmt::format(
      "<div class=\"recommend {}\"><h3>{}</h3><p>{}{}{} has {}.{}</p>\n"
      "<dl>{}</dl>\n{}{}<p class=\"small\">It is {}: {}.{} <a href=\"#cost\">Speed against accuracy</a> compares by "
      "other costs and "
      "errors.</p></div>\n",
      // Not green while a bound is broken: a reader would take the colour for the verdict.
      std::any_of(results.bounds.begin(), results.bounds.end(), breaks) ? "none" : "held",
      kept ? "What is set" : "What to set",
      kept ? "What is set is good enough" : "The cheapest setting that is good enough",
      conditions_text(results, found.choice), kept ? ". It" : "", cost_and_error(found, results), more, rows,
      causes.empty() ? ""
                     : fmt::format("<p>Largest causes there{}: {}.</p>\n",
                                   !found.bias          ? ""
                                   : found.bias->as_set ? ", with this bias, as set"
                                                        : ", with this bias (causes that no curve gives: as rendered)",
                                   causes),
      other, point_links(found.choice),
      kept ? "every bound holds with the bias that is set, which lies in the usable window"
           : fmt::format("the least <i>{}</i> among the settings of which {}; among equal costs the least <i>{}</i>",
                         html(metric_label(results.info.cost)),
                         !found.bias              ? "every bound holds"
                         : results.bounds.empty() ? "the bias window is not empty"
                                                  : "the bias window is not empty and every bound holds at that bias",
                         html(error_label(results.info.accuracy))),
      noise_text(found.noise, results));
}

}  // namespace noonmark::report
