#include "app/verbs/option_values.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>

#include "app/definition/share_text.h"

namespace noonmark {
namespace {

// Empty if the text is more than a number, or none.
template <class Number>
std::optional<Number> whole_text_as(const std::string& text) {
  Number value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return {};
  return value;
}

// Without a description, which CLI11 would add to the option's type.
template <class Mistake>
CLI::Validator validator(Mistake mistake) {
  return CLI::Validator(std::move(mistake), "");
}

}  // namespace

CLI::Validator not_empty() {
  return validator([](std::string& path) -> std::string { return path.empty() ? "the path is empty" : ""; });
}

CLI::Validator whole_number(long least, long most) {
  const std::string range = most == std::numeric_limits<long>::max() ? fmt::format("from {} on", least)
                                                                     : fmt::format("from {} to {}", least, most);
  return validator([=](std::string& text) -> std::string {
    const std::optional<long> value = whole_text_as<long>(text);
    return value && *value >= least && *value <= most ? "" : fmt::format("'{}' is not a whole number {}", text, range);
  });
}

CLI::Validator above_zero() {
  return validator([](std::string& text) -> std::string {
    const std::optional<double> value = whole_text_as<double>(text);
    return value && *value > 0 && std::isfinite(*value) ? "" : fmt::format("'{}' is not a number above 0", text);
  });
}

CLI::Validator as_share() {
  return validator([](std::string& text) -> std::string {
    const std::optional<double> value = share_from(text);
    if (!value || *value < 0)
      return fmt::format("'{}' is not a share: a number from 0 to 1, or a percentage such as 0.5%", text);
    if (*value > 1) return above_every_share(*value, text);
    text = fmt::format("{}", *value);
    return "";
  });
}

std::string percent_text(double share) { return fmt::format("{:g}%", 100 * share); }

}  // namespace noonmark
