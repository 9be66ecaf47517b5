#include "base/terminal.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <stdexcept>
#include <string>

#include "base/text.h"

namespace noonmark {
namespace {

// stdio's streams are globals, so this state is global too.
struct Stream {
  int descriptor = -1;
  int error = 0;          // errno of the first write that failed
  std::string pending{};  // the beginning of an incomplete character
};
Stream output{.descriptor = STDOUT_FILENO}, errors{.descriptor = STDERR_FILENO};

int write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(descriptor, bytes.data(), bytes.size());
    if (written > 0) {
      bytes.remove_prefix(static_cast<size_t>(written));
    } else if (errno == EAGAIN) {  // another program made it non-blocking
      pollfd ready{descriptor, POLLOUT, 0};
      poll(&ready, 1, -1);
    } else if (errno != EINTR) {
      return errno;
    }
  }
  return 0;
}

// The number of bytes at the end of text that belong to an incomplete character.
size_t cut_short(std::string_view text) {
  for (size_t length = 1; length <= 3 && length <= text.size(); ++length) {
    const auto first = static_cast<unsigned char>(text[text.size() - length]);
    if ((first & 0xc0) == 0x80) continue;  // a continuation byte of a character
    const size_t whole = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : first >= 0xc0 ? 2 : 1;
    return whole > length ? length : 0;
  }
  return 0;
}

ssize_t write_cookie(void* cookie, const char* data, size_t size) {
  auto& stream = *static_cast<Stream*>(cookie);
  std::string text = stream.pending + std::string(data, size);
  const size_t rest = cut_short(text);
  stream.pending = text.substr(text.size() - rest);
  text.resize(text.size() - rest);
  const int error = write_all(stream.descriptor, printable(text, Lines::many));
  if (stream.error == 0) stream.error = error;
  return static_cast<ssize_t>(size);  // otherwise stdio would try again, and fmt would throw
}

int close_cookie(void* cookie) {
  auto& stream = *static_cast<Stream*>(cookie);
  const std::string rest = printable(stream.pending);
  stream.pending.clear();
  const int error = write_all(stream.descriptor, rest);
  if (stream.error == 0) stream.error = error;
  return 0;
}

std::FILE* open_stream(Stream& stream, int buffering) {
  std::FILE* file = fopencookie(&stream, "w", {nullptr, write_cookie, nullptr, close_cookie});
  if (!file) throw std::bad_alloc();
  std::setvbuf(file, nullptr, buffering, BUFSIZ);
  return file;
}

// A file that is opened while 0, 1 or 2 is closed gets that number, and printed text would go into it. These numbers
// are opened read-only here, so a write fails and is noticed.
void occupy_standard_descriptors() {
  for (int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(descriptor, F_GETFD) == -1 && errno == EBADF) {
      [[maybe_unused]] const int occupied = open("/dev/null", O_RDONLY);  // the lowest number that is free
    }
}

}  // namespace

Terminal::Terminal() : stdout_before_(stdout), stderr_before_(stderr) {
  occupy_standard_descriptors();
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  stdout = open_stream(output, _IOLBF);
  stderr = open_stream(errors, _IONBF);
}

Terminal::~Terminal() {
  std::fclose(stdout);
  std::fclose(stderr);
  stdout = stdout_before_;
  stderr = stderr_before_;
}

int Terminal::lost() const {
  std::fflush(stdout);
  return output.error == EPIPE ? 0 : output.error;
}

void write_to_terminal(std::string_view bytes) { write_all(STDERR_FILENO, bytes); }

}  // namespace noonmark
