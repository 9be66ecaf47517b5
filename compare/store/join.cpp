#include "compare/store/join.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <string_view>

#include "base/error.h"
#include "compare/results/metrics.h"
#include "compare/results/record_fields.h"
#include "compare/store/record_tables.h"
#include "compare/store/schema.h"
#include "compare/store/seals.h"
#include "compare/store/sqlite.h"

namespace noonmark {
namespace {

using sqlite::Database;
using sqlite::Statement;
using sqlite::Transaction;

constexpr size_t most_differences_named = 3;

class AttachedStore {
 public:
  AttachedStore(Database& db, const std::string& path) : db_(db) {
    Statement attach(db, "ATTACH DATABASE ? AS other");
    attach.run(path);
  }
  ~AttachedStore() {
    try {
      db_.execute("DETACH DATABASE other");
    } catch (const Error&) {  // it is detached with the connection
    }
  }
  AttachedStore(const AttachedStore&) = delete;
  AttachedStore& operator=(const AttachedStore&) = delete;

 private:
  Database& db_;
};

std::string quoted_list(const std::vector<std::string>& names) { return fmt::format("'{}'", fmt::join(names, "', '")); }

// The metrics that two runs need not share.
std::string clocked_metrics() {
  std::vector<std::string> names;
  for (const Metric& row : metrics_table())
    if (row.unit == "ms") names.emplace_back(row.name);
  return quoted_list(names);
}

// The columns of `finished` that two runs share.
std::string shared_fields(const char* prefix) {
  std::string list;
  for (const RecordField& field : record_fields())
    if (field.group != machine_group) list += fmt::format("{}{}.{}", list.empty() ? "" : ", ", prefix, field.name);
  return list;
}

// Named values of a point that are in one of the two stores only, or are others.
std::string differing_values(std::string_view table, std::string_view value, std::string_view but) {
  const auto one_way = [&](const char* from, const char* to) {
    return fmt::format(
        "SELECT a.point, a.name FROM {0}.{2} a JOIN temp.both s ON s.point = a.point LEFT JOIN {1}.{2} b ON b.point = "
        "a.point AND b.name = a.name WHERE a.name NOT IN ({4}) AND (b.name IS NULL OR a.{3} IS NOT b.{3})",
        from, to, table, value, but);
  };
  return one_way("main", "other") + " UNION " + one_way("other", "main");
}

// Rows of a table that only one of the stores has.
std::string differing_rows(std::string_view table, const std::string& columns) {
  const auto rows = [&](const char* from) {
    return fmt::format("SELECT {} FROM {}.{} t WHERE t.point IN (SELECT point FROM temp.both)", columns, from, table);
  };
  return fmt::format("SELECT point FROM (SELECT * FROM ({0} EXCEPT {1}) UNION ALL SELECT * FROM ({1} EXCEPT {0}))",
                     rows("main"), rows("other"));
}

std::string value_in(Database& db, const char* store, std::string_view table, std::string_view value, int64_t point,
                     const std::string& name) {
  Statement row(db, fmt::format("SELECT {} FROM {}.{} WHERE point = ? AND name = ?", value, store, table));
  row.bind(1, point);
  row.bind(2, name);
  if (!row.step()) return "not there";
  return row.null(0) ? "not finite" : value == "text" ? row.text(0) : fmt::format("{}", row.real(0));
}

PointRecord metrics_in(Database& db, const char* store, int64_t point) {
  PointRecord record;
  record.id = point;
  Statement rows(db, fmt::format("SELECT name, value FROM {}.metrics WHERE point = ?", store));
  rows.bind(1, point);
  while (rows.step()) record.metrics[rows.text(0)] = rows.real(1);
  return record;
}

void compare_both(Database& db, JoinedStore& joined) {
  std::map<int64_t, Difference> first;  // of each point
  const auto found = [&](int64_t point, const std::string& what) -> Difference* {
    const auto [at, added] = first.emplace(point, Difference{point, what, "", ""});
    return added ? &at->second : nullptr;
  };
  // The names of scenes are compared as they are here.
  for (Statement rows(
           db, differing_values("settings", "text", "'scene.name'") +
                   " UNION SELECT a.point, a.name FROM main.settings a JOIN other.settings b USING (point, name) "
                   "LEFT JOIN temp.renamed r ON r.there = b.text WHERE a.name = 'scene.name' AND a.text IS NOT "
                   "coalesce(r.here, b.text)");
       rows.step();)
    if (Difference* const one = found(rows.integer(0), "setting " + rows.text(1))) {
      one->here = value_in(db, "main", "settings", "text", one->point, rows.text(1));
      one->there = value_in(db, "other", "settings", "text", one->point, rows.text(1));
    }
  for (Statement rows(db, differing_values("metrics", "value", clocked_metrics())); rows.step();)
    if (Difference* const one = found(rows.integer(0), rows.text(1))) {
      one->here = value_in(db, "main", "metrics", "value", one->point, rows.text(1));
      one->there = value_in(db, "other", "metrics", "value", one->point, rows.text(1));
    }
  for (const char* table : {"curves", "curve_points", "curve_windows"})
    for (Statement rows(db, differing_rows(table, "*")); rows.step();) found(rows.integer(0), "the bias curve");
  for (Statement rows(db, differing_rows("finished", "t.point, " + shared_fields("t"))); rows.step();)
    found(rows.integer(0), "the part or the worst pixel");
  for (Statement rows(db, differing_rows("worst_pixels", "*")); rows.step();)
    found(rows.integer(0), "the worst pixel of a metric");
  for (Statement rows(db, differing_rows("cascades", "*")); rows.step();) found(rows.integer(0), "the cascades");
  for (const char* table : {"lookup_curves", "lookup_bounds"})
    for (Statement rows(db, differing_rows(table, "*")); rows.step();)
      found(rows.integer(0), "a curve of the filtered map");
  joined.differing = static_cast<int64_t>(first.size());
  for (auto& [point, one] : first) {
    if (joined.differences.size() == most_differences_named) break;
    one.records = {metrics_in(db, "main", point), metrics_in(db, "other", point)};
    joined.differences.push_back(std::move(one));
  }
}

void read_pictures_of_new(Database& db, JoinedStore& joined) {
  std::map<int64_t, PointPictures> of_points;
  for (Statement rows(db,
                      "SELECT point, path, digest FROM other.pictures WHERE point IN (SELECT point FROM temp.added)");
       rows.step();)
    of_points[rows.integer(0)].pictures.push_back({"", rows.text(1), "", rows.text(2)});
  for (Statement rows(db, "SELECT point, path, digest FROM other.images WHERE point IN (SELECT point FROM temp.added)");
       rows.step();)
    of_points[rows.integer(0)].images.push_back({rows.text(1), rows.text(2)});
  for (auto& [point, pictures] : of_points) joined.pictures.push_back(std::move(pictures));
}

// Fills temp.renamed with the scenes that have another name here.
void find_other_names(Database& db, const SceneName& scene_name) {
  std::vector<std::string> names;
  for (Statement rows(db, "SELECT DISTINCT text FROM other.settings WHERE name = 'scene.name'"); rows.step();)
    names.push_back(rows.text(0));
  for (const std::string& there : names)
    if (const std::string here = scene_name(there); here != there) {
      Statement insert(db, "INSERT INTO temp.renamed VALUES (?, ?)");
      insert.bind(1, there);
      insert.bind(2, here);
      insert.step();
    }
}

// Gives the scenes of the rows that were taken over their names here, and seals those rows again.
void rename_scenes(Database& db) {
  std::vector<int64_t> points, phases;
  for (Statement rows(db,
                      "SELECT s.point FROM main.settings s JOIN temp.renamed r ON r.there = s.text WHERE s.name = "
                      "'scene.name' AND s.point IN (SELECT point FROM temp.added)");
       rows.step();)
    points.push_back(rows.integer(0));
  db.execute(
      "UPDATE main.settings SET value = (SELECT here FROM temp.renamed WHERE there = text), text = (SELECT here FROM "
      "temp.renamed WHERE there = text) WHERE name = 'scene.name' AND point IN (SELECT point FROM temp.added) AND text "
      "IN "
      "(SELECT there FROM temp.renamed)");
  for (const int64_t point : points) seal_point(db, point);

  std::vector<std::pair<std::string, std::string>> names;
  for (Statement rows(db, "SELECT there, here FROM temp.renamed"); rows.step();)
    names.emplace_back("\nscene.name = " + rows.text(0) + "\n", "\nscene.name = " + rows.text(1) + "\n");
  if (names.empty()) return;
  for (Statement rows(db, "SELECT phase FROM temp.drawn"); rows.step();) phases.push_back(rows.integer(0));
  for (const auto& [there, here] : names) {
    Statement update(db,
                     "UPDATE main.phases SET made_from = replace(made_from, ?, ?) WHERE phase IN (SELECT phase FROM "
                     "temp.drawn)");
    update.bind(1, there);
    update.bind(2, here);
    update.step();
  }
  for (const int64_t phase : phases) seal_phase(db, phase);
}

void take_over(Database& db, std::string_view table, std::string_view id, std::string_view added) {
  db.execute(fmt::format("INSERT INTO main.{0} SELECT * FROM other.{0} WHERE {1} IN (SELECT {1} FROM temp.{2})", table,
                         id, added));
}

}  // namespace

JoinedStore join_store(Database& db, const std::string& path, const SceneName& scene_name) {
  const AttachedStore attached(db, path);
  JoinedStore joined;
  db.execute(
      "CREATE TEMP TABLE IF NOT EXISTS both (point INTEGER PRIMARY KEY);"
      "CREATE TEMP TABLE IF NOT EXISTS added (point INTEGER PRIMARY KEY);"
      "CREATE TEMP TABLE IF NOT EXISTS drawn (phase INTEGER PRIMARY KEY);"
      "CREATE TEMP TABLE IF NOT EXISTS renamed (there TEXT PRIMARY KEY, here TEXT);"
      "DELETE FROM temp.renamed; DELETE FROM temp.both; DELETE FROM temp.added; DELETE FROM temp.drawn");
  Transaction transaction(db);
  const std::string there =
      fmt::format("SELECT point FROM other.finished WHERE point >= 0 AND point < {}", first_aside);
  db.execute("INSERT INTO temp.both " + there + " AND point IN (SELECT point FROM main.finished)");
  db.execute("INSERT INTO temp.added " + there + " AND point NOT IN (SELECT point FROM main.finished)");
  db.execute(
      "INSERT INTO temp.drawn SELECT phase FROM other.phases WHERE phase NOT IN (SELECT phase FROM main.phases)");
  for (Statement rows(db, "SELECT point FROM temp.added ORDER BY point"); rows.step();)
    joined.points.push_back(rows.integer(0));
  joined.shared = std::stoll(db.ask("SELECT count(*) FROM temp.both").value_or("0"));
  find_other_names(db, scene_name);
  if (joined.shared > 0) compare_both(db, joined);
  for (const std::string_view table : tables_of_points()) take_over(db, table, "point", "added");
  for (const std::string_view table : tables_of_phases()) take_over(db, table, "phase", "drawn");
  db.execute(
      "INSERT INTO main.seals SELECT name, digest FROM other.seals WHERE name IN (SELECT 'point ' || point FROM "
      "temp.added "
      "UNION ALL SELECT 'phase ' || phase FROM temp.drawn)");
  rename_scenes(db);
  db.execute(fmt::format("INSERT OR REPLACE INTO main.info SELECT key, value FROM other.info WHERE key GLOB '{}*'",
                         cause_prefix));
  seal_info(db);
  read_pictures_of_new(db, joined);
  transaction.commit();
  return joined;
}

}  // namespace noonmark
