// What a verb may write into a folder that a user names: only files that Noonmark made are removed or replaced. A folder keeps
// their names in its list, the file .noonmark-files.
//
//   OutputFolder out(outputs_of("map", "cube-room", arguments.out));   // the files of an earlier run are gone
//   out.make();                                                  // before the first file is written
#pragma once
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace noonmark {

struct VerbOutputs {
  std::string folder;
  std::vector<std::string> files;  // in the folder: all that the verb may write

  std::string inner = {};                     // a folder in the folder; empty: none
  std::vector<std::string> inner_files = {};  // in that one and its folders; patterns of fnmatch

  std::vector<std::string> all() const;  // `files` and `inner`
};

// make_folder (base/file.h) for a folder from the command line. Throws Error(usage).
void make_output_folder(const std::string& path);

// The same for the folder of a file that is to be written.
void make_folder_above(const std::string& file);

// For the path of a file that is to be written. Throws Error(usage) if it has not this ending, is a folder, or (unless overwrite)
// is there.
void require_new_file(const std::string& file, std::string_view ending, bool overwrite);

// Keeps other runs out of a folder for as long as it lives, also when the program is killed. Some file systems have no locks;
// there nobody is kept out.
class FolderLock {
 public:
  explicit FolderLock(const std::string& folder);  // throws Error(usage) if another run has it
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

// The list of a folder. Names are of entries of the folder itself. Who locks the folder reads and changes it.
class MadeFiles {
 public:
  // Of a folder without a list: none. Throws Error(usage) if a file of the list's name is no list.
  explicit MadeFiles(const std::string& folder);

  bool has(std::string_view name) const { return names_.contains(name); }
  // The first of these entries that is in the folder and not in the list; empty: there is none.
  std::string foreign(std::span<const std::string> names) const;
  // Throws Error(usage) if there is one.
  void require_ours(std::span<const std::string> names) const;
  // To be called before files of these names are written, so that a run that is killed leaves none that is not listed. Throws
  // Error(file).
  void add(std::span<const std::string> names);
  // Removes those of the files that are listed, from the folder and from the list: files and links, no folders. Throws
  // Error(file).
  void remove(std::span<const std::string> names);
  // Takes those names off the list that are not there: what was not written may come to be a user's file.
  void forget_absent(std::span<const std::string> names);

 private:
  void write() const;
  std::string folder_;
  std::set<std::string, std::less<>> names_;
};

// The folder of `recommend`, `render`, `map`, `inspect`, `judge` and `capture`, locked. The files of an earlier run are removed before
// anything else can fail, so that a run that fails or is killed leaves no file that looks like its own.
class OutputFolder {
 public:
  // A folder that does not exist is not made yet. Throws Error(usage), and has touched nothing, if another run is writing into the
  // folder, or if it has an entry of a name that the verb writes, which Noonmark did not make. Throws Error(file) if a file
  // of an earlier run cannot be removed.
  explicit OutputFolder(const VerbOutputs& outputs);
  ~OutputFolder();  // the list has only what was written
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  // Makes the folder. Throws as the constructor does, and Error(usage) if the folder cannot be made.
  void make();

 private:
  void take();
  VerbOutputs outputs_;
  std::optional<FolderLock> lock_;
  bool made_ = false;
};

// After an error of the command line: removes the files of an earlier run that are listed, unless another run is writing. Throws
// Error(file).
void retract(const VerbOutputs& outputs);

// subject: the experiment, scene, model or frame of the command line. out: the value of --out; without one, the default folder,
// but `recommend` and its --texels ("texels") have --out only.
VerbOutputs outputs_of(std::string_view verb, const std::string& subject, const std::string& out);

}  // namespace noonmark
