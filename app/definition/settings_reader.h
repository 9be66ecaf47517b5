// Reads the settings of an experiment file. Only experiment_file.cpp includes it, because toml++ is a large header.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "app/definition/toml_reader.h"
#include "scenes/library.h"

namespace noonmark {

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
