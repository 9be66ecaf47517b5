#include "compare/results/point_settings.h"

#include <string>

namespace noonmark {

Settings settings_of(const PointRecord& point) {
  Settings settings;
  for (const Setting& row : settings_table())
    if (const auto found = point.settings.find(std::string(row.name)); found != point.settings.end())
      row.set(settings, found->second);
  return settings;
}

}  // namespace noonmark
