// What a program does to the files of a folder, in order: written by tests/program/preload_disk.cpp, which is loaded into it,
// and read back by the test that plays it to a disk which loses power.
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

// Followed by the path's bytes and the data's.
struct DiskRecord {
  DiskOp op;
  uint32_t path_size;
  uint64_t inode, offset, data_size;
};

}  // namespace noonmark::test
