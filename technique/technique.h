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
#include "technique/settings.h"
#include "technique/tap_pattern.h"

namespace noonmark {

// A cascade's place among the others: what the lookup chooses by.
struct CascadePlace {
  int index = 0;                  // 0 is the nearest
  std::vector<ViewSlice> slices;  // of all cascades
  std::vector<float> bounds_m;    // the ends of all slices but the last, as the shader compares them
  glm::vec3 forward{0};           // the view's direction, as the shader has it
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
  std::optional<CascadePlace> cascade;  // empty: the map is for all receivers
};

}  // namespace noonmark
