// The error that a call throws, for tests.
#pragma once
#include <gtest/gtest.h>

#include <initializer_list>
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

// The message of the Error that f throws, which must be of this kind; "" if f throws none.
template <class F>
std::string refusal_of(ErrorKind kind, F&& f) {
  try {
    f();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), kind) << e.what();
    return e.what();
  }
  return "";
}

// f throws an Error of this kind, and its message holds each of these texts.
template <class F>
void expect_refused(ErrorKind kind, std::initializer_list<std::string> says, F&& f) {
  const std::string message = refusal_of(kind, f);
  for (const std::string& text : says) EXPECT_PRED_FORMAT2(testing::IsSubstring, text, message);
}

}  // namespace noonmark
