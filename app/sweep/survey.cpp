#include "app/sweep/survey.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text.h"
#include "technique/light_frame.h"
#include "technique/setting_rules.h"

namespace noonmark {

Survey::Survey(Workbench& bench, const Experiment& experiment, const std::vector<Settings>& points,
               const std::vector<int64_t>& wanted)
    : memory(points.size()) {
  for (const int64_t id : wanted) {
    const auto i = static_cast<size_t>(id);
    scenes.remember(bench, points[i]);
    const Experiment& part = part_of_point(experiment, id);
    // Where bounds can break, any point can get pictures.
    const bool by_itself = experiment.pictures != "broken" && (experiment.pictures != "first" || id == 0);
    const bool pictures = writes_pictures(experiment) && (by_itself || !part.bounds.empty());
    memory[i] = at_point(experiment, id, [&] {
      idle.add(part, points[i], effective_light(bench.scene(points[i].scene), points[i]).kind);
      return bench.memory(points[i], part.curve_enabled, pictures);
    });
  }
}

void Survey::tell() const {
  for (const std::string& text : idle.dead_sweeps()) fmt::print(stderr, "warning: {}\n", printable(text));
  for (const std::string& text : idle.fixed()) fmt::print(stderr, "note: {}\n", printable(text));
}

bool writes_pictures(const Experiment& experiment) { return experiment.pictures != "none"; }

std::string name_of_point(const Experiment& experiment, int64_t id) {
  const std::string part = part_of_point(experiment, id).part, swept = swept_text(experiment, id);
  const std::string name = part + (part.empty() || swept.empty() ? "" : " ") + swept;
  return name.empty() ? "the only point" : name;
}

void MemoryCheck::require_room_for(size_t id) {
  const auto now = std::chrono::steady_clock::now();
  if (!there_ || now - read_ > std::chrono::milliseconds(100)) {
    there_ = bench_.memory_of_program(writes_pictures(experiment_));
    read_ = now;
  }
  require_memory(memory_[id], *there_,
                 fmt::format("point {} ({})", id, name_of_point(experiment_, static_cast<int64_t>(id))));
}

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
