#include "technique/setting_rows.h"

#include <fmt/format.h>

#include <cmath>
#include <span>

#include "base/error.h"
#include "base/suggestion.h"

namespace noonmark::setting_rows {

namespace {

// Numbers in brackets, as a TOML file has them: what to type instead.
std::string without_brackets(const Setting& row, std::string_view text) {
  if (row.type != ValueType::point && !row.is_of_numbers()) return "";
  if (text.size() < 2 || !(text.front() == '[' || text.front() == '(') || !(text.back() == ']' || text.back() == ')'))
    return "";
  return fmt::format("; write {} = {}, without brackets", row.name, text.substr(1, text.size() - 2));
}

}  // namespace

[[noreturn]] void refuse(const Setting& row, std::string_view text) {
  constexpr std::string_view flags[] = {"true", "false"};
  const std::span<const std::string_view> choices = row.type == ValueType::flag ? flags : std::span(row.choices);
  throw Error(ErrorKind::usage,
              fmt::format("{} = '{}' is not allowed; it takes {}{}{}", row.name, text, row.range_with_unit(),
                          did_you_mean(text, choices), without_brackets(row, text)));
}

std::string number_text(double value) { return fmt::format("{}", value == 0 ? 0.0 : value); }

namespace {

// whole: the text of which it is a part.
double parse_real(const Setting& row, std::string_view text, std::string_view whole) {
  const std::optional<double> value = parse_number<double>(text);
  if (!value || !row.range().holds(*value)) refuse(row, whole);
  return *value;
}

// Numbers with commas between them, each perhaps after spaces.
std::vector<double> parse_numbers(const Setting& row, std::string_view text) {
  std::vector<double> numbers;
  for (std::string_view rest = text;;) {
    const size_t comma = rest.find(',');
    std::string_view part = rest.substr(0, comma);
    while (!part.empty() && part.front() == ' ') part.remove_prefix(1);
    numbers.push_back(parse_real(row, part, text));
    if (comma == std::string_view::npos) return numbers;
    rest.remove_prefix(comma + 1);
  }
}

}  // namespace

double parse_real(const Setting& row, std::string_view text) { return parse_real(row, text, text); }

glm::dvec3 parse_point(const Setting& row, std::string_view text) {
  const std::vector<double> numbers = parse_numbers(row, text);
  if (numbers.size() != 3) refuse(row, text);
  return {numbers[0], numbers[1], numbers[2]};
}

std::vector<double> parse_list(const Setting& row, std::string_view text) {
  std::vector<double> numbers = parse_numbers(row, text);
  for (size_t i = 0; i < numbers.size(); ++i) {
    const bool follows = row.type == ValueType::whole_list  ? numbers[i] == std::floor(numbers[i])
                         : row.type == ValueType::real_list ? true
                                                            : i == 0 || numbers[i] > numbers[i - 1];
    if (!follows) refuse(row, text);
  }
  return numbers;
}

std::string list_text(const std::vector<double>& list) {
  if (list.empty()) return "auto";
  std::string text;
  for (const double number : list) text += (text.empty() ? "" : ",") + number_text(number);
  return text;
}

std::string point_text(glm::dvec3 p) {
  return fmt::format("{},{},{}", number_text(p.x), number_text(p.y), number_text(p.z));
}

}  // namespace noonmark::setting_rows
