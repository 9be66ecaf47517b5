// compare/store/: the results on disk, as SQLite. May include base, technique (the rows of the settings are columns) and
// compare/results. Nothing that computes knows it.
//
// results.sqlite: the only store of a sweep. It is written point by point, so that a sweep that was killed can resume.
//
//   ResultStore store("out/results.sqlite", fingerprint, Existing::resume);
//   store.set_info(info, planned);
//   const std::vector<int64_t> done = store.finished();
//   for (int64_t id : wanted) if (std::find(done.begin(), done.end(), id) == done.end()) store.add(measure(id));
//   Results results = store.load();
//
// A person can ask `SELECT map_resolution, filter_kind, acne FROM points`. This view has every setting, metric and
// quantity of the curve as a column of its own type. `columns` gives the meaning and unit of each of its columns. The
// tables behind it are info, settings, metrics, times, curves, curve_points, curve_windows, pictures, images, cascades, bounds, laws,
// law_samples, and of the phase diagrams phases, phase_rows, phase_cells, phase_points.
//
// - A point, and a phase diagram, is one transaction, which is on the disk before add() returns. So a kill, or a power cut, loses at most the
//   point that is being measured. While a run writes, and after a kill, the newest points may be in results.sqlite-wal
//   (compare/store/journal.h): the files belong together. A finished store is one file.
// - SQLite has no NaN. A metric that could not be measured (NaN) is a row whose value is NULL. A metric that was not
//   recorded has no row. In `points` both are NULL, and `not_measured` counts the metrics of the first kind. Infinities
//   are stored as infinities.
// - Doubles come back exactly, except the payload of a NaN and the sign of a zero.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "compare/results/records.h"
#include "compare/store/join.h"

namespace noonmark {

namespace sqlite {
class Database;
}

enum class Existing {
  resume,     // continue a store that has the same fingerprint (its scenes may differ); refuse any other
  overwrite,  // start anew; the file's contents are lost
};

// The store holds the results of another program, driver or machine.
struct OtherResults : Error {
  explicit OtherResults(const std::string& message) : Error(ErrorKind::usage, message) {}
};

class ResultStore {
 public:
  // fingerprint: what every result depends on beside its point's settings (app/sweep/identity.h), as lines of "name = value".
  // The folder must exist. Throws OtherResults if the store's fingerprint differs in more than scenes, with the first line that
  // differs. Throws Error(usage) for the store of another version, and Error(file)
  // for a file that is damaged, is no store, or cannot be written.
  ResultStore(const std::string& path, const std::string& fingerprint, Existing existing);
  // Opens an existing store with any fingerprint, to make a report again. Throws Error(file) if there is none.
  static ResultStore open(const std::string& path);
  // RunInfo::file of the store at this path, also of one that open() refuses. Empty if there is no store, if it does not say,
  // or if it cannot be read.
  static std::string experiment_file(const std::string& path);
  // The bounds and their results in the store at this path; none if there is no store, if open() refuses it, or if its run was
  // interrupted.
  static std::vector<BoundResult> bounds_of(const std::string& path);

  ~ResultStore();
  ResultStore(ResultStore&&) noexcept;
  ResultStore& operator=(ResultStore&&) noexcept;

  // Ids of the points of the present experiment that are in the store, ascending.
  std::vector<int64_t> finished() const;
  // Removes what a sweep cannot use: points whose rows were edited or lost, points that are not expected (not all numbers
  // are there), and a verdict that was edited. Returns a message for each. planned_points: of the present experiment.
  std::vector<std::string> repair(int64_t planned_points, const std::function<bool(const PointRecord&)>& expected);
  // All points with whole rows, ascending, also those that are set aside (their ids are first_aside and above,
  // compare/store/schema.h): points that the present experiment does not have. load() leaves them out.
  std::vector<PointRecord> all_points() const;
  // Removes the points with these ids and adds these records instead, under the ids that they have. All or nothing.
  void replace(const std::vector<std::pair<int64_t, PointRecord>>& changed);
  // The experiment whose points have the ids of the store, as text for messages ("name = value" lines).
  std::string plan() const;
  // Takes over that text and the fingerprint. Scenes that only the store's fingerprint has are kept, because points that
  // are set aside may have them.
  void set_plan(const std::string& fingerprint, const std::string& plan);
  // Throws Error(usage) if the store has this id already.
  void add(const PointRecord& point);
  // The same for the phase diagrams, by their number.
  std::vector<int64_t> phases() const;
  std::vector<PhaseDiagram> stored_phases() const;  // those with whole rows
  std::vector<std::string> repair_phases(const std::function<bool(int64_t, const PhaseDiagram&)>& expected);
  void add_phase(int64_t phase, const PhaseDiagram& diagram);
  // Replaces the pictures of a point in the store. Some pictures are chosen after the sweep, and some are lost and made
  // again.
  void set_pictures(int64_t point, const PointPictures& pictures);
  // Gives points in the store more metrics, or other values of those that they have: times are measured after all points
  // (measure/pass_times.h). All in one transaction.
  void set_metrics(const std::map<int64_t, std::map<std::string, double>>& of_points);
  // Replaces the stored facts of the run.
  void set_info(const RunInfo& info, int64_t planned_points);
  // Until the facts of the run are replaced.
  void set_baseline(const BaselineComparison& baseline);
  void set_bounds(const std::vector<BoundResult>& bounds);
  void set_laws(const std::vector<LawResult>& laws);

  // Throws Error(file) if rows do not match their seal (compare/store/seals.h).
  Results load() const;
  // open(path).load(), in half the time: damage is noticed by the seals alone.
  static Results read(const std::string& path);
  // The facts of the run alone: its points are not read.
  Results facts() const;
  std::string fingerprint() const;
  // Throws Error(file) as load() does.
  void require_whole() const;

  // Throws Error(file) if the store's file or folder was renamed, replaced or removed since it was opened. Every call that
  // writes asks it too.
  void require_in_place() const;
  // Takes over the points and phase diagrams of another store (compare/store/join.h).
  JoinedStore join(const std::string& path, const SceneName& scene_name);
  // The ids of points without this metric, ascending.
  std::vector<int64_t> lacking(const std::string& metric) const;

 private:
  explicit ResultStore(std::unique_ptr<sqlite::Database> db);
  std::unique_ptr<sqlite::Database> db_;
  bool writes_ = false;  // the journal is that of begin_writing (compare/store/journal.h)
};

}  // namespace noonmark
