// What the tests of cascades share: their settings, and the maps of a point measured one by one.
#pragma once
#include <vector>

#include "tests/support/measured.h"

namespace noonmark::acceptance {

inline Settings street(const std::vector<Assignment>& more) {
  return with(more, with({{"cascades.count", "4"},
                          {"map.fit", "sphere"},
                          {"map.resolution", "256"},
                          {"bias.unit", "texel"},
                          {"bias.constant", "1.5"}},
                         small("pillars", 320, 180)));
}

// Measures maps one by one with the program's stages, over the receivers of a given truth.
class MapsApart {
 public:
  explicit MapsApart(const Settings& settings)
      : scene_(stages_.load_scene(renderer, settings)),
        view_(stages_.take_view(renderer, *scene_.scene, settings.view)) {
    renderer.load_receivers(view_.receivers, view_.camera.eye_m);
  }
  const Scene& scene() const { return *scene_.scene; }
  TruthStage truth_of(const Technique& technique) { return stages_.trace_truth(scene_, view_, technique); }
  Ladder climb(const Technique& technique, const TruthStage& truth) {
    LookupStage lookup = stages_.prepare_lookup(renderer, *scene_.tracer, view_, truth, technique);
    MapStage map = stages_.draw_map(renderer, *scene_.scene, technique);
    const ShownStage shown = stages_.show(renderer, map, lookup, truth, technique);
    return stages_.climb_strips(renderer, lookup, view_, truth, shown, technique, nullptr).ladder;
  }

  gl::Renderer renderer{gl::DebugMode::fatal};

 private:
  Pipeline stages_;
  SceneStage scene_;
  ViewStage view_;
};

}  // namespace noonmark::acceptance
