#include "compare/report/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <set>
#include <string_view>

#include "compare/report/escape.h"
#include "compare/results/metrics.h"
#include "compare/results/quantities.h"
#include "compare/results/record_fields.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

std::string exact_number(double value) { return fmt::format("{}", value); }

// A heading and its value for each point.
struct Column {
  std::string name;
  std::function<std::string(const PointRecord&)> cell;
};

std::string look_up(const std::map<std::string, double>& numbers, const std::string& name) {
  const auto found = numbers.find(name);
  return found == numbers.end() ? std::string() : exact_number(found->second);
}

// `known` in its order, then the names that only the points have (results of another version), sorted.
std::vector<std::string> names(std::vector<std::string> known, const std::set<std::string>& present) {
  const std::set<std::string> table(known.begin(), known.end());
  std::set_difference(present.begin(), present.end(), table.begin(), table.end(), std::back_inserter(known));
  return known;
}

std::vector<Column> columns(const Results& results) {
  std::set<std::string> present_settings, present_metrics;
  for (const PointRecord& point : results.points) {
    for (const auto& [name, text] : point.settings) present_settings.insert(name);
    for (const auto& [name, value] : point.metrics) present_metrics.insert(name);
  }
  std::vector<std::string> settings, metrics;
  std::set<std::string> clocked;  // metrics that are times
  for (const Setting& row : settings_table()) settings.emplace_back(row.name);
  for (const Metric& row : metrics_table()) {
    metrics.emplace_back(row.name);
    if (row.unit == "ms") clocked.emplace(row.name);
  }

  std::vector<Column> list, at_the_end;
  list.push_back({"point", [](const PointRecord& p) { return fmt::format("{}", p.id); }});
  const auto field_column = [&](const RecordField& field) {
    list.push_back({std::string(field.name), [&field](const PointRecord& p) {
                      return with_value(field, p, [](const auto& value) { return fmt::format("{}", value); });
                    }});
  };
  const auto any_has = [&](const RecordField& field) {
    return std::any_of(results.points.begin(), results.points.end(), [&](const PointRecord& p) {
      return with_value(field, p, [](const auto& value) { return !fmt::format("{}", value).empty(); });
    });
  };
  // The part: left out if no point has one.
  for (const RecordField& field : record_fields())
    if (field.group.empty() && any_has(field)) field_column(field);
  for (const std::string& name : names(settings, present_settings))
    list.push_back({name, [name](const PointRecord& p) {
                      const auto found = p.settings.find(name);
                      return found == p.settings.end() ? std::string() : found->second;
                    }});
  for (const std::string& name : names(metrics, present_metrics))
    (clocked.contains(name) ? at_the_end : list).push_back({name, [name](const PointRecord& p) {
                                                              return look_up(p.metrics, name);
                                                            }});
  for (const CurveQuantity& row : curve_quantities())
    list.push_back({std::string(row.name), [&row](const PointRecord& p) {
                      const std::optional<double> value = p.curve ? row.value(*p.curve) : std::nullopt;
                      return value ? exact_number(*value) : std::string();
                    }});
  for (const RecordField& field : record_fields())
    if (!field.group.empty() && field.group != machine_group && (field.group != delivery_group || any_has(field)))
      field_column(field);
  list.insert(list.end(), at_the_end.begin(), at_the_end.end());
  // After the times, the kind of machine. The host and its clock stand in the store alone.
  for (const RecordField& field : record_fields())
    if (field.group == machine_group && field.name != "machine_host" && field.name != "machine_clock")
      field_column(field);
  return list;
}

}  // namespace

std::string to_csv(const Results& results) {
  const std::vector<Column> list = columns(results);
  std::string csv;
  const auto row = [&](auto cell) {
    for (size_t i = 0; i < list.size(); ++i) csv += (i ? "," : "") + csv_text(cell(list[i]));
    csv += "\r\n";
  };
  row([](const Column& column) { return column.name; });
  for (const PointRecord& point : results.points) row([&](const Column& column) { return column.cell(point); });
  return csv;
}

}  // namespace noonmark
