#include "compare/report/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "compare/judge/curve_reading.h"
#include "compare/report/escape.h"
#include "compare/results/metrics.h"
#include "compare/results/quantities.h"
#include "compare/results/record_fields.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

// Numbers need no quotes.
void add_number(double value, std::string& csv) { fmt::format_to(std::back_inserter(csv), "{}", value); }

// A heading, and what adds the cell of a point, escaped.
struct Column {
  std::string name;
  std::function<void(const PointRecord& point, std::string& csv)> add;
};

// `known` in its order, then the names that only the points have (results of another version), sorted.
std::vector<std::string> names(std::vector<std::string> known, const std::set<std::string>& present) {
  const std::set<std::string> table(known.begin(), known.end());
  std::set_difference(present.begin(), present.end(), table.begin(), table.end(), std::back_inserter(known));
  return known;
}

std::vector<Column> all_columns(const Results& results) {
  std::set<std::string> present_settings, present_metrics;
  for (const PointRecord& point : results.points) {
    for (const auto& [name, text] : point.settings) present_settings.insert(name);
    for (const auto& [name, value] : point.metrics) present_metrics.insert(name);
  }
  std::vector<std::string> settings, metrics;
  for (const Setting& row : settings_table()) settings.emplace_back(row.name);
  for (const Metric& row : metrics_table()) metrics.emplace_back(row.name);

  std::vector<Column> list, at_the_end;
  list.push_back({"point", [](const PointRecord& point, std::string& csv) { csv += std::to_string(point.id); }});
  const auto field_column = [&](const RecordField& field) {
    list.push_back({std::string(field.name), [&field](const PointRecord& point, std::string& csv) {
                      with_value(field, point, [&](const auto& value) {
                        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::string>)
                          csv += csv_text(value);
                        else
                          fmt::format_to(std::back_inserter(csv), "{}", value);
                      });
                    }});
  };
  const auto any_has = [&](const RecordField& field) {
    return std::any_of(results.points.begin(), results.points.end(), [&](const PointRecord& p) {
      return with_value(field, p, [](const auto& value) {
        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::string>)
          return !value.empty();
        else
          return true;
      });
    });
  };
  // The part: left out if no point has one.
  for (const RecordField& field : record_fields())
    if (field.group.empty() && any_has(field)) field_column(field);
  for (const std::string& name : names(std::move(settings), present_settings))
    list.push_back({name, [name](const PointRecord& point, std::string& csv) {
                      if (const auto found = point.settings.find(name); found != point.settings.end())
                        csv += csv_text(found->second);
                    }});
  for (const std::string& name : names(std::move(metrics), present_metrics))
    (quantity_unit(name) == "ms" ? at_the_end : list)
        .push_back({name, [name](const PointRecord& point, std::string& csv) {
                      if (const auto found = point.metrics.find(name); found != point.metrics.end())
                        add_number(found->second, csv);
                    }});
  for (const CurveQuantity& quantity : curve_quantities())
    list.push_back({quantity.name, [&quantity](const PointRecord& point, std::string& csv) {
                      const auto& curve = known_curve(point);
                      if (const auto value = curve ? quantity.value(*curve) : std::nullopt) add_number(*value, csv);
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

// The names in a formula, as stores have them.
void add_names(std::string_view formula, std::set<std::string>& names) {
  const auto in_name = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.' || c == '@';
  };
  for (auto begin = formula.begin(); (begin = std::find_if(begin, formula.end(), in_name)) != formula.end();) {
    const auto end = std::find_if_not(begin, formula.end(), in_name);
    names.insert(stored_name({begin, end}));
    begin = end;
  }
}

// What is named, and what every reader asks where a point has it.
std::set<std::string> asked_columns(const Results& results) {
  std::set<std::string> names{"point", "part", results.info.cost, results.info.accuracy};
  names.insert(results.info.swept.begin(), results.info.swept.end());
  names.insert(results.info.plot.begin(), results.info.plot.end());
  for (const BoundResult& bound : results.bounds) {
    names.insert(bound.metric);
    const PlacedNames placed = placed_names(bound.metric);
    for (const auto* list : {&placed.largest, &placed.least})
      if (bound.placement == "worst") names.insert(list->begin(), list->end());
  }
  for (const LawResult& law : results.laws)
    for (const std::string* formula : {&law.measured, &law.predicted}) add_names(*formula, names);
  for (const RecordField& field : record_fields())
    if (field.group == delivery_group) names.emplace(field.name);
  for (const PointRecord& point : results.points) {
    const auto& first = results.points.front().settings;
    for (const auto& [name, text] : point.settings)
      if (const auto there = first.find(name); there == first.end() || there->second != text) names.insert(name);
    for (const auto& [name, value] : point.metrics)
      if (const Metric* const row = metric_named(name); row && row->is(Metric::csv)) names.insert(name);
    for (const RungCause& cause : point.causes) names.insert(cause.name);
    for (const char* end : {"window_min_m", "window_max_m", "window_min_worst_m", "window_max_worst_m"})
      if (quantity(point, end)) names.insert(end);
  }
  return names;
}

}  // namespace

std::string to_csv(const Results& results, CsvColumns columns) {
  std::vector<Column> list = all_columns(results);
  if (columns == CsvColumns::asked)
    std::erase_if(list,
                  [asked = asked_columns(results)](const Column& column) { return !asked.contains(column.name); });
  std::string csv;
  const auto add_row = [&](const auto& add_cell) {
    for (const Column& column : list) {
      if (&column != &list.front()) csv += ',';
      add_cell(column);
    }
    csv += "\r\n";
  };
  add_row([&](const Column& column) { csv += csv_text(column.name); });
  for (const PointRecord& point : results.points) add_row([&](const Column& column) { column.add(point, csv); });
  return csv;
}

}  // namespace noonmark
