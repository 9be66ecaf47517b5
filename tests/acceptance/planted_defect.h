// One planted defect, as the tests list them, and the test that each must pass: a sound run is sound, and the metrics
// named move as far as they must.
#pragma once
#include <gtest/gtest.h>

#include <iostream>
#include <ostream>
#include <string>
#include <vector>

#include "tests/acceptance/planted_support.h"
#include "tests/support/measured.h"

namespace noonmark::planted {

using acceptance::small;
using acceptance::with;

inline const char* const receiver = "shaders/receiver.glsl";
inline const char* const projected = "shaders/light/projected.glsl";

// A metric of the undamaged run at most (for `falls`: at least) `before`, of the damaged one at least (at most)
// `after`.
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
  std::vector<const char*> still{};  // metrics that must not see it, to show why another has to
};

// One floor, three cubes. At 512 texels a texel is 39 mm, and law 1 asks 2.3e-3 of depth at most for the floor.
inline Settings cubes(std::initializer_list<acceptance::Assignment> more = {}) {
  return with(more, with({{"map.resolution", "512"}, {"bias.constant", "0.0025"}}, small("cube-room", 320, 180)));
}
inline Settings cubes_3x3(std::initializer_list<acceptance::Assignment> more = {}) {
  return with(more, cubes({{"filter.kind", "box"}, {"bias.constant", "0.008"}}));
}

inline void PrintTo(const Planted& planted, std::ostream* out) { *out << planted.name; }

inline std::string name_of(const testing::TestParamInfo<Planted>& defect) { return defect.param.name; }

inline void expect_moves(const Planted& p) {
  const Figures sound = measure(p.settings), broken = measure(p.settings, p.defect);
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
      EXPECT_LE(before, moves.before) << moves.metric;
      EXPECT_GE(after, moves.after) << moves.metric;
    }
  }
  for (const char* metric : p.still) {
    // Rounding of shares that stay 0, and of residuals, at most.
    EXPECT_NEAR(broken.at(metric), sound.at(metric), 1e-6) << metric << " should not see this";
  }
}

}  // namespace noonmark::planted
