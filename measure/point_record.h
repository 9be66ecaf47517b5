// The numbers of a point that come from its ladder, its receivers and its maps: all that are not an extra (measure/extra.h).
#pragma once
#include <map>
#include <span>
#include <string>
#include <vector>

#include "compare/ladder/measure.h"
#include "compare/ladder/seams.h"
#include "measure/bench.h"

namespace noonmark {

// What a record is made of.
struct Recorded {
  const Technique& technique;
  const Ladder& ladder;
  const SceneStage& loaded;
  const ViewStage& view;
  const TruthStage& truth;  // of these receivers
  std::vector<LookedUpMap> maps;
  const MapChoice& choice;
  MetricSet metrics = MetricSet::all;
};
LookedUpMap looked_up(const ClimbedMap& map);

// Of the ladder, the view and the cost; of any number of maps.
PointRecord record_of(const Recorded& in);

// Adds the numbers of each map, joined: laws, soundness, and of several maps their seams and what each has by itself. ladder: the
// joined one, whose receivers of other maps are hidden for a time. seams: of each map to the next.
void add_maps(PointRecord& record, std::span<const ClimbedMap> maps, Ladder& ladder, std::span<const Seam> seams,
              const ChoiceStage& choice, const SceneStage& loaded, const ViewStage& view, Checks checks);

// Adds what the maps have seen and taken.
void add_texels(PointRecord& record, std::span<const ClimbedMap> maps, const MapStage& drawn, const TruthStage& truth,
                MetricSet metrics);

void add_time(PointRecord& record, const std::string& stage, const StageTime& time);

}  // namespace noonmark
