#include "scenes/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "scenes/error.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, std::string_view what, int error_number, std::string_view next) {
  throw Error(ErrorKind::scene, fmt::format("{}: {}: {}; {}", path, what, std::strerror(error_number), next));
}

// "results.csv" + ".noonmark-4711-0.tmp": process and attempt.
constexpr std::string_view temporary_mark = ".noonmark-", temporary_ending = ".tmp";

// The process that a temporary file's name tells of, 0 for any other name.
pid_t writer_of(std::string_view name) {
  const size_t mark = name.rfind(temporary_mark);
  if (mark == std::string_view::npos || mark == 0 || !name.ends_with(temporary_ending)) return 0;
  name.remove_suffix(temporary_ending.size());
  name.remove_prefix(mark + temporary_mark.size());
  pid_t process = 0;
  unsigned attempt = 0;
  const char* const end = name.data() + name.size();
  const auto [dash, no_process] = std::from_chars(name.data(), end, process);
  if (no_process != std::errc{} || dash == end || *dash != '-' || process <= 0) return 0;
  const auto [last, no_attempt] = std::from_chars(dash + 1, end, attempt);
  return no_attempt == std::errc{} && last == end ? process : 0;
}

// An open file that is closed, and removed unless it was kept. Locked as long as it is open, so that others see whether
// its program lives.
class Temporary {
 public:
  explicit Temporary(const std::string& beside) {
    for (int attempt = 0;; ++attempt) {
      path_ = fmt::format("{}{}{}-{}{}", beside, temporary_mark, ::getpid(), attempt, temporary_ending);
      descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (descriptor_ >= 0) {
        ::flock(descriptor_, LOCK_EX | LOCK_NB);
        return;
      }
      if (errno != EEXIST)
        fail(beside, "cannot be written", errno, "check that its folder exists and may be written to");
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

// What was made or renamed in a folder lasts through a power failure only once the folder has been flushed too. Some
// file systems cannot flush a folder; the files are whole all the same, so that is no error.
void flush_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

// Closes the descriptor.
std::string read_all(int descriptor, const std::string& path, uint64_t most_bytes) {
  std::string bytes;
  char block[1 << 16];
  for (;;) {
    const ssize_t count = ::read(descriptor, block, sizeof block);
    if (count < 0 && errno == EINTR) continue;
    const int error = errno;
    if (count <= 0) ::close(descriptor);
    if (count < 0) fail(path, "cannot be read", error, "check the path");
    if (count == 0) return bytes;
    bytes.append(block, static_cast<size_t>(count));
    if (bytes.size() > most_bytes) {
      ::close(descriptor);
      throw Error(ErrorKind::scene,
                  fmt::format("{}: holds more than {} bytes, which no file of its kind does; check the path", path,
                              most_bytes));
    }
  }
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
  if (const int error = temporary.rename_to(path))
    fail(path, "cannot be replaced", error, "choose another place for it");
  flush_folder(fs::path(path).parent_path());
}

void make_folder(const std::string& path) {
  const auto cannot = [&](const std::error_code& error) {
    throw Error(ErrorKind::scene, fmt::format("cannot make the folder {}: {}; check the path", path, error.message()));
  };
  fs::path made;
  for (const fs::path& part : fs::path(path)) {
    const fs::path parent = made;
    made /= part;
    std::error_code error;
    if (fs::is_directory(made, error)) continue;
    if (fs::create_directory(made, error))
      flush_folder(parent);
    else if (error)
      cannot(error);
  }
  std::error_code error;
  if (!fs::is_directory(path, error)) cannot(error ? error : std::make_error_code(std::errc::not_a_directory));
}

void clear_abandoned_files(const std::string& folder) {
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    const pid_t writer = writer_of(entry.path().filename().native());
    // A process of this number may be another one by now: then the file stays until a later start.
    if (writer == 0 || ::kill(writer, 0) == 0 || errno != ESRCH) continue;
    // Another container's process is not seen here, but its lock is.
    const int descriptor = ::open(entry.path().c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) continue;
    struct stat status {};
    if (::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) && ::flock(descriptor, LOCK_EX | LOCK_NB) == 0)
      ::unlink(entry.path().c_str());
    ::close(descriptor);
  }
}

std::string read_file(const std::string& path, uint64_t most_bytes) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) fail(path, "cannot be read", errno, "check the path");
  return read_all(descriptor, path, most_bytes);
}

std::string read_file_below(const std::string& folder, const std::string& name, uint64_t most_bytes) {
  const std::string path = folder + "/" + name;
  const auto refuse = [&](std::string_view what) {
    throw Error(ErrorKind::scene, fmt::format("{}: {}; only regular files in {} are read", path, what, folder));
  };
  std::error_code error;
  const fs::path home = fs::canonical(folder, error);
  if (error) fail(folder, "cannot be read", error.value(), "check the path");
  if (fs::path(name).is_absolute()) refuse("leads out of the folder");
  const fs::path target = fs::canonical(home / name, error);
  if (error) fail(path, "cannot be read", error.value(), "check the path");
  if (std::mismatch(home.begin(), home.end(), target.begin(), target.end()).first != home.end())
    refuse("leads out of the folder");
  const int descriptor = ::open(target.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (descriptor < 0) fail(path, "cannot be read", errno, "check the path");
  struct stat status {};
  if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
    ::close(descriptor);
    refuse("is not a regular file");
  }
  return read_all(descriptor, path, most_bytes);
}

}  // namespace noonmark
