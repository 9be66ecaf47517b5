#include "compare/store/point_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <exception>
#include <map>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "compare/store/record_tables.h"
#include "compare/store/seals.h"
#include "compare/store/sqlite.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

using sqlite::Database;
using sqlite::Statement;

void bind_setting_value(Statement& insert, int index, const std::string& name, const std::string& text) {
  const std::span<const Setting> table = settings_table();
  const auto row = std::find_if(table.begin(), table.end(), [&](const Setting& s) { return s.name == name; });
  if (row != table.end() && text != "auto") {
    if (row->type == ValueType::flag) return insert.bind(index, text == "true" ? 1 : 0);
    if (row->type == ValueType::integer || row->type == ValueType::real) {
      double value = 0;
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (error == std::errc{} && end == text.data() + text.size()) {
        // Every integer setting is far below 2^53.
        if (row->type == ValueType::integer) return insert.bind(index, static_cast<int64_t>(value));
        return insert.bind(index, value);
      }
    }
  }
  insert.bind(index, text);
}

void add_numbers(Database& db, const char* table, int64_t point, const std::map<std::string, double>& numbers) {
  Statement insert(db, fmt::format("INSERT INTO {} VALUES (?, ?, ?)", table));
  for (const auto& [name, value] : numbers) insert.run(point, name, value);
}

void add_curve(Database& db, int64_t point, const BiasCurve& curve) {
  if (curve.window_min_depth.has_value() != curve.window_max_depth.has_value())
    throw std::logic_error("a usable bias window must have two ends or none");
  Table<BiasCurve>::Insert(db, curves_table()).row({point}, curve);
  add_series(db, point, curve);
  Table<WindowSteps>::Insert(db, curve_windows_table()).row({point}, curve.steps);
}

BiasCurve curve_of(const Statement& row) {
  BiasCurve curve = curves_table().record_of(row);
  if (curve.window_min_depth.has_value() != curve.window_max_depth.has_value())
    throw std::runtime_error("a usable window with only one end");
  if (curve.window_min_depth && *curve.window_min_depth > *curve.window_max_depth)
    throw std::runtime_error("a usable window that ends before it begins");
  return curve;
}

// How the rows of each table become part of a point's record. The rows of a table come in the order of its keys, so names
// ascend and each is the last of its map.
struct TableOfPoints {
  std::string_view name;
  void (*read)(const Statement& row, PointRecord& point);
};
constexpr TableOfPoints tables[] = {
    {"finished",
     [](const Statement& row, PointRecord& point) {
       point = finished_table().record_of(row);
       point.id = row.integer(0);
     }},
    {"settings",
     [](const Statement& row, PointRecord& point) {
       point.settings.emplace_hint(point.settings.end(), row.text_view(1), row.text_view(3));
     }},
    {"metrics",
     [](const Statement& row, PointRecord& point) {
       point.metrics.emplace_hint(point.metrics.end(), row.text_view(1), row.real(2));
     }},
    {"times", [](const Statement& row,
                 PointRecord& point) { point.times.emplace_hint(point.times.end(), row.text_view(1), row.real(2)); }},
    {"curves", [](const Statement& row, PointRecord& point) { point.curve = curve_of(row); }},
    {"curve_points", [](const Statement& row, PointRecord& point) { read_series(row, point.curve.value()); }},
    {"pictures",
     [](const Statement& row, PointRecord& point) { point.pictures.push_back(pictures_table().record_of(row)); }},
    {"images", [](const Statement& row, PointRecord& point) { point.images.push_back(images_table().record_of(row)); }},
    {"curve_windows", [](const Statement& row,
                         PointRecord& point) { point.curve.value().steps = curve_windows_table().record_of(row); }},
    {"worst_pixels",
     [](const Statement& row, PointRecord& point) { point.worst_of.push_back(worst_pixels_table().record_of(row)); }},
    {"cascades",
     [](const Statement& row, PointRecord& point) { point.cascades.push_back(cascades_table().record_of(row)); }},
    {"lookup_curves",
     [](const Statement& row, PointRecord& point) {
       LookupCurvePoint at = lookup_curves_table().record_of(row);
       (at.parameter == "lookup.reduction" ? point.lookup_curve : point.over_curve).push_back(std::move(at));
     }},
    {"lookup_bounds",
     [](const Statement& row, PointRecord& point) { point.lookup_bounds = lookup_bounds_table().record_of(row); }},
};

// A point has the causes whose metric it has.
void load_causes(Database& db, std::map<int64_t, PointRecord>& points) {
  std::vector<RungCause> causes;
  for (Statement rows(db, "SELECT key, value FROM info ORDER BY key"); rows.step();)
    if (const std::string key = rows.text(0); key.starts_with(cause_prefix))
      causes.push_back(cause_of_text(key.substr(cause_prefix.size()), rows.text(1)));
  std::stable_sort(causes.begin(), causes.end(), [](const auto& a, const auto& b) { return a.rung < b.rung; });
  for (auto& [id, point] : points)
    for (const RungCause& cause : causes)
      if (point.metrics.contains(cause.name)) point.causes.push_back(cause);
}

}  // namespace

void add_pictures(Database& db, int64_t point, const PointPictures& made) {
  Table<PictureRecord>::Insert pictures(db, pictures_table());
  for (size_t i = 0; i < made.pictures.size(); ++i) pictures.row({point, static_cast<int64_t>(i)}, made.pictures[i]);
  Table<ImageRecord>::Insert images(db, images_table());
  for (size_t i = 0; i < made.images.size(); ++i) images.row({point, static_cast<int64_t>(i)}, made.images[i]);
}

void add_rows(Database& db, const PointRecord& point) {
  Table<PointRecord>::Insert(db, finished_table()).row({point.id}, point);
  Statement settings(db, "INSERT INTO settings VALUES (?, ?, ?, ?)");
  for (const auto& [name, text] : point.settings) {
    bind_setting_value(settings, 3, name, text);
    settings.bind(4, text);
    settings.run(point.id, name);
  }
  add_numbers(db, "metrics", point.id, point.metrics);
  add_numbers(db, "times", point.id, point.times);
  if (point.curve) add_curve(db, point.id, *point.curve);
  add_pictures(db, point.id, point);
  Table<PointRecord::WorstOf>::Insert worst(db, worst_pixels_table());
  for (size_t i = 0; i < point.worst_of.size(); ++i) worst.row({point.id, static_cast<int64_t>(i)}, point.worst_of[i]);
  Table<PointRecord::Cascade>::Insert cascades(db, cascades_table());
  for (size_t i = 0; i < point.cascades.size(); ++i)
    cascades.row({point.id, static_cast<int64_t>(i)}, point.cascades[i]);
  Table<LookupCurvePoint>::Insert lookup_curves(db, lookup_curves_table());
  int64_t row = 0;
  for (const std::vector<LookupCurvePoint>* curve : {&point.lookup_curve, &point.over_curve})
    for (const LookupCurvePoint& at : *curve) lookup_curves.row({point.id, row++}, at);
  if (point.lookup_bounds) Table<CauseBounds>::Insert(db, lookup_bounds_table()).row({point.id}, *point.lookup_bounds);
}

StoredPoints read_points(Database& db) {
  StoredPoints read;
  std::map<int64_t, std::exception_ptr> faults;  // the first of each point
  PointRecord* present = nullptr;                // the last of read.whole
  const auto reader_of = [&](std::string_view table) -> RowReader {
    const auto* const found =
        std::find_if(std::begin(tables), std::end(tables), [&](const auto& one) { return one.name == table; });
    if (found == std::end(tables)) throw std::logic_error(fmt::format("no reader for the table {}", table));
    const bool begins = found == std::begin(tables);
    return [&, found, begins](int64_t point, const Statement& row) {
      try {
        if (begins)
          present = &read.whole.emplace_hint(read.whole.end(), point, PointRecord())->second;
        else if (!present || present->id != point)
          throw std::runtime_error(fmt::format("rows of point {}, which is not finished", point));
        found->read(row, *present);
      } catch (const Error&) {
        throw;
      } catch (const std::bad_alloc&) {
        throw;
      } catch (const std::exception&) {
        faults.emplace(point, std::current_exception());
      }
    };
  };
  read.broken = broken_points(db, reader_of);
  for (const int64_t point : read.broken) {
    read.whole.erase(point);
    faults.erase(point);
  }
  if (!faults.empty()) read.fault = faults.begin()->second;
  load_causes(db, read.whole);
  return read;
}

std::map<int64_t, PointRecord> load_points(Database& db) {
  StoredPoints read = read_points(db);
  if (read.fault) std::rethrow_exception(read.fault);
  return std::move(read.whole);
}

}  // namespace noonmark
