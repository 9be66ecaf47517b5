#include "base/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <vector>

#include "base/digest.h"
#include "base/error.h"
#include "base/system_error.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, std::string_view what, int error_number, const char* next) {
  throw Error(kind_of_failure(error_number), fmt::format("{}: {}: {}; {}", path, what, std::strerror(error_number),
                                                         advice_on_failure(error_number, next)));
}

// "results.csv" + ".noonmark-4711-0.tmp": process and attempt.
constexpr std::string_view temporary_mark = ".noonmark-", temporary_ending = ".tmp";

bool is_temporary_name(std::string_view name) {
  const size_t mark = name.rfind(temporary_mark);
  if (mark == std::string_view::npos || mark == 0 || !name.ends_with(temporary_ending)) return false;
  name.remove_suffix(temporary_ending.size());
  name.remove_prefix(mark + temporary_mark.size());
  pid_t process = 0;
  unsigned attempt = 0;
  const char* const end = name.data() + name.size();
  const auto [dash, no_process] = std::from_chars(name.data(), end, process);
  if (no_process != std::errc{} || dash == end || *dash != '-' || process <= 0) return false;
  const auto [last, no_attempt] = std::from_chars(dash + 1, end, attempt);
  return no_attempt == std::errc{} && last == end;
}

// An open file that is closed, and removed unless it was kept. Locked until it has its own name, so that others see
// whether its program lives: a process's number would not tell, which is given again, also to another container's.
class Temporary {
 public:
  explicit Temporary(const std::string& beside) {
    for (int attempt = 0;; ++attempt) {
      path_ = fmt::format("{}{}{}-{}{}", beside, temporary_mark, ::getpid(), attempt, temporary_ending);
      descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (descriptor_ < 0 && errno == EEXIST) continue;
      if (descriptor_ < 0)
        fail(beside, "cannot be written", errno, "check that its folder exists and may be written to");
      if (is_ours()) return;
      ::close(descriptor_);
    }
  }
  ~Temporary() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!path_.empty()) ::unlink(path_.c_str());
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  int descriptor() const { return descriptor_; }

  // 0 or errno.
  int rename_to(const std::string& target) {
    if (::rename(path_.c_str(), target.c_str()) != 0) return errno;
    path_.clear();
    return 0;
  }

 private:
  // Between its making and its lock, somebody who clears the folder may have locked and removed it.
  bool is_ours() const {
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return false;
    struct stat status {};
    return ::fstat(descriptor_, &status) != 0 || status.st_nlink > 0;
  }

  std::string path_;
  int descriptor_ = -1;
};

// What was made or renamed in a folder lasts through a power failure only once the folder has been flushed too. Some
// file systems cannot flush a folder; the files are whole all the same, so that is no error.
void flush_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

// A regular file, open until the end. shown: its name in messages. Without O_NONBLOCK, to open a pipe would wait for its
// writer.
class Opened {
 public:
  Opened(const std::string& path, const std::string& shown, int flags = 0)
      : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | flags)), shown_(shown) {
    if (descriptor_ < 0) fail(shown, "cannot be read", errno, "check the path");
    struct stat status {};
    const bool regular = ::fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode);
    size_ = static_cast<uint64_t>(status.st_size);
    if (regular) return;
    ::close(descriptor_);
    throw Error(ErrorKind::file, fmt::format("{}: is not a regular file but a {}; give the path of a file", shown,
                                             S_ISDIR(status.st_mode) ? "folder" : "pipe or a device"));
  }
  ~Opened() { ::close(descriptor_); }
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;

  // Calls take(bytes) for all that is in it, block by block.
  template <class Take>
  void read(const Take& take) const {
    char block[1 << 16];
    for (;;) {
      const ssize_t count = ::read(descriptor_, block, sizeof block);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) fail(shown_, "cannot be read", errno, "check the path");
      if (count == 0) return;
      take(std::string_view(block, static_cast<size_t>(count)));
    }
  }
  // The size alone does not say how much there is: files of the system (/proc) have none, and a file can grow.
  std::string all(uint64_t most_bytes) const {
    const auto require = [&](uint64_t bytes) {
      if (bytes > most_bytes)
        throw Error(ErrorKind::file, fmt::format("{}: holds more than {} bytes, which no file of its kind does; check "
                                                 "the path",
                                                 shown_, most_bytes));
    };
    require(size_);
    std::string bytes;
    bytes.reserve(size_);
    read([&](std::string_view block) {
      require(bytes.size() + block.size());
      bytes += block;
    });
    return bytes;
  }

 private:
  int descriptor_;
  std::string shown_;
  uint64_t size_ = 0;
};

// A regular file below the folder, links resolved.
std::unique_ptr<Opened> open_below(const std::string& folder, const std::string& name) {
  const std::string path = folder + "/" + name;
  const auto refuse = [&](std::string_view what) {
    throw Error(ErrorKind::file, fmt::format("{}: {}; only regular files in {} are read", path, what, folder));
  };
  std::error_code error;
  const fs::path home = fs::canonical(folder, error);
  if (error) fail(folder, "cannot be read", error.value(), "check the path");
  if (fs::path(name).is_absolute()) refuse("leads out of the folder");
  const fs::path target = fs::canonical(home / name, error);
  if (error) fail(path, "cannot be read", error.value(), "check the path");
  if (std::mismatch(home.begin(), home.end(), target.begin(), target.end()).first != home.end())
    refuse("leads out of the folder");
  return std::make_unique<Opened>(target.string(), path, O_NOFOLLOW);
}

}  // namespace

struct AtomicFile::Impl {
  std::string path;
  Temporary temporary;
  explicit Impl(const std::string& target) : path(target), temporary(target) {}
  [[noreturn]] void fail_to_write() const { fail(path, "cannot be written", errno, "check that the disk has room"); }
};

AtomicFile::AtomicFile(const std::string& path) : impl_(std::make_unique<Impl>(path)) {}
AtomicFile::~AtomicFile() = default;

void AtomicFile::write_at(uint64_t offset, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written =
        ::pwrite(impl_->temporary.descriptor(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) impl_->fail_to_write();
    bytes.remove_prefix(static_cast<size_t>(written));
    offset += static_cast<uint64_t>(written);
  }
}

std::string AtomicFile::digest() const {
  Digest digest;
  std::vector<char> block(1 << 16);
  for (off_t offset = 0;;) {
    const ssize_t count = ::pread(impl_->temporary.descriptor(), block.data(), block.size(), offset);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(impl_->path, "cannot be read", errno, "check the disk");
    if (count == 0) return digest.hex();
    digest.bytes(block.data(), static_cast<size_t>(count));
    offset += count;
  }
}

void AtomicFile::keep() {
  if (::fsync(impl_->temporary.descriptor()) != 0) impl_->fail_to_write();
  // Closed, and with that unlocked, only when it has its own name; what close() could tell, fsync() has told.
  if (const int error = impl_->temporary.rename_to(impl_->path))
    fail(impl_->path, "cannot be replaced", error, "choose another place for it");
  flush_folder(fs::path(impl_->path).parent_path());
}

void write_file_atomically(const std::string& path, std::string_view bytes) {
  AtomicFile file(path);
  file.write_at(0, bytes);
  file.keep();
}

void make_folder(const std::string& path) {
  const auto cannot = [&](const std::error_code& error) {
    throw Error(ErrorKind::file, fmt::format("cannot make the folder {}: {}; check the path", path, error.message()));
  };
  fs::path made;
  for (const fs::path& part : fs::path(path)) {
    const fs::path parent = made;
    made /= part;
    std::error_code error;
    const fs::file_status there = fs::status(made, error);
    if (fs::is_directory(there)) continue;
    if (fs::exists(there))
      throw Error(ErrorKind::file,
                  fmt::format("cannot make the folder {}: {} is a file; remove or rename it", path, made.string()));
    if (fs::create_directory(made, error))
      flush_folder(parent);
    else if (error)
      cannot(error);
  }
  std::error_code error;
  if (!fs::is_directory(path, error)) cannot(error ? error : std::make_error_code(std::errc::not_a_directory));
}

void make_folder_in(const std::string& folder, const std::string& name) {
  const std::string path = folder + "/" + name;
  if (::mkdir(path.c_str(), 0777) == 0) return flush_folder(folder);
  const int error = errno;
  std::error_code none;
  if (!fs::is_directory(path, none)) fail(path, "cannot be made", error, "check that its folder is there");
}

void clear_abandoned_files(const std::string& folder) {
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (!is_temporary_name(entry.path().filename().native())) continue;
    const int descriptor = ::open(entry.path().c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) continue;
    // By the time that the lock is ours the file may have its own name, and this one may be another file's.
    struct stat status {};
    struct stat named {};
    if (::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) && ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 &&
        ::lstat(entry.path().c_str(), &named) == 0 && named.st_dev == status.st_dev && named.st_ino == status.st_ino)
      ::unlink(entry.path().c_str());
    ::close(descriptor);
  }
}

std::string read_file(const std::string& path, uint64_t most_bytes) { return Opened(path, path).all(most_bytes); }

std::string read_file_below(const std::string& folder, const std::string& name, uint64_t most_bytes) {
  return open_below(folder, name)->all(most_bytes);
}

std::string digest_of_file_below(const std::string& folder, const std::string& name) {
  Digest digest;
  open_below(folder, name)->read([&](std::string_view block) { digest.bytes(block.data(), block.size()); });
  return digest.hex();
}

}  // namespace noonmark
