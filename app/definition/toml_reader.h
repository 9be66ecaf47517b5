// Reads TOML values, keys and settings of an experiment file, so that every message can name file:line:column. Only
// experiment_file.cpp and promise_reader.cpp include it, because toml++ is a large header.
#pragma once
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
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
#include "compare/judge/formula.h"
#include "compare/results/quantities.h"
#include "scenes/library.h"
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
  // A formula, or a number as one.
  std::string formula(const toml::node& node, const std::string& name) const {
    if (node.is_number()) return fmt::format("{}", number(node, name));
    const std::string text = string(node, name);
    at(node.source(), [&] { Formula read(text); });
    return text;
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
    RangeOfValues read;
    read_keys(table, keys_of(read), name + ".", name + ".");
    if (!read.min || !read.max || read.steps == 0)
      fail(table, fmt::format("the range {} needs min, max and steps", name));
    const double min = *read.min, max = *read.max;
    const bool logarithmic = read.scale == "log";
    if (min >= max) fail(table, fmt::format("{}: min = {} is not below max = {}", name, min, max));
    if (logarithmic && min <= 0)
      fail(table, fmt::format("{}: a logarithmic range needs min above 0, not {}", name, min));

    std::vector<double> values;
    const double last = read.steps - 1.0;
    for (int i = 0; i + 1 < read.steps; ++i) {
      const double at_step = i;
      const double value =
          logarithmic ? min * std::pow(max / min, at_step / last) : min + at_step * ((max - min) / last);
      values.push_back(short_decimal(value, std::max(std::abs(value), std::abs(min))));
    }
    values.push_back(max);
    return values;
  }

  // ---- keys (app/definition/experiment_keys.h)

  // Reads the value of a key that has a place into it. name: of the key, for messages.
  void fill(const ExperimentKey& key, const toml::node& node, const std::string& name) const {
    using Kind = ExperimentKey::Kind;
    if (auto* const text = std::get_if<std::string*>(&key.place))
      **text = key.kind == Kind::formula                               ? formula(node, name)
               : key.kind == Kind::metric || key.kind == Kind::pattern ? quantity(node, name, key.kind)
               : key.kind == Kind::choice                              ? one_of(node, name, key.choices)
                                                                       : string(node, name);
    if (auto* const flag = std::get_if<bool*>(&key.place)) **flag = boolean(node, name);
    if (auto* const count = std::get_if<int*>(&key.place)) **count = integer(node, name, key.least, key.most);
    const auto real = [&] { return key.kind == Kind::fraction ? fraction(node, name) : number(node, name); };
    if (auto* const one = std::get_if<double*>(&key.place)) **one = real();
    // A limit is read when its metric is known.
    if (auto* const one = std::get_if<std::optional<double>*>(&key.place); one && key.kind != Kind::limit)
      **one = real();
    if (auto* const all = std::get_if<std::vector<double>*>(&key.place)) **all = amounts(node, name);
    if (auto* const names = std::get_if<std::vector<std::string>*>(&key.place))
      for (const toml::node* one : list(node, name)) {
        std::string text = key.kind == Kind::quantities ? quantity(*one, name, key.kind)
                           : key.choices.empty()        ? string(*one, name)
                                                        : one_of(*one, name, key.choices);
        if (std::find((*names)->begin(), (*names)->end(), text) != (*names)->end())
          fail(*one, fmt::format("{} names '{}' twice", name, text));
        (*names)->push_back(std::move(text));
      }
  }

  // Reads the keys of a table, and then calls `then` with each that the file gives. place: what stands before an unknown key
  // in its message, and value_place before the key of a wrong value.
  template <class Then>
  void read_keys(const toml::table& table, const std::vector<ExperimentKey>& keys, const std::string& place,
                 const std::string& value_place, const Then& then) const {
    for (const Item& item : items(table)) {
      const auto key = std::find_if(keys.begin(), keys.end(), [&](const auto& one) { return one.name == item.key; });
      if (key == keys.end()) unknown(item, "key", key_names(keys), place);
      fill(*key, *item.node, value_place + item.key);
      then(*key, item);
    }
  }
  void read_keys(const toml::table& table, const std::vector<ExperimentKey>& keys, const std::string& place,
                 const std::string& value_place) const {
    read_keys(table, keys, place, value_place, [](const ExperimentKey&, const Item&) {});
  }

  // The tables of [[name]]. plural: for the message.
  std::vector<const toml::table*> tables(const toml::node& node, const char* plural, const char* name) const {
    if (!node.is_array() || !node.is_array_of_tables())
      fail(node, fmt::format("{} are written as [[{}]], one for each", plural, name));
    std::vector<const toml::table*> all;
    for (const toml::node& element : *node.as_array()) all.push_back(element.as_table());
    return all;
  }

 private:
  int integer(const toml::node& node, const std::string& name, double least, double most) const {
    const int64_t value = node.is_integer() ? node.as_integer()->get() : std::numeric_limits<int64_t>::min();
    if (static_cast<double>(value) < least || static_cast<double>(value) > most)
      fail(node, fmt::format("{} must be an integer, {} ... {}", name, least, most));
    return static_cast<int>(value);
  }
  double fraction(const toml::node& node, const std::string& name) const {
    const double value = share(node, name);
    if (value > 1) fail(node, fmt::format("{} = {}", name, above_every_share(value, written(node, value))));
    if (value < 0) fail(node, fmt::format("{} = {} must be a share, 0 ... 1", name, written(node, value)));
    return value;
  }
  // A list, or a table that describes one.
  std::vector<double> amounts(const toml::node& node, const std::string& name) const {
    std::vector<double> values;
    if (const toml::table* range_table = node.as_table())
      values = range(*range_table, name);
    else
      for (const toml::node* element : list(node, name)) values.push_back(number(*element, name));
    if (!std::is_sorted(values.begin(), values.end(), std::less_equal<>()) || values.front() < 0)
      fail(node, fmt::format("{} must be 0 or more and ascend, each value once", name));
    return values;
  }
  // The name, as it is stored, of a metric or of a quantity of the curve; a pattern of names as it is.
  std::string quantity(const toml::node& node, const std::string& name, ExperimentKey::Kind kind) const {
    const std::string text = stored_name(string(node, name));
    if (kind == ExperimentKey::Kind::metric) at(node.source(), [&] { find_metric(text); });
    if (kind == ExperimentKey::Kind::quantities) at(node.source(), [&] { find_quantity(text); });
    return text;
  }

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

class SettingsReader : protected TomlReader {
 protected:
  using TomlReader::TomlReader;

  // ---- values

  // The text form, as the setting's row reads it, of one TOML value.
  std::string raw_text(const Setting& row, const toml::node& node) const {
    if (node.is_integer()) return fmt::format("{}", node.as_integer()->get());
    if (node.is_floating_point()) return fmt::format("{}", node.as_floating_point()->get());
    if (node.is_boolean()) return node.as_boolean()->get() ? "true" : "false";
    if (node.is_array() && row.is_of_numbers()) {
      std::vector<std::string> parts;
      for (const toml::node& part : *node.as_array())
        parts.push_back(fmt::format("{}", number(part, std::string(row.name))));
      return fmt::format("{}", fmt::join(parts, ","));
    }
    if (node.is_string()) {
      const std::string text = node.as_string()->get();
      const bool quoted_number =
          row.type == ValueType::integer || row.type == ValueType::real || row.type == ValueType::flag;
      if (quoted_number && !(row.may_be_auto && text == "auto"))
        fail(node, fmt::format("{} = \"{}\" is a string; it takes {}, written without quotes", row.name, text,
                               row.range_text()));
      return row.name == "scene.name" ? scene_path(text) : text;
    }
    fail(node, fmt::format("{} cannot be this kind of value; it takes {}{}", row.name, row.range_text(),
                           node.is_array() ? "; [sweep] takes a list of its values" : ""));
  }

  std::string canonical(const Setting& row, const toml::node& node) const {
    return at(node.source(), [&] { return canonical_text(row, raw_text(row, node)); });
  }

  static std::string canonical_text(const Setting& row, const std::string& text) {
    Settings scratch;
    row.set(scratch, text);
    return row.get(scratch);
  }

  // A relative path of a scene file starts at the experiment's folder. Names of built-in scenes do not end as those
  // of models.
  std::string scene_path(const std::string& name) const {
    const std::filesystem::path named(name);
    if (!names_file(name) || named.is_absolute()) return name;
    return (std::filesystem::path(path()).parent_path() / named).lexically_normal().string();
  }

  static std::string range_text(const Setting& row, double value) {
    if (row.type == ValueType::real) return canonical_text(row, fmt::format("{}", value));
    // In a range with doubling steps, pow() misses the integers by a few units in the last place, always below a
    // billionth.
    constexpr double rounding = 1e-9;
    const double nearest = std::round(value);
    if (std::abs(value - nearest) > rounding * std::abs(nearest))
      throw Error(ErrorKind::usage,
                  fmt::format("{} takes integers, and the range gives {}; list the values instead", row.name, value));
    return canonical_text(row, fmt::format("{:.0f}", nearest));
  }

  // ---- settings by table

  static std::vector<std::string_view> groups() {
    std::vector<std::string_view> names;
    for (const Setting& row : settings_table()) {
      const std::string_view group = row.name.substr(0, row.name.find('.'));
      if (std::find(names.begin(), names.end(), group) == names.end()) names.push_back(group);
    }
    return names;
  }
  static bool is_group(const std::string& key) {
    const std::vector<std::string_view> names = groups();
    return std::find(names.begin(), names.end(), key) != names.end();
  }
  // Calls `use` for every setting in a table: for `resolution` if the group is `map`. Without a group, for
  // `map.resolution` written as nested tables, as dotted keys or as one quoted key.
  template <class Use>
  void read_settings(const toml::table& table, const std::string& group, const Use& use) {
    for (const Item& item : items(table)) {
      const std::string name = group.empty() ? item.key : group + "." + item.key;
      if (group.empty() && is_group(item.key)) {
        if (!item.node->is_table())
          fail(*item.node, fmt::format("'{0}' is a group of settings; name one, such as {0}.{1}", item.key,
                                       settings_of(item.key).front().substr(item.key.size() + 1)));
        read_settings(*item.node->as_table(), item.key, use);
        continue;
      }
      if (name == "scene.scene") fail(*item.node, "in [scene] the scene is named by the key 'name'");
      at(item.where, [&] { find_setting(name); });
      use(name, *item.node);
    }
  }
  static std::vector<std::string_view> settings_of(const std::string& group) {
    std::vector<std::string_view> names;
    for (const Setting& row : settings_table())
      if (row.name.starts_with(group + ".")) names.push_back(row.name);
    return names;
  }
};

}  // namespace noonmark
