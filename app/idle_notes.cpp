#include "app/idle_notes.h"

#include <fmt/format.h>

#include "technique/setting_rules.h"

namespace noonmark {
namespace {

std::string of_part(const std::string& part) { return part.empty() ? "" : fmt::format(" of part '{}'", part); }

}  // namespace

void IdleNotes::add(const Experiment& part, const Settings& point, LightKind light) {
  ++points_[part.part];
  // The default value of a sweep is as dead as its other values.
  for (const Swept& swept : part.swept) {
    const Setting& row = find_setting(swept.name);
    const std::string why = row.why_idle ? row.why_idle(point, light) : "";
    if (why.empty()) continue;
    Idle& idle = swept_[{part.part, swept.name}];
    if (idle.points++ == 0) idle.why = why;
    idle.values = swept.values.size();
  }
  for (const IdleSetting& setting : idle_settings(light, point)) {
    Idle& idle = fixed_[{part.part, setting.name}];
    if (idle.points++ == 0) idle.why = setting.why;
  }
}

std::vector<std::string> IdleNotes::dead_sweeps() const {
  std::vector<std::string> texts;
  for (const auto& [key, idle] : swept_)
    if (everywhere(key, idle) && idle.values > 1)
      texts.push_back(
          fmt::format("the sweep of {} is dead: no point{} reads it ({}), so its {} values measure the same",
                      key.second, of_part(key.first), idle.why, idle.values));
  return texts;
}

std::vector<std::string> IdleNotes::fixed() const {
  std::vector<std::string> texts;
  for (const auto& [key, idle] : fixed_)
    if (everywhere(key, idle) && !(swept_.contains(key) && everywhere(key, swept_.at(key))))
      texts.push_back(fmt::format("{} has no effect at any point{}", key.second, of_part(key.first)));
  return texts;
}

}  // namespace noonmark
