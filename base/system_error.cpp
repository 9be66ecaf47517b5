#include "base/system_error.h"

#include <cerrno>

namespace noonmark {
namespace {

bool too_many_are_open(int error_number) { return error_number == EMFILE || error_number == ENFILE; }

}  // namespace

ErrorKind kind_of_failure(int error_number) {
  return too_many_are_open(error_number) ? ErrorKind::device : ErrorKind::file;
}

const char* advice_on_failure(int error_number, const char* otherwise) {
  return too_many_are_open(error_number) ? "raise the limit (ulimit -n), or close other programs" : otherwise;
}

}  // namespace noonmark
