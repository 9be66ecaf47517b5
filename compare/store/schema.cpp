#include "compare/store/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "compare/results/metrics.h"
#include "compare/results/quantities.h"
#include "compare/results/record_fields.h"
#include "compare/store/phase_tables.h"
#include "compare/store/record_tables.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

// settings.value: integers, reals and flags (0 or 1) as numbers, all others as text. settings.text: canonical text.
constexpr std::string_view info_table =
    "CREATE TABLE info (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;\n";
constexpr std::string_view named_values = R"sql(
CREATE TABLE settings (point INTEGER, name TEXT, value, text TEXT NOT NULL, PRIMARY KEY (point, name)) WITHOUT ROWID;
CREATE TABLE metrics (point INTEGER, name TEXT, value REAL, PRIMARY KEY (point, name)) WITHOUT ROWID;
CREATE TABLE times (point INTEGER, name TEXT, value REAL, PRIMARY KEY (point, name)) WITHOUT ROWID;
CREATE TABLE seals (name TEXT PRIMARY KEY, digest TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE columns (name TEXT PRIMARY KEY, kind TEXT, unit TEXT, help TEXT);
)sql";

std::string quoted(std::string_view text) {
  std::string result = "'";
  for (char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + "'";
}

// The view's columns, and their legend with one row per column.
class View {
 public:
  void column(std::string_view name, std::string_view expression, std::string_view kind, std::string_view unit,
              std::string_view help) {
    columns_ += fmt::format("{}  {} AS \"{}\"", columns_.empty() ? "" : ",\n", expression, name);
    legend_ += fmt::format("INSERT INTO columns VALUES ({}, {}, {}, {});\n", quoted(name), quoted(kind), quoted(unit),
                           quoted(help));
  }
  std::string sql() const {
    return fmt::format(
        "CREATE VIEW points AS SELECT\n{}\nFROM finished f LEFT JOIN curves c ON c.point = f.point\nWHERE f.point < "
        "{};\n{}",
        columns_, first_aside, legend_);
  }

 private:
  std::string columns_, legend_;
};

std::string value_of(std::string_view table, std::string_view name) {
  return fmt::format("(SELECT value FROM {} WHERE point = f.point AND name = {})", table, quoted(name));
}

}  // namespace

std::string store_schema() {
  View view;
  const auto field_column = [&](const RecordField& field) {
    view.column(field.name, fmt::format("f.{}", field.name), field.group, field.unit, field.help);
  };
  view.column("point", "f.point", "", "", "Position in the sweep, from 0.");
  for (const RecordField& field : record_fields())
    if (field.group.empty()) field_column(field);
  for (const Setting& row : settings_table()) {
    std::string name(row.name);  // every query would have to quote a dot
    std::replace(name.begin(), name.end(), '.', '_');
    view.column(name, value_of("settings", row.name), "setting", row.unit, row.help);
  }
  for (const Metric& row : metrics_table())
    view.column(row.name, value_of("metrics", row.name), "metric", row.unit, row.help);
  view.column("not_measured", "(SELECT count(*) FROM metrics WHERE point = f.point AND value IS NULL)", "metric",
              "count", "Number of metrics that could not be measured (NaN).");
  for (const CurveQuantity& row : curve_quantities()) view.column(row.name, row.sql, "curve", row.unit, row.help);
  for (const RecordField& field : record_fields())
    if (!field.group.empty()) field_column(field);
  return std::string(info_table) + finished_table().create("\n  ") + std::string(named_values) + record_tables() +
         phase_tables() + view.sql();
}

}  // namespace noonmark
