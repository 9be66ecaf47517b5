// results.sqlite: the one store of a sweep, written point by point, so that a killed sweep resumes.
//
//   ResultStore store("out/results.sqlite", fingerprint, Existing::resume);
//   store.set_info(info, planned);
//   for (each point whose id is not in store.finished()) store.add(measure(point));
//   Results results = store.load();
//
// For people: `SELECT map_resolution, filter_kind, acne FROM points` (a view: every setting, metric and quantity of the
// curve as a column of its own type), and the tables behind it: info, settings, metrics, times, curves, curve_points,
// pictures, images, bounds, laws, law_samples; `columns` says what each column of `points` means, and its unit.
//
// - A point is one transaction, flushed to the disk before add() returns: a kill at any time loses at most the point in
//   flight. A rollback journal is used, not a write-ahead log, so that a finished store is one file.
// - SQLite has no NaN. A metric that could not be measured (NaN) is a row whose value is NULL; one that was not
//   recorded has no row. In `points` both are NULL, and `not_measured` counts the former. Infinities are stored as
//   such.
// - Doubles come back exactly, but for the payload of a NaN and the sign of a zero.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "compare/store/records.h"
#include "scenes/error.h"

namespace noonmark {

namespace sqlite {
class Database;
}

enum class Existing {
  resume,     // continue a store that has the same fingerprint; refuse any other
  overwrite,  // start anew, whatever the file held
};

// The store holds the results of another experiment, scene, program, driver or machine.
struct OtherResults : Error {
  explicit OtherResults(const std::string& message) : Error(ErrorKind::usage, message) {}
};

class ResultStore {
 public:
  // fingerprint: everything that determines results, as lines of "name = value". The folder must exist. Throws
  // OtherResults where the store's differs, naming the first line that does; Error(usage) for the store of another
  // version; Error(scene) for a file that is damaged, no store, or cannot be written.
  ResultStore(const std::string& path, const std::string& fingerprint, Existing existing);
  // An existing store, whatever its fingerprint: for rebuilding a report. Throws Error(scene) when there is none.
  static ResultStore open(const std::string& path);

  ~ResultStore();
  ResultStore(ResultStore&&) noexcept;
  ResultStore& operator=(ResultStore&&) noexcept;

  // Ids of the points that are in the store, ascending.
  std::vector<int64_t> finished() const;
  // What a resumed sweep cannot go on from is removed: points whose rows are not those that were stored or that the
  // experiment does not expect (part or settings of something else, or an id beyond the planned ones), and a verdict
  // that was edited. Says each.
  std::vector<std::string> repair(int64_t planned_points, const std::function<bool(const PointRecord&)>& expected);
  // Throws Error(usage) when the id is there already.
  void add(const PointRecord& point);
  // The pictures of a point that is in the store, replacing those it had: some are chosen once the sweep is over, some
  // are lost and made again.
  void set_pictures(int64_t point, const PointPictures& pictures);
  // Replaces what was there.
  void set_info(const RunInfo& info, int64_t planned_points);
  void set_bounds(const std::vector<BoundResult>& bounds);
  void set_laws(const std::vector<LawResult>& laws);

  // Throws Error(scene) where rows are not those that were stored: every row is sealed (compare/store/seals.h).
  Results load() const;
  std::string fingerprint() const;

 private:
  explicit ResultStore(std::unique_ptr<sqlite::Database> db);
  std::unique_ptr<sqlite::Database> db_;
};

}  // namespace noonmark
