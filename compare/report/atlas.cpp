#include "compare/report/atlas.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "compare/report/blocks.h"
#include "compare/report/escape.h"
#include "compare/report/links.h"
#include "compare/report/page_parts.h"
#include "compare/report/text.h"

namespace noonmark {
namespace {

using report::Markup;

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

Markup cell_of(const AtlasRow& row, const AtlasCell* cell) {
  using namespace report;
  if (!cell) return td("–");
  const std::string_view kind = cell->verdict == AtlasVerdict::nothing ? "nothing" : name_of(cell->verdict);
  return td(css(kind), bold(verdict_text(row, *cell)), line_break(), cell->why.empty() ? "" : cell->why + line_break(),
            prose("error {}, work {}", left_text(*cell), report::cell(cell->cost, "count")));
}

Markup law_line(const LawResult& law) {
  using namespace report;
  const Markup verdict = prose("law “{}” {}", law.name, law.held ? "holds" : bold("broken"));
  if (law.worst < 0) return line_break() + verdict;
  const LawResult::Sample& sample = law.samples[static_cast<size_t>(law.worst)];
  return line_break() + verdict +
         prose(" (predicted {}, measured {})", report::number(sample.predicted), report::number(sample.measured));
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

Markup failure_cell(const AtlasRow& row) {
  using namespace report;
  const AtlasEntry& entry = row.entry;
  Markup text = bold(file_link(row.report, entry.failure));
  if (!row.held) text += " " + bold("(a bound or law is broken)");
  text += line_break() + prose("cause: {}; swept: {}", entry.cause, entry.driver);
  text += line_break() + prose("cure: {}", entry.cure);
  if (!entry.note.empty()) text += line_break() + entry.note;
  for (const LawResult& law : row.laws) text += law_line(law);
  if (!entry.thread.empty())
    text += line_break() + prose("{}: {}", web_link(entry.thread, thread_text(entry.thread)), entry.answer);
  return td(text, line_break(), code(row.command));
}

Markup picture_cell(const AtlasRow& row) {
  using namespace report;
  if (row.picture.empty()) return td("–");
  return td(element("img", Attribute("loading", "lazy"), Attribute("src", file_address(row.picture)),
                    Attribute("alt", "causes at the worst point of " + row.entry.failure)));
}

Markup others_cell(const AtlasRow& row, const std::vector<std::string>& techniques) {
  using namespace report;
  Markup text;
  for (const AtlasCell* cell : others_of(row, techniques))
    text += prose("{}: {}, error {}, work {}{}", cell->technique, bold(verdict_text(row, *cell)), left_text(*cell),
                  report::cell(cell->cost, "count"), line_break());
  return td(text);
}

Markup words_before_the_matrix(size_t rows) {
  using namespace report;
  return paragraph(prose(
      "Each of the {} rows is a known failure, each column a technique. A technique {} if at every point the usable "
      "biases span at least a factor of {} at every placement of the texel grid, with acne, Peter Panning and coverage "
      "of at most {} each. It is {} if the span is narrower, or if a placement breaks it. It {} if no bias is usable "
      "at "
      "some point. {} names the first value of the swept setting that does not hold. The error is the one that is left "
      "at the best bias there, the work counts texels written and texture instructions. What flickers in motion, and "
      "why, is measured by {}.",
      rows, bold("holds"), atlas_window_factor, quantity(atlas_share, "fraction"), bold("fragile"), bold("fails"),
      italic("From"), code("noonmark check experiments/motion.toml")));
}

}  // namespace

std::string to_atlas_page(std::span<const AtlasRow> rows, const std::string& version) {
  using namespace report;
  const std::vector<std::string> techniques = techniques_of(rows);
  Markup head = heads({"Failure", "Worst point"}), body;
  for (const std::string& technique : techniques) head += th(technique);
  head += th("Other techniques");
  for (const AtlasRow& row : rows) {
    Markup cells = failure_cell(row) + picture_cell(row);
    for (const std::string& technique : techniques) cells += cell_of(row, find_cell(row, technique));
    body += tr(cells, others_cell(row, techniques));
  }
  const Markup matrix = div(css("scroll tall"), Attribute("tabindex", 0), Attribute("role", "region"),
                            Attribute("aria-label", "Failures and techniques"), table("atlas", head, body));
  return plain_page({.title = "The atlas of failures",
                     .body = words_before_the_matrix(rows.size()) + matrix + "\n",
                     .version = version,
                     .pictures = Pictures::beside});
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
