// Seals of the store's rows. A seal is a digest of the rows as they were written, stored beside them. It shows rows
// that were edited, lost or added by another program. Every column of every row counts, with its type.
#pragma once
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace noonmark {

namespace sqlite {
class Database;
}

// Seals the present rows. Call it within the transaction that wrote them.
void seal_point(sqlite::Database& db, int64_t point);
void seal_phase(sqlite::Database& db, int64_t phase);
void seal_info(sqlite::Database& db);
void seal_verdict(sqlite::Database& db);  // bounds and laws

// The ids of points with rows in any table that do not match their seal, ascending.
std::vector<int64_t> broken_points(sqlite::Database& db);
// The same of phase diagrams.
std::vector<int64_t> broken_phases(sqlite::Database& db);
bool verdict_holds(sqlite::Database& db);
// Throws Error(file) that names the rows that do not match their seal.
void require_sealed(sqlite::Database& db);

// The tables that hold points (column `point`), and phase diagrams (column `phase`).
std::span<const std::string_view> tables_of_points();
std::span<const std::string_view> tables_of_phases();

// Removes a point's rows from every table, and its seal.
void remove_point(sqlite::Database& db, int64_t point);
void remove_phase(sqlite::Database& db, int64_t phase);

}  // namespace noonmark
