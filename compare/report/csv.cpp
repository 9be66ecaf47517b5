#include "compare/report/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "compare/report/escape.h"
#include "compare/results/metrics.h"
#include "compare/results/quantities.h"
#include "compare/results/record_fields.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

// Numbers need no quotes.
void add_number(double value, std::string& csv) { fmt::format_to(std::back_inserter(csv), "{}", value); }

// The values of a point. at(i) is the value whose name is number i in a list of names; null if the point has no such value.
// Most points have the same names in the same order. So each name is first compared with the name that the point before had at
// this place, and is searched for in the list only if they differ. The list holds the names of all points.
template <class Value>
class Places {
 public:
  explicit Places(const std::vector<std::string>& names) : values_(names.size()) {
    for (size_t i = 0; i < names.size(); ++i) place_.emplace(names[i], i);
  }
  void take(const std::map<std::string, Value>& values) {
    std::fill(values_.begin(), values_.end(), nullptr);
    size_t nth = 0;
    for (const auto& [name, value] : values) {
      if (nth == before_.size()) before_.push_back(place_.begin());
      if (before_[nth]->first != name) before_[nth] = place_.find(name);
      values_[before_[nth++]->second] = &value;
    }
  }
  const Value* at(size_t place) const { return values_[place]; }

 private:
  std::map<std::string, size_t> place_;
  std::vector<std::map<std::string, size_t>::const_iterator> before_;  // of the nth name of a point
  std::vector<const Value*> values_;
};

// A point, and its settings and metrics by the places of their names.
struct Row {
  const PointRecord* point = nullptr;
  Places<std::string> settings;
  Places<double> metrics;
};

// A heading, and what adds the cell of a row, escaped.
struct Column {
  std::string name;
  std::function<void(const Row& row, std::string& csv)> add;
};

// `known` in its order, then the names that only the points have (results of another version), sorted.
std::vector<std::string> names(std::vector<std::string> known, const std::set<std::string>& present) {
  const std::set<std::string> table(known.begin(), known.end());
  std::set_difference(present.begin(), present.end(), table.begin(), table.end(), std::back_inserter(known));
  return known;
}

struct Table {
  std::vector<Column> columns;
  std::vector<std::string> settings, metrics;  // the names that Row has places for
};

Table table_of(const Results& results) {
  std::set<std::string> present_settings, present_metrics;
  const auto add_names = [](const auto& values, std::set<std::string>& present) {
    auto next = present.begin();  // both are sorted, so most names are found without a search
    for (const auto& [name, value] : values) {
      if (next == present.end() || *next != name) next = present.insert(name).first;
      ++next;
    }
  };
  for (const PointRecord& point : results.points) {
    add_names(point.settings, present_settings);
    add_names(point.metrics, present_metrics);
  }
  Table table;
  std::set<std::string> clocked;  // metrics that are times
  for (const Setting& row : settings_table()) table.settings.emplace_back(row.name);
  for (const Metric& row : metrics_table()) {
    table.metrics.emplace_back(row.name);
    if (row.unit == "ms") clocked.emplace(row.name);
  }
  table.settings = names(std::move(table.settings), present_settings);
  table.metrics = names(std::move(table.metrics), present_metrics);

  std::vector<Column>& list = table.columns;
  std::vector<Column> at_the_end;
  list.push_back({"point", [](const Row& row, std::string& csv) { csv += std::to_string(row.point->id); }});
  const auto field_column = [&](const RecordField& field) {
    list.push_back({std::string(field.name), [&field](const Row& row, std::string& csv) {
                      with_value(field, *row.point, [&](const auto& value) {
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
  for (size_t i = 0; i < table.settings.size(); ++i)
    list.push_back({table.settings[i], [i](const Row& row, std::string& csv) {
                      if (const std::string* text = row.settings.at(i)) csv += csv_text(*text);
                    }});
  for (size_t i = 0; i < table.metrics.size(); ++i)
    (clocked.contains(table.metrics[i]) ? at_the_end : list)
        .push_back({table.metrics[i], [i](const Row& row, std::string& csv) {
                      if (const double* value = row.metrics.at(i)) add_number(*value, csv);
                    }});
  for (const CurveQuantity& quantity : curve_quantities())
    list.push_back({quantity.name, [&quantity](const Row& row, std::string& csv) {
                      const auto& curve = row.point->curve;
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
  return table;
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
    if (bound.placement == "worst")
      names.insert(placed.largest.begin(), placed.largest.end()),
          names.insert(placed.least.begin(), placed.least.end());
  }
  for (const LawResult& law : results.laws)
    for (const std::string* formula : {&law.measured, &law.predicted}) add_names(*formula, names);
  for (const RecordField& field : record_fields())
    if (field.group == delivery_group) names.emplace(field.name);
  for (const PointRecord& point : results.points) {
    for (const auto& [name, text] : point.settings)
      if (setting_of(results.points.front(), name) != text) names.insert(name);
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
  Table table = table_of(results);
  if (columns == CsvColumns::asked)
    std::erase_if(table.columns,
                  [asked = asked_columns(results)](const Column& column) { return !asked.contains(column.name); });
  std::string csv;
  const auto add_row = [&](const auto& add_cell) {
    for (size_t i = 0; i < table.columns.size(); ++i) {
      if (i > 0) csv += ',';
      add_cell(table.columns[i]);
    }
    csv += "\r\n";
  };
  add_row([&](const Column& column) { csv += csv_text(column.name); });
  Row row{nullptr, Places<std::string>(table.settings), Places<double>(table.metrics)};
  for (const PointRecord& point : results.points) {
    row.point = &point;
    row.settings.take(point.settings);
    row.metrics.take(point.metrics);
    add_row([&](const Column& column) { column.add(row, csv); });
  }
  return csv;
}

}  // namespace noonmark
