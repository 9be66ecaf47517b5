// The folder of a run's results, locked for as long as the run lasts.
//
//   const ResultsFolder folder("out/cube-room");   // makes and locks it, and removes the verdict of an earlier run
#pragma once
#include <exception>
#include <optional>
#include <string>

namespace noonmark {

// make_folder (scenes/file.h) for a folder from the command line. Throws Error(usage).
void make_output_folder(const std::string& path);

// How the names of the pictures begin that summary.md shows: "worst-pixel-p0003.png".
inline constexpr const char* summary_picture = "worst-pixel-p";

class ResultsFolder {
 public:
  // Makes the folder if it does not exist, locks it, and removes from it
  // - junit.xml, summary.md and its pictures, because a run that fails or is killed must not leave the verdict of an earlier run;
  // - temporary files of runs that were killed (clear_abandoned_files, scenes/file.h), also in images/.
  //
  // Throws Error(usage) if the folder cannot be made or another run is writing into it. Throws Error(file) if the
  // verdict cannot be removed, or if images/ is a link or a file.
  explicit ResultsFolder(const std::string& path);
  ~ResultsFolder();
  ResultsFolder(const ResultsFolder&) = delete;
  ResultsFolder& operator=(const ResultsFolder&) = delete;

  const std::string& path() const { return path_; }

  // Removes report.html and results.csv, because they show an earlier verdict, or results of another run. Both can be
  // made again from the store.
  void remove_report() const;
  // Removes the pictures too, before all points are measured anew.
  void remove_earlier_results() const;

 private:
  std::string path_;
  int descriptor_;  // closing it releases the lock, also when the program is killed
};

// A results' folder that is opened before anything else can fail, because opening it removes an earlier verdict. An
// error of the folder itself is thrown only by get(), so that an error of the experiment is reported first.
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
