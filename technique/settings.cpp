#include "technique/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/suggestion.h"
#include "technique/setting_rows.h"

namespace noonmark {
namespace {

using namespace setting_rows;

// The stages that read the settings of this group, except for rows with stages of their own.
Stages stages_of_group(std::string_view group) {
  if (group == "scene") return {Stage::scene};
  if (group == "view") return {Stage::view};
  if (group == "motion") return {Stage::view, Stage::truth, Stage::map, Stage::lookup};
  if (group == "light") return {Stage::truth, Stage::map, Stage::lookup};
  if (group == "map" || group == "cascades") return {Stage::map, Stage::lookup};
  if (group == "bias" || group == "filter" || group == "lookup") return {Stage::lookup};
  if (group == "truth") return {Stage::truth};
  if (group == "given") return {Stage::scene};  // another frame is another scene (app/sweep/frame_run.cpp)
  throw std::logic_error("no stage reads the group of settings '" + std::string(group) + "'");
}

std::vector<Setting> make_table() {
  std::vector<Setting> table;
  for (const auto& rows :
       {view_rows(), motion_rows(), light_rows(), map_rows(), cascade_rows(), bias_rows(), lookup_rows(), truth_rows()})
    table.insert(table.end(), rows.begin(), rows.end());
  for (Setting& row : table)
    if (row.read_by.bits == 0) row.read_by = stages_of_group(row.name.substr(0, row.name.find('.')));
  return table;
}

}  // namespace

std::vector<double> BiasSettings::no_bias() {
  std::vector<double> values;
  for (const BiasParameter& parameter : bias_parameters())
    values.push_back(parameter.role == BiasParameter::Role::cap ? std::numeric_limits<double>::infinity() : 0);
  return values;
}

Setting Setting::idle(std::function<std::string(const Settings&, LightKind)> why) const {
  Setting row = *this;
  row.why_idle = std::move(why);
  return row;
}
Setting Setting::refused(std::function<std::string(const Settings&, std::optional<LightKind>)> why) const {
  Setting row = *this;
  row.why_refused = std::move(why);
  return row;
}
Setting Setting::only_read_by(Stages stages) const {
  Setting row = *this;
  row.read_by = stages;
  return row;
}

std::string Setting::range_text() const { return may_be_auto ? bare_range() + " or auto" : bare_range(); }

std::string Setting::range_with_unit() const {
  std::string range = bare_range();
  if (!unit.empty()) range += fmt::format(" {}", unit);
  return may_be_auto ? range + ", or auto" : range;
}

std::string Setting::bare_range() const {
  switch (type) {
    case ValueType::integer:
    case ValueType::real:
      return fmt::format("{:g} ... {:g}", min, max);
    case ValueType::flag:
      return "true | false";
    case ValueType::choice:
      return fmt::format("{}", fmt::join(choices, " | "));
    case ValueType::text:
      return "a name or a path";
    case ValueType::point:
      return fmt::format("x,y,z, each {:g} ... {:g}", min, max);
    case ValueType::list:
      return fmt::format("ascending numbers, {:g} ... {:g}", min, max);
    case ValueType::whole_list:
      return fmt::format("whole numbers, {:g} ... {:g}", min, max);
    case ValueType::real_list:
      return fmt::format("numbers, {:g} ... {:g}", min, max);
  }
  throw std::logic_error("unknown value type");
}

std::span<const Setting> settings_table() {
  static const std::vector<Setting> table = make_table();
  return table;
}

const Setting& find_setting(std::string_view name) {
  std::vector<std::string_view> names;
  for (const Setting& row : settings_table()) {
    if (row.name == name) return row;
    names.push_back(row.name);
  }
  throw Error(ErrorKind::usage, fmt::format("there is no setting '{}'{} (noonmark settings lists them)", name,
                                            did_you_mean(name, names)));
}

std::map<std::string, std::string> settings_map(const Settings& settings) {
  std::map<std::string, std::string> map;
  for (const Setting& row : settings_table()) map[std::string(row.name)] = row.get(settings);
  return map;
}

}  // namespace noonmark
