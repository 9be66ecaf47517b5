#include "app/definition/share_text.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace noonmark {
namespace {

std::optional<double> number_from(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

std::optional<double> share_from(std::string_view text) {
  if (!text.ends_with('%')) return number_from(text);
  text.remove_suffix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  // Two places moved in the decimal text, so that 0.1% is the double of 0.001. A quotient can be one rounding away.
  if (text.find_first_of("eE") == std::string_view::npos) return number_from(std::string(text) + "e-2");
  const std::optional<double> percent = number_from(text);
  return percent ? std::optional(*percent / 100) : std::nullopt;
}

std::string percent_text(double share) { return fmt::format("{:g}%", 100 * share); }

std::string above_every_share(double value, std::string_view text) {
  const std::string written = fmt::format("{} is above every share, which is at most 1 (100%)", text);
  if (text.ends_with('%') || value > 100) return written;
  return fmt::format("{}; did you mean {} or \"{}%\"?", written, *share_from(fmt::format("{}%", value)), value);
}

}  // namespace noonmark
