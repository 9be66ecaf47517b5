#include "compare/report/answer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "compare/judge/baseline.h"
#include "compare/judge/bounds.h"
#include "compare/judge/curve_reading.h"
#include "compare/judge/deliveries.h"
#include "compare/judge/last_run.h"
#include "compare/judge/recommendation.h"
#include "compare/judge/soundness.h"
#include "compare/report/blocks.h"
#include "compare/report/broken.h"
#include "compare/report/cause_shares.h"
#include "compare/report/laws.h"
#include "compare/report/part_answers.h"
#include "compare/report/recommendation_box.h"
#include "compare/report/sections.h"
#include "compare/report/text.h"
#include "compare/results/metrics.h"
#include "compare/results/quantities.h"

namespace noonmark::report {
namespace {

Markup item(std::string_view kind, const Markup& content) { return element("li", css(kind), content) + "\n"; }

std::string points_text(size_t count) { return fmt::format("{} point{}", count, count == 1 ? "" : "s"); }

std::vector<bool> flags_of(const Results& results, bool (*holds)(const PointRecord&)) {
  std::vector<bool> flags;
  for (const PointRecord& point : results.points) flags.push_back(holds(point));
  return flags;
}

bool any(const std::vector<bool>& flags) { return std::find(flags.begin(), flags.end(), true) != flags.end(); }

// "at 9 of 32 points"
std::string where_text(const std::vector<bool>& chosen) {
  const auto count = static_cast<size_t>(std::count(chosen.begin(), chosen.end(), true));
  if (count < chosen.size()) return fmt::format("at {} of {}", count, points_text(chosen.size()));
  return count == 1 ? "here" : fmt::format("at every one of the {}", points_text(count));
}

// The window is the one that the recommendation uses: of all placements if there are several.
bool has_usable_bias(const PointRecord& point) { return usable_window(point) && bias_as_set(point); }
bool set_too_small(const PointRecord& point) {
  return has_usable_bias(point) && *bias_as_set(point) < usable_window(point)->low;
}
bool set_too_large(const PointRecord& point) {
  return has_usable_bias(point) && *bias_as_set(point) > usable_window(point)->high;
}

// "The method fails at 9 of 32 points: no value keeps ... (which points)." section: has the windows of all points.
Markup bad_item(std::string_view what, const Markup& how, const std::vector<bool>& chosen, std::string_view section) {
  const bool some = std::find(chosen.begin(), chosen.end(), false) != chosen.end();
  return item("bad", prose("{}{}{}.", bold(prose("{} {}", what, where_text(chosen))), how,
                           some ? prose(" ({})", section_link(section, "which points")) : Markup()));
}

// The same of the points whose free setting is this one.
template <FreeSetting setting, bool (*holds)(const PointRecord&)>
bool of_setting(const PointRecord& point) {
  return free_setting(point) == setting && holds(point);
}

// How a window of the free setting is told.
struct WindowWords {
  const char* name;  // "bias", also of the section that has the windows
  std::string keeps;
  const char *too_small, *too_large;
};

WindowWords words_of_bias(const CauseBounds& bounds) {
  return {"bias",
          fmt::format("acne at most {} and Peter Panning at most {}", quantity(bounds.acne_bound, "fraction"),
                      quantity(bounds.peter_panning_bound, "fraction")),
          ": it leaves acne, and a larger bias would not", ": it detaches shadows more than necessary"};
}

WindowWords words_of_reduction(const CauseBounds& bounds) {
  return {"reduction",
          fmt::format("the leak at most {}, and over-darkening and what the reduction darkens at most {} each",
                      quantity(bounds.peter_panning_bound, "fraction"), quantity(bounds.acne_bound, "fraction")),
          ": it leaves a leak, and a larger one would not", ": it darkens more than necessary"};
}

// Of the points that no reduction mends, the first ones: what breaks each.
Markup why_no_reductions(const Results& results) {
  constexpr size_t most_told = 3;
  Markup list;
  size_t told = 0, all = 0;
  for (const PointRecord& point : results.points) {
    const std::string why = no_reduction_text(point);
    if (why.empty() || ++all > most_told) continue;
    const std::string phrase = settings_phrase(point, results.info.swept);
    list += element(
        "li", prose("{}: {}.", point_link(point.id, phrase.empty() ? fmt::format("point {}", point.id) : phrase), why));
    ++told;
  }
  if (all > told) list += element("li", prose("and {} more: see the table of windows", all - told));
  return list.empty() ? "" : element("ul", css("rules"), list);
}

// Of filtered maps: where the rounding of what they store makes most of the error. Points of which the same is said share a line.
Markup precision_items(const Results& results) {
  std::map<std::string, std::vector<Markup>> points;
  for (const PointRecord& point : results.points)
    if (const std::string cures = cures_of_precision(point); !cures.empty())
      points[cures].push_back(point_link(point.id, point.id));
  Markup out;
  for (auto& [cures, links] : points) {
    constexpr size_t most_named = 8;
    const size_t more = links.size() - std::min(links.size(), most_named);
    links.resize(links.size() - more);
    out += item("bad", prose("At {} {}{} {}.", links.size() + more == 1 ? "point" : "points", joined(links, ", "),
                             more ? fmt::format(" and {} more", more) : "", cures));
  }
  return out;
}

template <FreeSetting setting>
Markup window_items_of(const Results& results) {
  const auto is_of = [](const PointRecord& point) { return free_setting(point) == setting; };
  const auto first = std::find_if(results.points.begin(), results.points.end(), is_of);
  if (first == results.points.end()) return "";
  const WindowWords words =
      setting == FreeSetting::bias ? words_of_bias(curve_bounds(*first)) : words_of_reduction(curve_bounds(*first));
  const std::string parameter = curve_parameter(*first);
  Markup out;
  const auto fails = flags_of(results, of_setting<setting, lacks_window>);
  const auto hidden = flags_of(results, of_setting<setting, hides_window>);
  if (any(hidden))
    out += bad_item(fmt::format("The usable {} is {}", words.name, window_not_known), "", hidden, words.name);
  if (any(fails)) {
    out += bad_item(setting == FreeSetting::bias ? "The method fails" : "No reduction is usable",
                    prose(": no value of {} keeps {}", parameter, words.keeps), fails, words.name);
    if (setting == FreeSetting::reduction) out += item("note", prose("What breaks it:{}", why_no_reductions(results)));
  } else if (!any(hidden)) {
    const bool all = std::all_of(results.points.begin(), results.points.end(), is_of);
    out += item("good", prose("A usable {} exists at every point{}: some value of {} keeps {}.", words.name,
                              all                            ? ""
                              : setting == FreeSetting::bias ? " that has a bias curve"
                                                             : " that has a curve over the reduction",
                              parameter, words.keeps));
  }
  const auto low = flags_of(results, of_setting<setting, set_too_small>),
             high = flags_of(results, of_setting<setting, set_too_large>);
  if (any(low))
    out += bad_item(fmt::format("The {} as set is too small", words.name), words.too_small, low, words.name);
  if (any(high))
    out += bad_item(fmt::format("The {} as set is too large", words.name), words.too_large, high, words.name);
  if (!any(low) && !any(high) && any(flags_of(results, of_setting<setting, has_usable_bias>)))
    out += item("good", prose("The {} as set lies within the usable window at every point that has one.", words.name));
  return out;
}

Markup window_items(const Results& results) {
  const auto without =
      std::find_if(results.points.begin(), results.points.end(), [](const auto& p) { return !has_curve(p); });
  const Markup why = without == results.points.end() || why_no_curve(*without).empty()
                         ? ""
                         : item("note", prose("Points without a curve: {}.", why_no_curve(*without)));
  if (std::none_of(results.points.begin(), results.points.end(), has_curve))
    return item("note", "No curve over a bias or a reduction was measured, so no usable window can be given.") + why;
  return window_items_of<FreeSetting::bias>(results) + window_items_of<FreeSetting::reduction>(results) + why;
}

Markup unsound_items(const Results& results) {
  Markup out;
  constexpr size_t most_listed = 5;
  const std::vector<Unsound> unsound = find_unsound(results.points);
  for (size_t i = 0; i < std::min(unsound.size(), most_listed); ++i)
    out += item("bad", prose("A defect of Noonmark, so do not rely on any number here: {}.", text_of(unsound[i])));
  if (unsound.size() > most_listed)
    out += item("bad", prose("And {} more such defects.", unsound.size() - most_listed));
  return out;
}

Markup refused_items(const Results& results) {
  Markup out;
  for (const PointRecord* frame : refused_frames(results.points))
    out += item("bad", prose("{}: its shadows are not judged: {}.", point_link(frame->id, frame_name(*frame)),
                             frame->delivery.refused));
  return out;
}

// What was accepted and what could not be checked. Frames of which the same is said share a line.
Markup delivery_items(const Results& results) {
  std::map<std::string, std::vector<Markup>> frames;
  for (const PointRecord& point : results.points)
    if (const PointRecord::Delivery& delivery = point.delivery;
        delivery.refused.empty() && !(delivery.accepted.empty() && delivery.not_checked.empty()))
      frames[delivery_text(point)].push_back(point_link(point.id, frame_name(point)));
  Markup out;
  for (auto& [text, links] : frames) {
    constexpr size_t most_named = 8;
    const size_t more = links.size() - std::min(links.size(), most_named);
    links.resize(links.size() - more);
    out += item("note", prose("The delivery of {}{}: {}.", joined(links, ", "),
                              more ? fmt::format(" and {} more", more) : "", text));
  }
  return out;
}

Markup baseline_items(const Results& results) {
  Markup out;
  if (!results.baseline) return out;
  for (const std::string& line : results.baseline->worse) out += item("bad", "Against the baseline, " + line + ".");
  for (const std::string& line : results.baseline->changed) out += item("note", "Since the baseline, " + line + ".");
  return out;
}

Markup health_items(const Findings& found) {
  const Results& results = found.all;
  Markup out = unsound_items(results) + refused_items(results) + baseline_items(results);
  size_t not_finite = 0;
  double ambiguous = 0;
  for (const PointRecord& point : results.points) {
    if (!point.delivery.refused.empty()) continue;
    bool finite = true;
    for (const auto& [name, value] : point.metrics) finite = finite && std::isfinite(value);
    not_finite += !finite;
    if (const double value = metric_of(point, "ambiguous"); std::isfinite(value))
      ambiguous = std::max(ambiguous, value);
  }
  if (not_finite)
    out += item("bad", prose("{} ha{} a metric that is {}: it could not be measured, which breaks every bound on it.",
                             points_text(not_finite), not_finite == 1 ? "s" : "ve", bold("not finite")));
  if (ambiguous > 0)
    out += item("note", prose("At most {} of the facing receivers have an ambiguous truth; they are left out.",
                              quantity(ambiguous, "fraction")));
  for (const Note& note : found.notes) out += item(note.warns() ? "bad" : "note", note.text + ".");
  return out + delivery_items(results);
}

std::string last_run_or_new(const BoundResult& bound, const Results& results) {
  const std::string text = since_last_run(bound, results);
  return text.empty() ? "new" : text;
}

// since: of the last column; empty: the table has none.
Markup bound_row(const BoundResult& bound, const Results& results, const std::string& since) {
  const std::string_view unit = bound_unit(bound);
  const bool of_frame = is_of_lights(bound.metric);
  std::string where = of_frame ? "" : bound.part;
  for (const auto& [name, values] : bound.where)
    where += fmt::format("{}{} = {}", where.empty() ? "" : ", ", name, fmt::join(values, " | "));
  std::string limit;
  const int digits = found_digits(bound, report_digits);
  if (bound.max) limit += fmt::format("at most {}", quantity(*bound.max, unit, digits));
  if (bound.min) limit += fmt::format("{}at least {}", limit.empty() ? "" : ", ", quantity(*bound.min, unit, digits));
  Markup found = bound.points == 0 ? "no point matches" : quantity(bound.found, unit, digits);
  if (const double room = room_of(bound, results.points); room > 0 && std::isfinite(bound.found))
    found += " ± " + quantity(room, unit);
  if (bound.point >= 0 && !of_frame) {
    const std::string name = fmt::format("point {}", bound.point);
    found += " at " + (bound.held ? point_link(bound.point, name) : failure_link(bound, name));
  }
  return tr(css(breaks(bound) ? "broken"
                : bound.held  ? "held"
                              : "warning"),
            td(bound.held    ? "✓ holds"
               : bound.warns ? "! warning"
                             : "✗ broken"),
            row_head(metric_label(bound.metric)), td(limit), td(found),
            td(bound.join, bound.placement.empty() ? "" : prose(", {}", placement_text(bound))),
            td(where.empty() ? "all" : where, prose(" ({})", bound.points)), since.empty() ? Markup() : td(since));
}

// The bias at which a broken bound was judged, its worst pixel, and the command that shows it.
Markup broken_bound_rows(const BoundResult& bound, const Results& results) {
  const auto row_below = [](const Markup& content) {
    return tr(css("command"), td(), td(Attribute("colspan", 5), content));
  };
  Markup rows;
  if (const PointRecord* point = find_point(results.points, bound.point)) {
    const std::string bias = set_bias_phrase(*point), worst = failing_pixel_text(bound, *point);
    if (!bias.empty() || !worst.empty())
      rows += row_below(prose("{}{}{}", bias.empty() ? "" : "With " + bias, bias.empty() || worst.empty() ? "" : "; ",
                              worst.empty() ? "" : failure_link(bound, worst)));
  }
  if (!bound.reproduce.empty()) rows += row_below("See it: " + code(bound.reproduce));
  return rows;
}

Markup bounds_section(const Results& results) {
  if (results.bounds.empty()) return "";
  const bool since = std::any_of(results.bounds.begin(), results.bounds.end(),
                                 [](const BoundResult& bound) { return bound.before.has_value(); });
  Markup rows;
  for (const BoundResult& bound : results.bounds) {
    rows += bound_row(bound, results, since ? last_run_or_new(bound, results) : "");
    if (!bound.held) rows += broken_bound_rows(bound, results);
  }
  const Markup head =
      since ? heads({"Verdict", "Metric", "Allowed", "Found", "Joined by", "Points", "Since the last run"})
            : heads({"Verdict", "Metric", "Allowed", "Found", "Joined by", "Points"});
  return element("h3", "Bounds") + div(css("scroll"), table("bounds", head, rows)) + "\n";
}

}  // namespace

Markup verdict_line(const Findings& found) {
  const char* const kind = found.verdict == Verdict::measured ? "none" : passes(found.verdict) ? "held" : "broken";
  return paragraph(css("verdict"), span(css(fmt::format("pill {}", kind)), found.sentence));
}

namespace {

// Points of different parts are not meant to be compared, so none of them is the answer.
bool has_answer(const ShownPoints& shown) {
  return !shown.all.points.empty() && shown.all.points.front().part.empty() &&
         shown.recommended.outcome == Recommendation::Outcome::found;
}

}  // namespace

const char* answer_label(const ShownPoints& shown) { return has_answer(shown) ? "Answer" : "Findings"; }

Markup answer_section(const ShownPoints& shown) {
  if (shown.all.points.empty()) return "";
  const char* const title = has_answer(shown) ? "The answer" : "What was found";
  const auto findings = [](const Markup& items) { return element("ul", css("findings"), "\n", items); };
  Markup items = precision_items(shown.all) + health_items(shown);
  if (!shown.all.points.front().part.empty()) {
    const Markup found = laws_table(shown.all) + part_answers(shown) + bounds_section(shown.all) +
                         (items.empty() ? "" : findings(items));
    return found.empty() ? "" : section("answer", title, found);
  }
  std::vector<const PointRecord*> all;
  for (const PointRecord& point : shown.all.points) all.push_back(&point);
  Markup causes = cause_sentence(all);
  if (!causes.empty())
    causes = item("note", judges_frames(shown.all.points)
                              ? prose("Where most of the error is: {}.", causes)
                              : prose("Largest causes of error over {}, with the {} as rendered: {}.",
                                      all.size() == 1 ? "this point" : "all points",
                                      free_setting_words(shown.all.points), causes));
  if (judges_frames(shown.all.points))  // nothing is set here, so nothing is recommended
    return section("answer", title, findings(causes + items) + bounds_section(shown.all));
  items = window_items(shown.all) + causes + items;
  const Markup what_breaks = div(css("breaks"), element("h3", "What breaks"), findings(items));
  return section("answer", title,
                 div(css("answer"), recommendation_box(shown), what_breaks) + "\n" + bounds_section(shown.all) +
                     laws_table(shown.all));
}

}  // namespace noonmark::report
