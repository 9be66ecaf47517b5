// Numbers as text that few settings expect: zeros, signs, magnitudes beyond floats and doubles, and what is no number.
#pragma once
#include <string_view>

namespace noonmark::fuzz {

inline constexpr std::string_view odd_numbers[] = {"0",    "-0",    "-1",   "1e9",   "-1e9",  "1000000000", "1e15",
                                                   "1e20", "-1e20", "1e38", "1e300", "1e400", "1e-300",     "4.9e-324",
                                                   "nan",  "-nan",  "inf",  "-inf",  "1e-9"};

}  // namespace noonmark::fuzz
