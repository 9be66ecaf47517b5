// The technique of one point: what its settings mean under its scene's light, resolved once. The stages of a measurement,
// OpenGL and the truth all take their parts from here.
//
//   const Technique technique(scene, settings);          // throws Error(usage) as make_light_frame()
//   gl::ShadowMap map = renderer.render_map(technique);
//   Image<float> r5 = renderer.lookup(map, technique);
//   const Technique moved = technique.at(placements.frame(technique.frame, 9));
#pragma once
#include "technique/bias.h"
#include "technique/casters.h"
#include "technique/filters.h"
#include "technique/light_frame.h"
#include "technique/moment_lookup.h"
#include "technique/settings.h"
#include "technique/tap_pattern.h"

namespace noonmark {

struct CascadeBlend;
struct CascadeSelection;

// A cascade's place among the others: what the lookup chooses by, as floats, because the shader has them so.
struct CascadePlace {
  int index = 0;                                // 0 is the nearest
  std::vector<ViewSlice> slices;                // of all cascades
  const CascadeSelection* selection = nullptr;  // never null in a technique
  float blend = 0;  // the part of a cascade, before its end, in which the next one is blended in; 0: none
  const CascadeBlend* shape = nullptr;  // of the weight in the band; never null in a technique
  float seam = 1;  // from this place in a cascade on, the next one is looked up too, for comparison
  glm::vec3 view_forward{0, 0, -1};
  glm::mat3 light_axes{1};  // right, up and forward
  // Of all cascades but the last. The selection reads some of them (technique/cascade_place.glsl).
  std::vector<glm::vec2> depths;           // where the place by depth is 0 and 1
  std::vector<glm::vec3> middles, halves;  // of the map's volume; or of the sphere, whose radius is x

  int last() const { return static_cast<int>(slices.size()) - 1; }
};

struct Technique {
  Technique(const Scene& scene, const Settings& settings);
  // With a frame that is known already. Throws SettingConflict.
  Technique(const Settings& settings, const LightFrame& frame);

  // The same settings with the map at another place. other: of this technique's kind of light.
  Technique at(const LightFrame& other) const;

  bool moves_casters() const { return noonmark::moves_casters(settings.map, bias); }

  Settings settings;
  LightFrame frame;
  Bias bias;             // with its reference of a tap
  const Filter* filter;  // the row of settings.filter.kind; never null
  TapPattern taps;
  std::optional<MomentLookup> moments;  // of a lookup in a map of moments
  std::optional<CascadePlace> cascade;  // empty: the map is for all receivers
};

}  // namespace noonmark
