#include "compare/report/recommendation_box.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/shell_words.h"
#include "base/text.h"
#include "compare/judge/bounds.h"
#include "compare/judge/curve_reading.h"
#include "compare/judge/poor_view.h"
#include "compare/judge/recommendation.h"
#include "compare/report/blocks.h"
#include "compare/report/broken.h"
#include "compare/report/cause_shares.h"
#include "compare/report/opening.h"
#include "compare/report/part_answers.h"
#include "compare/report/sections.h"
#include "compare/report/speed.h"
#include "compare/report/speed_section.h"
#include "compare/report/text.h"
#include "compare/results/quantities.h"

namespace noonmark::report {
namespace {

// A bias in the unit that a user sets and, if all curves share one scale, in the others.
std::string bias_of(const Recommendation& found, double value) {
  const PointRecord& first = found.choice.first();
  return found.choice.points.size() == 1 && first.curve ? bias_phrase(value / parameter_per_depth(first), *first.curve)
                                                        : amount_of_bias(found.choice.points, value);
}

// "bias" or "reduction": what the answer's free setting is called where it was named before.
const char* free_noun(const Recommendation& found) {
  return free_setting(found.choice.first()) == FreeSetting::reduction ? "reduction" : "bias";
}

// Opens the card of a point at the recommended bias, also where a bound is broken at the bias as set.
Markup recommended_link(const PointRecord* point, const Markup& content) {
  if (!point || content.empty()) return content;
  return element("a", Attribute("href", fmt::format("#p{}", point->id)), Attribute("data-show", "recommended"),
                 content);
}

Markup point_links(const Choice& choice) {
  constexpr size_t most = 4;
  std::vector<Markup> links;
  for (size_t i = 0; i < std::min(most, choice.points.size()); ++i)
    links.push_back(recommended_link(choice.points[i], choice.points[i]->id));
  return prose("{} {}{}", choice.points.size() == 1 ? "point" : "points", joined(links, ", "),
               choice.points.size() > most ? " …" : "");
}

// The swept settings that are chosen, but for the parameter of the curve, whose bias is the answer's own.
std::vector<std::string> chosen_settings(const Recommendation& found, const Results& results) {
  const std::vector<std::string> names = choice_settings(results.info);
  return found.bias ? without_curve_parameter(found.choice.first(), names) : names;
}

std::string chosen_phrase(const Recommendation& found, const Results& results) {
  return settings_phrase(found.choice.first(), chosen_settings(found, results));
}

// What is said of a choice that keeps all bounds. Where a value is worse than in the baseline, this is not good enough.
const char* praise(const Results& results) {
  return results.baseline && !results.baseline->held() ? "keeps the bounds" : "is good enough";
}

std::string conditions_text(const Results& results, const Choice& choice) {
  const std::vector<std::string> conditions = conditions_of(results.info);
  if (conditions.empty()) return "";
  std::string names;
  for (const std::string& name : conditions) names += (names.empty() ? "" : ", ") + setting_label(name);
  return choice.points.size() == 1 ? fmt::format(" under the one condition ({})", names)
                                   : fmt::format(" under all {} conditions ({})", choice.points.size(), names);
}

// Where points have many placements of the map's grid, the error is that of the worst one; the points' own columns have
// the placement of the settings.
std::string_view at_worst_placement(const Recommendation& found) {
  return found.error.at && has_placements(*found.error.at) ? ", at the worst placement of the map's grid" : "";
}

// "a cost of 4.2 MB (Map bytes) and an error of 0.1 % (Error against the light's size)"
Markup cost_and_error(const Recommendation& found, const Results& results) {
  const std::string_view unit = find_metric(results.info.accuracy).unit;
  Markup over;
  if (found.choice.points.size() > 1)
    over =
        prose(" (mean {}, 95th percentile {}; worst at {})", quantity(found.error.mean, unit),
              quantity(found.error.p95, unit), point_link(found.error.at->id, prose("point {}", found.error.at->id)));
  return prose("a cost of {} ({}) and an error of {} ({}{}){}",
               bold(quantity(found.cost, find_metric(results.info.cost).unit)), italic(metric_label(results.info.cost)),
               bold(quantity(found.error.worst, unit)), italic(error_label(results.info.accuracy)),
               at_worst_placement(found), over);
}

// What the noise of times means for the answer.
Markup noise_text(const CostNoise& noise, const Results& results) {
  if (find_metric(results.info.cost).unit != "ms") return " This cost is the same on every machine and in every run.";
  const Markup rule = prose(
      " A time is a median with an interval that holds it with at least {:.0f}\u202f%; two differ only where these do "
      "not overlap.",
      100 * median_coverage);
  if (noise.meaningless())
    return rule + prose(
                      " {}: the times of all {} kinds of work overlap with the shortest, so the answer is the most "
                      "accurate of them. Time on a quiet machine, or rank by a cost that does not depend on it.",
                      bold("Here the noise makes a ranking by time meaningless"), noise.costs);
  if (noise.least > 1)
    return rule + prose(
                      " The times of {} of {} kinds of work cannot be told from the shortest; the answer is the most "
                      "accurate of these.",
                      noise.least, noise.costs);
  return rule + (noise.costs > 1 ? " All others are certainly longer." : "");
}

}  // namespace

Markup cause_sentence(std::span<const PointRecord* const> points, std::optional<double> bias) {
  std::vector<Markup> largest;
  for (const CauseShare& one : cause_shares(points, bias)) {
    if (largest.size() == 3) break;
    largest.push_back(
        span(css("cause"), swatch(one.name), prose("{} ({:.0f}\u202f%)", metric_label(one.name), 100 * one.share)));
  }
  return joined(largest, ", ");
}

namespace {

// Of points of several parts: the cheapest choice of the largest group that can be compared. No part is the answer of another.
AnswerWords words_of_parts(const Findings& found) {
  AnswerWords words{fmt::format("{} of several parts, which are compared only where they can be.",
                                counted(found.all.points.size(), "point")),
                    "", "", answer_point(found)};
  const ComparedChoice* const best = answer_of_parts(found.all, found.groups);
  if (!best) return words;
  const ComparedGroup& group = found.groups[group_shown_first(found.groups)];
  const std::string of = GroupNames(found.all, found.groups).of(group);
  words.before += fmt::format(" Of the {} choices{} the cheapest that {} is ", group.choices.size(),
                              of.empty() ? "" : " for " + of, praise(found.all));
  words.subject = ChoiceNames(found.all).of(best->choice, AtBias::best);
  const std::optional<BiasChoice>& bias = best->good->bias;
  words.after = bias ? fmt::format(" with a {}.", named_bias(best->choice.points, bias->value)) : ".";
  return words;
}

bool any_point(const Findings& found, bool (*holds)(const PointRecord&)) {
  return std::any_of(found.all.points.begin(), found.all.points.end(), holds);
}

// Why nothing can be recommended, and what may help: sentences. kind: that of the box.
struct NoAnswer {
  std::string_view kind;
  std::string why, help;
};

std::optional<NoAnswer> why_no_answer(const Findings& found) {
  const std::string poor = poor_view_note(found.all.points), these = these_points(found.all.points),
                    none_is = found.all.points.size() == 1 ? "This point is not" : fmt::format("None of {} is", these);
  if (!any_point(found, [](const PointRecord& point) { return !nothing_judged(point); }))
    return NoAnswer{"broken", fmt::format("Nothing was measured: {}.", poor),
                    "This gives no information about the method."};
  switch (found.recommended.outcome) {
    case Recommendation::Outcome::no_criterion:
      if (any_point(found, has_fixed_reduction))
        return NoAnswer{"none",
                        "No bound says what is good enough, and with lookup.reduction_span there is no usable window "
                        "that could, so no setting is recommended.",
                        "Set bounds, on leak, over_darkening, peter_panning and error."};
      return NoAnswer{"none",
                      "No bound and no curve over a bias or a reduction says what is good enough, so no setting is "
                      "recommended.",
                      "Set a bound, or have a curve over the bias or the light-bleed reduction measured."};
    case Recommendation::Outcome::incomplete:
      return NoAnswer{"none", "Not all conditions are measured yet, so no setting is recommended.",
                      "The same command continues the sweep."};
    case Recommendation::Outcome::none_holds:
      if (any_point(found, hides_window))
        return NoAnswer{"broken", fmt::format("{} known to be good enough: {}.", none_is, poor), ""};
      return NoAnswer{
          "broken",
          fmt::format("{} good enough{}.", none_is,
                      conditions_of(found.all.info).empty() ? "" : " under all conditions"),
          fmt::format("None has a usable {} window and meets every bound, also those that the experiment asks of other "
                      "settings alone. Sweep a higher resolution, a smaller extent or {}, or loosen a bound.",
                      free_setting_words(found.all.points),
                      any_point(found, [](const auto& one) { return free_setting(one) == FreeSetting::reduction; })
                          ? "another lookup, blur or bias"
                          : "another part of the bias")};
    case Recommendation::Outcome::found:
      break;
  }
  return std::nullopt;
}

}  // namespace

// Where the verdict speaks of the bias that was set, that of the answer is the only other one.
AnswerWords answer_words(const Findings& found) {
  const Results& results = found.all;
  if (results.points.empty()) return {"No point was measured."};
  if (judges_frames(results.points))  // nothing is set here, so nothing is recommended
    return {results.bounds.empty() ? "No bound says what is good enough." : ""};
  if (has_parts(results)) return words_of_parts(found);
  if (const std::optional<NoAnswer> none = why_no_answer(found)) return {none->why};
  const Recommendation& answer = found.recommended;
  const std::string error =
      fmt::format("ts error is {}{}.", quantity(answer.error.worst, find_metric(results.info.accuracy).unit),
                  at_worst_placement(answer));
  const PointRecord* const point = &answer.choice.first();
  if (answer.bias && answer.bias->as_set) return {"", "I" + error, "", point};
  const std::string settings = chosen_phrase(answer, results),
                    bias = answer.bias ? named_bias(answer.choice.points, answer.bias->value) : "";
  const std::string good =
      praise(results) + std::string(conditions_of(results.info).empty() ? "" : " under all conditions");
  if (settings.empty())
    return {"", bias.empty() ? "What is set" : "A " + bias, fmt::format(" {}; i{}", good, error), point};
  const bool kept = found.verdict == Verdict::held && !your_bias(results.points).empty();
  return {kept ? fmt::format("Cheaper{}: ", conditions_of(results.info).empty() ? "" : ", under all conditions")
               : fmt::format("Of {} the cheapest that {}: ", these_points(results.points), good),
          settings,
          fmt::format("{}; i{}",
                      !answer.bias ? ""
                      : kept       ? " with " + amount_of_bias(answer.choice.points, answer.bias->value)
                                   : " with a " + bias,
                      error),
          point};
}

Markup answer_sentence(const Findings& found) {
  std::vector<Markup> said;
  if (found.headline) said.push_back(found.headline->found);
  if (Markup broken = broken_sentence(found.all); !broken.empty()) said.push_back(std::move(broken));
  if (const AnswerWords words = answer_words(found); !found.headline && !words.text().empty())
    said.push_back(words.before + recommended_link(words.point, words.subject) + words.after);
  return joined(said, " ");
}

namespace {

// kind: "held", "none" or "broken", for its colour.
Markup box(std::string_view kind, const Markup& title, const Markup& content) {
  return div(css(fmt::format("recommend {}", kind)), element("h3", title), content) + "\n";
}

// How far the bias is from the ends of its window.
Markup bias_margin_text(const BiasChoice& bias, const char* noun) {
  const double margin_percent = 100 * (bias_margin - 1);
  if (bias.narrow && bias.as_set)
    return prose(
        " The {} is closer than {:.0f}\u202f% to an end of its window, so a small change of the scene can break it.",
        noun, margin_percent);
  if (bias.narrow)
    return prose(
        " Its window is narrower than a margin of {:.0f}\u202f% to both ends, so a small change of the scene can break "
        "it.",
        margin_percent);
  if (bias.window.low > 0)
    return prose(" Its window is a factor {} wide; the {} keeps at least {:.0f}\u202f% from its ends.",
                 number(bias.window.high / bias.window.low), noun, margin_percent);
  return "";
}

Markup settings_and_bias(const Recommendation& found, const Results& results) {
  Markup list;
  for (const std::string& name : chosen_settings(found, results))
    list += term(name, settings_phrase(found.choice.first(), {name}).substr(setting_label(name).size() + 1));
  if (!found.bias) return list;
  return list + term(found.bias->parameter, bias_of(found, found.bias->value), "key") +
         term("usable from", bias_of(found, found.bias->window.low)) +
         term("to", bias_of(found, found.bias->window.high));
}

Markup causes_text(const Recommendation& found) {
  const Markup causes =
      cause_sentence(found.choice.points, found.bias ? found.bias->read_at() : std::optional<double>());
  if (causes.empty()) return "";
  const std::string at =
      !found.bias ? ""
                  : fmt::format(", with this {}{}", free_noun(found),
                                found.bias->as_set ? ", as set" : " (causes that no curve gives: as rendered)");
  return paragraph(prose("Largest causes there{}: {}.", at, causes));
}

// By what it is the answer.
Markup criterion_text(const Recommendation& found, const Results& results) {
  if (found.bias && found.bias->as_set)
    return prose("every bound holds with the {} that is set, which lies in the usable window", free_noun(found));
  const std::string noun = free_setting_words(results.points);  // of all settings, which may differ in it
  return prose(
      "the least {} among the settings of which {}{}; among equal costs the least {}{}",
      italic(metric_label(results.info.cost)),
      !found.bias ? "every bound holds"
                  : fmt::format("the {} window is not empty{}", noun,
                                results.bounds.empty() ? "" : " and every bound holds at a value of it"),
      keeps_bounds_of_others(found.choice, results) ? ", also each that the experiment asks of other settings alone"
                                                    : "",
      italic(error_label(results.info.accuracy)),
      found.bias && free_setting(found.choice.first()) == FreeSetting::reduction
          ? std::string("; of the values in its window the reduction is the one of least error")
      : found.bias ? fmt::format("; of the values whose error is within {:.0f}\u202f% of the least, the {} is the one "
                                 "furthest from both ends of its window, so it need not be the best one",
                                 100 * (flat_error - 1), noun)
                   : "");
}

}  // namespace

Markup recommendation_box(const ShownPoints& shown) {
  if (const std::optional<NoAnswer> none = why_no_answer(shown))
    return box(none->kind, "What to set", paragraph(prose("{} {}", bold(none->why), none->help)));
  const Recommendation& found = shown.recommended;
  const bool kept = found.bias && found.bias->as_set;
  const Markup answer =
      prose("{} {}{}{} has {}.{}",
            kept ? "What is set" : fmt::format("Of {} the cheapest that", these_points(shown.all.points)),
            praise(shown.all), conditions_text(shown.all, found.choice), kept ? ". It" : "",
            cost_and_error(found, shown.all), found.bias ? bias_margin_text(*found.bias, free_noun(found)) : "");
  const Markup search = shown.all.info.experiment.empty() || choice_settings(shown.all.info).empty()
                            ? Markup()
                            : prose(" {} searches beyond {}, so its answer can be another one.",
                                    code("noonmark recommend " + shell_quoted(shown.all.info.experiment)),
                                    these_points(shown.all.points));
  const Markup reasons = prose("It is {}: {}.{}{}{}", point_links(found.choice), criterion_text(found, shown.all),
                               noise_text(found.noise, shown.all),
                               compares_choices(shown.groups) ? prose(" {} compares by other costs and errors.",
                                                                      section_link("cost", "Speed against accuracy"))
                                                              : Markup(),
                               search);
  // Green only if the verdict is: a reader would take the colour for it.
  return box(passes(shown.verdict) ? "held" : "none", kept ? "What is set" : "What to set",
             paragraph(answer) + element("dl", settings_and_bias(found, shown.all)) + "\n" + causes_text(found) +
                 element("p", css("small"), reasons));
}

}  // namespace noonmark::report
