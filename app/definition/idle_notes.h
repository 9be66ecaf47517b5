// Settings that an experiment gives in vain, because no point reads them: fixed ones, and swept ones, whose values then all
// measure the same. Which setting a point reads is in the table of settings (Setting::why_idle).
//
//   IdleNotes notes;
//   for (const Settings& point : points(experiment)) notes.add(experiment, point, LightKind::spot);
//   for (const std::string& text : notes.fixed()) print(text);
#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "app/definition/experiment.h"
#include "scenes/scene.h"

namespace noonmark {

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

}  // namespace noonmark
