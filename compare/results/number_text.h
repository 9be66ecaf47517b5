// Numbers for people: at most four significant digits, and shares in percent. Whole numbers below 100 000 are whole. JSON,
// CSV and the store hold the exact values.
//
//   number_text(0.083472391);                      // "0.08347"
//   quantity_text(0.0083472391, "fraction");       // "0.8347%"
//   setting_text("24.784620536051,27.98850570,0"); // "24.78,27.99,0"
//
// The report has its own typography (compare/report/text.h) with the same rules.
#pragma once
#include <string>
#include <string_view>

namespace noonmark {

inline constexpr int people_digits = 4;

// "not measured" if the value is NaN.
std::string number_text(double value, int digits = people_digits);

// With its unit (Metric::unit): "0.8347%", "4.194 MB", "12.3 m", "16384".
std::string quantity_text(double value, std::string_view unit, int digits = people_digits);

// Shares and lit fractions are sums and differences of doubles around 1, which are 2^-52 apart. What is below four such steps is their
// rounding, and no measured amount: it is written as 0.
inline constexpr double least_share = 0x1p-50;
// A share in percent: "0.835%". quantity_text() of "fraction" does the same.
std::string share_text(double share, int digits = 3);

// A length or a distance with the unit that suits its size: "0.42 µm", "3.1 mm", "2.13 m", "1.2 km". It keeps the sign.
std::string length_text(double metres, int digits = 3);

// How many digits show that the two values differ, at least `least`: a found value that breaks a limit must not read as
// the limit. `least` if they are equal or one of them is not finite.
int digits_to_tell(double a, double b, int least = people_digits);

// The value of a setting, or of several with commas between them, where its exact text is not needed to name the point.
std::string setting_text(std::string_view value);

}  // namespace noonmark
