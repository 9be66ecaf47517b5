// The kind of the error that a call throws, for tests.
#pragma once
#include <string>

#include "base/error.h"

namespace noonmark {

// The kind of the Error that f throws, or 0; its message goes to `message`.
template <class F>
int kind_thrown(F&& f, std::string* message = nullptr) {
  try {
    f();
  } catch (const Error& e) {
    if (message) *message = e.what();
    return e.exit_code();
  }
  return 0;
}

}  // namespace noonmark
