#include "compare/store/seals.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "base/digest.h"
#include "base/error.h"
#include "compare/store/sqlite.h"

namespace noonmark {
namespace {

using sqlite::Database;
using sqlite::Statement;

// Each table has a column `point`, and its first two columns give the order of its rows.
constexpr std::string_view tables_by_point[] = {"finished",     "settings", "metrics", "times",         "curves",
                                                "curve_points", "pictures", "images",  "curve_windows", "worst_pixels"};
// Each table has a column `phase`, and its first three columns give the order of its rows.
constexpr std::string_view tables_by_phase[] = {"phases", "phase_rows", "phase_cells", "phase_points"};
constexpr std::string_view info_tables[] = {"info"};
constexpr std::string_view verdict_tables[] = {"bounds", "laws", "law_samples"};

// What is sealed by its id: the tables that hold it, with the column of the id and the columns that order the rows.
struct Sealed {
  std::string_view name;
  std::span<const std::string_view> tables;
  std::string_view order;
  std::string seal(int64_t id) const { return fmt::format("{} {}", name, id); }
};
constexpr Sealed sealed_points{"point", tables_by_point, "1, 2"};
constexpr Sealed sealed_phases{"phase", tables_by_phase, "1, 2, 3"};

std::string digest_of(Database& db, std::span<const std::string_view> tables) {
  Digest digest;
  for (std::string_view table : tables) {
    digest.text(table);
    for (Statement rows(db, fmt::format("SELECT * FROM {} ORDER BY 1, 2", table)); rows.step();) rows.add_to(digest);
  }
  return digest.hex();
}

std::string digest_of(Database& db, const Sealed& what, int64_t id) {
  Digest digest;
  for (std::string_view table : what.tables) {
    digest.text(table);
    Statement rows(db, fmt::format("SELECT * FROM {} WHERE {} = ? ORDER BY {}", table, what.name, what.order));
    rows.bind(1, id);
    while (rows.step()) rows.add_to(digest);
  }
  return digest.hex();
}

void set_seal(Database& db, const std::string& name, const std::string& digest) {
  Statement(db, "INSERT OR REPLACE INTO seals VALUES (?, ?)").run(name, digest);
}

bool holds(Database& db, const std::string& name, const std::string& digest) {
  Statement seal(db, "SELECT digest FROM seals WHERE name = ?");
  seal.bind(1, name);
  return seal.step() && seal.text(0) == digest;
}

void seal(Database& db, const Sealed& what, int64_t id) { set_seal(db, what.seal(id), digest_of(db, what, id)); }

std::vector<int64_t> broken(Database& db, const Sealed& what) {
  std::set<int64_t> ids, found;
  for (std::string_view table : what.tables)
    for (Statement rows(db, fmt::format("SELECT DISTINCT {} FROM {}", what.name, table)); rows.step();)
      ids.insert(rows.integer(0));
  for (int64_t id : ids)
    if (!holds(db, what.seal(id), digest_of(db, what, id))) found.insert(id);
  return {found.begin(), found.end()};
}

void remove(Database& db, const Sealed& what, int64_t id) {
  for (std::string_view table : what.tables)
    Statement(db, fmt::format("DELETE FROM {} WHERE {} = ?", table, what.name)).run(id);
  Statement(db, "DELETE FROM seals WHERE name = ?").run(what.seal(id));
}

}  // namespace

void seal_point(Database& db, int64_t point) { seal(db, sealed_points, point); }
void seal_phase(Database& db, int64_t phase) { seal(db, sealed_phases, phase); }
void seal_info(Database& db) { set_seal(db, "info", digest_of(db, info_tables)); }
void seal_verdict(Database& db) { set_seal(db, "verdict", digest_of(db, verdict_tables)); }

std::vector<int64_t> broken_points(Database& db) { return broken(db, sealed_points); }
std::vector<int64_t> broken_phases(Database& db) { return broken(db, sealed_phases); }

bool verdict_holds(Database& db) { return holds(db, "verdict", digest_of(db, verdict_tables)); }

void require_sealed(Database& db) {
  const auto refuse = [&](const std::string& what) {
    throw Error(ErrorKind::file,
                fmt::format("{}: {} are not those that were stored (edited or lost, or from another store); run the "
                            "experiment into this folder again, which measures what is damaged anew",
                            db.path(), what));
  };
  if (const std::vector<int64_t> points = broken_points(db); !points.empty())
    refuse(fmt::format("the rows of point {}", fmt::join(points, ", ")));
  if (const std::vector<int64_t> phases = broken_phases(db); !phases.empty())
    refuse(fmt::format("the rows of phase diagram {}", fmt::join(phases, ", ")));
  if (!holds(db, "info", digest_of(db, info_tables))) refuse("the facts of the run");
  if (!verdict_holds(db)) refuse("the bounds and laws");
}

std::span<const std::string_view> tables_of_points() { return tables_by_point; }
std::span<const std::string_view> tables_of_phases() { return tables_by_phase; }

void remove_point(Database& db, int64_t point) { remove(db, sealed_points, point); }
void remove_phase(Database& db, int64_t phase) { remove(db, sealed_phases, phase); }

}  // namespace noonmark
