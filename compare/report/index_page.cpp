#include "compare/report/index_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/text.h"
#include "compare/report/blocks.h"
#include "compare/report/broken.h"
#include "compare/report/links.h"
#include "compare/report/page_parts.h"
#include "compare/report/text.h"

namespace noonmark {
namespace {

using report::Markup;
// The order of the rows, and the class of a row: those whose verdict does not pass, those without one, those that pass.
constexpr std::string_view kinds[] = {"broken", "warning", "held"};
size_t kind_of(const IndexEntry& entry) { return !entry.verdict ? 1 : passes(*entry.verdict) ? 2 : 0; }

Markup row(const IndexEntry& entry) {
  using namespace report;
  constexpr std::string_view marks[] = {"✗", "!", "✓"};
  const size_t kind = kind_of(entry);
  const std::string name = entry.title.empty() ? entry.experiment : entry.title;
  return tr(
      css(kinds[kind]), td(fmt::format("{} {}", marks[kind], entry.verdict ? word_of(*entry.verdict) : "not judged")),
      row_head(entry.report.empty() ? name : file_link(entry.report, name), line_break(), small(entry.experiment)),
      td(entry.words), td(entry.numbers));
}

}  // namespace

std::string worst_numbers(const Results& results) {
  std::string out;
  for (const char* metric : {"error", "acne", "peter_panning", "frame_error", "frame_wrong", "frame_acne"}) {
    double worst = -1;
    for (const PointRecord& point : results.points) {
      if (!point.metrics.contains(metric)) continue;
      const double value = point.metrics.at(metric);
      worst = std::isfinite(value) ? std::max(worst, value) : std::numeric_limits<double>::infinity();
    }
    if (worst >= 0)
      out += fmt::format("{}{} {}{}", out.empty() ? "" : ", ", report::metric_label(metric),
                         std::isfinite(worst) ? "at most " : "", report::quantity(worst, "fraction"));
  }
  return out;
}

std::string broken_in_words(const Results& results) { return report::broken_words(results).text(); }

std::string index_words(const std::vector<IndexEntry>& entries) {
  std::map<std::optional<Verdict>, size_t> counts;
  for (const IndexEntry& entry : entries) ++counts[entry.verdict];
  std::string out;
  for (const auto& [verdict, count] : counts)
    if (verdict) out += fmt::format("{}{} {}", out.empty() ? "" : ", ", count, word_of(*verdict));
  if (counts.contains({})) out += fmt::format("{}{} not judged", out.empty() ? "" : ", ", counts[{}]);
  return fmt::format("{}: {}", counted(entries.size(), "experiment"), out);
}

std::string index_page(const std::vector<IndexEntry>& entries, const std::string& version) {
  std::vector<IndexEntry> ordered = entries;
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const IndexEntry& a, const IndexEntry& b) { return kind_of(a) < kind_of(b); });
  using namespace report;
  Markup rows;
  for (const IndexEntry& entry : ordered) rows += row(entry);
  const bool all = std::all_of(entries.begin(), entries.end(), [](const auto& one) { return kind_of(one) == 2; });
  const Markup head = heads({"Verdict", "Experiment", "In words", "Worst numbers"});
  return plain_page(
      {.title = "Checked experiments",
       .body = paragraph(css("verdict"), span(css(all ? "pill held" : "pill broken"), index_words(entries))) +
               div(css("scroll"), table("index", head, rows)) + "\n",
       .version = version});
}

}  // namespace noonmark
