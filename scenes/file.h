// Whole files, in and out.
//
//   write_file_atomically("out/results.csv", text);
#pragma once
#include <string>
#include <string_view>

namespace noonmark {

// Writes beside the file, flushes to the disk, then renames: a reader, a crash or a full disk meets the old file or the
// new one, never a part. The folder must exist. Throws Error(scene), and then leaves the old file and nothing else.
void write_file_atomically(const std::string& path, std::string_view bytes);

// Throws Error(scene) when there is no such file or it cannot be read.
std::string read_file(const std::string& path);

}  // namespace noonmark
