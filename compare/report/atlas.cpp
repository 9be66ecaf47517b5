#include "compare/report/atlas.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "compare/report/escape.h"
#include "compare/report/links.h"
#include "compare/report/page_parts.h"
#include "compare/report/text.h"

namespace noonmark {
namespace {

using report::html;

// The techniques with a column of their own: those that at least four rows try. The others stand in the last column.
constexpr size_t rows_of_a_column = 4;
std::vector<std::string> techniques_of(std::span<const AtlasRow> rows) {
  std::vector<std::string> names;
  std::map<std::string, size_t> tried;
  for (const AtlasRow& row : rows)
    for (const AtlasCell& cell : row.cells)
      if (++tried[cell.technique] == rows_of_a_column) names.push_back(cell.technique);
  return names;
}

const AtlasCell* find_cell(const AtlasRow& row, const std::string& technique) {
  for (const AtlasCell& cell : row.cells)
    if (cell.technique == technique) return &cell;
  return nullptr;
}

// "fails from 2 deg"
std::string verdict_text(const AtlasRow& row, const AtlasCell& cell) {
  std::string text(name_of(cell.verdict));
  if (!cell.cliff.empty()) text += fmt::format(" from {}", cell.cliff);
  if (const std::string unit = report::setting_unit(row.entry.driver); !cell.cliff.empty() && !unit.empty())
    text += " " + unit;
  return text;
}

std::string left_text(const AtlasCell& cell) {
  return std::isfinite(cell.left) ? report::quantity(cell.left, "fraction") : "–";
}

std::string cell_html(const AtlasRow& row, const AtlasCell* cell) {
  if (!cell) return "<td>–</td>";
  std::string_view kind = name_of(cell->verdict);
  if (cell->verdict == AtlasVerdict::nothing) kind = "nothing";
  return fmt::format("<td class=\"{}\"><b>{}</b><br>{}error {}, work {}</td>", kind, html(verdict_text(row, *cell)),
                     cell->why.empty() ? "" : html(cell->why) + "<br>", html(left_text(*cell)),
                     html(report::cell(cell->cost, "count")));
}

std::string laws_html(const AtlasRow& row) {
  std::string text;
  for (const LawResult& law : row.laws) {
    text += fmt::format("<br>law “{}” {}", html(law.name), law.held ? "holds" : "<b>broken</b>");
    if (law.worst < 0) continue;
    const LawResult::Sample& sample = law.samples[static_cast<size_t>(law.worst)];
    text += fmt::format(" (predicted {}, measured {})", html(report::number(sample.predicted)),
                        html(report::number(sample.measured)));
  }
  return text;
}

// The address without its host: "bevyengine/bevy/issues/16075".
std::string thread_text(const std::string& address) {
  const size_t scheme = address.find("://"),
               path = scheme == std::string::npos ? scheme : address.find('/', scheme + 3);
  return path == std::string::npos ? address : address.substr(path + 1);
}

std::vector<const AtlasCell*> others_of(const AtlasRow& row, const std::vector<std::string>& techniques) {
  std::vector<const AtlasCell*> cells;
  for (const AtlasCell& cell : row.cells)
    if (std::find(techniques.begin(), techniques.end(), cell.technique) == techniques.end()) cells.push_back(&cell);
  return cells;
}

}  // namespace

std::string to_atlas_page(std::span<const AtlasRow> rows, const std::string& version) {
  const std::vector<std::string> techniques = techniques_of(rows);
  std::string text = fmt::format(
      "<p>Each of the {} rows is a known failure, each column a technique. A technique <b>holds</b> if at "
      "every point the usable "
      "biases span at least a factor of {} at every placement of the texel grid, with acne, Peter Panning and coverage "
      "of at most {} each. It is <b>fragile</b> if the span is narrower, or if a placement breaks it. It <b>fails</b> "
      "if no bias is usable at some point. <i>From</i> names the first value of the swept setting that does not hold. "
      "The error is the one that is left at the best bias there, the work counts texels written and texture "
      "instructions. What flickers in motion, and why, is measured by <code>noonmark check "
      "experiments/motion.toml</code>.</p>\n",
      rows.size(), atlas_window_factor, html(report::quantity(atlas_share, "fraction")));
  text +=
      "<div class=\"scroll tall\" tabindex=\"0\" role=\"region\" aria-label=\"Failures and techniques\">"
      "<table class=\"atlas\"><thead><tr><th>Failure</th><th>Worst point</th>";
  for (const std::string& technique : techniques) text += fmt::format("<th>{}</th>", html(technique));
  text += "<th>Other techniques</th></tr></thead><tbody>\n";
  for (const AtlasRow& row : rows) {
    const AtlasEntry& entry = row.entry;
    text += fmt::format("<tr><td><b><a href=\"{}\">{}</a></b>{}<br>cause: {}; swept: {}<br>cure: {}",
                        report::file_address(row.report), html(entry.failure),
                        row.held ? "" : " <b>(a bound or law is broken)</b>", html(entry.cause), html(entry.driver),
                        html(entry.cure));
    if (!entry.note.empty()) text += "<br>" + html(entry.note);
    text += laws_html(row);
    if (!entry.thread.empty())
      text += fmt::format("<br>{}: {}", report::web_link(entry.thread, thread_text(entry.thread)), html(entry.answer));
    text += fmt::format("<br><code>{}</code></td><td>{}</td>", html(row.command),
                        row.picture.empty()
                            ? "–"
                            : fmt::format("<img loading=\"lazy\" src=\"{}\" alt=\"causes at the worst point of {}\">",
                                          report::file_address(row.picture), html(entry.failure)));
    for (const std::string& technique : techniques) text += cell_html(row, find_cell(row, technique));
    text += "<td>";
    for (const AtlasCell* cell : others_of(row, techniques))
      text += fmt::format("{}: <b>{}</b>, error {}, work {}<br>", html(cell->technique), html(verdict_text(row, *cell)),
                          html(left_text(*cell)), html(report::cell(cell->cost, "count")));
    text += "</td></tr>\n";
  }
  return report::plain_page("The atlas of failures", text + "</tbody></table></div>\n", version,
                            report::Pictures::beside);
}

std::string to_atlas_table(std::span<const AtlasRow> rows) {
  const std::vector<std::string> techniques = techniques_of(rows);
  std::string text = "| failure | cause | cure |";
  for (const std::string& technique : techniques) text += fmt::format(" {} |", markdown(technique));
  text += " other techniques |\n|---|---|---|---|";
  for (size_t i = 0; i < techniques.size(); ++i) text += "---|";
  text += "\n";
  for (const AtlasRow& row : rows) {
    text += fmt::format("| {} | {} | {} |", markdown(row.entry.failure), markdown(row.entry.cause),
                        markdown(row.entry.cure));
    for (const std::string& technique : techniques) {
      const AtlasCell* cell = find_cell(row, technique);
      text += fmt::format(" {} |", cell ? markdown(verdict_text(row, *cell)) : "–");
    }
    std::vector<std::string> others;
    for (const AtlasCell* cell : others_of(row, techniques))
      others.push_back(fmt::format("{}: {}", markdown(cell->technique), markdown(verdict_text(row, *cell))));
    text += fmt::format(" {} |\n", others.empty() ? "–" : fmt::format("{}", fmt::join(others, "; ")));
  }
  return text;
}

}  // namespace noonmark
