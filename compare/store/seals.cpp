#include "compare/store/seals.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "compare/store/sqlite.h"
#include "scenes/digest.h"
#include "scenes/error.h"

namespace noonmark {
namespace {

using sqlite::Database;
using sqlite::Statement;

// Each table has a column `point`, and its first two columns give the order of its rows.
constexpr std::string_view point_tables[] = {"finished", "settings",     "metrics",  "times",
                                             "curves",   "curve_points", "pictures", "images"};
constexpr std::string_view info_tables[] = {"info"};
constexpr std::string_view verdict_tables[] = {"bounds", "laws", "law_samples"};

// point: only the rows of this point; otherwise all rows.
std::string digest_of(Database& db, std::span<const std::string_view> tables, std::optional<int64_t> point = {}) {
  Digest digest;
  for (std::string_view table : tables) {
    digest.text(table);
    Statement rows(db, fmt::format("SELECT * FROM {} {} ORDER BY 1, 2", table, point ? "WHERE point = ?" : ""));
    if (point) rows.bind(1, *point);
    while (rows.step()) rows.add_to(digest);
  }
  return digest.hex();
}

std::string point_digest(Database& db, int64_t point) { return digest_of(db, point_tables, point); }

std::string point_seal(int64_t point) { return fmt::format("point {}", point); }

void set_seal(Database& db, const std::string& name, const std::string& digest) {
  Statement(db, "INSERT OR REPLACE INTO seals VALUES (?, ?)").run(name, digest);
}

bool holds(Database& db, const std::string& name, const std::string& digest) {
  Statement seal(db, "SELECT digest FROM seals WHERE name = ?");
  seal.bind(1, name);
  return seal.step() && seal.text(0) == digest;
}

}  // namespace

void seal_point(Database& db, int64_t point) { set_seal(db, point_seal(point), point_digest(db, point)); }
void seal_info(Database& db) { set_seal(db, "info", digest_of(db, info_tables)); }
void seal_verdict(Database& db) { set_seal(db, "verdict", digest_of(db, verdict_tables)); }

std::vector<int64_t> broken_points(Database& db) {
  std::set<int64_t> ids, broken;
  for (std::string_view table : point_tables)
    for (Statement rows(db, fmt::format("SELECT DISTINCT point FROM {}", table)); rows.step();)
      ids.insert(rows.integer(0));
  for (int64_t id : ids)
    if (!holds(db, point_seal(id), point_digest(db, id))) broken.insert(id);
  return {broken.begin(), broken.end()};
}

bool verdict_holds(Database& db) { return holds(db, "verdict", digest_of(db, verdict_tables)); }

void require_sealed(Database& db) {
  const auto refuse = [&](const std::string& what) {
    throw Error(ErrorKind::file,
                fmt::format("{}: {} are not those that were stored (edited or lost, or from another store); run the "
                            "experiment into this folder again, which measures the damaged points anew",
                            db.path(), what));
  };
  if (const std::vector<int64_t> broken = broken_points(db); !broken.empty())
    refuse(fmt::format("the rows of point {}", fmt::join(broken, ", ")));
  if (!holds(db, "info", digest_of(db, info_tables))) refuse("the facts of the run");
  if (!verdict_holds(db)) refuse("the bounds and laws");
}

void remove_point(Database& db, int64_t point) {
  for (std::string_view table : point_tables)
    Statement(db, fmt::format("DELETE FROM {} WHERE point = ?", table)).run(point);
  Statement(db, "DELETE FROM seals WHERE name = ?").run(point_seal(point));
}

}  // namespace noonmark
