#include "compare/store/store.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <new>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "base/error.h"
#include "compare/store/check.h"
#include "compare/store/fingerprint.h"
#include "compare/store/journal.h"
#include "compare/store/phase_tables.h"
#include "compare/store/point_rows.h"
#include "compare/store/record_tables.h"
#include "compare/store/schema.h"
#include "compare/store/seals.h"
#include "compare/store/sqlite.h"

namespace noonmark {
namespace {

using sqlite::Database;
using sqlite::Statement;
using sqlite::Transaction;

// The text members of RunInfo, with their keys in the table `info`.
constexpr std::pair<std::string_view, std::string RunInfo::*> info_texts[] = {
    {"experiment", &RunInfo::experiment},
    {"file", &RunInfo::file},
    {"title", &RunInfo::title},
    {"command", &RunInfo::command},
    {"commit", &RunInfo::commit},
    {"version", &RunInfo::version},
    {"started", &RunInfo::started},
    {"host_cpu", &RunInfo::host_cpu},
    {"gl_vendor", &RunInfo::gl_vendor},
    {"gl_renderer", &RunInfo::gl_renderer},
    {"gl_version", &RunInfo::gl_version},
    {"gl_timer", &RunInfo::gl_timer},
    {"embree_version", &RunInfo::embree_version},
    {"embree_isa", &RunInfo::embree_isa},
    {"scene_name", &RunInfo::scene_name},
    {"cost", &RunInfo::cost},
    {"accuracy", &RunInfo::accuracy},
    {"definition", &RunInfo::definition},
    {"share", &RunInfo::share},
};
constexpr std::string_view library_prefix = "library.";

void remove_store(const std::string& path) {
  // The database is removed first. SQLite drops a journal without a database, but a database without its journal may be
  // damaged.
  for (const char* ending : {"", "-journal", "-wal", "-shm"}) {
    const std::string file = path + ending;
    if (::unlink(file.c_str()) != 0 && errno != ENOENT)
      throw Error(ErrorKind::file,
                  fmt::format("{}: cannot be removed: {}; choose another --out", file, std::strerror(errno)));
  }
}

bool is_finished(Database& db, int64_t point) {
  Statement rows(db, "SELECT 1 FROM finished WHERE point = ?");
  rows.bind(1, point);
  return rows.step();
}

constexpr std::string_view baseline_key = "baseline";
constexpr std::pair<const char*, std::vector<std::string> BaselineComparison::*> baseline_lists[] = {
    {"worse", &BaselineComparison::worse},
    {"better", &BaselineComparison::better},
    {"notes", &BaselineComparison::notes},
    {"changed", &BaselineComparison::changed}};

BaselineComparison baseline_of(const nlohmann::json& text) {
  BaselineComparison found;
  for (const auto& [name, member] : baseline_lists) text.at(name).get_to(found.*member);
  text.at("compared").get_to(found.compared);
  return found;
}

void load_info(Database& db, Results& results) {
  RunInfo& info = results.info;
  for (Statement rows(db, "SELECT key, value FROM info"); rows.step();) {
    const std::string key = rows.text(0), value = rows.text(1);
    for (const auto& [name, member] : info_texts)
      if (key == name) info.*member = value;
    if (key.starts_with(library_prefix)) info.libraries[key.substr(library_prefix.size())] = value;
    if (key == "swept") info.swept = nlohmann::json::parse(value).get<std::vector<std::string>>();
    if (key == "over") info.over = nlohmann::json::parse(value).get<std::vector<std::string>>();
    if (key == "plot") info.plot = nlohmann::json::parse(value).get<std::vector<std::string>>();
    if (key == "scene_notes") info.scene_notes = nlohmann::json::parse(value).get<std::vector<std::string>>();
    if (key == "sweep_notes") info.sweep_notes = nlohmann::json::parse(value).get<std::vector<std::string>>();
    if (key == "triangles") info.triangles = std::stoull(value);
    if (key == "planned_points") results.planned_points = std::stoll(value);
    if (key == baseline_key) results.baseline = baseline_of(nlohmann::json::parse(value));
  }
}

std::vector<BoundResult> load_bounds(Database& db) {
  std::vector<BoundResult> bounds;
  bounds_table().read(db, [&](std::span<const int64_t>, BoundResult bound) { bounds.push_back(std::move(bound)); });
  return bounds;
}

std::vector<LawResult> load_laws(Database& db) {
  std::vector<LawResult> laws;
  laws_table().read(db, [&](std::span<const int64_t>, LawResult law) { laws.push_back(std::move(law)); });
  law_samples_table().read(db, [&](std::span<const int64_t> key, LawResult::Sample sample) {
    laws.at(static_cast<size_t>(key[0])).samples.push_back(sample);
  });
  for (const LawResult& law : laws)
    if (law.worst < -1 || law.worst >= static_cast<int>(law.samples.size()))
      throw std::runtime_error("a law whose worst sample is not one of its samples");
  return laws;
}

// Rows that contradict each other, and text that is not JSON, are faults of the file.
template <class Read>
auto read_rows(const Database& db, const Read& read) {
  try {
    return read();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(ErrorKind::file, fmt::format("{}: holds data that Noonmark did not write ({}); {}", db.path(),
                                             error.what(), db.way_out()));
  }
}

}  // namespace

ResultStore::ResultStore(const std::string& path, const std::string& fingerprint, Existing existing) {
  if (existing == Existing::overwrite) remove_store(path);
  db_ = std::make_unique<Database>(path, Database::Mode::create);
  db_->execute("PRAGMA synchronous = EXTRA");
  {
    Transaction transaction(*db_);  // if two programs start on an empty file, one of them makes the tables
    if (db_->ask("SELECT count(*) FROM sqlite_master") == "0") {
      db_->execute(store_schema());
      db_->execute(
          fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {};", store_application_id, store_version));
      Statement(*db_, "INSERT INTO info VALUES ('fingerprint', ?)").run(fingerprint);
      seal_info(*db_);
      seal_verdict(*db_);
      transaction.commit();
    }
  }
  check_store(*db_);
  const std::string here = without_scenes(fingerprint), there = without_scenes(this->fingerprint());
  if (!same_facts(here, there))
    throw OtherResults(fmt::format("{}: its points were measured by another program or on another machine ({}); {}",
                                   db_->path(), first_difference(here, there), db_->way_out()));
  begin_writing(*db_);
  writes_ = true;
}

ResultStore::ResultStore(std::unique_ptr<Database> db) : db_(std::move(db)) {}
ResultStore::~ResultStore() {
  if (db_ && writes_) end_writing(*db_);
}
ResultStore::ResultStore(ResultStore&&) noexcept = default;
ResultStore& ResultStore::operator=(ResultStore&&) noexcept = default;

ResultStore ResultStore::open(const std::string& path) {
  auto db = std::make_unique<Database>(path, Database::Mode::existing);
  check_store(*db);
  return ResultStore(std::move(db));
}

std::string ResultStore::experiment_file(const std::string& path) try {
  return Database(path, Database::Mode::existing).ask("SELECT value FROM info WHERE key = 'file'").value_or("");
} catch (const Error&) {
  return "";
}

std::vector<BoundResult> ResultStore::bounds_of(const std::string& path) try {
  const ResultStore store = open(path);
  const bool whole = static_cast<int64_t>(store.finished().size()) >= store.facts().planned_points;
  return whole ? load_bounds(*store.db_) : std::vector<BoundResult>();
} catch (const Error&) {
  return {};
}

std::vector<int64_t> ResultStore::finished() const {
  std::vector<int64_t> ids;
  for (Statement rows(*db_, "SELECT point FROM finished ORDER BY point"); rows.step();)
    if (const int64_t id = rows.integer(0); id < first_aside) ids.push_back(id);
  return ids;
}

std::vector<PointRecord> ResultStore::all_points() const {
  std::vector<PointRecord> points;
  read_rows(*db_, [&] {
    for (auto& [id, point] : load_points(*db_)) points.push_back(std::move(point));
  });
  return points;
}

void ResultStore::replace(const std::vector<std::pair<int64_t, PointRecord>>& changed) {
  Transaction transaction(*db_);
  for (const auto& [id, point] : changed) remove_point(*db_, id);
  for (const auto& [id, point] : changed) {
    add_rows(*db_, point);
    seal_point(*db_, point.id);
  }
  transaction.commit();
}

void ResultStore::require_in_place() const { db_->require_in_place(); }

std::string ResultStore::plan() const { return db_->ask("SELECT value FROM info WHERE key = 'plan'").value_or(""); }

void ResultStore::set_plan(const std::string& fingerprint, const std::string& plan) {
  Transaction transaction(*db_);
  Statement(*db_, "INSERT OR REPLACE INTO info VALUES ('fingerprint', ?)")
      .run(joined_facts(fingerprint, this->fingerprint()));
  Statement(*db_, "INSERT OR REPLACE INTO info VALUES ('plan', ?)").run(plan);
  seal_info(*db_);
  transaction.commit();
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
  const StoredPoints read = read_rows(*db_, [&] { return read_points(*db_); });
  for (int64_t point : read.broken) {
    remove_point(*db_, point);
    say(point, "not those that were stored (edited or lost, or from another store)");
  }
  read_rows(*db_, [&] {
    if (read.fault) std::rethrow_exception(read.fault);
  });
  for (const auto& [id, point] : read.whole) {
    if (id >= 0 && expected(point)) continue;
    remove_point(*db_, id);
    say(id, "not those of a whole measurement");
  }
  if (!verdict_holds(*db_)) {
    db_->execute("DELETE FROM bounds; DELETE FROM laws; DELETE FROM law_samples");
    seal_verdict(*db_);
    said.push_back(fmt::format("{}: the stored verdict was edited; it is judged anew", db_->path()));
  }
  transaction.commit();
  return said;
}

std::vector<int64_t> ResultStore::phases() const {
  std::vector<int64_t> ids;
  for (Statement rows(*db_, "SELECT phase FROM phases ORDER BY phase"); rows.step();) ids.push_back(rows.integer(0));
  return ids;
}

std::vector<PhaseDiagram> ResultStore::stored_phases() const {
  std::vector<PhaseDiagram> diagrams;
  const std::vector<int64_t> broken = broken_phases(*db_);
  for (auto& [id, diagram] : read_rows(*db_, [&] { return load_phase_rows(*db_); }))
    if (std::find(broken.begin(), broken.end(), id) == broken.end()) diagrams.push_back(std::move(diagram));
  return diagrams;
}

std::vector<std::string> ResultStore::repair_phases(const std::function<bool(int64_t, const PhaseDiagram&)>& expected) {
  std::vector<std::string> said;
  Transaction transaction(*db_);
  for (int64_t phase : broken_phases(*db_)) {
    remove_phase(*db_, phase);
    said.push_back(
        fmt::format("{}: the rows of phase diagram {} are not those that were stored (edited or lost, or "
                    "from another store); it is made anew",
                    db_->path(), phase));
  }
  // Another [phase] changes no point, so only the diagram is made anew.
  for (const auto& [id, diagram] : read_rows(*db_, [&] { return load_phase_rows(*db_); }))
    if (!expected(id, diagram)) remove_phase(*db_, id);
  transaction.commit();
  return said;
}

void ResultStore::add_phase(int64_t phase, const PhaseDiagram& diagram) {
  Transaction transaction(*db_);
  const std::vector<int64_t> there = phases();
  if (std::find(there.begin(), there.end(), phase) != there.end())
    throw Error(ErrorKind::usage,
                fmt::format("phase diagram {} is in the result store already; let no two runs share one --out", phase));
  add_phase_rows(*db_, phase, diagram);
  seal_phase(*db_, phase);
  transaction.commit();
}

void ResultStore::add(const PointRecord& point) {
  Transaction transaction(*db_);
  if (is_finished(*db_, point.id))
    throw Error(ErrorKind::usage,
                fmt::format("point {} is in the result store already; let no two runs share one --out", point.id));
  add_rows(*db_, point);
  for (const RungCause& cause : point.causes)
    Statement(*db_, "INSERT OR REPLACE INTO info VALUES (?, ?)")
        .run(std::string(cause_prefix) + cause.name, text_of_cause(cause));
  seal_point(*db_, point.id);
  if (!point.causes.empty()) seal_info(*db_);
  transaction.commit();
}

void ResultStore::set_pictures(int64_t point, const PointPictures& pictures) {
  Transaction transaction(*db_);
  if (!is_finished(*db_, point))
    throw std::logic_error(fmt::format("pictures of point {}, which is not in the store", point));
  Statement(*db_, "DELETE FROM pictures WHERE point = ?").run(point);
  Statement(*db_, "DELETE FROM images WHERE point = ?").run(point);
  add_pictures(*db_, point, pictures);
  seal_point(*db_, point);
  transaction.commit();
}

void ResultStore::set_metrics(const std::map<int64_t, std::map<std::string, double>>& of_points) {
  Transaction transaction(*db_);
  Statement set(*db_, "INSERT OR REPLACE INTO metrics VALUES (?, ?, ?)");
  for (const auto& [point, metrics] : of_points) {
    if (!is_finished(*db_, point))
      throw std::logic_error(fmt::format("metrics of point {}, which is not in the store", point));
    for (const auto& [name, value] : metrics) set.run(point, name, value);
    seal_point(*db_, point);
  }
  transaction.commit();
}

void ResultStore::set_info(const RunInfo& info, int64_t planned_points) {
  Transaction transaction(*db_);
  db_->execute(
      fmt::format("DELETE FROM info WHERE key NOT IN ('fingerprint', 'plan') AND key NOT GLOB '{}*'", cause_prefix));
  Statement insert(*db_, "INSERT INTO info VALUES (?, ?)");
  for (const auto& [name, member] : info_texts) insert.run(name, info.*member);
  for (const auto& [name, version] : info.libraries) insert.run(std::string(library_prefix) + name, version);
  insert.run("swept", json_text(info.swept));
  insert.run("over", json_text(info.over));
  insert.run("plot", json_text(info.plot));
  insert.run("triangles", std::to_string(info.triangles));
  insert.run("scene_notes", json_text(info.scene_notes));
  insert.run("sweep_notes", json_text(info.sweep_notes));
  insert.run("planned_points", std::to_string(planned_points));
  seal_info(*db_);
  transaction.commit();
}

void ResultStore::set_baseline(const BaselineComparison& baseline) {
  nlohmann::json text = {{"compared", baseline.compared}};
  for (const auto& [name, member] : baseline_lists) text[name] = baseline.*member;
  Transaction transaction(*db_);
  Statement(*db_, "INSERT OR REPLACE INTO info VALUES (?, ?)")
      .run(std::string(baseline_key), text.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  seal_info(*db_);
  transaction.commit();
}

void ResultStore::set_bounds(const std::vector<BoundResult>& bounds) {
  Transaction transaction(*db_);
  db_->execute("DELETE FROM bounds");
  Table<BoundResult>::Insert insert(*db_, bounds_table());
  for (size_t i = 0; i < bounds.size(); ++i) insert.row({static_cast<int64_t>(i)}, bounds[i]);
  seal_verdict(*db_);
  transaction.commit();
}

void ResultStore::set_laws(const std::vector<LawResult>& laws) {
  Transaction transaction(*db_);
  db_->execute("DELETE FROM laws; DELETE FROM law_samples");
  Table<LawResult>::Insert insert(*db_, laws_table());
  Table<LawResult::Sample>::Insert insert_sample(*db_, law_samples_table());
  for (size_t i = 0; i < laws.size(); ++i) {
    const auto law = static_cast<int64_t>(i);
    insert.row({law}, laws[i]);
    for (size_t j = 0; j < laws[i].samples.size(); ++j)
      insert_sample.row({law, static_cast<int64_t>(j)}, laws[i].samples[j]);
  }
  seal_verdict(*db_);
  transaction.commit();
}

Results ResultStore::load() const {
  Results results;
  db_->execute("BEGIN");  // a consistent state, even if another program writes meanwhile
  try {
    StoredPoints read = read_rows(*db_, [&] { return read_points(*db_); });
    require_sealed(*db_, read.broken);
    read_rows(*db_, [&] {
      load_info(*db_, results);
      if (read.fault) std::rethrow_exception(read.fault);
      results.points.reserve(read.whole.size());
      for (auto& [id, point] : read.whole)
        if (id < first_aside) results.points.push_back(std::move(point));
      results.bounds = load_bounds(*db_);
      results.laws = load_laws(*db_);
      for (auto& [id, diagram] : load_phase_rows(*db_)) results.phases.push_back(std::move(diagram));
    });
  } catch (...) {
    db_->execute("ROLLBACK");
    throw;
  }
  db_->execute("COMMIT");
  return results;
}

Results ResultStore::read(const std::string& path) {
  auto db = std::make_unique<Database>(path, Database::Mode::existing);
  check_tables(*db);
  return ResultStore(std::move(db)).load();
}

Results ResultStore::facts() const {
  Results results;
  read_rows(*db_, [&] { load_info(*db_, results); });
  return results;
}

void ResultStore::require_whole() const {
  require_sealed(*db_, read_rows(*db_, [&] { return broken_points(*db_); }));
}

JoinedStore ResultStore::join(const std::string& path, const SceneName& scene_name) {
  return read_rows(*db_, [&] { return join_store(*db_, path, scene_name); });
}

std::vector<int64_t> ResultStore::lacking(const std::string& metric) const {
  Statement rows(
      *db_, "SELECT point FROM finished WHERE point NOT IN (SELECT point FROM metrics WHERE name = ?) ORDER BY point");
  rows.bind(1, metric);
  std::vector<int64_t> ids;
  while (rows.step())
    if (const int64_t id = rows.integer(0); id < first_aside) ids.push_back(id);
  return ids;
}

std::string ResultStore::fingerprint() const {
  return db_->ask("SELECT value FROM info WHERE key = 'fingerprint'").value_or("");
}

}  // namespace noonmark
