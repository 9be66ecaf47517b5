#include "compare/report/laws.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "compare/judge/laws.h"
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

std::string broken_rows(const LawResult& law) {
  if (law.held) return "";
  std::string what = "no point matches";
  if (law.worst >= 0) {
    const LawResult::Sample& sample = law.samples[static_cast<size_t>(law.worst)];
    what = fmt::format("Off by {} at <a href=\"#p{}\">point {}</a>, where at most {} is allowed.",
                       number(sample.measured - sample.predicted), sample.point, sample.point, number(sample.allowed));
  }
  if (!law.reproduce.empty()) what += fmt::format(" See it: <code>{}</code>", html(law.reproduce));
  return fmt::format("<tr class=\"command\"><td></td><td colspan=\"5\">{}</td></tr>\n", what);
}

std::string sentence(const std::string& text) {
  return text.empty() ? "" : fmt::format("<br><span class=\"says\">{}</span>", html(text));
}

}  // namespace

std::string laws_table(const Results& results) {
  if (results.laws.empty()) return "";
  std::string rows;
  for (const LawResult& law : results.laws) {
    const LawResult::Sample* worst = law.worst < 0 ? nullptr : &law.samples[static_cast<size_t>(law.worst)];
    rows += fmt::format(
        "<tr class=\"{}\"><td>{}</td><th scope=\"row\">{}{}<br><code>{}</code></th><td class=\"number\">{}</td><td "
        "class=\"number\">{}</td>"
        "<td class=\"number\">{}</td><td class=\"number\">{}</td></tr>\n{}",
        law.held ? "held" : "broken", law.held ? "✓ holds" : "✗ broken", html(law.name),
        sentence(law.says) + sentence(law.found), html(law_text(law)), law.samples.size(), html(predicted_text(law)),
        worst ? number(worst->measured) : "–", html(ratio_text(law)), broken_rows(law));
  }
  std::string out = "<h3 id=\"laws\">Laws</h3>\n";
  if (std::any_of(results.laws.begin(), results.laws.end(), charted))
    out += chart_place("laws", "Measured against predicted. On the line the two are equal.");
  if (std::any_of(results.laws.begin(), results.laws.end(), [](const auto& law) { return drawn_every(law) > 1; }))
    out += fmt::format(
        "<p class=\"note thinned\">Of a law with more than {} samples the chart draws some, evenly chosen, and the "
        "worst. All samples are judged; <code>results.sqlite</code> has them.</p>\n",
        most_whole_points);
  return out +
         "<div class=\"scroll\"><table class=\"bounds laws\"><thead><tr><th>Verdict</th><th>Law</th><th "
         "class=\"number\">Samples</th>"
         "<th class=\"number\">Predicted</th><th class=\"number\">Measured</th><th class=\"number\">Measured / "
         "predicted</th></tr></thead><tbody>\n" +
         rows +
         "</tbody></table></div>\n<p class=\"small\">Predicted and measured are from the sample that is furthest "
         "off.</p>\n";
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
