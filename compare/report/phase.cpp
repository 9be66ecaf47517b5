#include "compare/report/phase.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "compare/report/cause_colors.h"
#include "compare/report/page_parts.h"
#include "compare/report/sections.h"
#include "compare/report/text.h"

namespace noonmark {
namespace {

using report::html;
using report::number;
using report::quantity;

// Acne falls with the bias and Peter Panning grows, so each bound is met from one bias on, or up to one.
BiasInterval between(const std::vector<double>& bias_m, const std::vector<double>& acne, double acne_bound,
                     const std::vector<double>& panning, double panning_bound) {
  const auto from = std::find_if(acne.begin(), acne.end(), [&](double share) { return share <= acne_bound; });
  const auto end =
      std::find_if(panning.begin(), panning.end(), [&](double share) { return !(share <= panning_bound); });
  const auto first = from - acne.begin(), last = end - panning.begin() - 1;
  if (first > last) return {};
  return {bias_m[static_cast<size_t>(first)], bias_m[static_cast<size_t>(last)]};
}

std::string metres(double m) { return m < 1 ? fmt::format("{} mm", number(1000 * m)) : fmt::format("{} m", number(m)); }

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
  return std::stod(fmt::format("{:.2g}", least));
}

double six_digits(double value) { return std::isfinite(value) ? std::stod(fmt::format("{:.6g}", value)) : value; }

nlohmann::json finite(double value) {
  return std::isfinite(value) ? nlohmann::json(six_digits(value)) : nlohmann::json(nullptr);
}

nlohmann::json series(const std::vector<double>& values) {
  nlohmann::json list = nlohmann::json::array();
  for (double value : values) list.push_back(finite(value));
  return list;
}

nlohmann::json data_of(const PhaseDiagram& d) {
  nlohmann::json phase{{"bias_m", series(d.bias_m)},
                       {"acne_bound", d.acne_bound},
                       {"peter_panning_bound", d.peter_panning_bound},
                       {"law_at_bound", finite(d.law_at_bound)},
                       {"law_steepest", finite(d.law_steepest)},
                       {"render", d.render},
                       {"per_metre", 1 / d.metres_per_bias},
                       {"placements", d.placements * d.placements},
                       {"rows", nlohmann::json::array()}};
  for (const PhaseRow& row : d.rows) {
    nlohmann::json json{{"resolution", row.resolution},
                        {"texel_m", row.texel_m},
                        {"last_acne_m", finite(row.last_acne_m)},
                        {"error", series(row.error)},
                        {"error_worst", series(row.error_worst)},
                        {"acne", series(row.acne)},
                        {"acne_worst", series(row.acne_worst)},
                        {"peter_panning", series(row.peter_panning)},
                        {"peter_panning_worst", series(row.peter_panning_worst)},
                        {"aliasing", series(row.aliasing)},
                        {"coverage", series(row.coverage)},
                        {"filter", series(row.filter)},
                        {"undecided", series(row.undecided)}};
    const BiasInterval worst = d.usable(row), mean = d.usable_on_average(row);
    if (!worst.empty()) json["usable"] = {worst.from, worst.to};
    if (!mean.empty()) json["usable_mean"] = {mean.from, mean.to};
    phase["rows"].push_back(std::move(json));
  }
  nlohmann::json causes = nlohmann::json::array();
  for (const CauseColor& color : cause_colors) causes.push_back({{"name", color.name}, {"label", color.label}});
  return {{"points", nlohmann::json::array()},
          {"metrics", nlohmann::json::array()},
          {"plot", nlohmann::json::array()},
          {"swept", nlohmann::json::array()},
          {"causes", causes},
          {"phase", phase}};
}

std::string table(const PhaseDiagram& d) {
  std::string rows;
  for (const PhaseRow& row : d.rows) {
    const BiasInterval worst = d.usable(row), mean = d.usable_on_average(row);
    const auto least = std::min_element(row.error_worst.begin(), row.error_worst.end()) - row.error_worst.begin();
    const auto best = static_cast<size_t>(least);
    const auto cells = [](const BiasInterval& interval) {
      return interval.empty() ? std::string("<td colspan=\"2\">none</td>")
                              : fmt::format("<td>{}</td><td>{}</td>", metres(interval.from), metres(interval.to));
    };
    rows +=
        fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td>{}{}<td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                    row.resolution, metres(row.texel_m), cells(worst), cells(mean), metres(d.bias_m[best]),
                    quantity(row.error_worst[best], "fraction"), quantity(row.error[best], "fraction"),
                    std::isfinite(row.last_acne_m) ? metres(row.last_acne_m) : "more");
  }
  return fmt::format(
      "<details open><summary>The same as a table</summary>\n<div class=\"scroll\"><table class=\"numbers\"><thead>"
      "<tr><th>Resolution</th><th>Texel</th><th>Usable from</th><th>to</th><th>In the mean from</th><th>to</th>"
      "<th>Least error at</th><th>Error, worst</th><th>mean</th><th>No acne from</th></tr></thead><tbody>\n{}"
      "</tbody></table></div></details>\n",
      rows);
}

}  // namespace

BiasInterval PhaseDiagram::usable(const PhaseRow& row) const {
  return between(bias_m, row.acne_worst, acne_bound, row.peter_panning_worst, peter_panning_bound);
}
BiasInterval PhaseDiagram::usable_on_average(const PhaseRow& row) const {
  return between(bias_m, row.acne, acne_bound, row.peter_panning, peter_panning_bound);
}

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
  if (const BiasInterval window = d.usable(*usual); !window.empty())
    words.push_back(
        fmt::format("At {} texels, each {} wide, a constant bias from {} to {} keeps {}, at every placement "
                    "of the texel grid.",
                    usual->resolution, metres(usual->texel_m), metres(window.from), metres(window.to), bounds));
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
                    metres(coarsest->texel_m), coarsest->resolution, metres(d.usable(*coarsest).from)));
  else
    words.push_back("Only some of the texel sizes have a usable bias; see the table.");
  return words;
}

std::string render_phase(const PhaseDiagram& d) {
  std::string sentences;
  for (const std::string& sentence : phase_words(d)) sentences += fmt::format("<p>{}</p>\n", html(sentence));
  const std::string section = fmt::format(
      "<section id=\"phase\"><h2>Texel size and bias</h2>\n{}{}{}<p class=\"small\">{} receivers. Each texel size is "
      "measured at {} placements of its grid, all from one set of first hits. Colour: the cause with the largest "
      "share; "
      "the stronger, the larger the error. The largest error of all placements may be a tenth more than the largest of "
      "these {}. The error is that on an exact map: what the depth format and the rasteriser add is not in it.</p>\n"
      "</section>\n"
      "<section id=\"making\"><h2>How it was made</h2>\n<dl class=\"terms\"><div><dt>Command</dt><dd><code>{}</code>"
      "</dd></div><div><dt>Technique</dt><dd>{}</dd></div>{}</dl></section>\n",
      sentences,
      report::chart_place("phase",
                          "Texel size against a constant bias. Hatched: usable at every placement of the texel grid. "
                          "Red line: acne meets its bound; blue line: Peter Panning meets its bound (solid: worst "
                          "placement, dashed: mean). Move over the figure for all causes; click for the command that "
                          "renders a point."),
      table(d), report::number(d.receivers), d.placements * d.placements, d.placements * d.placements, html(d.command),
      html(d.technique), d.notes.empty() ? "" : fmt::format("<div><dt>Notes</dt><dd>{}</dd></div>", html(d.notes)));
  return report::fill_page({.title = html(fmt::format("Phase diagram of {}", d.scene)),
                            .subtitle = html(fmt::format("Scene {} · {} light · {} texel sizes × {} biases", d.scene,
                                                         d.light, d.rows.size(), d.bias_m.size())),
                            .navigation = "<a href=\"#phase\">Diagram</a><a href=\"#making\">Making</a>",
                            .sections = section,
                            .data = data_of(d),
                            .causes = {cause_colors.begin(), cause_colors.end()},
                            .scripts = {"charts", "chart_phase", "page"},
                            .version = d.version});
}

std::string phase_csv(const PhaseDiagram& d) {
  std::string csv =
      "resolution,texel_m,bias_m,error,error_worst,acne,acne_worst,peter_panning,peter_panning_worst,aliasing,coverage,"
      "filter,undecided,cause,usable\n";
  for (const PhaseRow& row : d.rows) {
    const BiasInterval usable = d.usable(row);
    for (size_t i = 0; i < d.bias_m.size(); ++i)
      csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", row.resolution, row.texel_m, d.bias_m[i],
                         row.error[i], row.error_worst[i], row.acne[i], row.acne_worst[i], row.peter_panning[i],
                         row.peter_panning_worst[i], row.aliasing[i], row.coverage[i], row.filter[i], row.undecided[i],
                         dominating(row, i), d.bias_m[i] >= usable.from && d.bias_m[i] <= usable.to ? 1 : 0);
  }
  return csv;
}

}  // namespace noonmark
