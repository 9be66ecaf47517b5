// The description of one planted defect, and the test that each defect must pass: without the defect the run is sound,
// and with it the named metrics change by at least the given amount.
#pragma once
#include <gtest/gtest.h>

#include <iostream>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "gl/renderer.h"
#include "tests/acceptance/planted_support.h"
#include "tests/support/measured.h"

namespace noonmark::planted {

using acceptance::small;
using acceptance::with;

inline const char* const receiver = "shaders/receiver.glsl";
inline const char* const projected = "shaders/light/projected.glsl";

// The metric is at most `before` without the defect and at least `after` with it. For `falls` it is the other way
// round: at least `before`, and at most `after`.
struct Moves {
  const char* metric;
  double before, after;
  bool falls = false;
};

struct Planted {
  const char* name;
  Settings settings;
  Defect defect;
  std::vector<Moves> moves;
  std::vector<const char*> still{};  // metrics that must not change, which shows why another metric is needed
};

// One floor and three cubes. At a resolution of 512 a texel is 39 mm, and law 1 requires at most 2.3e-3 of depth for
// the floor.
inline Settings cubes(std::initializer_list<acceptance::Assignment> more = {}) {
  return with(more, with({{"map.resolution", "512"}, {"bias.constant", "0.0025"}}, small("cube-room", 320, 180)));
}
inline Settings cubes_3x3(std::initializer_list<acceptance::Assignment> more = {}) {
  return with(more, cubes({{"filter.kind", "box"}, {"bias.constant", "0.008"}}));
}

inline void PrintTo(const Planted& planted, std::ostream* out) { *out << planted.name; }

inline std::string name_of(const testing::TestParamInfo<Planted>& defect) { return defect.param.name; }

// What a GPU adds to a sound map's own error: it interpolates depths between vertices that moved to whole 1/256 of a
// texel, where Mesa's software renderers interpolate between the vertices as they were. 23 steps in place of 1 were seen
// on an H100.
inline double rasteriser_scale(std::string_view metric) {
  static const bool software = gl::Renderer(gl::DebugMode::off).info().software;
  return !software && (metric == "map_error_quanta" || metric == "precision") ? 32 : 1;
}

inline void expect_moves(const Planted& p) {
  const Figures &sound = sound_figures(p.settings), broken = measure(p.settings, p.defect);
  EXPECT_GT(sound.at("counted"), 5000);
  EXPECT_EQ(sound.at("contract"), 0);
  EXPECT_LE(sound.at("rounding_excess"), 1);
  for (const Moves& moves : p.moves) {
    const double before = sound.at(moves.metric), after = broken.at(moves.metric);
    std::cout << p.name << ": " << moves.metric << " " << before << " -> " << after << "\n";
    if (moves.falls) {
      EXPECT_GE(before, moves.before) << moves.metric;
      EXPECT_LE(after, moves.after) << moves.metric;
    } else {
      EXPECT_LE(before, rasteriser_scale(moves.metric) * moves.before) << moves.metric;
      EXPECT_GE(after, moves.after) << moves.metric;
      EXPECT_GT(after, before) << moves.metric;
    }
  }
  for (const char* metric : p.still) {
    // The tolerance is for the rounding of shares that stay 0 and of residuals.
    EXPECT_NEAR(broken.at(metric), sound.at(metric), 1e-6) << metric << " must not change with this defect";
  }
}

}  // namespace noonmark::planted
