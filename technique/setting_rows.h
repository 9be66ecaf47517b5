// Functions that make the rows of technique/settings.cpp. There is one for each kind of member; it makes the functions
// that read and write the member as text. Only settings.cpp and the *_rows.cpp include this file.
#pragma once
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "scenes/number_ranges.h"
#include "technique/settings.h"

namespace noonmark::setting_rows {

template <class T>
std::optional<T> parse_number(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// Throws Error(usage) with the values that the row accepts.
[[noreturn]] void refuse(const Setting& row, std::string_view text);

// The shortest decimal that reads back as the same double. -0 becomes 0, so that equal values have equal keys.
std::string number_text(double value);
std::string point_text(glm::dvec3 p);
std::string list_text(const std::vector<double>& list);  // "5,15,50"; empty: "auto"

// Throw Error(usage) if the text is not a number, a point or a list of the row's type, or is outside the row's range.
double parse_real(const Setting& row, std::string_view text);
glm::dvec3 parse_point(const Setting& row, std::string_view text);
std::vector<double> parse_list(const Setting& row, std::string_view text);  // "5, 15, 50"

// Each function below makes a row for one kind of member. `member` maps Settings& to a reference.

template <class Member>
Setting integer(std::string_view name, std::string_view unit, double min, double max, std::string_view help,
                Member member) {
  constexpr bool is_optional = std::is_same_v<std::invoke_result_t<Member, Settings&>, std::optional<int>&>;
  Setting row{name, unit, ValueType::integer, min, max, is_optional, {}, std::string(help), {}, {}};
  row.get = [member](const Settings& s) {
    const auto& value = member(const_cast<Settings&>(s));
    if constexpr (is_optional)
      return value ? fmt::format("{}", *value) : std::string("auto");
    else
      return fmt::format("{}", value);
  };
  row.set = [member, row](Settings& s, std::string_view text) {
    if constexpr (is_optional) {
      if (text == "auto") {
        member(s).reset();
        return;
      }
    }
    const std::optional<int> value = parse_number<int>(text);
    if (!value || *value < row.min || *value > row.max) refuse(row, text);
    member(s) = *value;
  };
  return row;
}

template <class Member>
Setting real(std::string_view name, std::string_view unit, double min, double max, std::string_view help,
             Member member) {
  constexpr bool is_optional = std::is_same_v<std::invoke_result_t<Member, Settings&>, std::optional<double>&>;
  Setting row{name, unit, ValueType::real, min, max, is_optional, {}, std::string(help), {}, {}};
  row.get = [member](const Settings& s) {
    const auto& value = member(const_cast<Settings&>(s));
    if constexpr (is_optional)
      return value ? number_text(*value) : std::string("auto");
    else
      return number_text(value);
  };
  row.set = [member, row](Settings& s, std::string_view text) {
    if constexpr (is_optional) {
      if (text == "auto") {
        member(s).reset();
        return;
      }
    }
    member(s) = parse_real(row, text);
  };
  return row;
}

// range: of each of the three numbers.
template <class Member>
Setting point(std::string_view name, std::string_view unit, const NumberRange& range, std::string_view help,
              Member member) {
  Setting row{name, unit, ValueType::point, range.least, range.most, true, {}, std::string(help), {}, {}};
  row.get = [member](const Settings& s) {
    const auto& value = member(const_cast<Settings&>(s));
    return value ? point_text(*value) : std::string("auto");
  };
  row.set = [member, row](Settings& s, std::string_view text) {
    if (text == "auto")
      member(s).reset();
    else
      member(s) = parse_point(row, text);
  };
  return row;
}

// The member is a bool, or a number that is 0 or 1 (a filter's parameter).
template <class Member>
Setting flag(std::string_view name, std::string_view help, Member member) {
  Setting row{name, "", ValueType::flag, 0, 0, false, {}, std::string(help), {}, {}};
  row.get = [member](const Settings& s) {
    return std::string(member(const_cast<Settings&>(s)) != 0 ? "true" : "false");
  };
  row.set = [member, row](Settings& s, std::string_view text) {
    if (text != "true" && text != "false") refuse(row, text);
    member(s) = text == "true";
  };
  return row;
}

// choices: the names in the order of the enumerators.
template <class Member>
Setting choice(std::string_view name, std::vector<std::string_view> choices, std::string_view help, Member member) {
  Setting row{name, "", ValueType::choice, 0, 0, false, choices, std::string(help), {}, {}};
  row.get = [member, choices](const Settings& s) {
    return std::string(choices[static_cast<size_t>(member(const_cast<Settings&>(s)))]);
  };
  row.set = [member, row](Settings& s, std::string_view text) {
    const auto found = std::find(row.choices.begin(), row.choices.end(), text);
    if (found == row.choices.end()) refuse(row, text);
    using Enum = std::remove_reference_t<std::invoke_result_t<Member, Settings&>>;
    member(s) = static_cast<Enum>(found - row.choices.begin());
  };
  return row;
}

template <class Member>
Setting text(std::string_view name, std::string_view help, Member member) {
  Setting row{name, "", ValueType::text, 0, 0, false, {}, std::string(help), {}, {}};
  row.get = [member](const Settings& s) { return member(const_cast<Settings&>(s)); };
  row.set = [member, row](Settings& s, std::string_view value) {
    if (value.empty()) refuse(row, value);
    member(s) = std::string(value);
  };
  return row;
}

// A list of numbers between min and max: ascending ones (ValueType::list), or in any order whole ones (whole_list) or all
// (real_list). An empty list is "auto".
template <class Member>
Setting number_list(ValueType type, std::string_view name, std::string_view unit, double min, double max,
                    std::string_view help, Member member) {
  Setting row{name, unit, type, min, max, true, {}, std::string(help), {}, {}};
  row.get = [member](const Settings& s) { return list_text(member(const_cast<Settings&>(s))); };
  row.set = [member, row](Settings& s, std::string_view text) {
    if (text == "auto")
      member(s).clear();
    else
      member(s) = parse_list(row, text);
  };
  return row;
}

// A choice whose values are the names of the rows of a table. The help text is `help` and then the help of each row.
template <class Rows, class Member>
Setting named(std::string_view name, std::string_view help, const Rows& rows, Member member) {
  Setting row{name, "", ValueType::choice, 0, 0, false, {}, std::string(help), {}, {}};
  for (const auto& choice : rows) {
    row.help += fmt::format("{}{}: {}", row.choices.empty() ? " " : "; ", choice.name, choice.help);
    row.choices.push_back(choice.name);
  }
  row.help += ".";
  row.get = [member](const Settings& s) { return member(const_cast<Settings&>(s)); };
  row.set = [member, row](Settings& s, std::string_view value) {
    if (std::find(row.choices.begin(), row.choices.end(), value) == row.choices.end()) refuse(row, value);
    member(s) = std::string(value);
  };
  return row;
}

// The row of one parameter of a table of kinds, such as the filters. It is idle with a kind that does not read it. member:
// Settings& -> the settings of the table's group.
template <class Rows, class Member>
Setting kind_row(const Rows& rows, const KindParameter& parameter, Member of) {
  std::vector<std::string_view> readers;
  for (const auto& row : rows)
    if (find_read(row, parameter)) readers.push_back(row.name);
  const std::string help = fmt::format("{}: {}", fmt::join(readers, ", "), parameter.help);
  const auto member = [&parameter, of](Settings& s) -> double& { return of(s)[parameter.name()]; };
  const auto bare = [&] {
    switch (parameter.type) {
      case ValueType::integer:
        return integer(parameter.setting, parameter.unit, parameter.min, parameter.max, help, member);
      case ValueType::real:
        return real(parameter.setting, parameter.unit, parameter.min, parameter.max, help, member);
      case ValueType::flag:
        return flag(parameter.setting, help, member);
      case ValueType::choice:
        return choice(parameter.setting, {parameter.choices.begin(), parameter.choices.end()}, help, member);
      default:
        throw std::logic_error("a parameter of a kind that is no number, flag or choice");
    }
  };
  const auto read_by = [rows, &parameter, of](const Settings& s) {
    const auto& values = of(const_cast<Settings&>(s));
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const auto& one) { return one.name == values.kind; });
    return std::pair(row == rows.end() ? nullptr : find_read(*row, parameter), &values);
  };
  const std::string kind = std::string(parameter.setting.substr(0, parameter.setting.find('.'))) + ".kind";
  return bare()
      .idle([read_by, kind](const Settings& s, LightKind) {
        const auto [read, values] = read_by(s);
        if (!read) return fmt::format("with {} = {}", kind, values->kind);
        return read->why_idle ? read->why_idle(*values) : "";
      })
      .refused([read_by](const Settings& s, std::optional<LightKind>) {
        const auto [read, values] = read_by(s);
        return read && read->why_refused ? read->why_refused(*values) : "";
      });
}

// The rows of a group or two, each in the file of its name; those of the truth are in lookup_rows.cpp. The table has them in this
// order.
std::vector<Setting> view_rows();
std::vector<Setting> motion_rows();
std::vector<Setting> light_rows();
std::vector<Setting> map_rows();
std::vector<Setting> cascade_rows();
std::vector<Setting> bias_rows();
std::vector<Setting> lookup_rows();
std::vector<Setting> truth_rows();

}  // namespace noonmark::setting_rows
