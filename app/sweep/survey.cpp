#include "app/sweep/survey.h"

#include <fmt/format.h>

#include "base/text.h"
#include "technique/light_frame.h"

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

}  // namespace noonmark
