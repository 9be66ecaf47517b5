#include "compare/report/summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.h"
#include "compare/judge/baseline.h"
#include "compare/judge/bounds.h"
#include "compare/judge/curve_reading.h"
#include "compare/judge/deliveries.h"
#include "compare/judge/law_table.h"
#include "compare/judge/laws.h"
#include "compare/judge/undecided.h"
#include "compare/report/escape.h"
#include "compare/report/recommendation_box.h"
#include "compare/results/metrics.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"

namespace noonmark {
namespace {

constexpr size_t best_count = 5;  // rows of the table of best settings

void add_row(std::string& text, const std::vector<std::string>& cells) {
  text += fmt::format("| {} |\n", fmt::join(cells, " | "));
}
void add_heading(std::string& text, const std::vector<std::string>& names) {
  add_row(text, names);
  add_row(text, std::vector<std::string>(names.size(), "---"));
}

std::string short_or_missing(std::optional<double> value, std::string_view unit = "") {
  return value ? quantity_text(*value, unit) : "–";
}

std::string short_or_missing(const PointRecord& point, const std::string& name) {
  const std::optional<double> value = quantity(point, name);
  return value ? text_with_room(*value, ambiguous_room(point, name), find_metric(name).unit) : "–";
}

// What the reader of a verdict can do with it.
std::string_view advice_on(Verdict verdict) {
  switch (verdict) {
    case Verdict::unsound:
      return " Do not rely on these numbers.";
    case Verdict::incomplete:
      return " Run it again to continue.";
    case Verdict::refused:
      return " The bounds are judged over the other frames.";
    default:
      return "";
  }
}

std::string laws_table(const Results& results) {
  std::string text = "\n## Laws\n\n";
  add_heading(text, {"", "law", "samples", "predicted", "measured", "measured / predicted"});
  for (const LawResult& law : results.laws) {
    const LawResult::Sample* worst = law.worst < 0 ? nullptr : &law.samples[static_cast<size_t>(law.worst)];
    add_row(text, {law.held ? "holds" : "**broken**", markdown(law.name), fmt::format("{}", law.samples.size()),
                   markdown(predicted_text(law)), worst ? short_or_missing(worst->measured) : "–",
                   markdown(ratio_text(law))});
  }
  for (const LawResult& law : results.laws)
    if (!law.held) text += "\n" + markdown_block(law_table({&law, 1}));
  bool any = false;
  for (const LawResult& law : results.laws) {
    if (law.found.empty()) continue;
    text += fmt::format("{}- {}\n", any ? "" : "\n### Found\n\n", markdown(law.found));
    any = true;
  }
  return text;
}

std::string baseline_list(const BaselineComparison& baseline) {
  std::string text = fmt::format("\n## Baseline\n\n{}{}.\n", baseline.held() ? "" : "**Worse.** ",
                                 markdown(baseline_verdict(baseline)));
  for (const auto* lines : {&baseline.changed, &baseline.worse, &baseline.better, &baseline.notes}) {
    if (!lines->empty()) text += "\n";
    for (const std::string& line : *lines) text += fmt::format("- {}\n", markdown(line));
  }
  return text;
}

std::string bounds_table(const Findings& found) {
  const Results& results = found.all;
  std::string text = "\n## Bounds\n\n";
  add_heading(text, {"", "bound", "found", "points", "worst at"});
  for (const BoundResult& bound : results.bounds) {
    std::vector<std::string> at;
    if (const PointRecord* point = find_point(results.points, bound.point))
      for (const std::string& name : results.info.swept) {
        const auto setting = point->settings.find(name);
        if (setting != point->settings.end()) at.push_back(fmt::format("{} = {}", name, setting_text(setting->second)));
      }
    add_row(text, {breaks(bound) ? "**broken**" : std::string(verdict_of(bound)), markdown(bound_text(bound)),
                   bound.points == 0 ? "–" : found_text(bound, results.points), fmt::format("{}", bound.points),
                   markdown(fmt::format("{}", fmt::join(at, ", ")))});
  }
  for (const Promise& one : found.promises)
    if (one.of == Promise::Of::bound && one.state != Promise::State::held) text += "\n" + markdown_block(one.text);
  return text;
}

// The parameter that the points' curves vary, or in words what they vary if they differ.
std::string parameter_of_all(const Results& results) {
  std::string parameter;
  for (const PointRecord& point : results.points) {
    if (!has_curve(point)) continue;
    if (!parameter.empty() && parameter != curve_parameter(point)) return free_setting_words(results.points);
    parameter = curve_parameter(point);
  }
  return parameter.empty() ? "bias" : parameter;
}

// Of a point of the table: its usable window and the value of its free setting with the least error, and the error there. If any point
// has a bias, biases stand in metres, and the best one in texels too. A reduction among biases says that it is one.
std::vector<std::string> window_cells(const PointRecord& point, bool biases, bool mixed) {
  if (hides_window(point)) return std::vector<std::string>(biases ? 4 : 3, "not known");
  const std::optional<Interval> window = usable_window(point);
  const bool curve = has_curve(point), reduction = free_setting(point) == FreeSetting::reduction;
  const double unit = point.curve && !reduction ? point.curve->m_per_depth : 1;
  const char* const what = reduction && mixed ? "reduction " : "";
  std::vector<std::string> cells{
      window  ? fmt::format("{}{} … {}", what, number_text(window->low * unit), number_text(window->high * unit))
      : curve ? "none"
              : "–",
      curve ? what + number_text(best_depth(point) * unit) : "–"};
  if (biases) cells.push_back(reduction ? "–" : short_or_missing(quantity(point, "best_bias_texels")));
  cells.push_back(curve ? quantity_text(best_error(point), "fraction") : "–");
  return cells;
}

// Of the points whose free setting is this one: at how many no value of it is usable.
std::string without_window(const Results& results, FreeSetting setting, std::string_view what) {
  const auto count = [&](const auto& holds) {
    return std::count_if(results.points.begin(), results.points.end(),
                         [&](const PointRecord& p) { return free_setting(p) == setting && holds(p); });
  };
  const auto lacking = count(lacks_window);
  if (lacking == 0) return "";
  return fmt::format("\nAt {} of {} points no {} within the curve's bounds.\n", lacking, count(has_curve), what);
}

// Of frames: the error of each, and where it is.
std::string frames_table(const Results& results) {
  std::vector<std::string> heading = {"frame", "delivery"}, metrics;
  for (const Metric& row : metrics_of(results.points))
    if (row.is(Metric::frames)) {
      metrics.emplace_back(row.name);
      heading.push_back(markdown(std::string(row.name)));
    }
  std::string text = "\n## Frames\n\n";
  add_heading(text, heading);
  for (const PointRecord& point : results.points) {
    std::vector<std::string> cells = {markdown(frame_name(point)), markdown(delivery_text(point))};
    for (const std::string& metric : metrics) cells.push_back(short_or_missing(point, metric));
    add_row(text, cells);
  }
  for (const PointRecord* frame : refused_frames(results.points))
    text += fmt::format("\n{}.\n", markdown(why_refused(*frame)));
  return text;
}

std::string best_table(const Results& results) {
  if (judges_frames(results.points)) return frames_table(results);
  std::vector<const PointRecord*> order;
  for (const PointRecord& point : results.points)
    if (std::isfinite(quantity(point, "error").value_or(std::numeric_limits<double>::infinity())))
      order.push_back(&point);
  if (order.empty()) return "\nNo point has an error that could be measured.\n";
  // Sorted by error, then by cost. Points that could not be measured come last.
  const auto key = [](const PointRecord* point, std::string_view name) {
    const double value = quantity(*point, name).value_or(std::numeric_limits<double>::infinity());
    return std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
  };
  std::stable_sort(order.begin(), order.end(), [&](const PointRecord* a, const PointRecord* b) {
    return std::pair(key(a, "error"), key(a, results.info.cost)) <
           std::pair(key(b, "error"), key(b, results.info.cost));
  });
  order.resize(std::min(order.size(), best_count));

  std::string text = order.size() == 1 ? std::string("\n## The point\n\n")
                                       : fmt::format("\n## Best settings: the least error at the {} that was set\n\n",
                                                     free_setting_words(results.points));
  std::vector<std::string> heading;
  for (const std::string& name : results.info.swept) heading.push_back(markdown(name));
  for (const char* name : {"error", "acne", "Peter Panning", "aliasing"}) heading.emplace_back(name);
  heading.push_back(markdown(results.info.cost));
  const std::string words = free_setting_words(results.points), parameter = markdown(parameter_of_all(results));
  const bool biases = words.starts_with("bias"), mixed = words != "bias" && biases;
  const char* const unit = biases ? " (m)" : "";
  heading.push_back(fmt::format("usable {}{}", parameter, unit));
  // Not the recommended one, which keeps away from the ends of the window.
  heading.push_back(fmt::format("{} of least error{}", parameter, unit));
  if (biases) heading.emplace_back("(texels)");
  heading.emplace_back("error there");
  add_heading(text, heading);
  for (const PointRecord* point : order) {
    std::vector<std::string> cells;
    for (const std::string& name : results.info.swept) {
      const auto setting = point->settings.find(name);
      cells.push_back(markdown(setting == point->settings.end() ? "–" : setting_text(setting->second)));
    }
    for (const std::string& name : {std::string("error"), std::string("acne"), std::string("peter_panning"),
                                    std::string("aliasing"), results.info.cost})
      cells.push_back(short_or_missing(*point, name));
    for (std::string& cell : window_cells(*point, biases, mixed)) cells.push_back(std::move(cell));
    add_row(text, cells);
  }

  text += without_window(results, FreeSetting::bias, "bias keeps both acne and Peter Panning");
  text += without_window(results, FreeSetting::reduction,
                         "lookup.reduction keeps the leak, over-darkening and what the reduction darkens");
  return text;
}

}  // namespace

std::string to_summary(const Findings& found, const std::vector<SummaryPicture>& pictures) {
  const Results& results = found.all;
  const RunInfo& info = results.info;
  std::string text = fmt::format("# {}\n\n**{}.**{}\n", markdown(info.title.empty() ? "Noonmark" : info.title),
                                 markdown(found.sentence), advice_on(found.verdict));
  if (const std::string answer = report::answer_words(found).text(); !answer.empty())
    text += fmt::format("\n{}\n", markdown(answer));
  for (const Note& note : found.notes)
    if (note.of != Note::Of::machines)
      text += fmt::format("\n{}: {}.\n", note.of == Note::Of::sweep ? "Warning" : "Note", markdown(note.text));
  if (results.baseline) text += baseline_list(*results.baseline);
  if (!results.laws.empty()) text += laws_table(results);
  if (!results.bounds.empty()) text += bounds_table(found);
  for (const SummaryPicture& picture : pictures)
    text += fmt::format("\n![the worst pixel, enlarged]({})\n\n{}\n", picture.path, markdown(picture.text));
  // Points of different parts are not meant to be compared.
  if (!results.points.empty() && results.points.front().part.empty()) text += best_table(results);
  text += fmt::format("\nMade by noonmark {} ({}){}; Embree {} ({}).\n", markdown(info.version), markdown(info.commit),
                      info.gl_renderer.empty() ? "" : " on " + markdown(info.gl_renderer),
                      markdown(info.embree_version), markdown(info.embree_isa));
  return text;
}

std::string to_summary(const Unjudged& unjudged) {
  return fmt::format("# {}\n\n**Not judged (exit code {}): {}**\n", markdown(unjudged.experiment), unjudged.exit_code,
                     markdown(unjudged.why));
}

}  // namespace noonmark
