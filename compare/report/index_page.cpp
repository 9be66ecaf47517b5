#include "compare/report/index_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compare/report/blocks.h"
#include "compare/report/broken.h"
#include "compare/report/links.h"
#include "compare/report/page_parts.h"
#include "compare/report/text.h"

namespace noonmark {
namespace {

using report::Markup;
using Listed = IndexEntry::Verdict;

size_t count(const std::vector<IndexEntry>& entries, Listed verdict) {
  return static_cast<size_t>(
      std::count_if(entries.begin(), entries.end(), [&](const IndexEntry& one) { return one.verdict == verdict; }));
}

int rank(Listed verdict) { return verdict == Listed::broken ? 0 : verdict == Listed::not_judged ? 1 : 2; }

Markup row(const IndexEntry& entry) {
  using namespace report;
  const char* const mark = entry.verdict == Listed::held     ? "✓ held"
                           : entry.verdict == Listed::broken ? "✗ broken"
                                                             : "! not judged";
  const char* const kind = entry.verdict == Listed::held     ? "held"
                           : entry.verdict == Listed::broken ? "broken"
                                                             : "warning";
  const std::string name = entry.title.empty() ? entry.experiment : entry.title;
  return tr(
      css(kind), td(mark),
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

std::string broken_in_words(const Results& results) { return report::broken_words(results); }

std::string index_words(const std::vector<IndexEntry>& entries) {
  std::string out = fmt::format("{} experiment{}: {} held", entries.size(), entries.size() == 1 ? "" : "s",
                                count(entries, Listed::held));
  if (const size_t broken = count(entries, Listed::broken)) out += fmt::format(", {} broken", broken);
  if (const size_t others = count(entries, Listed::not_judged)) out += fmt::format(", {} not judged", others);
  return out;
}

std::string index_page(const std::vector<IndexEntry>& entries, const std::string& version) {
  std::vector<IndexEntry> ordered = entries;
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const IndexEntry& a, const IndexEntry& b) { return rank(a.verdict) < rank(b.verdict); });
  using namespace report;
  Markup rows;
  for (const IndexEntry& entry : ordered) rows += row(entry);
  const bool all = count(entries, Listed::held) == entries.size();
  const Markup head = heads({"Verdict", "Experiment", "In words", "Worst numbers"});
  return plain_page(
      {.title = "Checked experiments",
       .body = paragraph(css("verdict"), span(css(all ? "pill held" : "pill broken"), index_words(entries))) +
               div(css("scroll"), table("index", head, rows)) + "\n",
       .version = version});
}

}  // namespace noonmark
