// Reads TOML values of an experiment file, so that every message can name file:line:column. Only settings_reader.h
// includes it, because toml++ is a large header.
#pragma once
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/definition/experiment.h"
#include "app/definition/experiment_keys.h"
#include "app/definition/share_text.h"
#include "base/error.h"
#include "base/text.h"
#include "technique/settings.h"

namespace noonmark {

// One key of a table and its value, in the order of the file (toml++ sorts keys by name).
struct Item {
  std::string key;
  toml::source_region where;
  const toml::node* node;
};

// An error whose message already starts with its place.
struct LocatedError : Error {
  using Error::Error;
};

class TomlReader {
 protected:
  explicit TomlReader(std::string path) : path_(std::move(path)) {}
  const std::string& path() const { return path_; }

  // ---- messages

  std::string location_text(const toml::source_region& where) const {
    return fmt::format("{}:{}:{}", path_, where.begin.line, where.begin.column);
  }
  [[noreturn]] void fail(const toml::source_region& where, const std::string& what) const {
    throw LocatedError(ErrorKind::usage, fmt::format("{}: {}", location_text(where), what));
  }
  [[noreturn]] void fail(const toml::node& node, const std::string& what) const { fail(node.source(), what); }

  // Runs f. An error that f throws gets the place in front, unless it already has one.
  template <class F>
  auto at(const toml::source_region& where, F f) const {
    try {
      return f();
    } catch (const LocatedError&) {
      throw;
    } catch (const Error& error) {
      fail(where, error.what());
    }
  }

  [[noreturn]] void unknown(const Item& item, std::string_view kind, std::vector<std::string_view> known,
                            const std::string& place) const {
    const std::string near = nearest_name(item.key, known);
    fail(item.where, fmt::format("there is no {} '{}{}'; {}", kind, place, item.key,
                                 near.empty() ? fmt::format("known: {}", fmt::join(known, ", "))
                                              : fmt::format("did you mean '{}{}'?", place, near)));
  }

  // ---- values

  static std::vector<Item> items(const toml::table& table) {
    std::vector<Item> list;
    for (auto&& [key, node] : table) list.push_back({std::string(key.str()), key.source(), &node});
    std::sort(list.begin(), list.end(), [](const Item& a, const Item& b) {
      return std::pair(a.where.begin.line, a.where.begin.column) < std::pair(b.where.begin.line, b.where.begin.column);
    });
    return list;
  }

  const toml::table& table(const toml::node& node, const std::string& name) const {
    if (!node.is_table()) fail(node, fmt::format("{} must be a table", name));
    return *node.as_table();
  }
  std::string string(const toml::node& node, const std::string& name) const {
    if (!node.is_string()) fail(node, fmt::format("{} must be a string", name));
    return node.as_string()->get();
  }
  std::string one_of(const toml::node& node, const std::string& name, std::vector<std::string_view> choices) const {
    const std::string text = string(node, name);
    if (std::find(choices.begin(), choices.end(), text) != choices.end()) return text;
    const std::string near = nearest_name(text, choices);
    fail(node, fmt::format("{} = '{}' is not one of {}{}", name, text, fmt::join(choices, " | "),
                           near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
  }
  double number(const toml::node& node, const std::string& name) const {
    const std::optional<double> value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value || !std::isfinite(*value)) fail(node, fmt::format("{} must be a finite number", name));
    return *value;
  }
  // A share: a number, or a text in percent ("0.5%").
  double share(const toml::node& node, const std::string& name) const {
    if (!node.is_string()) return number(node, name);
    const std::string text = node.as_string()->get();
    const std::optional<double> value = text.ends_with('%') ? share_from(text) : std::nullopt;
    if (!value) fail(node, fmt::format("{} = '{}' must be a number, or a text such as \"0.5%\"", name, text));
    return *value;
  }
  // As the file has it, for messages.
  static std::string written(const toml::node& node, double value) {
    return node.is_string() ? node.as_string()->get() : fmt::format("{}", value);
  }
  bool boolean(const toml::node& node, const std::string& name) const {
    if (!node.is_boolean()) fail(node, fmt::format("{} must be true or false", name));
    return node.as_boolean()->get();
  }
  std::vector<const toml::node*> list(const toml::node& node, const std::string& name) const {
    if (!node.is_array()) fail(node, fmt::format("{} must be a list", name));
    if (node.as_array()->empty()) fail(node, fmt::format("{} is an empty list; give it at least one value", name));
    std::vector<const toml::node*> nodes;
    for (const toml::node& element : *node.as_array()) nodes.push_back(&element);
    return nodes;
  }

  // {min, max, steps, scale} -> the values.
  std::vector<double> range(const toml::table& table, const std::string& name) const {
    std::optional<double> min, max;
    std::optional<int64_t> steps;
    bool logarithmic = false;
    for (const Item& item : items(table)) {
      const std::string item_name = name + "." + item.key;
      if (item.key == "min")
        min = number(*item.node, item_name);
      else if (item.key == "max")
        max = number(*item.node, item_name);
      else if (item.key == "scale")
        logarithmic = one_of(*item.node, item_name, key_choices("range", "scale")) == "log";
      else if (item.key == "steps") {
        if (!item.node->is_integer()) fail(*item.node, fmt::format("{} must be an integer", item_name));
        steps = item.node->as_integer()->get();
        if (*steps < 2 || *steps > max_points)
          fail(*item.node, fmt::format("{} = {} must be 2 ... {}: the number of values, both ends among them",
                                       item_name, *steps, max_points));
      } else {
        unknown(item, "key", key_names("range"), name + ".");
      }
    }
    if (!min || !max || !steps) fail(table, fmt::format("the range {} needs min, max and steps", name));
    if (*min >= *max) fail(table, fmt::format("{}: min = {} is not below max = {}", name, *min, *max));
    if (logarithmic && *min <= 0)
      fail(table, fmt::format("{}: a logarithmic range needs min above 0, not {}", name, *min));

    std::vector<double> values;
    const auto last = static_cast<double>(*steps - 1);
    for (int64_t i = 0; i + 1 < *steps; ++i) {
      const auto at_step = static_cast<double>(i);
      const double value =
          logarithmic ? *min * std::pow(*max / *min, at_step / last) : *min + at_step * ((*max - *min) / last);
      values.push_back(short_decimal(value, std::max(std::abs(value), std::abs(*min))));
    }
    values.push_back(*max);
    return values;
  }

 private:
  // The arithmetic of a range misses a short decimal by a few units in the last place: 10 * 8^(2/3) gives
  // 39.99999999999999. Such a value is replaced by the decimal, because `where` and --set name a value by its exact
  // text.
  static double short_decimal(double value, double magnitude) {
    constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();  // pow() over 12 decades: 13 of them
    if (std::abs(value) <= rounding * magnitude) return 0;
    const double decimal = std::stod(fmt::format("{:.12g}", value));
    return std::abs(value - decimal) <= rounding * magnitude ? decimal : value;
  }

  std::string path_;
};

}  // namespace noonmark
