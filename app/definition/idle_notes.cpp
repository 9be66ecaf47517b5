#include "app/definition/idle_notes.h"

#include <fmt/format.h>

#include <algorithm>

#include "technique/setting_rules.h"

namespace noonmark {
namespace {

std::string of_part(const std::string& part) { return part.empty() ? "" : fmt::format(" of part '{}'", part); }

// " of 5 parts ('a', 'b', 'c' and 2 others)"
std::string of_parts(const std::vector<std::string>& parts) {
  if (parts.size() == 1) return of_part(parts.front());
  constexpr size_t most_named = 3;
  std::string named;
  for (size_t i = 0; i < std::min(parts.size(), most_named); ++i)
    named += fmt::format("{}'{}'", i ? ", " : "", parts[i]);
  if (const size_t more = parts.size() - std::min(parts.size(), most_named))
    named += fmt::format(" and {} other{}", more, more == 1 ? "" : "s");
  return fmt::format(" of {} parts ({})", parts.size(), named);
}

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
  std::map<std::string, std::vector<std::string>> parts;  // by setting: one note for all parts
  for (const auto& [key, idle] : fixed_)
    if (everywhere(key, idle) && !(swept_.contains(key) && everywhere(key, swept_.at(key))))
      parts[key.second].push_back(key.first);
  std::vector<std::string> texts;
  for (const auto& [setting, in] : parts) texts.push_back(setting + " has no effect at any point" + of_parts(in));
  return texts;
}

}  // namespace noonmark
