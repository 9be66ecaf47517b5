#include "app/verbs/option_values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/suggestion.h"

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

CLI::Validator number_in(const NumberRange& range) {
  return validator([=](std::string& text) -> std::string {
    const std::optional<double> value = whole_text_as<double>(text);
    return value && range.holds(*value)
               ? ""
               : fmt::format("'{}' is not a number from {:g} to {:g}", text, range.least, range.most);
  });
}

CLI::Validator one_of(std::vector<std::string> words) {
  return validator([words = std::move(words)](std::string& text) -> std::string {
    if (std::find(words.begin(), words.end(), text) != words.end()) return "";
    const std::vector<std::string_view> names(words.begin(), words.end());
    return fmt::format("'{}' is none of {}{}", text, fmt::join(words, ", "), did_you_mean(text, names));
  });
}

std::vector<std::string> words_of(const std::vector<std::string>& lists) {
  std::vector<std::string> words;
  for (const std::string& list : lists)
    for (size_t begin = 0; begin <= list.size();) {
      const size_t end = std::min(list.find(',', begin), list.size());
      std::string word = list.substr(begin, end - begin);
      word.erase(0, std::min(word.find_first_not_of(' '), word.size()));
      word.erase(word.find_last_not_of(' ') + 1);
      words.push_back(std::move(word));
      begin = end + 1;
    }
  return words;
}

CLI::Validator list_of(std::vector<std::string> words) {
  const CLI::Validator one = one_of(std::move(words));
  return validator([one](std::string& list) -> std::string {
    for (std::string& word : words_of({list})) {
      if (word.empty() && !list.empty()) return fmt::format("'{}' has a comma without a name beside it", list);
      if (std::string mistake = one(word); !mistake.empty()) return mistake;
    }
    return "";
  });
}

std::string joined(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, "|")); }

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

}  // namespace noonmark
