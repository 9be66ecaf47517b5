#include "compare/report/function_shapes.h"

#include <fmt/format.h>

#include "compare/judge/curve_reading.h"

namespace noonmark::report {

Attribute at(Name name, double value) { return Attribute(name, fmt::format("{:.0f}", value)); }
Attribute fill(const std::string& color) { return Attribute("fill", fmt::format("var(--{})", color)); }
Attribute stroke(const std::string& color) { return Attribute("stroke", fmt::format("var(--{})", color)); }

Attribute unless(bool usual, Name name, const std::string& value) {
  return usual ? Attribute(name, false) : Attribute(name, value);
}

Markup line_in_box(double x1, double y1, double x2, double y2, const std::string& color, const char* dashes,
                   double width) {
  return element("line", at("x1", x1), at("y1", y1), at("x2", x2), at("y2", y2), stroke(color),
                 unless(dashes == std::string("none"), "stroke-dasharray", dashes),
                 unless(width == 1, "stroke-width", fmt::format("{}", width)),
                 Attribute("vector-effect", "non-scaling-stroke"));
}

namespace {

double part_of(const FunctionCell& cell, size_t cause, size_t i) {
  const double value = cell.parts[cause][i];
  return std::isfinite(value) ? std::max(value, 0.0) : 0;
}

double sum_of(const FunctionCell& cell, size_t causes, size_t i) {
  double sum = 0;
  for (size_t k = 0; k < causes; ++k) sum += part_of(cell, k, i);
  return sum;
}

}  // namespace

// Biases from a tenth of the least texel to ten of the largest, and all windows and biases as set. Shares up to the largest
// without acne, because acne at a small bias is a wall that would press all else to the ground.
FunctionScale function_scale(const FunctionFigure& figure) {
  FunctionScale scale;
  double low = INFINITY, high = 0, first = INFINITY, last = 0;
  const auto reach = [&](double from, double to) {
    if (from > 0) low = std::min(low, from);
    high = std::max(high, to);
  };
  each_cell(figure, [&](const FunctionCell& cell) {
    if (!cell.curve) return;
    first = std::min(first, *std::upper_bound(cell.at.begin(), cell.at.end(), 0.0));
    last = std::max(last, cell.at.back());
    reach(cell.texel_m / 10, cell.texel_m * 10);
    if (const auto window = usable_window(*cell.points.front()))
      reach(window->low * cell.curve->m_per_depth / 2, window->high * cell.curve->m_per_depth * 2);
    for (const PointRecord* point : cell.points)
      if (const auto set = bias_as_set(*point))
        reach(*set * cell.curve->m_per_depth / 2, *set * cell.curve->m_per_depth * 2);
  });
  if (last > 0) scale.low = std::max(low, first), scale.high = std::max(std::min(high, last), 2 * scale.low);
  each_cell(figure, [&](const FunctionCell& cell) {
    for (size_t i = 0; i < cell.error.size(); ++i) {
      if (cell.curve && (cell.at[i] < scale.low || cell.at[i] > scale.high)) continue;
      double share = 0;
      for (size_t k = 0; k < figure.causes.size(); ++k)
        if (!cell.curve || figure.causes[k].name != "acne") share += part_of(cell, k, i);
      scale.top = std::max(scale.top, 1.1 * share);
    }
    if (cell.curve) scale.top = std::max({scale.top, 4 * cell.curve->acne_bound, 4 * cell.curve->peter_panning_bound});
  });
  scale.top = std::clamp(scale.top, 1e-6, 10.0);  // the causes of one receiver can be more than 1 together
  return scale;
}

std::vector<size_t> drawn_entries(const FunctionCell& cell, const FunctionScale& scale) {
  std::vector<size_t> out;
  for (size_t i = 0; i < cell.at.size(); ++i)
    if (cell.at[i] > 0 && (i + 1 == cell.at.size() || cell.at[i + 1] >= scale.low) &&
        (i == 0 || cell.at[i - 1] <= scale.high))
      out.push_back(i);
  return out;
}

namespace {

constexpr double box = FunctionScale::box, zero_end = FunctionScale::zero_end;

// A path through points of whole numbers: "M70 980l13 -4 ...". Points amid a level line are left out.
std::string path_through(const std::vector<std::pair<double, double>>& points) {
  std::string path;
  long x = 0, y = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const long next_x = std::lround(points[i].first), next_y = std::lround(points[i].second);
    if (i > 0 && i + 1 < points.size() && next_y == y && std::lround(points[i + 1].second) == y) continue;
    path += i == 0 ? fmt::format("M{} {}l0 0", next_x, next_y) : fmt::format(" {} {}", next_x - x, next_y - y);
    x = next_x, y = next_y;
  }
  return path;
}

Markup rect(double x, double y, double width, double height, const Attribute& color) {
  return element("rect", at("x", x), at("y", y), at("width", std::max(width, 0.0)), at("height", std::max(height, 0.0)),
                 color);
}

// The layers of a curve, the upper ones first, because each goes down to the ground and the next one covers it.
Markup layers(const FunctionCell& cell, const FunctionFigure& figure, const FunctionScale& scale) {
  Markup out;
  const std::vector<size_t> entries = drawn_entries(cell, scale);
  for (size_t k = figure.causes.size(); k-- > 0;) {
    std::vector<std::pair<double, double>> edge;
    bool any = false;
    for (const size_t i : entries) {
      any = any || part_of(cell, k, i) > 0;
      edge.emplace_back(scale.x(cell.at[i]), scale.y(sum_of(cell, k + 1, i)));
    }
    const std::string color = fmt::format("c-{}", figure.causes[k].name);
    if (any) {
      edge.insert(edge.begin(), {edge.front().first, box});
      edge.emplace_back(edge.back().first, box);
      out += element("path", Attribute("d", path_through(edge) + "z"), fill(color),
                     Attribute("data-cause", figure.causes[k].name));
    }
    if (cell.at.front() == 0 && part_of(cell, k, 0) > 0) {
      const double y = scale.y(sum_of(cell, k + 1, 0));
      out += rect(0, y, zero_end, box - y, fill(color));
    }
  }
  const auto error = [&](std::string_view name, const std::vector<double>& values, const char* dashes) {
    std::vector<std::pair<double, double>> line;
    for (const size_t i : entries) line.emplace_back(scale.x(cell.at[i]), scale.y(values[i]));
    return element("path", Attribute("d", path_through(line)), Attribute("fill", "none"), stroke("ink"),
                   Attribute("data-line", name), Attribute("stroke-dasharray", dashes),
                   Attribute("stroke-width", "1.2"), Attribute("vector-effect", "non-scaling-stroke"));
  };
  out += error("error", cell.error, "none");
  if (const Band& band = cell.curve->error_band; band.worst.size() == cell.at.size())
    out += error("worst", band.worst, "1 2");
  return out;
}

Markup curve_shapes(const FunctionCell& cell, const FunctionFigure& figure, const FunctionScale& scale) {
  const BiasCurve& curve = *cell.curve;
  Markup out, strip;
  if (const auto window = usable_window(*cell.points.front())) {
    const double from = scale.x(window->low * curve.m_per_depth), to = scale.x(window->high * curve.m_per_depth);
    out += rect(from, 0, to - from, box, fill("window"));
    strip = rect(from, 0, to - from, 24, fill("good"));
  }
  out += layers(cell, figure, scale) + strip;
  for (const double bound : {curve.acne_bound, curve.peter_panning_bound})
    out += line_in_box(0, scale.y(bound), box, scale.y(bound), "ink", "2 3");
  for (const PointRecord* point : cell.points)
    if (const auto set = bias_as_set(*point)) {
      const double x = scale.x(*set * curve.m_per_depth);
      out += line_in_box(x, 0, x, box, "accent", "5 3", 1.6);
    }
  return out;
}

Markup bar_shapes(const FunctionCell& cell, const FunctionFigure& figure, const FunctionScale& scale) {
  Markup out;
  const double step = box / static_cast<double>(std::max<size_t>(cell.points.size(), 1));
  for (size_t i = 0; i < cell.points.size(); ++i) {
    const double left = (static_cast<double>(i) + 0.15) * step, right = (static_cast<double>(i) + 0.85) * step;
    for (size_t k = figure.causes.size(); k-- > 0;)
      if (part_of(cell, k, i) > 0) {
        const double y = scale.y(sum_of(cell, k + 1, i));
        out += rect(left, y, right - left, box - y, fill(fmt::format("c-{}", figure.causes[k].name)));
      }
    if (std::isfinite(cell.error[i]))
      out += line_in_box(left, scale.y(cell.error[i]), right, scale.y(cell.error[i]), "ink", "none", 1.2);
  }
  return out;
}

}  // namespace

Markup function_shapes(const FunctionCell& cell, const FunctionFigure& figure, const FunctionScale& scale) {
  return cell.curve ? curve_shapes(cell, figure, scale) : bar_shapes(cell, figure, scale);
}

}  // namespace noonmark::report
