#include "compare/judge/conditions.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "technique/settings.h"

namespace noonmark {

bool matches(const PointRecord& point, const Conditions& conditions) {
  return std::all_of(conditions.begin(), conditions.end(), [&](const auto& condition) {
    const auto setting = point.settings.find(condition.first);
    return setting != point.settings.end() &&
           std::find(condition.second.begin(), condition.second.end(), setting->second) != condition.second.end();
  });
}

void check_conditions(const Conditions& conditions, const std::string& where) {
  for (const auto& [name, texts] : conditions) {
    const Setting& row = find_setting(name);
    if (texts.empty()) throw Error(ErrorKind::usage, fmt::format("{} {} lists no value", where, name));
    Settings scratch;
    for (const std::string& text : texts) {
      row.set(scratch, text);
      if (row.get(scratch) != text)
        throw Error(ErrorKind::usage,
                    fmt::format("{} {} = '{}' must be written '{}'", where, name, text, row.get(scratch)));
    }
  }
}

}  // namespace noonmark
