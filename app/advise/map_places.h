// Where the map of a directional light can lie over a scene: the places that a recommendation compares. They are numbers that
// stay as they are while the camera moves, so that they can be typed into an engine that does not fit its map.
//
//   for (const MapPlace& place : map_places(bench.scene(conditions[0].scene), conditions, views)) place.apply(settings);
#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "app/advise/engines/engine_settings.h"
#include "measure/workbench.h"
#include "scenes/scene.h"
#include "technique/light_frame.h"
#include "technique/settings.h"

namespace noonmark {

struct MapPlace {
  std::string covers;       // what the map covers, for a sentence: "the whole scene". Empty: as the settings give it
  double extent_m = 0;      // of a directional light's one map with these settings; else 0
  bool moves_with = false;  // it covers what some views show, so another camera needs another place
  std::string laid_by;      // the engine that lays its maps so (EngineAdvice::engine); empty: none
  bool of_casters = false;  // it leaves out a ground on which there is light alone (map.fit = casters)
  std::function<void(Settings&)> apply;
};

// Settings that lay a directional light's map where this frame lies, whatever the camera shows.
void lay_as(const LightFrame& frame, Settings& settings);

// The place that the settings give. in_texels: the bias is in texels, which is right in all of several maps (law 31), in place of
// metres.
MapPlace place_as_given(bool in_texels = false);

// The first is the settings' own, or, if that is narrower, the map around the whole scene whose middle is the middle of the scene;
// or the one around all that casts shadows (map.fit = casters), if it is narrower by places_differ and map.wrap lights what lies
// outside. If the casters that `views` need are covered by one that is narrower again, that comes second. The settings' own is the
// only one where the light is not directional, and where its direction or the scene is not the same in all conditions.
// conditions, views: at least one each; of `views` only the view is read. Throws Error as make_light_frame() does.
inline constexpr double places_differ = 1.12;  // its square, 1.25, is what a map of equal texels saves
std::vector<MapPlace> map_places(const Scene& scene, std::span<const Settings> conditions,
                                 std::span<const Settings> views);

// Of what these conditions show. Throws Error.
SeenDepths depths_in_views(Workbench& bench, std::span<const Settings> conditions);

}  // namespace noonmark
