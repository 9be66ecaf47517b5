#include "app/sweep/judging.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>

#include "app/pictures/point_pictures.h"
#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "compare/judge/bounds.h"
#include "compare/judge/last_run.h"
#include "compare/judge/law_table.h"
#include "compare/judge/laws.h"
#include "compare/judge/soundness.h"
#include "compare/report/report.h"

namespace noonmark {

namespace {

// What is said of a law that no point matches: its place in the file, and the --set that removed its points.
std::string no_point_words(const Experiment& part, const std::string& name) {
  const auto law = std::find_if(part.laws.begin(), part.laws.end(), [&](const Law& one) { return one.name == name; });
  std::string text = fmt::format("no point is left that the law '{}' speaks of", printable(law->name));
  if (!law->location.empty()) text += fmt::format(" ({})", law->location);
  for (const auto& [setting, values] : law->where)
    if (const auto given = part.locations.find(setting);
        given != part.locations.end() && given->second.starts_with("--set"))
      text += fmt::format("; it is about {} = {}, and {} leaves none of them", setting, fmt::join(values, " | "),
                          given->second);
  return text;
}

void judge_parts(const Experiment& experiment, Results& results) {
  const auto reproduce = [&](const PointRecord& point) { return reproduce_command(experiment, point); };
  const auto judge_part = [&](const Experiment& part, std::span<const PointRecord> points) {
    for (BoundResult& bound : evaluate_bounds(points, part.bounds, reproduce)) {
      bound.part = part.part;
      // `render` measures one light, and no frame.
      if (is_of_lights(bound.metric) && !bound.reproduce.empty())
        bound.reproduce = "noonmark run " + shell_quoted(experiment.path);
      if (!experiment.frames.empty() && !bound.reproduce.empty() && bound.max)
        bound.reproduce += fmt::format(" --max {}={}", bound.metric, *bound.max);
      results.bounds.push_back(std::move(bound));
    }
    for (LawResult& law : evaluate_laws(points, part.laws, reproduce)) {
      law.part = part.part;
      if (law.samples.empty()) law.found = no_point_words(part, law.name);
      results.laws.push_back(std::move(law));
    }
  };
  results.bounds.clear();
  results.laws.clear();
  if (experiment.parts.empty()) return judge_part(experiment, results.points);
  for (const Experiment& part : experiment.parts) {
    const auto in_part = [&](const PointRecord& point) { return point.part == part.part; };
    const auto begin = std::find_if(results.points.begin(), results.points.end(), in_part);
    const auto end = std::find_if_not(begin, results.points.end(), in_part);  // parts are stored one after the other
    judge_part(part, {begin, end});
  }
}

}  // namespace

void judge(const Experiment& experiment, Results& results, const std::vector<BoundResult>& earlier) {
  judge_parts(experiment, results);
  add_last_run(results.bounds, earlier);
}

std::string refused_text(const Findings& found) {
  std::string text;
  for (const Promise& one : found.promises)
    if (one.state == Promise::State::refused) text += fmt::format("refused: {}\n", printable(one.text));
  if (!text.empty())
    text += "  deliver it anew; a check that fails for a known reason is passed over with the frame's key 'accept'\n";
  return text;
}

std::string findings_text(const Findings& found) {
  const Results& results = found.all;
  std::string text = refused_text(found);
  for (const Promise& one : found.promises)
    if (one.of == Promise::Of::bound) text += one.text;
  if (!results.laws.empty()) text += (results.bounds.empty() ? "" : "\n") + law_table(results.laws);
  for (const LawResult& law : results.laws)
    if (!law.found.empty()) text += fmt::format("found: {}\n", printable(law.found));
  if (const std::string since = last_run_text(results); !since.empty()) text += printable(since) + "\n";
  if (const auto& compared = results.baseline)
    for (const auto* lines : {&compared->changed, &compared->worse, &compared->better, &compared->notes})
      for (const std::string& line : *lines) text += printable(line) + "\n";
  return text;
}

std::string verdict_line(const Findings& found, const std::string& file, const std::string& counts,
                         const std::string& folder) {
  return fmt::format("{}: {}; {}; the report is {}/report.html\n", printable(file), printable(found.sentence), counts,
                     printable(folder));
}

void require_sound(const Results& results) {
  if (const std::vector<Unsound> unsound = find_unsound(results.points); !unsound.empty())
    throw Error(ErrorKind::defect,
                fmt::format("{}; the results are stored, but do not trust them, and report this with the output of "
                            "noonmark doctor",
                            text_of(unsound.front())));
}

void write_report(const Results& results, const std::string& out, CsvColumns columns) {
  write_file_atomically(out + "/results.csv", to_csv(results, columns));
  write_file_atomically(out + "/report.html", render_report(results, [&](const std::string& path) {
                          return read_picture(out, path, results.points);
                        }));
}

}  // namespace noonmark
