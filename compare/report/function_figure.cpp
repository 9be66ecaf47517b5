#include "compare/report/function_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "compare/judge/curve_reading.h"
#include "compare/report/blocks.h"
#include "compare/report/function_shapes.h"
#include "compare/report/text.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"

namespace noonmark::report {
namespace function_drawing {
namespace {

constexpr double box = FunctionScale::box;
constexpr size_t most_tips = 32;  // numbers of a chart that a pointer finds

// Powers of ten from the least to the most.
std::vector<double> decades(double least, double most) {
  std::vector<double> out;
  if (!(least > 0) || !std::isfinite(most)) return out;
  for (double e = std::ceil(std::log10(least) - 1e-9); e <= std::log10(most); ++e) out.push_back(std::pow(10, e));
  return out;
}

// The shares that have a line and a label, from the top downward and far enough from each other.
std::vector<double> shares_on(const FunctionScale& scale) {
  constexpr double apart = 170;  // of the box; a chart is at least 80 pixels high, a label 12
  std::vector<double> out;
  double last = -box;
  for (double e = 0; e > -6; --e)
    for (const double step : {5.0, 2.0, 1.0})
      if (const double share = step * std::pow(10, e);
          share <= scale.top && scale.y(share) - last > apart && box - scale.y(share) > apart)
        out.push_back(share), last = scale.y(share);
  return out;
}

// ---- where charts and texts stand. In pixels of the picture.
struct Frame {
  double width = 0;
  size_t columns = 1;  // of a line of charts
  double left = 0;     // room for the labels of the shares
  double height = 0;   // of a chart
  bool wide = false;
};

struct Look {
  const char* anchor = "start";
  int size = 12, weight = 400;
};
// Stands in an element with texts_around(), which has what all texts share.
Markup text_at(double x, double y, const Markup& content, const std::string& color, const Look& look = {}) {
  return element("text", at("x", x), at("y", y),
                 unless(look.anchor == std::string("start"), "text-anchor", look.anchor),
                 unless(look.size == 12, "font-size", std::to_string(look.size)),
                 unless(look.weight == 400, "font-weight", std::to_string(look.weight)), fill(color), content);
}
// A line of the card's colour around each letter keeps texts apart from what they stand on.
Markup texts_around(const Markup& texts) {
  return element("g", Attribute("font-family", "var(--sans)"), Attribute("font-size", 12), stroke("card"),
                 Attribute("stroke-width", 3), Attribute("stroke-linejoin", "round"),
                 Attribute("paint-order", "stroke"), texts);
}

std::string value_text(const std::string& name, const std::string& value, const Results& results) {
  const std::string unit = swept_unit(name, results);
  return setting_text(value) + (unit.empty() ? "" : std::string(" ") + unit);
}

class Drawing {
 public:
  Drawing(const FunctionFigure& figure, const Results& results)
      : figure_(figure), results_(results), scale_(function_scale(figure)) {}

  Markup grid(size_t index) const {
    const FunctionGrid& grid = figure_.grids[index];
    const size_t columns = grid.columns.size(), rows = grid.rows.size();
    const double height =
        rows == 1 ? (columns == 1 ? 300 : 220) : std::clamp(300.0 / static_cast<double>(rows), 80.0, 150.0);
    const Frame wide{1060, columns, grid.row.empty() ? 48.0 : 112.0, height, true};
    const Frame narrow{360, std::min<size_t>(columns, 2), 44, columns == 1 ? 200.0 : 110.0, false};
    std::string chosen;
    for (const std::string& value : grid.chosen) chosen += (chosen.empty() ? "" : "|") + value;
    return div(css("function-grid"), Attribute("data-chosen", chosen), sentence(grid), picture(index, wide),
               picture(index, narrow)) +
           "\n";
  }

  const FunctionScale& scale() const { return scale_; }

 private:
  static bool texels_differ(const FunctionGrid& grid) {
    return std::any_of(grid.cells.begin(), grid.cells.end(), [&](const FunctionCell& cell) {
      return !cell.points.empty() && cell.texel_m != grid.cells.front().texel_m;
    });
  }
  // "Largest texel with a usable bias: 156 mm (resolution 256 texels, extent 40 m), from 0.201 m to 0.605 m".
  Markup sentence(const FunctionGrid& grid) const {
    const FunctionCell* const cell = largest_usable(grid);
    if (!cell || (grid.cells.size() > 1 && !texels_differ(grid))) return "";
    const Interval window = *usable_window(*cell->points.front());
    std::vector<std::string> names;
    for (const std::string& name : {grid.column, grid.row})
      if (!name.empty()) names.push_back(name);
    const std::string where = settings_phrase(*cell->points.front(), names);
    if (grid.cells.size() == 1)
      return paragraph(css("facts"), "The bias is usable from ", bold(bias_words(window.low, *cell->curve)), " to ",
                       bold(bias_words(window.high, *cell->curve)), ".");
    return paragraph(css("facts"), "Largest texel with a usable bias: ", bold(length_text(cell->texel_m)),
                     where.empty() ? "" : fmt::format(" ({})", where), ". There the bias is usable from ",
                     bold(bias_words(window.low, *cell->curve)), " to ", bold(bias_words(window.high, *cell->curve)),
                     ".");
  }
  static std::string bias_words(double depth, const BiasCurve& curve) {
    return fmt::format("{} m ({} texels)", number(depth * curve.m_per_depth), number(depth * curve.texels_per_depth));
  }

  Markup picture(size_t index, const Frame& frame) const {
    const FunctionGrid& grid = figure_.grids[index];
    const double gap = 14, head = 36, foot = 20;
    const double width = (frame.width - frame.left) / static_cast<double>(frame.columns) - gap;
    Markup shapes, texts, targets;
    if (frame.wide) shapes += element("defs", axes(index), each_shape(index));
    double y = 0;
    for (size_t row = 0; row < grid.rows.size(); ++row) {
      if (!grid.row.empty()) {
        const std::string value = value_text(grid.row, grid.rows[row], results_);
        if (frame.wide) {
          texts += text_at(0, y + head + 14, setting_label(grid.row), "soft", {"start", 13});
          texts += text_at(0, y + head + 31, value, "ink", {"start", 14, 600});
        } else {
          y += 24;
          texts += text_at(0, y, setting_label(grid.row) + " " + value, "ink", {"start", 14, 600});
        }
      }
      for (size_t column = 0; column < grid.columns.size(); ++column) {
        const size_t in_line = column % frame.columns;
        if (in_line == 0 && column > 0) y += head + frame.height + foot;
        const double x = frame.left + static_cast<double>(in_line) * (width + gap);
        const size_t i = row * grid.columns.size() + column;
        const bool last = frame.wide ? row + 1 == grid.rows.size() : column + frame.columns >= grid.columns.size();
        const auto [one, words] = chart(index, i, {x, y + head, width, frame.height}, in_line == 0, last);
        shapes += one;
        texts += words;
        targets += target(grid.cells[i], i, {x, y + head, width, frame.height}, frame.wide);
        if (!grid.column.empty()) {
          const std::string& value = grid.columns[column];
          // A word says not by itself what it is of: "filter box".
          const std::string of = number_of(value) ? "" : setting_label(grid.column) + " ";
          texts += text_at(x, y + head - 20, of + value_text(grid.column, value, results_), "ink", {"start", 13, 600});
        }
      }
      y += head + frame.height + (frame.wide && row + 1 < grid.rows.size() ? 6 : foot);
    }
    const std::string axis = scale_.high > 0      ? "bias (m), and in texels above"
                             : grid.inner.empty() ? ""
                                                  : setting_label(grid.inner);
    if (!axis.empty()) texts += text_at(frame.width - gap, y += 16, axis, "soft", {"end", 12});
    y += 4;
    return element("svg", css(frame.wide ? "wide" : "narrow"),
                   Attribute("viewBox", fmt::format("0 0 {:.0f} {:.0f}", frame.width, y)), Attribute("width", "100%"),
                   shapes, texts_around(texts),
                   element("line", css("cursor"), stroke("ink"), Attribute("visibility", "hidden")), targets);
  }

  struct Place {
    double x, y, width, height;
  };

  // The lines of the axes, which every chart of the grid has.
  Markup axes(size_t index) const {
    Markup lines = line_in_box(0, box, box, box, "faint", "none");
    for (const double share : shares_on(scale_))
      lines += line_in_box(0, scale_.y(share), box, scale_.y(share), "grid", "none");
    if (scale_.high > 0)
      for (const double bias : decades(scale_.low, scale_.high))
        lines += line_in_box(scale_.x(bias), 0, scale_.x(bias), box, "grid", "none");
    return element("g", Attribute("id", fmt::format("function-{}", index)), lines);
  }
  Markup each_shape(size_t index) const {
    Markup out;
    const FunctionGrid& grid = figure_.grids[index];
    for (size_t i = 0; i < grid.cells.size(); ++i) {
      const FunctionCell& cell = grid.cells[i];
      if (cell.points.empty()) continue;
      out += element("g", Attribute("id", fmt::format("function-{}-{}", index, i)),
                     function_shapes(cell, figure_, scale_));
    }
    return out;
  }

  std::pair<Markup, Markup> chart(size_t index, size_t i, const Place& place, bool shares, bool biases) const {
    const FunctionGrid& grid = figure_.grids[index];
    const FunctionCell& cell = grid.cells[i];
    const auto use = [&](const std::string& id) {
      return element("use", Attribute("href", "#" + id),
                     Attribute("transform", fmt::format("translate({:.1f} {:.1f}) scale({:.5f} {:.5f})", place.x,
                                                        place.y, place.width / box, place.height / box)));
    };
    const auto x = [&](double of_box) { return place.x + of_box * place.width / box; };
    const bool narrow = place.width < 170;  // then there is no room for all words
    Markup shapes = use(fmt::format("function-{}", index)), texts;
    if (shares) {
      texts += text_at(place.x - 6, place.y + place.height + 4, "0", "soft", {"end"});
      for (const double share : shares_on(scale_))
        texts += text_at(place.x - 6, place.y + scale_.y(share) * place.height / box + 4, quantity(share, "fraction"),
                         "soft", {"end"});
    }
    if (cell.points.empty())
      return {shapes, texts + text_at(x(box / 2), place.y + place.height / 2, "not measured", "faint", {"middle"})};
    shapes += use(fmt::format("function-{}-{}", index, i));
    if (cell.curve && biases) {
      texts += text_at(x(scale_.x(0)), place.y + place.height + 15, "0", "soft", {"middle"});
      for (const double bias : decades(scale_.low, scale_.high))
        if (x(scale_.x(bias)) > place.x + 30)
          texts += text_at(x(scale_.x(bias)), place.y + place.height + 15, number(bias), "soft", {"middle"});
    }
    if (const double most = *std::max_element(cell.error.begin(), cell.error.end());
        !narrow && cell.curve && most > scale_.top)
      texts += text_at(x(FunctionScale::log_begin) + 3, place.y + 12, "↑ " + quantity(most, "fraction", 2), "ink",
                       {"start", 10});
    texts += cell.curve ? texels(cell, place) + window_words(cell, place) : values(cell, grid.inner, place, biases);
    if (std::isfinite(cell.texel_m)) {
      const bool largest = texels_differ(grid) && &cell == largest_usable(grid);
      texts += text_at(place.x + place.width, place.y - 20, (narrow ? "" : "texel ") + length_text(cell.texel_m),
                       largest ? "good" : "soft", {"end", 12, largest ? 700 : 400});
    }
    return {shapes, texts};
  }

  // Ticks at powers of ten of the texel.
  Markup texels(const FunctionCell& cell, const Place& place) const {
    Markup out;
    if (!(cell.texel_m > 0)) return out;
    std::string ticks;
    for (const double count : decades(scale_.low / cell.texel_m, scale_.high / cell.texel_m)) {
      const double x = place.x + scale_.x(count * cell.texel_m) * place.width / box;
      if (x > place.x + place.width - 4) continue;
      ticks += fmt::format("M{:.0f} {:.0f}v4", x, place.y - 4);
      if (count >= 0.1) out += text_at(x, place.y - 6, number(count), "faint", {"middle", 10});
    }
    if (!ticks.empty()) out += element("path", Attribute("d", ticks), stroke("faint"), Attribute("stroke-width", 1));
    return out;
  }
  Markup window_words(const FunctionCell& cell, const Place& place) const {
    const PointRecord& point = *cell.points.front();
    const std::optional<Interval> window = usable_window(point);
    const auto line_of = [&](double center, double y, const std::string& words, const char* color) {
      const double half = std::min(3.1 * static_cast<double>(words.size()), place.width / 2);
      return text_at(std::clamp(center, place.x + half, place.x + place.width - half), y, words, color,
                     {"middle", 11, 600});
    };
    if (!window)
      return line_of(place.x + place.width / 2, place.y + 18,
                     hides_window(point) ? "window not known" : "no usable bias", "bad");
    const BiasCurve& curve = *cell.curve;
    const double center =
        place.x + (scale_.x(window->low * curve.m_per_depth) + scale_.x(window->high * curve.m_per_depth)) / 2 *
                      place.width / box;
    return line_of(center, place.y + 17,
                   fmt::format("{} … {} m", number(window->low * curve.m_per_depth),
                               number(window->high * curve.m_per_depth)),
                   "good") +
           line_of(center, place.y + 31,
                   fmt::format("{} … {} texels", number(window->low * curve.texels_per_depth),
                               number(window->high * curve.texels_per_depth)),
                   "good");
  }
  // The names of the bars.
  Markup values(const FunctionCell& cell, const std::string& inner, const Place& place, bool labels) const {
    Markup out;
    if (inner.empty() || !labels) return out;
    const double step = place.width / static_cast<double>(cell.points.size());
    const size_t every = static_cast<size_t>(std::ceil(36 / step));  // so that names of few letters do not touch
    for (size_t i = 0; i < cell.points.size(); i += every)
      out += text_at(place.x + (static_cast<double>(i) + 0.5) * step, place.y + place.height + 15,
                     setting_text(setting_of(*cell.points[i], inner)), "soft", {"middle", 11});
    return out;
  }

  // What the pointer finds: places in the box, their numbers, and the points with their places.
  // They stand in the wide picture alone.
  Markup target(const FunctionCell& cell, size_t i, const Place& place, bool with_data) const {
    if (cell.points.empty()) return "";
    const auto found = [&](const auto&... data) {
      return element("rect", css("cell"), at("x", place.x), at("y", place.y), at("width", place.width),
                     at("height", place.height), Attribute("fill", "transparent"), Attribute("data-cell", i), data...);
    };
    if (!with_data) return found();
    std::string places, tips, points;
    const auto tip = [&](double x, const std::string& title, size_t entry) {
      places += fmt::format("{}{:.0f}", places.empty() ? "" : " ", x);
      tips += (tips.empty() ? "" : ";") + title;
      for (size_t k = 0; k < figure_.causes.size(); ++k) tips += "|" + quantity(cell.parts[k][entry], "fraction", 2);
      tips += "|" + quantity(cell.error[entry], "fraction", 2);
    };
    const double step = box / static_cast<double>(cell.points.size());
    for (size_t p = 0; p < cell.points.size(); ++p) {
      const double x = (static_cast<double>(p) + 0.5) * step;
      const std::optional<double> set = cell.curve ? bias_as_set(*cell.points[p]) : std::nullopt;
      points += fmt::format("{}{}:{:.0f}", points.empty() ? "" : " ", cell.points[p]->id,
                            cell.curve ? scale_.x(set.value_or(0) * cell.curve->m_per_depth) : x);
      if (!cell.curve) tip(x, settings_phrase(*cell.points[p], results_.info.swept), p);
    }
    if (cell.curve) {
      std::vector<size_t> entries = drawn_entries(cell, scale_);
      if (cell.at.front() == 0) entries.insert(entries.begin(), 0);
      const size_t every = entries.size() / most_tips + 1;
      for (size_t e = 0; e < entries.size(); e += every)
        tip(scale_.x(cell.at[entries[e]]), "bias " + bias_words(cell.curve->bias_depth[entries[e]], *cell.curve),
            entries[e]);
    }
    return found(Attribute("data-at", places), Attribute("data-tips", tips), Attribute("data-points", points));
  }

  const FunctionFigure& figure_;
  const Results& results_;
  FunctionScale scale_;
};

// A list of the values of each further setting.
Markup lists(const FunctionFigure& figure) {
  Markup out;
  for (size_t s = 0; s < figure.switches.size(); ++s) {
    std::vector<std::string> values;
    Markup options;
    for (const FunctionGrid& grid : figure.grids)
      if (const std::string& value = grid.chosen[s];
          !value.empty() && std::find(values.begin(), values.end(), value) == values.end()) {
        values.push_back(value);
        options += element("option", Attribute("value", value), setting_text(value));
      }
    out += element("label", setting_label(figure.switches[s]), element("select", options));
  }
  return div(css("controls js-only"), out);
}

Markup key(const std::string& color, const char* dashes, const std::string& words) {
  return span(element("svg", Attribute("viewBox", "0 0 26 10"), Attribute("aria-hidden", "true"),
                      line_in_box(0, 5, 26, 5, color, dashes, 1.6)),
              words);
}

Markup legend(const FunctionFigure& figure) {
  const PointRecord* first = nullptr;
  const FunctionCell* curved = nullptr;
  each_cell(figure, [&](const FunctionCell& cell) {
    if (!first) first = cell.points.front();
    if (cell.curve && !curved) curved = &cell;
  });
  Markup out;
  for (const CauseColor& cause : figure.causes) out += legend_entry(cause.name, cause.label);
  out += key("ink", "none", fmt::format("Error, mean |{} − R1|", judged_rung(*first)));
  if (!curved) return out;
  const BiasCurve& curve = *curved->curve;
  out += key("good", "none", "Usable bias");
  out += key("accent", "5 3", "Bias as set");
  std::string bounds = quantity(curve.acne_bound, "fraction");
  if (curve.peter_panning_bound != curve.acne_bound)
    bounds += " and " + quantity(curve.peter_panning_bound, "fraction");
  if (curve.placements > 1)
    out += key("ink", "1 2", fmt::format("Error at the worst of {} placements of the grid", curve.placements));
  return out + key("ink", "2 3", "Bound " + bounds);
}

}  // namespace
}  // namespace function_drawing

bool has_function_chart(const ShownPoints& shown) { return !function_figure(shown.results).grids.empty(); }

Markup function_chart(const ShownPoints& shown) {
  const FunctionFigure figure = function_figure(shown.results);
  if (figure.grids.empty()) return "";
  const function_drawing::Drawing drawing(figure, shown.results);
  Markup grids;
  for (size_t i = 0; i < figure.grids.size(); ++i) grids += drawing.grid(i);
  std::string names, causes;
  for (const CauseColor& cause : figure.causes) {
    names += std::string(cause.label) + "|";
    causes += std::string(cause.name) + "|";
  }
  const FunctionScale& scale = drawing.scale();
  const auto number_of_axis = [](Name name, double value) { return Attribute(name, fmt::format("{}", value)); };
  const bool curved = scale.high > 0;
  const std::string caption = fmt::format(
      "Share of counted receivers by cause, stacked, {}. Heights go with the square root of the share, so that small "
      "shares show.",
      curved ? "over the bias; what is higher than a chart is cut off" : "at each value");
  const Markup note =
      figure.thinned ? paragraph(css("small"), "Of many values some are shown, evenly chosen. The tables have all.")
                     : "";
  return element("figure", css("chart"), Attribute("id", "chart-function"), function_drawing::lists(figure), note,
                 div(css("legend"), function_drawing::legend(figure)),
                 div(css("plot"), number_of_axis("data-low", scale.low), number_of_axis("data-high", scale.high),
                     number_of_axis("data-top", scale.top), Attribute("role", "img"), Attribute("aria-label", caption),
                     Attribute("data-names", names + "Error"), Attribute("data-causes", causes), grids),
                 element("figcaption", caption)) +
         "\n";
}

}  // namespace noonmark::report
