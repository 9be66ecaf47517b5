#include "compare/results/number_text.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "compare/results/quantities.h"

namespace noonmark {
namespace {

constexpr int all_digits = 17;       // they tell any two doubles apart
constexpr double most_plain = 1e15;  // above it a double is not written without an exponent

double rounded(double value, int digits) {
  return std::strtod(fmt::format("{:.{}e}", value, digits - 1).c_str(), nullptr);
}

std::string whole_text(double value) { return fmt::format("{:.0f}", value); }

}  // namespace

std::string number_text(double value, int digits) {
  if (std::isnan(value)) return std::string(not_measured);
  const double size = std::abs(value);
  if (size >= most_plain || (size < 1e4 && value != 0)) return fmt::format("{:.{}g}", value, digits);
  if (size < 1e5 && value == std::round(value)) return whole_text(value);
  const double shorter = rounded(value, digits);
  return shorter == std::round(shorter) ? whole_text(shorter) : fmt::format("{:.{}g}", value, digits);
}

std::string share_text(double share, int digits) {
  if (std::isnan(share)) return std::string(not_measured);
  return number_text(std::abs(share) < least_share ? 0 : 100 * share, digits) + "%";
}

std::string quantity_text(double value, std::string_view unit, int digits) {
  if (std::isnan(value)) return std::string(not_measured);
  if (unit == "fraction") return share_text(value, digits);
  if (unit == "bytes") return number_text(1e-6 * value, digits) + " MB";
  if (unit == "count") return number_text(std::abs(value) < most_plain ? std::round(value) : value, digits);
  const std::string number = number_text(value, digits);
  if (number == "1" && (unit == "pixels" || unit == "texels")) unit.remove_suffix(1);
  return unit.empty() ? number : fmt::format("{} {}", number, unit);
}

std::string length_text(double metres, int digits) {
  struct Unit {
    double metres;
    const char* name;
  };
  constexpr Unit units[] = {{1e3, "km"}, {1, "m"}, {1e-3, "mm"}, {1e-6, "µm"}, {1e-9, "nm"}};
  if (std::isnan(metres)) return std::string(not_measured);
  const double size = rounded(std::abs(metres), digits);  // 0.9996 m is 1 m, not 1000 mm
  if (size == 0) return "0 m";
  for (const Unit& unit : units)
    if (size >= unit.metres || unit.metres == 1e-9)
      return fmt::format("{} {}", number_text(metres / unit.metres, digits), unit.name);
  return "";  // not reached: the last unit takes all
}

int digits_to_tell(double a, double b, int least) {
  if (a == b || !std::isfinite(a) || !std::isfinite(b)) return least;
  int digits = least;
  while (digits < all_digits && number_text(a, digits) == number_text(b, digits)) ++digits;
  return digits;
}

std::string setting_text(std::string_view value) {
  std::string out;
  while (true) {
    const size_t comma = value.find(',');
    const std::string one(value.substr(0, comma));
    const std::optional<double> number = number_of(one);
    out += number ? number_text(*number) : one;
    if (comma == std::string_view::npos) return out;
    out += ',';
    value.remove_prefix(comma + 1);
  }
}

}  // namespace noonmark
