// What `run` and its dry run find out about an experiment before the first point is measured: whether each point can be,
// how much memory it takes, and which settings are given in vain.
//
//   const Survey survey(bench, experiment, points(experiment), wanted);   // throws the error of the first point that cannot be
//   survey.tell();
//   MemoryCheck(bench, experiment, survey.memory).require_room_for(0);
#pragma once
#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/definition/experiment.h"
#include "app/sweep/identity.h"
#include "measure/workbench.h"
#include "scenes/scene.h"

namespace noonmark {

// Settings that an experiment gives in vain, because no point reads them: fixed ones, and swept ones, whose values then all
// measure the same. Which setting a point reads is in the table of settings (Setting::why_idle).
class IdleNotes {
 public:
  // light: the kind of the point's light.
  void add(const Experiment& part, const Settings& point, LightKind light);

  // Sentences without a full stop. First the swept settings: "the sweep of filter.size is dead: no point reads it (with
  // filter.kind = none), so its 3 values measure the same". Then the fixed ones, one sentence for each setting:
  // "map.extent_m has no effect at any point of 2 parts ('a', 'b')".
  std::vector<std::string> dead_sweeps() const;
  std::vector<std::string> fixed() const;

 private:
  struct Idle {
    int points = 0;
    std::string why;    // of the first point
    size_t values = 0;  // of a swept setting
  };
  using Key = std::pair<std::string, std::string>;  // part, setting
  bool everywhere(const Key& key, const Idle& idle) const { return idle.points == points_.at(key.first); }

  std::map<std::string, int> points_;
  std::map<Key, Idle> swept_, fixed_;
};

struct Survey {
  // Predicts the memory of each point and remembers the present contents of every scene. Each scene is loaded once, in the
  // order of the points. Throws the error of the first point that cannot be measured (settings that its light refuses, a
  // map without volume).
  // wanted: the ids of the points to measure; nothing is found out about the others.
  Survey(Workbench& bench, const Experiment& experiment, const std::vector<Settings>& points,
         const std::vector<int64_t>& wanted);

  // Prints the settings that are given in vain to standard error.
  void tell() const;

  SceneDigests scenes;
  IdleNotes idle;
  std::vector<MemoryEstimate> memory;  // of each point; of those that are not wanted: nothing
};

bool writes_pictures(const Experiment& experiment);

// "3 edges map.resolution = 512", for progress lines and messages.
std::string name_of_point(const Experiment& experiment, int64_t id);

// Compares points with the memory that is free. Reading it opens some 20 files of the system, which takes longer than a
// small point, so a value is used for a tenth of a second.
class MemoryCheck {
 public:
  MemoryCheck(const Workbench& bench, const Experiment& experiment, const std::vector<MemoryEstimate>& memory)
      : bench_(bench), experiment_(experiment), memory_(memory) {}
  // Throws Error(usage).
  void require_room_for(size_t id);

 private:
  const Workbench& bench_;
  const Experiment& experiment_;
  const std::vector<MemoryEstimate>& memory_;
  std::optional<AvailableMemory> there_;
  std::chrono::steady_clock::time_point read_;
};

}  // namespace noonmark
