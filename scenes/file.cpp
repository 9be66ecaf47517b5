#include "scenes/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "scenes/error.h"

namespace noonmark {
namespace {

[[noreturn]] void fail(const std::string& path, std::string_view what, int error_number, std::string_view next) {
  throw Error(ErrorKind::scene, fmt::format("{}: {}: {}; {}", path, what, std::strerror(error_number), next));
}

// An open file that is closed, and removed unless it was kept.
class Temporary {
 public:
  explicit Temporary(const std::string& beside) {
    for (int attempt = 0;; ++attempt) {
      path_ = fmt::format("{}.{}-{}.tmp", beside, ::getpid(), attempt);
      descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (descriptor_ >= 0) return;
      if (errno != EEXIST) fail(beside, "cannot be written", errno, "check that its folder exists and may be written to");
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
  int close() {
    const int result = ::close(descriptor_);
    descriptor_ = -1;
    return result == 0 ? 0 : errno;
  }
  int rename_to(const std::string& target) {
    if (::rename(path_.c_str(), target.c_str()) != 0) return errno;
    path_.clear();
    return 0;
  }

 private:
  std::string path_;
  int descriptor_ = -1;
};

// A rename lasts through a power failure only once its folder has been flushed too. Some file systems cannot flush a
// folder; the file is whole all the same, so that is no error.
void flush_folder_of(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

void write_file_atomically(const std::string& path, std::string_view bytes) {
  Temporary temporary(path);
  constexpr std::string_view next = "check that the disk has room";
  while (!bytes.empty()) {
    const ssize_t written = ::write(temporary.descriptor(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path, "cannot be written", errno, next);
    bytes.remove_prefix(static_cast<size_t>(written));
  }
  if (::fsync(temporary.descriptor()) != 0) fail(path, "cannot be written", errno, next);
  if (const int error = temporary.close()) fail(path, "cannot be written", error, next);
  if (const int error = temporary.rename_to(path)) fail(path, "cannot be replaced", error, "choose another place for it");
  flush_folder_of(path);
}

std::string read_file(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) fail(path, "cannot be read", errno, "check the path");
  std::string bytes;
  char block[1 << 16];
  for (;;) {
    const ssize_t count = ::read(descriptor, block, sizeof block);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      const int error = errno;
      ::close(descriptor);
      fail(path, "cannot be read", error, "check the path");
    }
    if (count == 0) break;
    bytes.append(block, static_cast<size_t>(count));
  }
  ::close(descriptor);
  return bytes;
}

}  // namespace noonmark
