#include "compare/store/seals.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <deque>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_map>

#include "base/digest.h"
#include "base/error.h"
#include "compare/store/sqlite.h"

namespace noonmark {
namespace {

using sqlite::Database;
using sqlite::Statement;

// Each table has a column `point`, and its first two columns give the order of its rows.
constexpr std::string_view tables_by_point[] = {
    "finished", "settings",      "metrics",      "times",    "curves",        "curve_points", "pictures",
    "images",   "curve_windows", "worst_pixels", "cascades", "lookup_curves", "lookup_bounds"};
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

// All rows of a table, by their id. Those of one id come in the order in which digest_of() reads them.
class RowsById {
 public:
  RowsById(Database& db, const Sealed& what, std::string_view table)
      : db_(db), table_(table), rows_(db, fmt::format("SELECT * FROM {} ORDER BY {}", table, what.order)) {
    step();
  }
  std::string_view table() const { return table_; }
  std::optional<int64_t> id() const { return id_; }  // of the present row; empty after the last
  const Statement& row() const { return rows_; }
  void step() {
    id_.reset();
    if (!rows_.step()) return;
    if (!rows_.is_integer(0))
      throw Error(ErrorKind::file,
                  fmt::format("{}: holds data that Noonmark did not write (a row of {} without a number); {}",
                              db_.path(), table_, db_.way_out()));
    id_ = rows_.integer(0);
  }

 private:
  const Database& db_;
  std::string_view table_;
  Statement rows_;
  std::optional<int64_t> id_;
};

// Reads each table once and all side by side: one question for each id and table would take several times as long.
std::vector<int64_t> broken(Database& db, const Sealed& what,
                            const std::function<RowReader(std::string_view table)>& reader_of = {}) {
  std::unordered_map<std::string, std::string> seals;
  for (Statement rows(db, "SELECT name, digest FROM seals"); rows.step();) seals[rows.text(0)] = rows.text(1);
  std::deque<RowsById> tables;  // rows do not move
  std::vector<RowReader> readers;
  for (std::string_view table : what.tables) {
    tables.emplace_back(db, what, table);
    readers.push_back(reader_of ? reader_of(table) : nullptr);
  }
  std::vector<int64_t> found;
  for (;;) {
    std::optional<int64_t> id;
    for (const RowsById& rows : tables)
      if (rows.id() && (!id || *rows.id() < *id)) id = rows.id();
    if (!id) return found;
    Digest digest;
    for (size_t i = 0; i < tables.size(); ++i) {
      RowsById& rows = tables[i];
      digest.text(rows.table());
      for (; rows.id() == id; rows.step()) {
        rows.row().add_to(digest);
        if (readers[i]) readers[i](*id, rows.row());
      }
    }
    const auto seal = seals.find(what.seal(*id));
    if (seal == seals.end() || seal->second != digest.hex()) found.push_back(*id);
  }
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

std::vector<int64_t> broken_points(Database& db, const std::function<RowReader(std::string_view table)>& reader_of) {
  return broken(db, sealed_points, reader_of);
}
std::vector<int64_t> broken_phases(Database& db) { return broken(db, sealed_phases); }

bool verdict_holds(Database& db) { return holds(db, "verdict", digest_of(db, verdict_tables)); }

void require_sealed(Database& db, const std::vector<int64_t>& points) {
  const auto refuse = [&](const std::string& what) {
    throw Error(ErrorKind::file,
                fmt::format("{}: {} are not those that were stored (edited or lost, or from another store); run the "
                            "experiment into this folder again, which measures what is damaged anew",
                            db.path(), what));
  };
  if (!points.empty()) refuse(fmt::format("the rows of point {}", fmt::join(points, ", ")));
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
