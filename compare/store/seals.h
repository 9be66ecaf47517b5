// Seals of the store's rows. A seal is a digest of the rows as they were written, stored beside them. It shows rows
// that were edited, lost or added by another program. Every column of every row counts, with its type.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

namespace noonmark {

namespace sqlite {
class Database;
class Statement;
}  // namespace sqlite

// Seals the present rows. Call it within the transaction that wrote them.
void seal_point(sqlite::Database& db, int64_t point);
void seal_phase(sqlite::Database& db, int64_t phase);
void seal_info(sqlite::Database& db);
void seal_verdict(sqlite::Database& db);  // bounds and laws

// The ids of points with rows in any table that do not match their seal, ascending.
//
// Every row is read for that, so whoever needs the rows takes them from here: reader_of(table) is called once for each
// table of tables_of_points() and returns what takes its rows, or null. The rows come point by point in ascending order,
// those of a point table by table, with all columns. Throws std::runtime_error if an id is no integer.
using RowReader = std::function<void(int64_t point, const sqlite::Statement& row)>;
std::vector<int64_t> broken_points(sqlite::Database& db,
                                   const std::function<RowReader(std::string_view table)>& reader_of = {});
// The same of phase diagrams.
std::vector<int64_t> broken_phases(sqlite::Database& db);
bool verdict_holds(sqlite::Database& db);
// Throws Error(file) that names the rows that do not match their seal. points: broken_points().
void require_sealed(sqlite::Database& db, const std::vector<int64_t>& points);

// The tables that hold points (column `point`), and phase diagrams (column `phase`).
std::span<const std::string_view> tables_of_points();
std::span<const std::string_view> tables_of_phases();

// Removes a point's rows from every table, and its seal.
void remove_point(sqlite::Database& db, int64_t point);
void remove_phase(sqlite::Database& db, int64_t phase);

}  // namespace noonmark
