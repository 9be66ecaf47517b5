// The folder of a run's results, locked for as long as the run lasts.
//
//   ResultsFolder folder("out/cube-room", "cube-room.toml");   // makes and locks it; its earlier verdict is removed
//   if (!folder.ours()) return;                                       // the results of another experiment: nothing was touched
//   folder.take();                                                   // this run may write here: the verdict is removed
#pragma once
#include <exception>
#include <optional>
#include <string>

#include "app/sweep/output_folder.h"

namespace noonmark {

// How the names of the pictures begin that summary.md shows: "worst-pixel-p0003.png".
inline constexpr const char* summary_picture = "worst-pixel-p";

// The path of an experiment's file as seen from a results' folder: what a store keeps of the file (RunInfo::file). It stays
// the same if both are moved together.
std::string seen_from(const std::string& folder, const std::string& experiment);

class ResultsFolder {
 public:
  // Makes the folder if it does not exist and locks it. Calls take() unless the store there names another experiment's file.
  // experiment: the file whose results are written; empty: take() is left to the caller.
  //
  // Throws Error(usage) if the folder cannot be made or another run is writing into it, and as take() does. Throws Error(file) if the
  // verdict cannot be removed, or if images/ is a link or a file.
  ResultsFolder(const std::string& path, const std::string& experiment);

  const std::string& path() const { return path_; }

  // Whether take() was called.
  bool ours() const { return ours_; }
  // To be called as soon as it is known that this run may write into the folder. Throws Error(usage), and has touched nothing, if
  // the folder has no store and files of names that a run writes, which no list (app/sweep/output_folder.h) names: they may be a
  // user's. Otherwise removes from it
  // - junit.xml, summary.md and its pictures, because a run that fails or is killed must not leave the verdict of an earlier run;
  // - temporary files of runs that were killed (clear_abandoned_files, base/file.h), also in images/.
  void take() const;

  // Removes report.html and results.csv, because they show an earlier verdict, or results of another run. Both can be
  // made again from the store.
  void remove_report() const;
  // Removes the pictures too, before all points are measured anew.
  void remove_earlier_results() const;

 private:
  std::string path_;
  FolderLock lock_;
  mutable bool ours_ = false;
};

// A results' folder that is opened before anything else can fail, because opening it removes an earlier verdict. An
// error of the folder itself is thrown only by get(), so that an error of the experiment is reported first.
class EarlyFolder {
 public:
  void open(const std::string& path, const std::string& experiment);
  bool ours() const { return folder_ && folder_->ours(); }
  const ResultsFolder& get() const;  // call open() first; throws the error that open() met

 private:
  std::optional<ResultsFolder> folder_;
  std::exception_ptr fault_;
};

}  // namespace noonmark
