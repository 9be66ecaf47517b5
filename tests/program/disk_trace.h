// A record of what a program does to the files of a folder, in order. tests/program/preload_disk.cpp, which is loaded
// into the program, writes it. The power cut test reads it back and replays it on a simulated disk that loses power.
#pragma once
#include <cstdint>

namespace noonmark::test {

enum class DiskOp : uint32_t {
  create,    // path, inode: a file that was not there
  write,     // inode, offset, data
  truncate,  // inode, offset: the new size
  sync,      // inode: of a file or a folder
  rename,    // path, data: the new path
  remove,    // path
  folder,    // path, inode: a new folder
  said,      // data: written to standard error
};

// The bytes of the path and of the data follow.
struct DiskRecord {
  DiskOp op;
  uint32_t path_size;
  uint64_t inode, offset, data_size;
};

}  // namespace noonmark::test
