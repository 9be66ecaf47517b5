#include "compare/results/point_settings.h"

#include <algorithm>
#include <string>

#include "compare/results/quantities.h"
#include "technique/lookups.h"

namespace noonmark {

Settings settings_of(const PointRecord& point) {
  Settings settings;
  for (const Setting& row : settings_table())
    if (const auto found = point.settings.find(std::string(row.name)); found != point.settings.end())
      row.set(settings, found->second);
  return settings;
}

const LookupKind* filtered_lookup_of(const PointRecord& point) {
  const std::string name = setting_of(point, "lookup.kind");
  const auto kind =
      std::find_if(lookups().begin(), lookups().end(), [&](const LookupKind& one) { return one.name == name; });
  return kind == lookups().end() || kind->compares() ? nullptr : &*kind;
}

}  // namespace noonmark
