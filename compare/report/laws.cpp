#include "compare/report/laws.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "compare/judge/laws.h"
#include "compare/report/blocks.h"
#include "compare/report/sections.h"
#include "compare/report/shown.h"
#include "compare/report/text.h"

namespace noonmark::report {
namespace {

using nlohmann::json;

// A chart of measured against predicted is useful only if there are several of each.
bool charted(const LawResult& law) {
  double low = INFINITY, high = -INFINITY;
  for (const LawResult::Sample& sample : law.samples) {
    if (!std::isfinite(sample.predicted) || !std::isfinite(sample.measured)) continue;
    low = std::min(low, sample.predicted);
    high = std::max(high, sample.predicted);
  }
  return high > low;
}

// The chart draws every n-th sample of a law, and the worst. With most_whole_points samples or fewer it draws all.
size_t drawn_every(const LawResult& law) {
  return law.samples.size() <= most_whole_points ? 1 : 1 + law.samples.size() / max_even_points;
}

// Where a broken law is furthest off, and the command that shows it.
Markup broken_law_row(const LawResult& law) {
  if (law.held) return "";
  Markup what = "No point is left that it speaks of.";
  if (law.worst >= 0) {
    const LawResult::Sample& sample = law.samples[static_cast<size_t>(law.worst)];
    what = prose("Off by {} at {}, where at most {} is allowed.", number(sample.measured - sample.predicted),
                 point_link(sample.point, prose("point {}", sample.point)), number(sample.allowed));
  }
  if (!law.reproduce.empty()) what += " See it: " + code(law.reproduce);
  return tr(css("command"), td(), td(Attribute("colspan", 5), what));
}

Markup said_below(const std::string& text) { return text.empty() ? "" : line_break() + span(css("says"), text); }

Markup law_row(const LawResult& law) {
  const auto figure = [](const Markup& content) { return td(css("number"), content); };
  const LawResult::Sample* worst = law.worst < 0 ? nullptr : &law.samples[static_cast<size_t>(law.worst)];
  return tr(css(law.held ? "held" : "broken"),
            td(law.held ? "✓ holds"
               : worst  ? "✗ broken"
                        : "✗ no point"),
            row_head(law.name, said_below(law.says), said_below(law.found), line_break(), code(law_text(law))),
            figure(law.samples.size()), figure(predicted_text(law)), figure(worst ? number(worst->measured) : "–"),
            figure(ratio_text(law)));
}

}  // namespace

Markup laws_table(const Results& results) {
  if (results.laws.empty()) return "";
  const auto any_law = [&](const auto& is) { return std::any_of(results.laws.begin(), results.laws.end(), is); };
  Markup rows;
  for (const LawResult& law : results.laws) rows += law_row(law) + broken_law_row(law);
  Markup out = element("h3", Attribute("id", "laws"), "Laws") + "\n";
  if (any_law(charted)) out += chart_place("laws", "Measured against predicted. On the line the two are equal.");
  if (any_law([](const LawResult& law) { return drawn_every(law) > 1; }))
    out += paragraph(css("note thinned"),
                     prose("Of a law with more than {} samples the chart draws some, evenly chosen, and the worst. All "
                           "samples are judged; {} has them.",
                           most_whole_points, code("results.sqlite")));
  Markup head = heads({"Verdict", "Law"});
  for (const char* name : {"Samples", "Predicted", "Measured", "Measured / predicted"}) head += th(css("number"), name);
  return out + div(css("scroll"), table("bounds laws", head, rows)) + "\n" +
         paragraph(css("small"), "Predicted and measured are from the sample that is furthest off.");
}

json law_data(const Results& results) {
  json laws = json::array();
  for (const LawResult& law : results.laws) {
    if (!charted(law)) continue;
    json samples = json::array();
    const size_t every = drawn_every(law);
    for (size_t i = 0; i < law.samples.size(); ++i) {
      const LawResult::Sample& sample = law.samples[i];
      if (i % every != 0 && static_cast<int>(i) != law.worst) continue;
      if (std::isfinite(sample.predicted) && std::isfinite(sample.measured))
        samples.push_back({{"point", sample.point},
                           {"predicted", sample.predicted},
                           {"measured", sample.measured},
                           {"allowed", sample.allowed}});
    }
    laws.push_back(
        {{"name", law.name}, {"measured", law.measured}, {"predicted", law.predicted}, {"samples", samples}});
  }
  return laws;
}

}  // namespace noonmark::report
