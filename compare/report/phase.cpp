#include "compare/report/phase.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <utility>

#include "compare/report/blocks.h"
#include "compare/report/cause_colors.h"
#include "compare/report/page_parts.h"
#include "compare/report/phase_section.h"
#include "compare/report/text.h"

namespace noonmark {
namespace {

using report::metres;

std::string percent(double share) { return fmt::format("{:g}%", 100 * share); }

std::string bounds_text(const PhaseDiagram& d) {
  return d.acne_bound == d.peter_panning_bound
             ? fmt::format("acne and Peter Panning each within {}", percent(d.acne_bound))
             : fmt::format("acne within {} and Peter Panning within {}", percent(d.acne_bound),
                           percent(d.peter_panning_bound));
}

// The cause with the largest share there; "" if nothing is wrong.
std::string_view dominating(const PhaseRow& row, size_t i) {
  const std::pair<std::string_view, double> causes[] = {
      {"acne", row.acne[i]},         {"peter_panning", row.peter_panning[i]},
      {"aliasing", row.aliasing[i]}, {"coverage", row.coverage[i]},
      {"filter", row.filter[i]},     {"undecided", row.undecided[i]}};
  const auto largest = std::max_element(std::begin(causes), std::end(causes),
                                        [](const auto& a, const auto& b) { return a.second < b.second; });
  return largest->second > 0 ? largest->first : "";
}

// The least bound, to two digits, that some bias keeps for both acne and Peter Panning at every placement.
double least_bound(const PhaseRow& row) {
  double least = 1;
  for (size_t i = 0; i < row.acne_worst.size(); ++i)
    least = std::min(least, std::max(row.acne_worst[i], row.peter_panning_worst[i]));
  return std::strtod(fmt::format("{:.2g}", least).c_str(), nullptr);
}

}  // namespace

std::vector<std::string> phase_words(const PhaseDiagram& d) {
  std::vector<std::string> words;
  const auto nearest = [&](int resolution) {
    return std::min_element(d.rows.begin(), d.rows.end(), [&](const PhaseRow& a, const PhaseRow& b) {
      return std::abs(std::log(static_cast<double>(a.resolution) / resolution)) <
             std::abs(std::log(static_cast<double>(b.resolution) / resolution));
    });
  };
  const std::string bounds = bounds_text(d);
  // The rows from the finest on that are usable without a gap.
  auto coarsest = d.rows.end();
  while (coarsest != d.rows.begin() && !d.usable(*(coarsest - 1)).empty()) --coarsest;
  const auto any =
      std::find_if(d.rows.begin(), d.rows.end(), [&](const PhaseRow& row) { return !d.usable(row).empty(); });
  if (any == d.rows.end()) {
    words.push_back(
        fmt::format("No constant bias keeps {} at every placement of the texel grid, for any texel from {} to "
                    "{} (resolution {} to {}).",
                    bounds, metres(d.rows.back().texel_m), metres(d.rows.front().texel_m), d.rows.back().resolution,
                    d.rows.front().resolution));
    words.push_back(fmt::format("At the finest texel, {}, the best bias keeps both within {}.",
                                metres(d.rows.back().texel_m), percent(least_bound(d.rows.back()))));
    for (const PhaseRow& row : d.rows)
      if (const double ten_times = 10 * std::max(d.acne_bound, d.peter_panning_bound); least_bound(row) <= ten_times) {
        words.push_back(fmt::format("{} holds for every texel up to {}.", percent(ten_times), metres(row.texel_m)));
        break;
      }
    return words;
  }
  const auto usual = nearest(1024);
  if (const Interval window = d.usable(*usual); !window.empty())
    words.push_back(
        fmt::format("At {} texels, each {} wide, a constant bias from {} to {} keeps {}, at every placement "
                    "of the texel grid.",
                    usual->resolution, metres(usual->texel_m), metres(window.low), metres(window.high), bounds));
  else
    words.push_back(fmt::format("At {} texels, each {} wide, no constant bias keeps {}.", usual->resolution,
                                metres(usual->texel_m), bounds));
  if (coarsest == d.rows.begin())
    words.push_back(fmt::format("Every texel up to {}, the coarsest that was tried, has a usable bias.",
                                metres(d.rows.front().texel_m)));
  else if (coarsest != d.rows.end())
    words.push_back(
        fmt::format("Every texel up to {} (resolution {} and more) has a usable bias; the tip of the usable "
                    "region is at {}.",
                    metres(coarsest->texel_m), coarsest->resolution, metres(d.usable(*coarsest).low)));
  else
    words.push_back("Only some of the texel sizes have a usable bias; see the table.");
  return words;
}

std::string render_phase(const PhaseDiagram& d) {
  using namespace report;
  const Markup made = term("Command", code(d.command)) + term("Technique", d.technique) +
                      (d.notes.empty() ? "" : term("Notes", d.notes));
  nlohmann::json causes = nlohmann::json::array();
  for (const CauseColor& color : cause_colors) causes.push_back({{"name", color.name}, {"label", color.label}});
  const nlohmann::json none = nlohmann::json::array();
  return fill_page({.title = prose("Phase diagram of {}", d.scene),
                    .subtitle = prose("Scene {} · {} light · {} texel sizes × {} biases", d.scene, d.light,
                                      d.rows.size(), d.bias_m.size()),
                    .navigation = section_link("phase", "Diagram") + section_link("making", "Making"),
                    .sections = section("phase", "Texel size and bias", phase_figure(d, 0)) +
                                section("making", "How it was made", terms("terms", made)),
                    .data = {{"points", none},
                             {"metrics", none},
                             {"plot", none},
                             {"swept", none},
                             {"causes", causes},
                             {"phases", {phase_data(d)}}},
                    .causes = {cause_colors.begin(), cause_colors.end()},
                    .scripts = {"charts", "chart_phase", "save", "page"},
                    .version = d.version});
}

std::string phase_csv(const PhaseDiagram& d) {
  std::string csv = "resolution,texel_m,bias_m";
  for (const PhaseSeries& series : phase_series()) csv += fmt::format(",{}", series.name);
  csv += ",cause,usable\n";
  for (const PhaseRow& row : d.rows) {
    const Interval usable = d.usable(row);
    for (size_t i = 0; i < d.bias_m.size(); ++i) {
      csv += fmt::format("{},{},{}", row.resolution, row.texel_m, d.bias_m[i]);
      for (const PhaseSeries& series : phase_series()) csv += fmt::format(",{}", (row.*series.values)[i]);
      csv +=
          fmt::format(",{},{}\n", dominating(row, i), d.bias_m[i] >= usable.low && d.bias_m[i] <= usable.high ? 1 : 0);
    }
  }
  return csv;
}

}  // namespace noonmark
