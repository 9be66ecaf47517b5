// The time of day and how long something took, for records.
#pragma once
#include <chrono>
#include <string>

namespace noonmark {

std::string utc_now();  // "2025-01-31T12:00:00Z"

inline double milliseconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace noonmark
