// The verification of an answer: its measurements are checked, because those of the search are not.
#include "app/advise/recommend_verify.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "tests/support/kind_thrown.h"

namespace noonmark {
namespace {

// A lookup that returns 1 - visibility.
struct Reversed : Pipeline {
  MapResults look_up(gl::Renderer& renderer, const gl::ShadowMap& map, std::span<const Technique> techniques) override {
    MapResults results = Pipeline::look_up(renderer, map, techniques);
    for (float& lit : results.own.pixels) lit = 1 - lit;
    return results;
  }
};

Verified verify(std::unique_ptr<Pipeline> stages, const char* light, int rendered) {
  Settings settings;
  settings.scene.name = "cube-room";
  find_setting("light.kind").set(settings, light);
  settings.view.width_px = 64, settings.view.height_px = 36;
  settings.map.resolution = 64;
  settings.bias["constant"] = 1;
  CurveOptions all_hold;
  all_hold.acne_bound = all_hold.peter_panning_bound = 1;
  Workbench bench(gl::DebugMode::fatal, {}, std::move(stages));
  return verify_at_fresh_placements(bench, settings, all_hold, "error", std::nullopt, rendered, [](int, int) {});
}

TEST(RecommendVerify, AContradictionIsAnError) {
  for (const char* light : {"directional", "point"}) {
    EXPECT_FALSE(verify(std::make_unique<Pipeline>(), light, 2).broken) << light;
    expect_refused(ErrorKind::defect, {"contradicts itself ("},
                   [&] { verify(std::make_unique<Reversed>(), light, 2); });
  }
}

}  // namespace
}  // namespace noonmark
