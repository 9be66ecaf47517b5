#include "compare/report/function_grid.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "compare/judge/curve_reading.h"
#include "compare/results/curve_fields.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"

namespace noonmark::report {
namespace {

constexpr std::string_view resolutions[] = {"map.resolution"};
constexpr std::string_view extents[] = {"map.extent_m", "map.extent_scale", "map.fit"};

// Takes the first of the preferred settings out of the list; empty if it has none of them.
std::string taken(std::vector<std::string>& names, std::span<const std::string_view> preferred) {
  const auto found = std::find_first_of(names.begin(), names.end(), preferred.begin(), preferred.end());
  if (found == names.end()) return "";
  std::string name = *found;
  names.erase(found);
  return name;
}

constexpr size_t most_letters = 12;  // of a value that stands beside or above a chart

// The first setting whose values are so short.
std::string taken_short(std::vector<std::string>& names, std::span<const PointRecord> part) {
  for (const std::string& name : names) {
    const std::vector<std::string> values = values_of(part, name);
    if (std::all_of(values.begin(), values.end(), [](const auto& v) { return setting_text(v).size() <= most_letters; }))
      return taken(names, std::vector<std::string_view>{std::string_view(name)});
  }
  return "";
}

std::vector<std::string> some_of(std::vector<std::string> values, bool& thinned) {
  if (values.size() <= most_in_line) return values;
  thinned = true;
  std::vector<std::string> out;
  for (size_t i = 0; i < most_in_line; ++i) out.push_back(values[i * (values.size() - 1) / (most_in_line - 1)]);
  return out;
}

// cause_rows.end() if it is no built-in cause.
auto row_of(std::string_view name) {
  return std::find_if(cause_rows.begin(), cause_rows.end(), [&](const CauseRow& row) { return row.name == name; });
}

// The causes that a figure can stack: those of the error against the hard truth, sums in place of their parts.
std::vector<CauseColor> stacked_causes(const Results& results) {
  std::vector<CauseColor> causes;
  const auto add = [&](std::string_view name) {
    const auto named = [&](const CauseColor& color) { return color.name == name; };
    const std::vector<CauseColor> all = causes_of(results.points);
    const auto color = std::find_if(all.begin(), all.end(), named);
    if (color != all.end() && std::none_of(causes.begin(), causes.end(), named)) causes.push_back(*color);
  };
  const auto add_whole = [&](std::string_view name) {
    const auto row = row_of(name);
    if (row == cause_rows.end() || row->place != CausePlace::light)
      add(row == cause_rows.end() || row->sum.empty() ? name : row->sum);
  };
  for (const std::string& metric : results.info.plot) add_whole(metric);
  for (const CauseColor& color : causes_of(results.points)) add_whole(color.name);
  return causes;
}

// The numbers of a cause along a curve, of a sum those of its parts together. Filter and displacement do not depend on the bias.
std::vector<double> along(const PointRecord& point, const BiasCurve& curve, std::string_view cause) {
  const bool fixed = cause == "filter" || cause == "displacement";
  std::vector<double> values(curve.bias_depth.size(), fixed ? metric_of(point, std::string(cause)) : 0);
  for (const CurveSeries& series : curve_series()) {
    const auto row = row_of(series.name);
    if (series.name != cause && (row == cause_rows.end() || row->sum != cause)) continue;
    const std::vector<double>& part = series.of(curve);
    for (size_t i = 0; i < std::min(values.size(), part.size()); ++i) values[i] += part[i];
  }
  return values;
}

// A stored curve can be anything; one that is drawn has a number at each of ascending biases.
bool can_be_drawn(const BiasCurve& curve) {
  const std::vector<double>& bias = curve.bias_depth;
  const auto positive = [](double value) { return std::isfinite(value) && value > 0; };
  return !bias.empty() && curve.error.size() == bias.size() && positive(bias.back() * curve.m_per_depth) &&
         bias.front() >= 0 && std::is_sorted(bias.begin(), bias.end()) && positive(curve.m_per_depth) &&
         positive(curve.texels_per_depth);
}

FunctionCell cell_of(std::vector<const PointRecord*> points, const std::vector<CauseColor>& causes) {
  FunctionCell cell;
  cell.points = std::move(points);
  if (cell.points.empty()) return cell;
  const PointRecord& point = *cell.points.front();
  cell.texel_m = metric_of(point, "texel_m");
  if (point.curve && can_be_drawn(*point.curve)) {
    cell.curve = &*point.curve;
    cell.texel_m = cell.curve->m_per_depth / cell.curve->texels_per_depth;
    for (const double depth : cell.curve->bias_depth) cell.at.push_back(depth * cell.curve->m_per_depth);
    cell.error = cell.curve->error;
    for (const CauseColor& cause : causes) cell.parts.push_back(along(point, *cell.curve, cause.name));
    return cell;
  }
  for (const PointRecord* one : cell.points) cell.error.push_back(metric_of(*one, "error"));
  for (const CauseColor& cause : causes) {
    cell.parts.emplace_back();
    for (const PointRecord* one : cell.points) cell.parts.back().push_back(metric_of(*one, std::string(cause.name)));
  }
  return cell;
}

using Part = std::span<const PointRecord>;

// The swept settings of a part, by what they are in its grids.
struct Axes {
  std::string column, row, inner;
  std::vector<std::string> switched;
};

Axes axes_of(Part part, const std::vector<std::string>& swept) {
  Axes axes;
  std::vector<std::string> names;
  for (const std::string& name : swept)
    if (values_of(part, name).size() > 1) names.push_back(name);
  const auto curved = std::find_if(part.begin(), part.end(), [](const auto& point) { return point.curve.has_value(); });
  const bool curve = curved != part.end();
  const auto bias = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
    return curve ? name == curved->curve->parameter : name.starts_with("bias.");
  });
  if (bias != names.end()) {
    axes.inner = *bias;
    names.erase(bias);
  } else if (!curve) {
    axes.inner = taken(names, resolutions);
    if (axes.inner.empty()) axes.inner = taken_short(names, part);
  }
  axes.column = taken(names, resolutions);
  axes.row = taken(names, extents);
  if (axes.column.empty()) std::swap(axes.column, axes.row);
  if (axes.column.empty()) axes.column = taken_short(names, part);
  if (axes.row.empty()) axes.row = taken_short(names, part);
  axes.switched = names;
  return axes;
}

// The grids of one part, one for each combination of its switches.
void add_grids(Part part, const Axes& axes, FunctionFigure& figure) {
  using Key = std::vector<std::string>;
  std::map<Key, std::vector<const PointRecord*>> cells;  // by the values of the switches, the row and the column
  std::vector<Key> choices;
  for (const PointRecord& point : part) {
    Key key;
    for (const std::string& name : figure.switches) {
      const bool here = std::find(axes.switched.begin(), axes.switched.end(), name) != axes.switched.end();
      key.push_back(name == "part" ? point.part : here ? setting_of(point, name) : "");
    }
    if (std::find(choices.begin(), choices.end(), key) == choices.end()) choices.push_back(key);
    key.insert(key.end(), {setting_of(point, axes.row), setting_of(point, axes.column)});
    cells[key].push_back(&point);
  }
  const auto values = [&](const std::string& name) {
    return name.empty() ? Key{""} : some_of(values_of(part, name), figure.thinned);
  };
  size_t charts = 0;
  for (const FunctionGrid& grid : figure.grids) charts += grid.cells.size();
  for (const Key& chosen : choices) {
    FunctionGrid grid{chosen, axes.column, axes.row, axes.inner, values(axes.column), values(axes.row), {}};
    charts += grid.columns.size() * grid.rows.size();
    if (charts > most_charts) {
      figure.thinned = true;
      break;
    }
    for (const std::string& row : grid.rows)
      for (const std::string& column : grid.columns) {
        Key key = chosen;
        key.insert(key.end(), {row, column});
        std::vector<const PointRecord*>& points = cells[key];
        const auto value = [&](const PointRecord* p) { return number_of(setting_of(*p, axes.inner)).value_or(0); };
        std::stable_sort(points.begin(), points.end(), [&](auto* a, auto* b) { return value(a) < value(b); });
        grid.cells.push_back(cell_of(points, figure.causes));
      }
    figure.grids.push_back(std::move(grid));
  }
}

// Leaves out the causes that are 0 everywhere. Without any the figure has no grid.
void drop_zeros(FunctionFigure& figure) {
  const auto cells = [&](const auto& use) {
    for (FunctionGrid& grid : figure.grids)
      for (FunctionCell& cell : grid.cells)
        if (!cell.parts.empty()) use(cell.parts);
  };
  for (size_t k = figure.causes.size(); k-- > 0;) {
    bool any = false;
    cells([&](const auto& parts) {
      any = any || std::any_of(parts[k].begin(), parts[k].end(), [](double value) { return value > least_share; });
    });
    if (any) continue;
    figure.causes.erase(figure.causes.begin() + static_cast<std::ptrdiff_t>(k));
    cells([&](auto& parts) { parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(k)); });
  }
  if (figure.causes.empty()) figure.grids.clear();
}

}  // namespace

FunctionFigure function_figure(const Results& results) {
  FunctionFigure figure;
  if (judges_frames(results.points)) return figure;
  figure.causes = stacked_causes(results);
  std::vector<Part> parts;
  for (auto begin = results.points.begin(); begin != results.points.end();) {
    const auto end = std::find_if(begin, results.points.end(), [&](const auto& p) { return p.part != begin->part; });
    parts.emplace_back(begin, end);
    begin = end;
  }
  if (parts.size() > 1) figure.switches.push_back("part");
  std::vector<Axes> axes;
  for (const Part& part : parts)
    for (const std::string& name : axes.emplace_back(axes_of(part, results.info.swept)).switched)
      if (std::find(figure.switches.begin(), figure.switches.end(), name) == figure.switches.end())
        figure.switches.push_back(name);
  for (size_t i = 0; i < parts.size(); ++i) add_grids(parts[i], axes[i], figure);
  drop_zeros(figure);
  return figure;
}

const FunctionCell* largest_usable(const FunctionGrid& grid) {
  const FunctionCell* largest = nullptr;
  for (const FunctionCell& cell : grid.cells)
    if (cell.curve && usable_window(*cell.points.front()) && (!largest || cell.texel_m > largest->texel_m))
      largest = &cell;
  return largest;
}

}  // namespace noonmark::report
