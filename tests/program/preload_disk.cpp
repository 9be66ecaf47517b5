// Loaded before the C library (LD_PRELOAD). Passes every call on and records in the file NOONMARK_TEST_DISK_LOG what
// the call did to files below the folder NOONMARK_TEST_DISK_ROOT (both absolute). Format: tests/program/disk_trace.h.
#include <dlfcn.h>
#include <fcntl.h>
#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <set>
#include <string>
#include <string_view>

#include "tests/program/disk_trace.h"

namespace {

using noonmark::test::DiskOp;
using noonmark::test::DiskRecord;

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

class Trace {
 public:
  std::string below_root(const char* path) const {
    std::string whole = path;
    if (path[0] != '/') {
      char here[4096];
      if (!getcwd(here, sizeof here)) return "";
      whole = std::string(here) + "/" + path;
    }
    return whole.compare(0, root_.size(), root_) == 0 ? whole : "";
  }
  bool knows(int descriptor) const {
    const std::lock_guard lock(mutex_);
    return descriptors_.count(descriptor) > 0;
  }
  void opened(int descriptor, const std::string& path, bool created) {
    const std::lock_guard lock(mutex_);
    descriptors_.insert(descriptor);
    if (created) add(DiskOp::create, path, inode(descriptor), 0, {});
  }
  void closed(int descriptor) {
    const std::lock_guard lock(mutex_);
    descriptors_.erase(descriptor);
  }
  void done(DiskOp op, int descriptor, uint64_t offset, std::string_view data) {
    const std::lock_guard lock(mutex_);
    add(op, "", inode(descriptor), offset, data);
  }
  void named(DiskOp op, const std::string& path, std::string_view other) {
    struct stat status {};
    if (op == DiskOp::folder) stat(path.c_str(), &status);
    const std::lock_guard lock(mutex_);
    add(op, path, status.st_ino, 0, other);
  }
  static Trace& instance() {
    static Trace trace;
    return trace;
  }

 private:
  static uint64_t inode(int descriptor) {
    struct stat status {};
    fstat(descriptor, &status);
    return status.st_ino;
  }
  void add(DiskOp op, const std::string& path, uint64_t inode, uint64_t offset, std::string_view data) const {
    const DiskRecord record{op, static_cast<uint32_t>(path.size()), inode, offset, data.size()};
    std::string bytes(reinterpret_cast<const char*>(&record), sizeof record);
    bytes += path;
    bytes += data;
    const int log = static_cast<int>(
        syscall(SYS_openat, AT_FDCWD, std::getenv("NOONMARK_TEST_DISK_LOG"), O_WRONLY | O_CREAT | O_APPEND, 0600));
    if (syscall(SYS_write, log, bytes.data(), bytes.size()) != static_cast<long>(bytes.size())) abort();
    syscall(SYS_close, log);
  }

  mutable std::mutex mutex_;
  std::set<int> descriptors_;
  std::string root_ = std::getenv("NOONMARK_TEST_DISK_ROOT");
};

int open_at(int folder, const char* path, int flags, mode_t mode) {
  static const auto real = next<int(int, const char*, int, ...)>("openat");
  Trace& trace = Trace::instance();
  const std::string whole = folder == AT_FDCWD ? trace.below_root(path) : "";
  struct stat before {};
  const bool was_there = whole.empty() || stat(path, &before) == 0;
  const int descriptor = real(folder, path, flags, mode);
  if (descriptor >= 0 && !whole.empty()) {
    trace.opened(descriptor, whole, !was_there);
    if (was_there && (flags & O_TRUNC) != 0) trace.done(DiskOp::truncate, descriptor, 0, {});
  }
  return descriptor;
}

mode_t mode_of(int flags, va_list arguments) { return (flags & O_CREAT) != 0 ? va_arg(arguments, mode_t) : 0; }

}  // namespace

extern "C" {

#define OPEN(name)                                 \
  int name(const char* path, int flags, ...) {     \
    va_list arguments;                             \
    va_start(arguments, flags);                    \
    const mode_t mode = mode_of(flags, arguments); \
    va_end(arguments);                             \
    return open_at(AT_FDCWD, path, flags, mode);   \
  }
OPEN(open)
OPEN(open64)

int close(int descriptor) {
  static const auto real = next<int(int)>("close");
  Trace::instance().closed(descriptor);
  return real(descriptor);
}

ssize_t write(int descriptor, const void* data, size_t size) {
  static const auto real = next<ssize_t(int, const void*, size_t)>("write");
  const ssize_t written = real(descriptor, data, size);
  Trace& trace = Trace::instance();
  if (written > 0 && (descriptor == STDERR_FILENO || trace.knows(descriptor))) {
    const std::string_view bytes(static_cast<const char*>(data), static_cast<size_t>(written));
    if (descriptor == STDERR_FILENO)
      trace.done(DiskOp::said, descriptor, 0, bytes);
    else
      trace.done(DiskOp::write, descriptor, static_cast<uint64_t>(lseek(descriptor, 0, SEEK_CUR) - written), bytes);
  }
  return written;
}

#define PWRITE(name, offset_type)                                                             \
  ssize_t name(int descriptor, const void* data, size_t size, offset_type offset) {           \
    static const auto real = next<ssize_t(int, const void*, size_t, offset_type)>(#name);     \
    const ssize_t written = real(descriptor, data, size, offset);                             \
    if (written > 0 && Trace::instance().knows(descriptor))                                   \
      Trace::instance().done(DiskOp::write, descriptor, static_cast<uint64_t>(offset),        \
                             {static_cast<const char*>(data), static_cast<size_t>(written)}); \
    return written;                                                                           \
  }
PWRITE(pwrite, off_t)
PWRITE(pwrite64, off64_t)

#define TRUNCATE(name, offset_type)                                                          \
  int name(int descriptor, offset_type size) {                                               \
    static const auto real = next<int(int, offset_type)>(#name);                             \
    const int result = real(descriptor, size);                                               \
    if (result == 0 && Trace::instance().knows(descriptor))                                  \
      Trace::instance().done(DiskOp::truncate, descriptor, static_cast<uint64_t>(size), {}); \
    return result;                                                                           \
  }
TRUNCATE(ftruncate, off_t)
TRUNCATE(ftruncate64, off64_t)

// The real disk is not synced: the test decides what is lost, and waiting for the disk would take most of the time.
#define SYNC(name)                                                                                    \
  int name(int descriptor) {                                                                          \
    if (Trace::instance().knows(descriptor)) Trace::instance().done(DiskOp::sync, descriptor, 0, {}); \
    return 0;                                                                                         \
  }
SYNC(fsync)
SYNC(fdatasync)

// With NOONMARK_TEST_DISK_NETWORK the folder claims to be on a network file system (NFS).
#define STATFS(name)                                                                                \
  int name(const char* path, struct name* status) {                                                 \
    static const auto real = next<int(const char*, struct name*)>(#name);                           \
    const int result = real(path, status);                                                          \
    if (result == 0 && std::getenv("NOONMARK_TEST_DISK_NETWORK")) status->f_type = NFS_SUPER_MAGIC; \
    return result;                                                                                  \
  }
STATFS(statfs)
STATFS(statfs64)

int rename(const char* from, const char* to) {
  static const auto real = next<int(const char*, const char*)>("rename");
  const int result = real(from, to);
  const std::string old_path = Trace::instance().below_root(from);
  if (result == 0 && !old_path.empty())
    Trace::instance().named(DiskOp::rename, old_path, Trace::instance().below_root(to));
  return result;
}

#define REMOVE(name)                                                                       \
  int name(const char* path) {                                                             \
    static const auto real = next<int(const char*)>(#name);                                \
    const std::string whole = Trace::instance().below_root(path);                          \
    const int result = real(path);                                                         \
    if (result == 0 && !whole.empty()) Trace::instance().named(DiskOp::remove, whole, {}); \
    return result;                                                                         \
  }
REMOVE(unlink)
REMOVE(remove)

int mkdir(const char* path, mode_t mode) {
  static const auto real = next<int(const char*, mode_t)>("mkdir");
  const int result = real(path, mode);
  const std::string whole = Trace::instance().below_root(path);
  if (result == 0 && !whole.empty()) Trace::instance().named(DiskOp::folder, whole, {});
  return result;
}

}  // extern "C"
