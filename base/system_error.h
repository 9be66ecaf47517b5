// Which kind of Error a failed call to the system is.
//
//   throw Error(kind_of_failure(errno), "cannot write out/x");
#pragma once
#include "base/error.h"

namespace noonmark {

// error_number: errno. If no more files can be open, the machine has to change, or the limit that it sets; otherwise the
// file.
ErrorKind kind_of_failure(int error_number);

// What to do about it: `otherwise`, or how to have more files open.
const char* advice_on_failure(int error_number, const char* otherwise);

}  // namespace noonmark
