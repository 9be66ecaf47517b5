#include "compare/results/quantities.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <unordered_set>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "compare/results/curve_fields.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

// A number that is computed from a curve, as a function and as SQL over the store's table `curves` as c. Each way to
// compute a number is one function below, which gives both. Without a curve the SQL gives NULL.
struct Expression {
  std::function<std::optional<double>(const BiasCurve&)> value;
  std::string sql;
};

// The field's number. No value if the field is empty.
Expression number_of(const CurveField& field) {
  return {[&field](const BiasCurve& curve) {
            return std::visit(
                [&](auto member) -> std::optional<double> {
                  if constexpr (std::is_same_v<decltype(member), std::string BiasCurve::*>)
                    return std::nullopt;
                  else if constexpr (std::is_same_v<decltype(member), std::optional<double> BiasCurve::*>)
                    return curve.*member;
                  else
                    return static_cast<double>(curve.*member);
                },
                field.member);
          },
          fmt::format("c.{}", field.name)};
}

Expression number_of(std::string_view name) {
  for (const CurveField& field : curve_fields())
    if (field.name == name) return number_of(field);
  throw std::logic_error(fmt::format("the curve has no field {}", name));
}

Expression product(const Expression& a, const Expression& b) {
  return {[a = a.value, b = b.value](const BiasCurve& curve) {
            const std::optional<double> x = a(curve), y = b(curve);
            return x && y ? std::optional(*x * *y) : std::nullopt;
          },
          fmt::format("({}) * {}", a.sql, b.sql)};
}

Expression width_of(const CurveWidth& width) {
  const Expression from = number_of(width.from), to = number_of(width.to);
  return {
      [a = from.value, b = to.value, placed = width.of_placements](const BiasCurve& curve) -> std::optional<double> {
        if (placed && curve.placements == 0) return std::nullopt;
        const std::optional<double> x = a(curve), y = b(curve);
        return x && y ? *y - *x : 0;
      },
      fmt::format("CASE WHEN c.point IS NULL{2} THEN NULL WHEN {0} IS NULL THEN 0 ELSE {1} - {0} END", from.sql, to.sql,
                  width.of_placements ? " OR c.placements = 0" : "")};
}

constexpr std::string_view depth_ending = "_depth";

std::vector<CurveQuantity> make_table() {
  std::vector<CurveQuantity> table;
  const auto add = [&](std::string_view name, std::string_view unit, std::string_view help, const Expression& number) {
    const auto row = [&](const std::string& row_name, std::string_view row_unit, const Expression& e) {
      table.push_back({row_name, std::string(row_unit), std::string(help), e.value, e.sql});
    };
    row(std::string(name), unit, number);
    if (unit != "depth") return;
    const std::string stem(name.substr(0, name.size() - depth_ending.size()));
    row(stem + "_m", "m", product(number, number_of("m_per_depth")));
    row(stem + "_texels", "texels", product(number, number_of("texels_per_depth")));
  };
  for (const CurveField& field : curve_fields()) {
    if (!field.quantity) continue;
    add(field.name, field.unit, field.help, number_of(field));
    for (const CurveWidth& width : curve_widths())
      if (width.to == field.name) add(width.name, width.unit, width.help, width_of(width));
  }
  return table;
}

}  // namespace

std::span<const CurveQuantity> curve_quantities() {
  static const std::vector<CurveQuantity> table = make_table();
  return table;
}

const CurveQuantity* curve_quantity(std::string_view name) {
  for (const CurveQuantity& row : curve_quantities())
    if (row.name == name) return &row;
  return nullptr;
}

std::vector<const RungCause*> brought_causes(std::span<const PointRecord> points) {
  std::vector<const RungCause*> causes;
  for (const PointRecord& point : points)
    for (const RungCause& cause : point.causes)
      if (std::none_of(causes.begin(), causes.end(), [&](const RungCause* c) { return c->name == cause.name; }))
        causes.push_back(&cause);
  return causes;
}

bool judges_frames(std::span<const PointRecord> points) {
  return !points.empty() && judged_rung(points.front()) == frame_rung;
}

bool knows_causes(std::span<const PointRecord> points) {
  return std::any_of(points.begin(), points.end(),
                     [](const PointRecord& point) { return point.metrics.contains("acne"); });
}

bool has_cause(const PointRecord& point, std::string_view cause) {
  if (!point.metrics.contains(std::string(cause))) return false;
  const Metric* const row = metric_named(cause);
  const bool by_place = !is_cause_of_own_map(cause) && cause != frame_missing && row && row->is(Metric::frames);
  return !by_place || !knows_causes({&point, 1});
}

std::string error_metric(std::span<const PointRecord> points) {
  return judges_frames(points) ? "frame_error" : "error";
}

std::vector<Metric> metrics_of(std::span<const PointRecord> points) {
  std::vector<Metric> metrics(metrics_table().begin(), metrics_table().end());
  // Of a frame, what no frame can have has no meaning for a reader.
  if (judges_frames(points))
    std::erase_if(metrics, [&](const Metric& row) {
      return std::none_of(points.begin(), points.end(),
                          [&](const PointRecord& point) { return point.metrics.contains(std::string(row.name)); });
    });
  for (const RungCause* cause : brought_causes(points))
    if (!metric_named(cause->name))
      metrics.push_back({cause->name, "fraction", cause->help, Metric::plot | Metric::share});
  return metrics;
}

bool is_free_name(std::string_view name) {
  if (name.empty() || name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") != name.npos) return false;
  const Metric* const row = metric_named(name);
  return (!row || row->is(Metric::frames)) && !curve_quantity(name);
}

std::string_view judged_rung(const PointRecord& point) {
  return point.causes.empty() ? std::string_view("R5") : std::string_view(point.causes.back().rung);
}

QuantityInfo find_quantity(std::string_view name, std::span<const PointRecord> points) {
  const std::vector<Metric> metrics = metrics_of(points);
  for (const Metric& row : metrics)
    if (row.name == name) return {row.name, row.unit, row.help, false};
  if (const CurveQuantity* const row = curve_quantity(name)) return {row->name, row->unit, row->help, true};
  std::vector<std::string_view> names;
  for (const Metric& row : metrics) names.push_back(row.name);
  for (const CurveQuantity& row : curve_quantities()) names.push_back(row.name);
  refuse_metric(name, names);
}

std::string_view quantity_unit(std::string_view name, std::string_view otherwise) {
  if (const Metric* const row = metric_named(name)) return row->unit;
  const CurveQuantity* const row = curve_quantity(name);
  return row ? std::string_view(row->unit) : otherwise;
}

std::string why_no_curve(const PointRecord& point) {
  if (point.curve) return "";
  if (nothing_judged(point)) return "no pixel can be judged";
  const auto lookup = point.settings.find("lookup.kind");
  if (lookup != point.settings.end() && lookup->second != "compare") {
    const std::string kind = printable(lookup->second);
    if (!point.lookup_curve.empty())
      return fmt::format("lookup.kind = {} compares no depths: its curve is over lookup.reduction", kind);
    if (const std::string span = setting_of(point, "lookup.reduction_span"); !span.empty() && span != "0")
      return fmt::format(
          "lookup.kind = {} compares no depths, and lookup.reduction_span gives its reduction a fixed form, so there "
          "is "
          "no usable window; bounds on leak, over_darkening, peter_panning and error say what is good enough",
          kind);
    return fmt::format(
        "lookup.kind = {} compares no depths, so no curve over the bias is exact in one pass; sweep the bias", kind);
  }
  std::string why;
  for (const BiasPart& part : bias_parts()) {
    const auto amount = point.settings.find("bias." + std::string(part.name));
    if (amount == point.settings.end() || amount->second == "0") continue;
    if (part.no_curve.empty()) return "";
    if (why.empty()) why = fmt::format("bias.{} {}; sweep it instead", part.name, part.no_curve);
  }
  return why;
}

std::optional<double> quantity(const PointRecord& point, std::string_view name) {
  const auto found = point.metrics.find(std::string(name));
  if (found != point.metrics.end()) return found->second;
  const CurveQuantity* const row = point.curve ? curve_quantity(name) : nullptr;
  return row ? row->value(*point.curve) : std::nullopt;
}

namespace {

constexpr std::string_view cascade_prefix = "cascades.", of_slice[] = {"begin_m", "end_m", "bias_needed"};

}  // namespace

std::span<const std::string> cascade_number_names() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> names;
    for (int k = 1; k <= most_cascades; ++k) {
      const auto add = [&](std::string_view number) {
        names.push_back(fmt::format("{}{}.{}", cascade_prefix, k, number));
      };
      for (const std::string_view number : of_slice) add(number);
      for (const char* metric : cascade_metrics) add(metric);
    }
    return names;
  }();
  return all;
}

std::optional<double> cascade_number(const PointRecord& point, std::string_view name) {
  if (!name.starts_with(cascade_prefix)) return std::nullopt;
  name.remove_prefix(cascade_prefix.size());
  size_t k = 0;
  const auto [dot, error] = std::from_chars(name.data(), name.data() + name.size(), k);
  if (error != std::errc{} || dot == name.data() + name.size() || *dot != '.' || k < 1 || k > point.cascades.size())
    return std::nullopt;
  const PointRecord::Cascade& cascade = point.cascades[k - 1];
  const std::string number(dot + 1, name.data() + name.size());
  if (number == "begin_m") return cascade.begin_m;
  if (number == "end_m") return cascade.end_m;
  if (number == "bias_needed") return cascade.bias_needed;
  const auto metric = cascade.metrics.find(number);
  return metric == cascade.metrics.end() ? std::nullopt : std::optional(metric->second);
}

bool is_cascade_bias(std::string_view name) {
  return name.starts_with(cascade_prefix) && name.ends_with(".bias_needed");
}

PlacedNames placed_names(std::string_view name) {
  const std::string text(name), worst = stored_name(text + "@worst");
  if (metric_named(worst)) {
    PlacedNames names{{text, worst}, {text, stored_name(text + "@best")}};
    if (const std::string shown = worst + "_shown"; metric_named(shown)) names.largest.push_back(shown);
    return names;
  }
  if (curve_quantity(worst)) return {{worst}, {worst}};
  return {};
}

std::optional<PointRecord::WorstOf> worst_pixel_of(const PointRecord& point, std::string_view metric) {
  for (std::string_view suffix : {"_worst_shown", "_worst", "_mean"})
    if (const std::string_view stem = metric.substr(0, metric.size() - std::min(suffix.size(), metric.size()));
        metric.ends_with(suffix) && !placed_names(stem).largest.empty()) {
      metric = stem;
      break;
    }
  if (metric == "error" || metric == "wrong") {
    if (point.worst.x < 0 || point.worst.error == 0) return std::nullopt;
    return PointRecord::WorstOf{std::string(metric), point.worst.x, point.worst.y, point.worst.error};
  }
  for (const PointRecord::WorstOf& worst : point.worst_of)
    if (worst.metric == metric) return worst;
  return std::nullopt;
}

std::optional<double> number_of(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

bool has_placements(const PointRecord& point) {
  const std::string side = setting_of(point, "map.placements");
  return !side.empty() && side != "1";
}

double worst_placed(const PointRecord& point, const std::string& metric) {
  double most = metric_of(point, metric);
  if (has_placements(point))
    for (const std::string& name : placed_names(metric).largest)
      if (const double value = metric_of(point, name); !(value <= most)) most = value;
  return most;
}

double metric_of(const PointRecord& point, const std::string& name) {
  const auto found = point.metrics.find(name);
  return found == point.metrics.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
}

std::string setting_of(const PointRecord& point, const std::string& name) {
  const auto found = point.settings.find(name);
  return found == point.settings.end() ? std::string() : found->second;
}

std::vector<std::string> values_of(std::span<const PointRecord> points, const std::string& setting) {
  std::vector<std::string> values;
  std::unordered_set<std::string> seen;
  for (const PointRecord& point : points)
    if (std::string value = setting_of(point, setting); seen.insert(value).second) values.push_back(std::move(value));
  std::vector<std::pair<double, std::string>> numbered;
  for (const std::string& value : values)
    if (const std::optional<double> number = number_of(value)) numbered.emplace_back(*number, value);
  if (numbered.size() != values.size()) return values;
  std::stable_sort(numbered.begin(), numbered.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (size_t i = 0; i < values.size(); ++i) values[i] = std::move(numbered[i].second);
  return values;
}

bool nothing_judged(const PointRecord& point) { return quantity(point, "counted") == 0.0; }

}  // namespace noonmark
