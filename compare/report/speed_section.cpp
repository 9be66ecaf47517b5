#include "compare/report/speed_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <tuple>
#include <unordered_set>
#include <utility>

#include "base/text.h"
#include "compare/judge/curve_reading.h"
#include "compare/report/blocks.h"
#include "compare/report/cause_colors.h"
#include "compare/report/sections.h"
#include "compare/report/speed.h"
#include "compare/report/speed_reading.h"
#include "compare/report/text.h"
#include "compare/results/quantities.h"

namespace noonmark::report {
namespace {

using Window = ComparedChoice::Window;

constexpr size_t most_tables = 8;  // one for each group; a sweep of many scenes has many

constexpr const char* held_to_nothing = "held to no bound";

// What the section is about: one cost and one error, and how choices are named and linked.
struct Plane {
  const Results& results;
  std::string cost, error;
  ChoiceNames names;
  std::unordered_set<int64_t> shown_ids;

  std::string cost_text(const ComparedChoice& one) const {
    return quantity(cost_of(one, cost), find_metric(cost).unit);
  }
  std::string error_text(const ComparedChoice& one, AtBias at) const {
    return quantity(value_of(one, error, at).worst, find_metric(error).unit);
  }
  Markup link(const ComparedChoice& one, AtBias at) const {
    const std::string name = names.of(one.choice, at);
    const PointRecord* const point = point_on_page(one, error, shown_ids);
    return point ? point_link(point->id, name) : name;
  }
  // "filter box (10.7 MB, 0.2 %)"
  Markup with_numbers(const ComparedChoice& one, AtBias at) const {
    return prose("{} ({}, {}{})", bold(link(one, at)), cost_text(one), error_text(one, at),
                 !one.judged ? std::string(", ") + held_to_nothing : "");
  }
};

std::string free_words(const ComparedGroup& group) {
  std::vector<FreeSetting> settings;
  for (const ComparedChoice& one : group.choices) settings.push_back(free_setting(one.choice.first()));
  return free_setting_words(settings);
}

// "Of 32 choices 18 have a usable window; 6 have none, and ...".
std::string windows_text(const ComparedGroup& group) {
  const std::string word = free_words(group);
  size_t with[4] = {};
  for (const ComparedChoice& one : group.choices) ++with[static_cast<size_t>(one.window)];
  const size_t usable = with[static_cast<size_t>(Window::usable)], empty = with[static_cast<size_t>(Window::empty)],
               none = with[static_cast<size_t>(Window::no_curve)], unknown = with[static_cast<size_t>(Window::unknown)];
  std::string out = fmt::format("Of {} {} ha{} a usable {} window", counted(group.choices.size(), "choice"), usable,
                                usable == 1 ? "s" : "ve", word);
  if (empty)
    out += fmt::format("; {} ha{} none, so no {} makes {} good enough", empty, empty == 1 ? "s" : "ve", word,
                       empty == 1 ? "it" : "them");
  if (unknown)
    out += fmt::format("; of {} {} is {}, nor is what {} least", unknown, unknown == 1 ? "it" : "them",
                       window_not_known, unknown == 1 ? "it errs" : "they err");
  if (none)
    out += fmt::format("; {} ha{} no such curve and stand{} here as rendered", none, none == 1 ? "s" : "ve",
                       none == 1 ? "s" : "");
  if (const auto free =
          std::count_if(group.choices.begin(), group.choices.end(), [](const auto& one) { return !one.judged; });
      free > 0)
    out += fmt::format(", {}{}", static_cast<size_t>(free) == none ? "" : fmt::format("{} of them ", free),
                       held_to_nothing);
  return out + ".";
}

std::string good_text(const ComparedGroup& group, const Plane& plane) {
  const auto good = std::count_if(group.choices.begin(), group.choices.end(), [](const auto& one) { return one.good; });
  if (is_incomplete(plane.results)) return " Not all conditions are measured yet, so nothing is recommended.";
  return good ? fmt::format(" Good enough {} {}.", good == 1 ? "is" : "are", good) : " None is good enough.";
}

// The three answers, those that are the same choice together.
Markup answers_text(const ComparedGroup& group, const SpeedReading& reading, const Plane& plane) {
  if (!reading.answers) return "";
  const ThreeAnswers& found = *reading.answers;
  const std::string budget =
      fmt::format("it errs least of those that cost at most {}", quantity(found.budget, find_metric(plane.cost).unit));
  const std::tuple<const char*, size_t, std::string> answers[] = {
      {"least", found.least, "it is the cheapest"},
      {"balanced", found.balanced, fmt::format("no cheaper one has less than {} times its error", error_that_pays)},
      {"best", found.best, budget}};
  Markup out;
  for (size_t i = 0; i < std::size(answers);) {
    const size_t choice = std::get<1>(answers[i]);
    std::string names, reasons;
    for (; i < std::size(answers) && std::get<1>(answers[i]) == choice; ++i) {
      names += (names.empty() ? "" : ", ") + std::string(std::get<0>(answers[i]));
      reasons += (reasons.empty() ? "" : ", ") + std::get<2>(answers[i]);
    }
    names[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(names[0])));
    out += prose("{}{}: {}: {}.", out.empty() ? "" : " ", names, plane.with_numbers(group.choices[choice], reading.at),
                 reasons);
  }
  return out;
}

constexpr const char* no_front[] = {"No choice that counts has both a finite cost and a finite error.",
                                    "No choice has a finite cost and a finite error and is usable as set."};

const char* why_no_front(AtBias at) { return no_front[at == AtBias::as_set]; }

// Names the front, which goes from the cheapest to the most accurate.
Markup front_text(const ComparedGroup& group, const SpeedReading& reading, const Plane& plane) {
  const std::vector<size_t>& front = reading.front;
  if (front.empty()) return why_no_front(reading.at);
  const auto place = [&](size_t i) {
    return std::make_pair(value_of(group.choices[i], plane.cost).worst,
                          value_of(group.choices[i], plane.error, reading.at).worst);
  };
  const auto said = [&](size_t i) { return plane.with_numbers(group.choices[i], reading.at); };
  if (place(front.front()) == place(front.back())) {
    const size_t equal = front.size() - 1;
    return prose("No choice is cheaper than {}, and none is more accurate{}.", said(front.front()),
                 equal ? fmt::format("; {} more cost the same and are as accurate", equal) : "");
  }
  return prose(
      "The Pareto front has {}, from {} to {}: no other choice is both cheaper and more accurate than one of these.",
      counted(front.size(), "choice"), said(front.front()), said(front.back()));
}

std::string span_cell(const ComparedChoice& one, const std::string& error, std::string_view unit) {
  const std::optional<Interval> span = span_over_window(one, error);
  return span ? fmt::format("{} … {}", cell(span->low, unit), cell(span->high, unit)) : "–";
}

// "4.1", with the ends of its interval if it has one.
Markup cost_cell(const ComparedChoice& one, const std::string& cost) {
  const std::string_view unit = find_metric(cost).unit;
  const MedianInterval known = cost_of(one, cost);
  const bool sure = !(known.low < known.high);
  return with_small(cell(known.middle, unit),
                    sure ? "" : fmt::format("{} … {}", cell(known.low, unit), cell(known.high, unit)));
}

// "0.7 texels", or as the experiment writes it where the bias is as set.
std::string bias_cell(const ComparedChoice& one, AtBias at) {
  if (!one.bias) return "as rendered";
  const PointRecord& first = one.choice.first();
  const std::string unit = curve_unit(first);
  const bool reduction =
      free_setting(first) == FreeSetting::reduction;  // beside biases the number alone would be taken for one
  if (at == AtBias::best) return (reduction ? "reduction " : "") + bias_in_unit(*one.bias, unit);
  const std::string set = (reduction ? "reduction " : "") + setting_of(first, curve_parameter(first));
  const std::optional<double> value = number_of(set);
  return value ? bias_in_unit(*value, unit) : set;
}

// "least, balanced"; empty if the choice is no answer.
std::string answer_names(size_t choice, const std::optional<ThreeAnswers>& found) {
  std::string out;
  if (!found) return out;
  for (const auto& [name, i] :
       {std::pair("least", found->least), std::pair("balanced", found->balanced), std::pair("best", found->best)})
    if (i == choice) out += (out.empty() ? "" : ", ") + std::string(name);
  return out;
}

Markup front_row(const ComparedChoice& one, const Plane& plane, const std::string& answers, AtBias at) {
  const std::string cause = dominating_cause(one, at);
  const std::string_view unit = find_metric(plane.error).unit;
  const std::string held = !one.judged ? held_to_nothing : "",
                    more = answers + (answers.empty() || held.empty() ? "" : "; ") + held;
  return tr(css(answers.empty() ? "" : "recommended"), row_head(css("text"), with_small(plane.link(one, at), more)),
            td(cost_cell(one, plane.cost)), td(cell(value_of(one, plane.error, at).worst, unit)),
            td(span_cell(one, plane.error, unit)), td(bias_cell(one, at)),
            td(css("text"), cause.empty() ? "–" : swatch(cause) + metric_label(cause)));
}

// Both texts, or one where they are equal.
Markup at_both(const Markup& as_set, const Markup& best) { return as_set == best ? best : by_bias(as_set, best); }

struct FrontRows {
  Markup summary, rows;
  size_t count = 0;
};

// Choices of which no point is shown have no row, because their links would lead nowhere.
FrontRows front_rows(const ComparedGroup& group, const std::string& name, const Plane& plane,
                     const SpeedReading& reading) {
  const std::vector<size_t>& front = reading.front;
  const AtBias at = reading.at;
  FrontRows out;
  for (size_t i : front) {
    if (!point_on_page(group.choices[i], plane.error, plane.shown_ids)) continue;
    out.rows += front_row(group.choices[i], plane, answer_names(i, reading.answers), at), ++out.count;
  }
  if (front.empty()) out.rows = tr(td(css("text"), Attribute("colspan", 6), why_no_front(at)));
  const std::string which = name.empty() ? "" : " of " + name;
  out.summary = out.count == front.size()
                    ? prose("The Pareto front{}: {}", which, counted(out.count, "choice"))
                    : prose("{} of the {} choices of the Pareto front{}", out.count, front.size(), which);
  return out;
}

// The front of one group: as set, and at the best bias of each choice. The page shows that of its bias. Empty if no
// choice is on either.
Markup front_table(const ComparedGroup& group, const Techniques& techniques, const std::string& name,
                   const Plane& plane) {
  const SpeedReadings readings(group, techniques, plane.results);
  const auto rows_at = [&](AtBias at) {
    return front_rows(group, name, plane, readings.of(plane.cost, plane.error, at));
  };
  const FrontRows set = rows_at(AtBias::as_set), best = rows_at(AtBias::best);
  if (set.count == 0 && best.count == 0) return "";
  const auto body = [](std::string_view at, const Markup& rows) { return element("tbody", css(at), "\n", rows); };
  const Markup rows =
      set.rows == best.rows ? body("", best.rows) : body("as-set", set.rows) + body("as-recommended", best.rows);
  const Markup head = th(css("text"), "Choice") +
                      th(metric_label(plane.cost), " ", small(head_unit(find_metric(plane.cost).unit))) +
                      th(error_label(plane.error), " ", small(head_unit(find_metric(plane.error).unit))) +
                      heads({"Over the usable window", "At"}) + th(css("text"), "Largest cause");
  const Markup front = element("table", css("numbers"), element("thead", element("tr", head)), rows);
  return folded("more", false, at_both(set.summary, best.summary), div(css("scroll"), front) + "\n");
}

}  // namespace

Markup speed_chart() {
  return chart_place(
      "cost",
      "Each choice at the bias or reduction that is chosen at the top: as set, or its best one. A line joins the "
      "choices of one technique; those that err least at some cost are coloured. The dotted line is the "
      "Pareto front. Choices of equal cost and nearly equal error share one mark.");
}

bool compares_choices(const std::vector<ComparedGroup>& groups) {
  return std::any_of(groups.begin(), groups.end(), [](const ComparedGroup& group) { return group.choices.size() > 1; });
}

bool has_speed_chart(const ShownPoints& shown) {
  return compares_choices(shown.groups) && !shown.costs.empty() && !shown.errors.empty();
}

Markup speed_section(const ShownPoints& shown, bool on_first_screen) {
  if (!has_speed_chart(shown)) return "";
  Plane plane{shown.all, shown.costs.front(), shown.error_first, ChoiceNames(shown.all), {}};
  for (const PointRecord& point : shown.results.points) plane.shown_ids.insert(point.id);
  const size_t first = group_shown_first(shown.groups);
  const ComparedGroup& group = shown.groups[first];
  const SpeedReadings readings(group, shown.techniques[first], shown.all);
  const auto words = [&](AtBias at) {
    const SpeedReading reading = readings.of(plane.cost, plane.error, at);
    Markup takeovers;
    for (const Phrase& phrase : readings.takeovers(reading, plane.names))
      takeovers += phrase.is_name ? bold(phrase.text) : Markup(phrase.text);
    std::vector<Markup> sentences{takeovers, front_text(group, reading, plane), answers_text(group, reading, plane)};
    std::erase_if(sentences, [](const Markup& sentence) { return sentence.empty(); });
    return joined(sentences, " ");
  };
  const GroupNames names(shown.all, shown.groups);
  const std::string name = names.of(group);
  Markup out;
  if (!name.empty())
    out +=
        paragraph(prose("Choices can be compared if they have the same scene, view and light: here are {}, and "
                        "these words are about {}.",
                        counted(shown.groups.size(), "group"), bold(name)));
  out += paragraph(windows_text(group), good_text(group, plane)) +
         paragraph(at_both(words(AtBias::as_set), words(AtBias::best))) + shown.note;
  if (!on_first_screen) out += speed_chart();
  for (size_t i = 0; i < std::min(shown.groups.size(), most_tables); ++i) {
    const size_t which = i == 0 ? first : i <= first ? i - 1 : i;  // the one shown first, then the others
    out += front_table(shown.groups[which], shown.techniques[which], names.of(shown.groups[which]), plane);
  }
  if (shown.groups.size() > most_tables)
    out +=
        paragraph(css("small"), prose("The other {} groups are in the chart only.", shown.groups.size() - most_tables));
  return section("cost", "Speed against accuracy", out);
}

}  // namespace noonmark::report
