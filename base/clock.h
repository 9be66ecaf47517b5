// The time of day, for records.
#pragma once
#include <string>

namespace noonmark {

std::string utc_now();  // "2025-01-31T12:00:00Z"

}  // namespace noonmark
