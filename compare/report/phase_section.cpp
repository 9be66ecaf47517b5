#include "compare/report/phase_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "compare/report/blocks.h"
#include "compare/report/phase.h"
#include "compare/report/sections.h"
#include "compare/report/text.h"

namespace noonmark::report {
namespace {

double six_digits(double value) { return std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr); }

int64_t placements_of(const PhaseDiagram& d) { return int64_t{d.placements} * d.placements; }

nlohmann::json finite(double value) {
  return std::isfinite(value) ? nlohmann::json(six_digits(value)) : nlohmann::json(nullptr);
}

nlohmann::json series(const std::vector<double>& values) {
  nlohmann::json list = nlohmann::json::array();
  for (double value : values) list.push_back(finite(value));
  return list;
}

Markup texel_size_row(const PhaseDiagram& d, const PhaseRow& row) {
  const auto least = std::min_element(row.error_worst.begin(), row.error_worst.end()) - row.error_worst.begin();
  const auto best = static_cast<size_t>(least);
  const auto cells = [](const Interval& interval) {
    return interval.empty() ? td(Attribute("colspan", 2), "none")
                            : td(metres(interval.low)) + td(metres(interval.high));
  };
  return tr(row_head(row.resolution), td(metres(row.texel_m)), cells(d.usable(row)), cells(d.usable_on_average(row)),
            td(metres(d.bias_m[best])), td(quantity(row.error_worst[best], "fraction")),
            td(quantity(row.error[best], "fraction")),
            td(std::isfinite(row.last_acne_m) ? metres(row.last_acne_m) : "more"));
}

Markup texel_sizes(const PhaseDiagram& d) {
  Markup rows;
  for (const PhaseRow& row : d.rows) rows += texel_size_row(d, row);
  const Markup head = heads({"Resolution", "Texel", "Usable from", "to", "In the mean from", "to", "Least error at",
                             "Error, worst", "mean", "No acne from"});
  return folded("more", d.points.empty(), "The same as a table", div(css("scroll"), table("numbers", head, rows)));
}

// Where a bias lies to the usable interval of its texel size.
std::string_view verdict_of(const Interval& usable, double bias_m) {
  return usable.empty()         ? "no bias is"
         : bias_m < usable.low  ? "too small"
         : bias_m > usable.high ? "too large"
                                : "usable";
}

// "16 with filter.kind = box, 4 with ...": the most frequent first.
std::string left_out_text(const PhaseDiagram& d) {
  std::map<std::string, size_t> reasons;
  for (const PhasePoint& point : d.points)
    if (!point.left_out.empty()) ++reasons[point.left_out];
  std::vector<std::pair<std::string, size_t>> ordered(reasons.begin(), reasons.end());
  std::stable_sort(ordered.begin(), ordered.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  constexpr size_t most = 4;  // the point's own rows in the table of all points have the rest
  std::string text;
  for (size_t i = 0; i < std::min(most, ordered.size()); ++i)
    text += fmt::format("{}{} with {}", i ? ", " : "", ordered[i].second, ordered[i].first);
  if (ordered.size() > most) text += fmt::format(", and others with {} other settings", ordered.size() - most);
  return text;
}

Markup point_on_diagram(const PhasePoint& point, const PointRecord& record, const std::vector<std::string>& swept,
                        const Interval& window, std::string_view verdict) {
  return tr(row_head(point_link(point.point, point.point)), td(css("text"), settings_phrase(record, swept)),
            td(metres(point.texel_m)), td(metres(point.bias_m)),
            td(window.empty() ? "none" : fmt::format("{} … {}", metres(window.low), metres(window.high))),
            td(css(verdict == "usable" ? "text" : "text fails"), verdict));
}

// The points of the sweep that lie on the diagram: in words, and as a table of those that are shown one by one.
Markup points_of(const PhaseDiagram& d, const ShownPoints& shown) {
  if (d.points.empty()) return "";
  size_t on = 0, usable = 0;
  Markup rows;
  for (const PhasePoint& point : d.points) {
    if (!point.left_out.empty()) continue;
    ++on;
    const Interval window = d.usable(d.nearest_row(point.texel_m));
    const std::string_view verdict = verdict_of(window, point.bias_m);
    usable += verdict == "usable";
    const auto& all = shown.results.points;
    const auto record = std::find_if(all.begin(), all.end(), [&](const auto& p) { return p.id == point.point; });
    if (record != all.end()) rows += point_on_diagram(point, *record, shown.results.info.swept, window, verdict);
  }
  Markup words = prose(
      "{} of the {} point{} of {} {} on the diagram, as rings; with the bias as set, {} of them {} usable at every "
      "placement of the grid. A ring lies at the width of its point's texel and {}; what lies outside its own map is "
      "not on the diagram.",
      on, d.points.size(), d.points.size() == 1 ? "" : "s", d.part.empty() ? "this sweep" : "part " + d.part,
      on == 1 ? "is" : "are", usable, usable == 1 ? "is" : "are",
      by_bias("its constant bias as set", "its recommended constant bias"));
  if (on < d.points.size())
    words += prose(
        " The diagram is of {}. Points with other settings are not on it, because other texel sizes and biases are "
        "usable for them: {}.",
        d.technique, left_out_text(d));
  if (rows.empty()) return paragraph(words);
  const Markup head = th("Point") + th(css("text"), "Settings") +
                      heads({"Texel", "Bias as set", "Usable at the nearest texel size"}) + th(css("text"), "That is");
  return paragraph(words) + folded("more", false, prose("The sweep's points on the diagram"),
                                   div(css("scroll"), table("numbers", head, rows)));
}

}  // namespace

std::string metres(double m) { return m < 1 ? fmt::format("{} mm", number(1000 * m)) : fmt::format("{} m", number(m)); }

nlohmann::json phase_data(const PhaseDiagram& d) {
  nlohmann::json phase{{"bias_m", series(d.bias_m)},
                       {"acne_bound", finite(d.acne_bound)},
                       {"peter_panning_bound", finite(d.peter_panning_bound)},
                       {"law_at_bound", finite(d.law_at_bound)},
                       {"law_steepest", finite(d.law_steepest)},
                       {"render", d.render},
                       {"per_metre", finite(1 / d.metres_per_bias)},
                       {"rows", nlohmann::json::array()},
                       {"points", nlohmann::json::array()}};
  for (const PhaseRow& row : d.rows) {
    nlohmann::json json{{"resolution", row.resolution}, {"texel_m", finite(row.texel_m)}};
    for (const PhaseSeries& one : phase_series()) json[one.name] = series(row.*one.values);
    if (const Interval worst = d.usable(row); !worst.empty()) json["usable"] = {worst.low, worst.high};
    phase["rows"].push_back(std::move(json));
  }
  for (const PhasePoint& point : d.points)
    if (point.left_out.empty())
      phase["points"].push_back(
          {{"id", point.point}, {"texel_m", finite(point.texel_m)}, {"bias_m", finite(point.bias_m)}});
  return phase;
}

namespace {

Markup chart_of(size_t index) {
  return chart_place(index == 0 ? std::string("phase") : fmt::format("phase-{}", index + 1),
                     "Texel size against a constant bias. Hatched: usable at every placement of the texel grid. "
                     "Red line: acne meets its bound; blue line: Peter Panning meets its bound (solid: worst "
                     "placement, dashed: mean). Move over the figure for all causes; click for the command that "
                     "renders a point.");
}

}  // namespace

bool has_diagram(const Results& results) {
  return std::any_of(results.phases.begin(), results.phases.end(),
                     [](const PhaseDiagram& diagram) { return diagram.refused.empty(); });
}

Markup first_diagram() { return chart_of(0); }

Markup phase_figure(const PhaseDiagram& d, size_t index, const Markup& points, bool with_chart) {
  Markup sentences;
  for (const std::string& sentence : phase_words(d)) sentences += paragraph(sentence);
  const int64_t placements = placements_of(d);
  return sentences + (with_chart ? chart_of(index) : "") + points + texel_sizes(d) +
         paragraph(
             css("small"),
             prose("{} receivers of a picture of {} × {} pixels. Each texel size is measured at {} placements of its "
                   "grid, all from one set of first hits. Colour: the cause with the largest share; the stronger, the "
                   "larger the error. The largest error of all placements may be a tenth more than the largest of "
                   "these {}. The error is that on an exact map: what the depth format and the rasteriser add is not "
                   "in it.",
                   number(d.receivers), d.width_px, d.height_px, placements, placements));
}

Markup phase_section(const ShownPoints& shown) {
  if (shown.all.phases.empty()) return "";
  Markup out;
  size_t index = 0;
  for (const PhaseDiagram& diagram : shown.all.phases) {
    if (!diagram.part.empty()) out += element("h3", diagram.part) + "\n";
    if (!diagram.refused.empty()) {
      out += paragraph(prose("There is no phase diagram: {}.", diagram.refused));
      continue;
    }
    out += phase_figure(diagram, index, points_of(diagram, shown), index > 0);
    ++index;
  }
  return section("phase", "Texel size and bias", out);
}

}  // namespace noonmark::report
