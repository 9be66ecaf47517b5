// Whole files, in and out.
//
//   make_folder("out");
//   write_file_atomically("out/results.csv", text);
//   std::string picture = read_file_below("out", "images/p0000-truth.png", max_picture_bytes);
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>

namespace noonmark {

// Writes a temporary file beside the file, flushes it to the disk and renames it. So after a crash, a power failure or
// a full disk a reader finds the old file or the new one, and never a part. The folder must exist. Throws Error(file);
// then the old file is there and nothing else. A program that is killed may leave the temporary file;
// clear_abandoned_files removes it.
void write_file_atomically(const std::string& path, std::string_view bytes);

// The same for a file that is written piece by piece, so that it need not be in memory as a whole.
//
//   AtomicFile file("out/map.exr");
//   file.write_at(0, head);
//   file.keep();                     // without it the old file stays
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write_at(uint64_t offset, std::string_view bytes);
  std::string digest() const;  // digest_of what was written
  void keep();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Makes the folder and all folders above it, and flushes them, so that they survive a power failure. Throws
// Error(file) if the folder is not there afterwards.
void make_folder(const std::string& path);

// Makes one folder in a folder that is there. Throws Error(file), also if that one has gone: then files would be written where nobody
// looks for them.
void make_folder_in(const std::string& folder, const std::string& name);

// Removes the temporary files that write_file_atomically left in this folder (not below it) when its program was
// killed: files with such a name on which nobody holds a lock. A missing folder is no error. On a file system without
// locks nothing is removed.
void clear_abandoned_files(const std::string& folder);

// Reads a regular file. Throws Error(file) when there is no such file, it cannot be read, it holds more than most_bytes, or it is
// a pipe, a device or a folder: reading those might never end.
std::string read_file(const std::string& path, uint64_t most_bytes = std::numeric_limits<uint64_t>::max());

// The same of a file below the folder; links are resolved. Throws Error(file) also for a name that leads out of the folder
// (absolute, "..", a link).
std::string read_file_below(const std::string& folder, const std::string& name, uint64_t most_bytes);

// digest_of (base/digest.h) the bytes that read_file_below would read, for a file of any size.
std::string digest_of_file_below(const std::string& folder, const std::string& name);

}  // namespace noonmark
