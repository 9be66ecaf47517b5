// Writes the rows of a point into the tables of the store. Call these within a transaction, and seal the point afterwards.
#pragma once
#include <cstdint>

#include "compare/store/records.h"

namespace noonmark {

namespace sqlite {
class Database;
}

// All rows, under the point's id, but no cause of a rung, which stands in the table `info`.
void add_rows(sqlite::Database& db, const PointRecord& point);
void add_pictures(sqlite::Database& db, int64_t point, const PointPictures& made);

}  // namespace noonmark
