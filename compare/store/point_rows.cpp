#include "compare/store/point_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <stdexcept>
#include <string>

#include "compare/store/record_tables.h"
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

void load_curves(Database& db, std::map<int64_t, PointRecord>& points) {
  curves_table().read(db, [&](std::span<const int64_t> key, BiasCurve curve) {
    if (curve.window_min_depth.has_value() != curve.window_max_depth.has_value())
      throw std::runtime_error("a usable window with only one end");
    if (curve.window_min_depth && *curve.window_min_depth > *curve.window_max_depth)
      throw std::runtime_error("a usable window that ends before it begins");
    points.at(key[0]).curve = std::move(curve);
  });
  read_series(db, [&](int64_t point) -> BiasCurve& { return points.at(point).curve.value(); });
  curve_windows_table().read(db, [&](std::span<const int64_t> key, WindowSteps steps) {
    points.at(key[0]).curve.value().steps = std::move(steps);
  });
}

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
}

std::map<int64_t, PointRecord> load_points(Database& db) {
  std::map<int64_t, PointRecord> points;
  finished_table().read(db, [&](std::span<const int64_t> key, PointRecord point) {
    point.id = key[0];
    points.emplace(key[0], std::move(point));
  });
  for (Statement rows(db, "SELECT point, name, text FROM settings"); rows.step();)
    points.at(rows.integer(0)).settings[rows.text(1)] = rows.text(2);
  for (Statement rows(db, "SELECT point, name, value FROM metrics"); rows.step();)
    points.at(rows.integer(0)).metrics[rows.text(1)] = rows.real(2);
  for (Statement rows(db, "SELECT point, name, value FROM times"); rows.step();)
    points.at(rows.integer(0)).times[rows.text(1)] = rows.real(2);
  pictures_table().read(db, [&](std::span<const int64_t> key, PictureRecord picture) {
    points.at(key[0]).pictures.push_back(std::move(picture));
  });
  images_table().read(db, [&](std::span<const int64_t> key, ImageRecord image) {
    points.at(key[0]).images.push_back(std::move(image));
  });
  worst_pixels_table().read(db, [&](std::span<const int64_t> key, PointRecord::WorstOf worst) {
    points.at(key[0]).worst_of.push_back(std::move(worst));
  });
  load_curves(db, points);
  load_causes(db, points);
  return points;
}

}  // namespace noonmark
