// Whole files, in and out.
//
//   make_folder("out");
//   write_file_atomically("out/results.csv", text);
//   std::string picture = read_file_below("out", "images/p0000-truth.png", max_picture_bytes);
#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace noonmark {

// Writes beside the file, flushes to the disk, then renames: a reader, a crash, a power failure or a full disk meets
// the old file or the new one, never a part. The folder must exist. Throws Error(scene), and then leaves the old file
// and nothing else; a kill may leave the file beside, which clear_abandoned_files removes.
void write_file_atomically(const std::string& path, std::string_view bytes);

// With all folders above it, and so that a power failure does not take it away again. Throws Error(scene) when it is
// not there then.
void make_folder(const std::string& path);

// Removes the temporary files that write_file_atomically left in this folder (not below it) when its program was
// killed: files of that name's form that nobody holds a lock on. No error when the folder is absent; where the file
// system has no locks, nothing is removed.
void clear_abandoned_files(const std::string& folder);

// Throws Error(scene) when there is no such file, it cannot be read, or it holds more than most_bytes (a device may
// hold any number).
std::string read_file(const std::string& path, uint64_t most_bytes = std::numeric_limits<uint64_t>::max());

// A regular file below the folder, links resolved. Throws Error(scene) as above, and for a name that leads out of the
// folder (absolute, "..", a link) or to a pipe or device, which might never end.
std::string read_file_below(const std::string& folder, const std::string& name, uint64_t most_bytes);

// digest_of (scenes/digest.h) what read_file_below would read, however large it is.
std::string digest_of_file_below(const std::string& folder, const std::string& name);

}  // namespace noonmark
