// The rows of a point in the tables of the store. Call those that add within a transaction, and seal the point afterwards.
#pragma once
#include <cstdint>
#include <exception>
#include <map>
#include <vector>

#include "compare/results/records.h"

namespace noonmark {

namespace sqlite {
class Database;
}

// All rows, under the point's id, but no cause of a rung, which stands in the table `info`.
void add_rows(sqlite::Database& db, const PointRecord& point);
void add_pictures(sqlite::Database& db, int64_t point, const PointPictures& made);

// What the tables hold of all points.
struct StoredPoints {
  std::map<int64_t, PointRecord> whole;  // those whose rows match their seal, by their id
  std::vector<int64_t> broken;           // the ids of the others: broken_points() (compare/store/seals.h)
  std::exception_ptr fault;              // rows that match their seal and contradict each other; null: none
};
// Reads and checks every row once.
StoredPoints read_points(sqlite::Database& db);
// The whole points of read_points(). Rows that contradict each other throw std::runtime_error.
std::map<int64_t, PointRecord> load_points(sqlite::Database& db);

}  // namespace noonmark
