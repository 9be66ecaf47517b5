#include "technique/setting_rows.h"

#include <fmt/format.h>

#include <cmath>
#include <span>

#include "base/error.h"
#include "base/suggestion.h"

namespace noonmark::setting_rows {

[[noreturn]] void refuse(const Setting& row, std::string_view text) {
  constexpr std::string_view flags[] = {"true", "false"};
  const std::span<const std::string_view> choices = row.type == ValueType::flag ? flags : std::span(row.choices);
  throw Error(ErrorKind::usage, fmt::format("{} = '{}' is not allowed; it takes {}{}", row.name, text,
                                            row.range_with_unit(), did_you_mean(text, choices)));
}

std::string number_text(double value) { return fmt::format("{}", value == 0 ? 0.0 : value); }

double parse_real(const Setting& row, std::string_view text) {
  const std::optional<double> value = parse_number<double>(text);
  if (!value || !std::isfinite(*value) || *value < row.min || *value > row.max) refuse(row, text);
  return *value;
}

glm::dvec3 parse_point(const Setting& row, std::string_view text) {
  glm::dvec3 point;
  std::string_view rest = text;
  for (int axis = 0; axis < 3; ++axis) {
    const size_t comma = rest.find(',');
    if ((comma == std::string_view::npos) != (axis == 2)) refuse(row, text);
    std::string_view part = rest.substr(0, comma);
    while (!part.empty() && part.front() == ' ') part.remove_prefix(1);
    const std::optional<double> value = parse_number<double>(part);
    if (!value || !std::isfinite(*value)) refuse(row, text);
    point[axis] = *value;
    if (axis < 2) rest.remove_prefix(comma + 1);
  }
  return point;
}

std::string point_text(glm::dvec3 p) {
  return fmt::format("{},{},{}", number_text(p.x), number_text(p.y), number_text(p.z));
}

}  // namespace noonmark::setting_rows
