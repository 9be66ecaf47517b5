#include "base/failure.h"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <new>
#include <stdexcept>

#include "base/error.h"
#include "base/text.h"

namespace noonmark {

Failure current_failure() {
  try {
    throw;
  } catch (const Error& error) {
    return {error.exit_code(), printable(error.what())};
  } catch (const std::bad_alloc&) {
    return {static_cast<int>(ErrorKind::device),
            "memory has run out; choose a smaller picture, map or filter, or a machine with more"};
  } catch (const std::exception& error) {
    return {static_cast<int>(ErrorKind::defect),
            fmt::format("a defect of Noonmark: {}; please report it with the command and the output of noonmark doctor",
                        printable(error.what()))};
  }
}

int tell(const Failure& failure) {
  fmt::print(stderr, "noonmark: {}\n", failure.message);
  return failure.exit_code;
}

}  // namespace noonmark
