#include "compare/store/store.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <new>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "compare/store/check.h"
#include "compare/store/fingerprint.h"
#include "compare/store/schema.h"
#include "compare/store/seals.h"
#include "compare/store/sqlite.h"
#include "scenes/error.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

using sqlite::Database;
using sqlite::Statement;
using sqlite::Transaction;

// The text members of RunInfo, by their key in the table `info`.
constexpr std::pair<std::string_view, std::string RunInfo::*> info_texts[] = {
    {"experiment", &RunInfo::experiment},   {"title", &RunInfo::title},
    {"command", &RunInfo::command},         {"commit", &RunInfo::commit},
    {"version", &RunInfo::version},         {"started", &RunInfo::started},
    {"host_cpu", &RunInfo::host_cpu},       {"gl_vendor", &RunInfo::gl_vendor},
    {"gl_renderer", &RunInfo::gl_renderer}, {"gl_version", &RunInfo::gl_version},
    {"gl_timer", &RunInfo::gl_timer},       {"embree_version", &RunInfo::embree_version},
    {"embree_isa", &RunInfo::embree_isa},   {"scene_name", &RunInfo::scene_name},
};
constexpr std::string_view library_prefix = "library.";

// The series of a curve, in the order of the columns of curve_points after bias_depth.
constexpr std::vector<double> BiasCurve::*series[] = {
    &BiasCurve::error,         &BiasCurve::wrong,          &BiasCurve::acne,    &BiasCurve::peter_panning,
    &BiasCurve::aliasing_dark, &BiasCurve::aliasing_light, &BiasCurve::coverage};

// Paths may hold bytes that are no UTF-8: those, and only those, are replaced.
std::string json_text(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void remove_store(const std::string& path) {
  // The database first: a journal that is left alone is dropped by SQLite, a database without its journal may be torn.
  for (const char* ending : {"", "-journal", "-wal", "-shm"}) {
    const std::string file = path + ending;
    if (::unlink(file.c_str()) != 0 && errno != ENOENT)
      throw Error(ErrorKind::scene,
                  fmt::format("{}: cannot be removed: {}; choose another --out", file, std::strerror(errno)));
  }
}

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
  const size_t count = curve.bias_depth.size();
  for (auto values : series)
    if ((curve.*values).size() != count)
      throw std::logic_error("a bias curve's series differ in length from its biases");
  if (curve.window_min_depth.has_value() != curve.window_max_depth.has_value())
    throw std::logic_error("a usable bias window has two ends or none");

  Statement(db, "INSERT INTO curves VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
      .run(point, curve.parameter, curve.made, curve.m_per_depth, curve.texels_per_depth, curve.acne_bound,
           curve.peter_panning_bound, curve.window_min_depth ? 1 : 0, curve.window_min_depth, curve.window_max_depth,
           curve.best_bias_depth, curve.best_error, curve.flat_min_depth, curve.flat_max_depth,
           static_cast<int64_t>(curve.breakpoints), curve.acne_free_bias_depth, curve.acne_free_bias_stored_depth);
  Statement insert(db, "INSERT INTO curve_points VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  for (size_t i = 0; i < count; ++i)
    insert.run(point, static_cast<int64_t>(i), curve.bias_depth[i], curve.error[i], curve.wrong[i], curve.acne[i],
               curve.peter_panning[i], curve.aliasing_dark[i], curve.aliasing_light[i], curve.coverage[i]);
}

void add_pictures(Database& db, int64_t point, const PointPictures& made) {
  Statement insert(db, "INSERT INTO pictures VALUES (?, ?, ?, ?, ?, ?)");
  for (size_t i = 0; i < made.pictures.size(); ++i) {
    const PictureRecord& picture = made.pictures[i];
    insert.run(point, static_cast<int64_t>(i), picture.name, picture.path, picture.caption, picture.digest);
  }
  Statement insert_image(db, "INSERT INTO images VALUES (?, ?, ?, ?)");
  for (size_t i = 0; i < made.images.size(); ++i)
    insert_image.run(point, static_cast<int64_t>(i), made.images[i].path, made.images[i].digest);
}

void load_info(Database& db, Results& results) {
  RunInfo& info = results.info;
  for (Statement rows(db, "SELECT key, value FROM info"); rows.step();) {
    const std::string key = rows.text(0), value = rows.text(1);
    for (const auto& [name, member] : info_texts)
      if (key == name) info.*member = value;
    if (key.starts_with(library_prefix)) info.libraries[key.substr(library_prefix.size())] = value;
    if (key == "swept") info.swept = nlohmann::json::parse(value).get<std::vector<std::string>>();
    if (key == "plot") info.plot = nlohmann::json::parse(value).get<std::vector<std::string>>();
    if (key == "scene_notes") info.scene_notes = nlohmann::json::parse(value).get<std::vector<std::string>>();
    if (key == "triangles") info.triangles = std::stoull(value);
    if (key == "planned_points") results.planned_points = std::stoll(value);
  }
}

void load_curves(Database& db, std::map<int64_t, PointRecord>& points) {
  for (Statement rows(db,
                      "SELECT point, parameter, made, m_per_depth, texels_per_depth, acne_bound, peter_panning_bound, "
                      "has_window, window_min_depth, window_max_depth, best_bias_depth, best_error, flat_min_depth, "
                      "flat_max_depth, breakpoints, acne_free_bias_depth, acne_free_bias_stored_depth FROM curves");
       rows.step();) {
    BiasCurve& curve = points.at(rows.integer(0)).curve.emplace();
    curve.parameter = rows.text(1);
    curve.made = rows.text(2);
    curve.m_per_depth = rows.real(3);
    curve.texels_per_depth = rows.real(4);
    curve.acne_bound = rows.real(5);
    curve.peter_panning_bound = rows.real(6);
    if (rows.integer(7) != 0) {
      curve.window_min_depth = rows.real(8);
      curve.window_max_depth = rows.real(9);
      if (*curve.window_min_depth > *curve.window_max_depth)
        throw std::runtime_error("a usable window that ends before it begins");
    }
    curve.best_bias_depth = rows.real(10);
    curve.best_error = rows.real(11);
    curve.flat_min_depth = rows.real(12);
    curve.flat_max_depth = rows.real(13);
    curve.breakpoints = static_cast<uint64_t>(rows.integer(14));
    if (!rows.null(15)) curve.acne_free_bias_depth = rows.real(15);
    if (!rows.null(16)) curve.acne_free_bias_stored_depth = rows.real(16);
  }
  for (Statement rows(db,
                      "SELECT point, bias_depth, error, wrong, acne, peter_panning, aliasing_dark, aliasing_light, "
                      "coverage FROM curve_points ORDER BY point, i");
       rows.step();) {
    BiasCurve& curve = points.at(rows.integer(0)).curve.value();
    curve.bias_depth.push_back(rows.real(1));
    int column = 2;
    for (auto values : series) (curve.*values).push_back(rows.real(column++));
  }
}

std::map<int64_t, PointRecord> load_points(Database& db) {
  std::map<int64_t, PointRecord> points;
  for (Statement rows(db, "SELECT point, worst_x, worst_y, worst_error, worst_cause, part FROM finished");
       rows.step();) {
    PointRecord& point = points[rows.integer(0)];
    point.id = rows.integer(0);
    point.worst = {static_cast<int>(rows.integer(1)), static_cast<int>(rows.integer(2)), rows.real(3), rows.text(4)};
    point.part = rows.text(5);
  }
  for (Statement rows(db, "SELECT point, name, text FROM settings"); rows.step();)
    points.at(rows.integer(0)).settings[rows.text(1)] = rows.text(2);
  for (Statement rows(db, "SELECT point, name, value FROM metrics"); rows.step();)
    points.at(rows.integer(0)).metrics[rows.text(1)] = rows.real(2);
  for (Statement rows(db, "SELECT point, name, value FROM times"); rows.step();)
    points.at(rows.integer(0)).times[rows.text(1)] = rows.real(2);
  for (Statement rows(db, "SELECT point, name, path, caption, digest FROM pictures ORDER BY point, i"); rows.step();)
    points.at(rows.integer(0)).pictures.push_back({rows.text(1), rows.text(2), rows.text(3), rows.text(4)});
  for (Statement rows(db, "SELECT point, path, digest FROM images ORDER BY point, i"); rows.step();)
    points.at(rows.integer(0)).images.push_back({rows.text(1), rows.text(2)});
  load_curves(db, points);
  return points;
}

std::vector<BoundResult> load_bounds(Database& db) {
  std::vector<BoundResult> bounds;
  for (Statement rows(db,
                      "SELECT metric, max, min, where_json, join_by, held, found, point, points, reproduce FROM bounds "
                      "ORDER BY i");
       rows.step();) {
    BoundResult bound;
    bound.metric = rows.text(0);
    if (!rows.null(1)) bound.max = rows.real(1);
    if (!rows.null(2)) bound.min = rows.real(2);
    bound.where = nlohmann::json::parse(rows.text(3)).get<std::map<std::string, std::vector<std::string>>>();
    bound.join = rows.text(4);
    bound.held = rows.integer(5) != 0;
    bound.found = rows.real(6);
    bound.point = rows.integer(7);
    bound.points = static_cast<int>(rows.integer(8));
    bound.reproduce = rows.text(9);
    bounds.push_back(std::move(bound));
  }
  return bounds;
}

constexpr std::pair<LawRelation, std::string_view> relations[] = {
    {LawRelation::equal, "="}, {LawRelation::at_most, "<="}, {LawRelation::at_least, ">="}};

std::vector<LawResult> load_laws(Database& db) {
  std::vector<LawResult> laws;
  for (Statement rows(
           db,
           "SELECT part, name, says, measured, relation, predicted, tolerance, join_by, held, worst, reproduce, found "
           "FROM laws ORDER BY i");
       rows.step();) {
    LawResult law;
    law.part = rows.text(0);
    law.name = rows.text(1);
    law.says = rows.text(2);
    law.measured = rows.text(3);
    const std::string sign = rows.text(4);
    const auto row = std::find_if(std::begin(relations), std::end(relations),
                                  [&](const auto& relation) { return relation.second == sign; });
    if (row == std::end(relations)) throw std::runtime_error("a law whose relation is none");
    law.relation = row->first;
    law.predicted = rows.text(5);
    law.tolerance = rows.text(6);
    law.join = rows.text(7);
    law.held = rows.integer(8) != 0;
    law.worst = static_cast<int>(rows.integer(9));
    law.reproduce = rows.text(10);
    law.found = rows.text(11);
    laws.push_back(std::move(law));
  }
  for (Statement rows(db, "SELECT law, point, predicted, measured, allowed FROM law_samples ORDER BY law, i");
       rows.step();)
    laws.at(static_cast<size_t>(rows.integer(0)))
        .samples.push_back({rows.integer(1), rows.real(2), rows.real(3), rows.real(4)});
  for (const LawResult& law : laws)
    if (law.worst < -1 || law.worst >= static_cast<int>(law.samples.size()))
      throw std::runtime_error("a law whose worst sample is none of its samples");
  return laws;
}

// Rows that do not fit together, and text that is no JSON, are faults of the file.
template <class Read>
auto read_rows(const Database& db, const Read& read) {
  try {
    return read();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(ErrorKind::scene,
                fmt::format("{}: holds what Noonmark did not write ({}); {}", db.path(), error.what(), db.way_out()));
  }
}

}  // namespace

ResultStore::ResultStore(const std::string& path, const std::string& fingerprint, Existing existing) {
  if (existing == Existing::overwrite) remove_store(path);
  db_ = std::make_unique<Database>(path, Database::Mode::create);
  db_->execute("PRAGMA synchronous = EXTRA");
  {
    Transaction transaction(*db_);  // of two programs that start on an empty file, one makes the tables
    if (db_->ask("SELECT count(*) FROM sqlite_master") == "0") {
      db_->execute(store_schema());
      db_->execute(
          fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {};", store_application_id, store_version));
      Statement(*db_, "INSERT INTO info VALUES ('fingerprint', ?)").run(fingerprint);
      seal_info(*db_);
      seal_verdict(*db_);
      transaction.commit();
      return;
    }
  }
  check_store(*db_);
  db_->execute("PRAGMA journal_mode = DELETE");  // a person's tool may have left it otherwise
  const std::string there = this->fingerprint();
  if (there != fingerprint)
    throw OtherResults(fmt::format("{}: holds the results of another experiment ({}); {}", path,
                                   first_difference(fingerprint, there), db_->way_out()));
}

ResultStore::ResultStore(std::unique_ptr<Database> db) : db_(std::move(db)) {}
ResultStore::~ResultStore() = default;
ResultStore::ResultStore(ResultStore&&) noexcept = default;
ResultStore& ResultStore::operator=(ResultStore&&) noexcept = default;

ResultStore ResultStore::open(const std::string& path) {
  auto db = std::make_unique<Database>(path, Database::Mode::existing);
  check_store(*db);
  return ResultStore(std::move(db));
}

std::vector<int64_t> ResultStore::finished() const {
  std::vector<int64_t> ids;
  for (Statement rows(*db_, "SELECT point FROM finished ORDER BY point"); rows.step();) ids.push_back(rows.integer(0));
  return ids;
}

std::vector<std::string> ResultStore::repair(int64_t planned_points,
                                             const std::function<bool(const PointRecord&)>& expected) {
  std::vector<std::string> said;
  const auto say = [&](int64_t point, const char* why) {
    if (point < 0 || point >= planned_points)
      said.push_back(fmt::format("{}: has rows of point {}, which this experiment does not have; they are dropped",
                                 db_->path(), point));
    else
      said.push_back(fmt::format("{}: the rows of point {} are {}; it is measured anew", db_->path(), point, why));
  };
  Transaction transaction(*db_);
  for (int64_t point : broken_points(*db_)) {
    remove_point(*db_, point);
    say(point, "not those that were stored (edited, lost, or of another store)");
  }
  for (const auto& [id, point] : read_rows(*db_, [&] { return load_points(*db_); })) {
    if (id >= 0 && id < planned_points && expected(point)) continue;
    remove_point(*db_, id);
    say(id, "of another experiment");
  }
  if (!verdict_holds(*db_)) {
    db_->execute("DELETE FROM bounds; DELETE FROM laws; DELETE FROM law_samples");
    seal_verdict(*db_);
    said.push_back(fmt::format("{}: the stored verdict was edited; it is judged anew", db_->path()));
  }
  transaction.commit();
  return said;
}

void ResultStore::add(const PointRecord& point) {
  Transaction transaction(*db_);
  if (db_->ask(fmt::format("SELECT 1 FROM finished WHERE point = {}", point.id)))
    throw Error(ErrorKind::usage,
                fmt::format("point {} is in the result store already; let no two runs share one --out", point.id));
  Statement(*db_, "INSERT INTO finished VALUES (?, ?, ?, ?, ?, ?)")
      .run(point.id, point.part, point.worst.x, point.worst.y, point.worst.error, point.worst.cause);
  Statement settings(*db_, "INSERT INTO settings VALUES (?, ?, ?, ?)");
  for (const auto& [name, text] : point.settings) {
    bind_setting_value(settings, 3, name, text);
    settings.bind(4, text);
    settings.run(point.id, name);
  }
  add_numbers(*db_, "metrics", point.id, point.metrics);
  add_numbers(*db_, "times", point.id, point.times);
  if (point.curve) add_curve(*db_, point.id, *point.curve);
  add_pictures(*db_, point.id, point);
  seal_point(*db_, point.id);
  transaction.commit();
}

void ResultStore::set_pictures(int64_t point, const PointPictures& pictures) {
  Transaction transaction(*db_);
  if (!db_->ask(fmt::format("SELECT 1 FROM finished WHERE point = {}", point)))
    throw std::logic_error(fmt::format("pictures of point {}, which is not in the store", point));
  Statement(*db_, "DELETE FROM pictures WHERE point = ?").run(point);
  Statement(*db_, "DELETE FROM images WHERE point = ?").run(point);
  add_pictures(*db_, point, pictures);
  seal_point(*db_, point);
  transaction.commit();
}

void ResultStore::set_info(const RunInfo& info, int64_t planned_points) {
  Transaction transaction(*db_);
  db_->execute("DELETE FROM info WHERE key <> 'fingerprint'");
  Statement insert(*db_, "INSERT INTO info VALUES (?, ?)");
  for (const auto& [name, member] : info_texts) insert.run(name, info.*member);
  for (const auto& [name, version] : info.libraries) insert.run(std::string(library_prefix) + name, version);
  insert.run("swept", json_text(info.swept));
  insert.run("plot", json_text(info.plot));
  insert.run("triangles", std::to_string(info.triangles));
  insert.run("scene_notes", json_text(info.scene_notes));
  insert.run("planned_points", std::to_string(planned_points));
  seal_info(*db_);
  transaction.commit();
}

void ResultStore::set_bounds(const std::vector<BoundResult>& bounds) {
  Transaction transaction(*db_);
  db_->execute("DELETE FROM bounds");
  Statement insert(*db_, "INSERT INTO bounds VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  for (size_t i = 0; i < bounds.size(); ++i) {
    const BoundResult& b = bounds[i];
    insert.run(static_cast<int64_t>(i), b.metric, b.max, b.min, json_text(b.where), b.join, b.held ? 1 : 0, b.found,
               b.point, b.points, b.reproduce);
  }
  seal_verdict(*db_);
  transaction.commit();
}

void ResultStore::set_laws(const std::vector<LawResult>& laws) {
  Transaction transaction(*db_);
  db_->execute("DELETE FROM laws; DELETE FROM law_samples");
  Statement insert(*db_, "INSERT INTO laws VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  Statement insert_sample(*db_, "INSERT INTO law_samples VALUES (?, ?, ?, ?, ?, ?)");
  for (size_t i = 0; i < laws.size(); ++i) {
    const LawResult& law = laws[i];
    std::string sign;
    for (const auto& [relation, text] : relations)
      if (relation == law.relation) sign = text;
    insert.run(static_cast<int64_t>(i), law.part, law.name, law.says, law.measured, sign, law.predicted, law.tolerance,
               law.join, law.held ? 1 : 0, law.worst, law.reproduce, law.found);
    for (size_t j = 0; j < law.samples.size(); ++j) {
      const LawResult::Sample& sample = law.samples[j];
      insert_sample.run(static_cast<int64_t>(i), static_cast<int64_t>(j), sample.point, sample.predicted,
                        sample.measured, sample.allowed);
    }
  }
  seal_verdict(*db_);
  transaction.commit();
}

Results ResultStore::load() const {
  Results results;
  db_->execute("BEGIN");  // one moment of the store, whoever writes meanwhile
  try {
    require_sealed(*db_);
    read_rows(*db_, [&] {
      load_info(*db_, results);
      for (auto& [id, point] : load_points(*db_)) results.points.push_back(std::move(point));
      results.bounds = load_bounds(*db_);
      results.laws = load_laws(*db_);
    });
  } catch (...) {
    db_->execute("ROLLBACK");
    throw;
  }
  db_->execute("COMMIT");
  return results;
}

std::string ResultStore::fingerprint() const {
  return db_->ask("SELECT value FROM info WHERE key = 'fingerprint'").value_or("");
}

}  // namespace noonmark
