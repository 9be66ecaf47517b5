// The folder that a run writes its results into, held for as long as the run lasts.
//
//   const ResultsFolder folder("out/cube-room");   // made, ours alone, and nothing in it says how an earlier run ended
#pragma once
#include <exception>
#include <optional>
#include <string>

namespace noonmark {

// make_folder (scenes/file.h) for a folder that the command line names: throws Error(usage).
void make_output_folder(const std::string& path);

class ResultsFolder {
 public:
  // Makes the folder where it is not there, locks it, and removes from it
  // - junit.xml and summary.md: the verdict of an earlier run must not be taken for that of one that fails or is
  //   killed;
  // - temporary files of runs that were killed (clear_abandoned_files, scenes/file.h), in images/ too.
  // Throws Error(usage) when the folder cannot be made or another run is writing into it; Error(scene) when the verdict
  // cannot be removed, or when images/ is a link or a file.
  explicit ResultsFolder(const std::string& path);
  ~ResultsFolder();
  ResultsFolder(const ResultsFolder&) = delete;
  ResultsFolder& operator=(const ResultsFolder&) = delete;

  const std::string& path() const { return path_; }

  // report.html and results.csv, which show an earlier verdict, or other results than this run's. They are made from
  // the store, and can be made again from it.
  void remove_report() const;
  // The pictures too, when all is measured anew.
  void remove_earlier_results() const;

 private:
  std::string path_;
  int descriptor_;  // the lock goes with it, also when the program is killed
};

// A results' folder that is opened before anything else can fail, because that removes an earlier verdict. What is
// wrong with the folder itself is thrown only by get(): what is wrong with the experiment is to be said first.
class EarlyFolder {
 public:
  void open(const std::string& path);
  bool is_open() const { return folder_.has_value(); }
  const ResultsFolder& get() const;  // call open() first; throws the error that open() met

 private:
  std::optional<ResultsFolder> folder_;
  std::exception_ptr fault_;
};

}  // namespace noonmark
