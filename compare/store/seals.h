// Seals of the store's rows: a digest of what was written, kept beside it, so that a row that was edited, lost or put
// there by somebody else is noticed. Every column of every row counts, with its type.
#pragma once
#include <cstdint>
#include <vector>

namespace noonmark {

namespace sqlite {
class Database;
}

// Of what is in the tables now. To be called within the transaction that wrote it.
void seal_point(sqlite::Database& db, int64_t point);
void seal_info(sqlite::Database& db);
void seal_verdict(sqlite::Database& db);  // bounds and laws

// Ids that some table of points has, ascending, and whose rows are not those that were sealed.
std::vector<int64_t> broken_points(sqlite::Database& db);
bool verdict_holds(sqlite::Database& db);
// Throws Error(scene) that names what does not hold.
void require_sealed(sqlite::Database& db);

// The rows of a point in every table, and its seal.
void remove_point(sqlite::Database& db, int64_t point);

}  // namespace noonmark
