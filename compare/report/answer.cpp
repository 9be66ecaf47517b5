#include "compare/report/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/judge/bounds.h"
#include "compare/judge/curve_reading.h"
#include "compare/judge/machines.h"
#include "compare/judge/no_flicker.h"
#include "compare/judge/poor_view.h"
#include "compare/judge/recommendation.h"
#include "compare/judge/soundness.h"
#include "compare/judge/undecided.h"
#include "compare/report/broken.h"
#include "compare/report/findings.h"
#include "compare/report/laws.h"
#include "compare/report/recommendation_box.h"
#include "compare/report/rules.h"
#include "compare/report/sections.h"
#include "compare/report/text.h"
#include "compare/results/metrics.h"
#include "compare/results/quantities.h"

namespace noonmark::report {
namespace {

std::string item(std::string_view kind, const std::string& inner) {
  return fmt::format("<li class=\"{}\">{}</li>\n", kind, inner);
}

std::string points_text(size_t count) { return fmt::format("{} point{}", count, count == 1 ? "" : "s"); }

std::string_view unit_of(const std::string& metric, const Results& results) {
  for (const Metric& row : metrics_of(results.points))
    if (row.name == metric) return row.unit;
  return "";
}

std::vector<bool> flags_of(const Results& results, bool (*holds)(const PointRecord&)) {
  std::vector<bool> flags;
  for (const PointRecord& point : results.points) flags.push_back(holds(point));
  return flags;
}

bool any(const std::vector<bool>& flags) { return std::find(flags.begin(), flags.end(), true) != flags.end(); }

// "at 9 of 32 points", and a list of these points to follow the sentence.
struct Where {
  std::string count, list;
};
Where where_text(const Results& results, const std::vector<bool>& chosen, const std::vector<bool>& either_way = {}) {
  const size_t count = static_cast<size_t>(std::count(chosen.begin(), chosen.end(), true));
  if (count == chosen.size())
    return {results.points.size() == 1 ? "here" : fmt::format("at every one of the {}", points_text(count)), ""};
  constexpr size_t most_rules = 4;  // more rules are harder to read than the table
  RuleSearch search{.most_rules = most_rules + 1};
  const std::vector<Rule> rules = describe_points(results, chosen, either_way, &search);
  std::string list;
  for (size_t i = 0; i < std::min(rules.size(), most_rules); ++i)
    list += fmt::format("<li>{}{}</li>", html(rule_phrase(rules[i])),
                        rules.size() > 1 ? fmt::format(" <small>{}</small>", points_text(rules[i].points)) : "");
  if (rules.size() > most_rules) list += "<li>and others: see the table of windows</li>";
  return {fmt::format("at {} of {}", count, points_text(chosen.size())),
          list.empty() ? "" : "<ul class=\"rules\">" + list + "</ul>"};
}

// The window is the one that the recommendation uses: of all placements if there are several.
bool window_fails(const PointRecord& point) { return point.curve && !usable_window(*point.curve); }
bool has_usable_bias(const PointRecord& point) { return point.curve && !window_fails(point) && bias_as_set(point); }
bool set_too_small(const PointRecord& point) {
  return has_usable_bias(point) && *bias_as_set(point) < usable_window(*point.curve)->low;
}
bool set_too_large(const PointRecord& point) {
  return has_usable_bias(point) && *bias_as_set(point) > usable_window(*point.curve)->high;
}

std::string window_items(const Results& results) {
  const auto curved =
      std::find_if(results.points.begin(), results.points.end(), [](const auto& p) { return p.curve.has_value(); });
  const auto without =
      std::find_if(results.points.begin(), results.points.end(), [](const auto& p) { return !p.curve.has_value(); });
  const std::string why =
      without == results.points.end() || why_no_curve(*without).empty()
          ? ""
          : item("note", fmt::format("Points without a bias curve: {}.", html(why_no_curve(*without))));
  if (curved == results.points.end())
    return item("note", "No bias curve was measured, so no usable window can be given.") + why;
  const BiasCurve& first = *curved->curve;
  const std::string bounds =
      fmt::format("acne at most {} and Peter Panning at most {}", quantity(first.acne_bound, "fraction"),
                  quantity(first.peter_panning_bound, "fraction"));
  std::string out;
  const auto fails = flags_of(results, window_fails);
  if (any(fails)) {
    const Where where = where_text(results, fails);
    out += item("bad", fmt::format("<b>The method fails {}</b>: no value of {} keeps {}{}{}", where.count,
                                   html(first.parameter), bounds, where.list.empty() ? "." : ", with", where.list));
  } else {
    out += item("good", fmt::format("A usable bias exists at every point{}: some value of {} keeps {}.",
                                    without == results.points.end() ? "" : " that has a bias curve",
                                    html(first.parameter), bounds));
  }
  const auto low = flags_of(results, set_too_small), high = flags_of(results, set_too_large);
  if (any(low)) {
    const Where where = where_text(results, low, fails);
    out += item("bad",
                fmt::format("<b>The bias as set is too small {}</b>: it leaves acne, and a larger bias would not{}{}",
                            where.count, where.list.empty() ? "." : ", with", where.list));
  }
  if (any(high)) {
    const Where where = where_text(results, high, fails);
    out +=
        item("bad", fmt::format("<b>The bias as set is too large {}</b>: it detaches shadows more than necessary{}{}",
                                where.count, where.list.empty() ? "." : ", with", where.list));
  }
  if (!any(low) && !any(high) && any(flags_of(results, has_usable_bias)))
    out += item("good", "The bias as set lies within the usable window at every point that has one.");
  return out + why;
}

std::string health_items(const Results& results) {
  std::string out;
  constexpr size_t most_listed = 5;
  const std::vector<Unsound> unsound = find_unsound(results.points);
  for (size_t i = 0; i < std::min(unsound.size(), most_listed); ++i)
    out += item("bad",
                fmt::format("A defect of Noonmark, so do not rely on any number here: {}.", html(text_of(unsound[i]))));
  if (unsound.size() > most_listed)
    out += item("bad", fmt::format("And {} more such defects.", unsound.size() - most_listed));
  size_t not_finite = 0;
  double ambiguous = 0;
  for (const PointRecord& point : results.points) {
    bool finite = true;
    for (const auto& [name, value] : point.metrics) finite = finite && std::isfinite(value);
    not_finite += !finite;
    if (const double value = metric_of(point, "ambiguous"); std::isfinite(value))
      ambiguous = std::max(ambiguous, value);
  }
  if (not_finite)
    out += item(
        "bad",
        fmt::format(
            "{} ha{} a metric that is <b>not finite</b>: it could not be measured, which breaks every bound on it.",
            points_text(not_finite), not_finite == 1 ? "s" : "ve"));
  if (const std::string poor = poor_view_note(results.points); !poor.empty()) out += item("bad", html(poor) + ".");
  if (const std::string still = no_flicker_note(results.points); !still.empty()) out += item("bad", html(still) + ".");
  if (const std::string doubt = undecided_note(results.points); !doubt.empty())
    out += item("note", fmt::format("At the point with the largest share, {}.", html(doubt)));
  if (ambiguous > 0)
    out += item("note", fmt::format("At most {} of the facing receivers have an ambiguous truth; they are left out.",
                                    quantity(ambiguous, "fraction")));
  for (const std::string& note : results.info.sweep_notes) out += item("bad", html(note) + ".");
  const MachineNotes machines = machine_notes(results);
  for (const std::string& note : machines.warnings) out += item("bad", html(note) + ".");
  for (const std::string& note : machines.machines) out += item("note", html(note) + ".");
  for (const std::string& note : results.info.scene_notes)
    out += item("note", fmt::format("About the scene {}.", html(note)));
  return out;
}

std::string bounds_section(const Results& results) {
  if (results.bounds.empty()) return "";
  std::string rows;
  for (const BoundResult& bound : results.bounds) {
    std::string where;
    for (const auto& [name, values] : bound.where)
      where += fmt::format("{}{} = {}", where.empty() ? "" : ", ", html(name),
                           html(fmt::format("{}", fmt::join(values, " | "))));
    const std::string_view unit = unit_of(bound.metric, results);
    std::string limit;
    const int digits = found_digits(bound, report_digits);
    if (bound.max) limit += fmt::format("at most {}", quantity(*bound.max, unit, digits));
    if (bound.min) limit += fmt::format("{}at least {}", limit.empty() ? "" : ", ", quantity(*bound.min, unit, digits));
    std::string found = bound.points == 0 ? "no point matches" : quantity(bound.found, unit, digits);
    if (bound.point >= 0) {
      const std::string name = fmt::format("point {}", bound.point);
      found +=
          " at " + (bound.held ? fmt::format("<a href=\"#p{}\">{}</a>", bound.point, name) : failure_link(bound, name));
    }
    rows += fmt::format(
        "<tr class=\"{}\"><td>{}</td><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
        breaks(bound) ? "broken"
        : bound.held  ? "held"
                      : "warning",
        bound.held    ? "✓ holds"
        : bound.warns ? "! warning"
                      : "✗ broken",
        html(metric_label(bound.metric)), limit, found,
        html(bound.join) + (bound.placement.empty() ? "" : fmt::format(", {}", placement_text(bound))),
        where.empty() ? fmt::format("all ({})", bound.points) : fmt::format("{} ({})", where, bound.points));
    if (bound.held) continue;
    if (const PointRecord* point = find_point(results.points, bound.point)) {
      const std::string bias = set_bias_phrase(*point), worst = failing_pixel_text(bound, *point);
      if (!bias.empty() || !worst.empty())
        rows += fmt::format("<tr class=\"command\"><td></td><td colspan=\"5\">{}{}{}</td></tr>\n",
                            bias.empty() ? "" : "With " + html(bias), bias.empty() || worst.empty() ? "" : "; ",
                            worst.empty() ? "" : failure_link(bound, html(worst)));
    }
    if (!bound.reproduce.empty())
      rows += fmt::format("<tr class=\"command\"><td></td><td colspan=\"5\">See it: <code>{}</code></td></tr>\n",
                          html(bound.reproduce));
  }
  return "<h3>Bounds</h3><div class=\"scroll\"><table "
         "class=\"bounds\"><thead><tr><th>Verdict</th><th>Metric</th><th>Allowed</th><th>Found</th>"
         "<th>Joined by</th><th>Points</th></tr></thead><tbody>\n" +
         rows + "</tbody></table></div>\n";
}

}  // namespace

std::string verdict_line(const Results& results) {
  std::string out;
  // Bounds are judged as rendered. The page also shows other biases, so it is said which one.
  const bool other_biases = std::any_of(results.points.begin(), results.points.end(),
                                        [](const PointRecord& point) { return point.curve.has_value(); });
  const char* const as_set = other_biases ? ", with the bias as set" : "";
  const auto judge = [&](const auto& list, const char* noun, const char* alone, const char* at, const auto& is_broken) {
    if (list.empty()) return;
    const auto broken = std::count_if(list.begin(), list.end(), is_broken);
    const auto kept = std::count_if(list.begin(), list.end(), [](const auto& one) { return one.held; });
    const bool warned = !broken && kept < static_cast<std::ptrdiff_t>(list.size());
    const std::string text = broken   ? fmt::format("{} of {} {}s broken", broken, list.size(), noun)
                             : warned ? fmt::format("{} of {} {}s hold, the others warn", kept, list.size(), noun)
                             : list.size() == 1 ? std::string(alone)
                                                : fmt::format("All {} {}s hold", list.size(), noun);
    out += fmt::format("{}<span class=\"pill {}\">{}{}</span>", out.empty() ? "" : " ", broken ? "broken" : "held",
                       text, at);
  };
  if (const std::vector<Unsound> unsound = find_unsound(results.points); !unsound.empty()) {
    // If the numbers are not sound, the verdicts on them have no meaning.
    out = "<span class=\"pill broken\">Not sound: the measurement contradicts itself</span>";
  } else {
    judge(results.bounds, "bound", "The bound holds", as_set, breaks);
    judge(results.laws, "law", "The law holds", "", [](const LawResult& law) { return !law.held; });
  }
  if (out.empty()) out = "<span class=\"pill none\">No bounds were set</span>";
  if (static_cast<int64_t>(results.points.size()) < results.planned_points)
    out += fmt::format(" <span class=\"pill broken\">Incomplete: {} of {} points</span>", results.points.size(),
                       results.planned_points);
  return "<p class=\"verdict\">" + out + "</p>\n";
}

namespace {

// Points of different parts are not meant to be compared, so none of them is the answer.
bool has_answer(const Results& results) {
  return !results.points.empty() && results.points.front().part.empty() &&
         recommend(results).outcome == Recommendation::Outcome::found;
}

}  // namespace

const char* answer_label(const Results& results) { return has_answer(results) ? "Answer" : "Findings"; }

std::string answer_section(const Results& results) {
  if (results.points.empty()) return "";
  const std::string head =
      fmt::format("<section id=\"answer\"><h2>{}</h2>", has_answer(results) ? "The answer" : "What was found");
  if (!results.points.front().part.empty()) {
    std::string found = laws_table(results) + bounds_section(results);
    if (const std::string items = health_items(results); !items.empty())
      found += "<ul class=\"findings\">\n" + items + "</ul>";
    return found.empty() ? "" : head + found + "</section>\n";
  }
  std::vector<const PointRecord*> all;
  for (const PointRecord& point : results.points) all.push_back(&point);
  std::string items = window_items(results);
  if (const std::string causes = cause_sentence(all); !causes.empty())
    items += item("note", fmt::format("Largest causes of error over {}, with the bias as rendered: {}.",
                                      all.size() == 1 ? "this point" : "all points", causes));
  items += health_items(results);
  return head + "<div class=\"answer\">" + recommendation_box(results) +
         "<div class=\"breaks\"><h3>What breaks</h3><ul class=\"findings\">\n" + items + "</ul></div></div>\n" +
         bounds_section(results) + laws_table(results) + "</section>\n";
}

}  // namespace noonmark::report
