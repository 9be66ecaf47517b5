#include "compare/report/summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>

#include "base/text.h"
#include "compare/judge/baseline.h"
#include "compare/judge/bounds.h"
#include "compare/judge/deliveries.h"
#include "compare/judge/law_table.h"
#include "compare/judge/undecided.h"
#include "compare/report/escape.h"
#include "compare/report/recommendation_box.h"
#include "compare/results/metrics.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"

namespace noonmark {
namespace {

void add_row(std::string& text, const std::vector<std::string>& cells) {
  text += fmt::format("| {} |\n", fmt::join(cells, " | "));
}
void add_heading(std::string& text, const std::vector<std::string>& names) {
  add_row(text, names);
  add_row(text, std::vector<std::string>(names.size(), "---"));
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

std::string laws_list(const Results& results) {
  std::string text = "\n## Laws\n\n" + markdown_block(law_table(results.laws));
  std::string found;
  for (const LawResult& law : results.laws)
    if (!law.found.empty()) found += fmt::format("- {}\n", markdown(law.found));
  return found.empty() ? text : text + "\n### Found\n\n" + found;
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
  if (!results.laws.empty()) text += laws_list(results);
  if (!results.bounds.empty()) text += bounds_table(found);
  for (const SummaryPicture& picture : pictures)
    text += fmt::format("\n![the worst pixel, enlarged]({})\n\n{}\n", picture.path, markdown(picture.text));
  if (judges_frames(results.points)) text += frames_table(results);
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
