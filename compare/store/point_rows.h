// The rows of a point in the tables of the store. Call those that add within a transaction, and seal the point afterwards.
#pragma once
#include <cstdint>
#include <map>

#include "compare/results/records.h"

namespace noonmark {

namespace sqlite {
class Database;
}

// All rows, under the point's id, but no cause of a rung, which stands in the table `info`.
void add_rows(sqlite::Database& db, const PointRecord& point);
void add_pictures(sqlite::Database& db, int64_t point, const PointPictures& made);

// All points that are finished, by their id. Rows that contradict each other throw std::runtime_error.
std::map<int64_t, PointRecord> load_points(sqlite::Database& db);

}  // namespace noonmark
