// Law 11 on meshes as they occur in practice: tiles whose common edges differ only by rounding, and corners that
// lie on a neighbour's edge. No plane is parallel to an axis, and the scene is at the origin or far from it. All must
// give the results of one quad. For an empty floor see experiments/laws.toml.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/laws/support.h"

namespace noonmark::acceptance {
namespace {

const Assignment places[] = {{"scene.move_m", "0,0,0"}, {"scene.move_m", "-220,180,90"}};  // 300 m
const char* const forms[] = {"tiles", "t_junctions"};

// With occluders, every pixel has the same causes as with the mesh as built. Single pixels at the borders of shadows
// and texels are an exception, because there the last place of a receiver's position decides
// (tests/laws/surface_test.cpp).
TEST(Law11Rounding, OccludersCastTheSameErrorsOnPieces) {
  Workbench bench(gl::DebugMode::fatal);
  for (const char* scene : {"wall", "facade"}) {
    for (const Assignment& place : places) {
      for (int size : {1, 5}) {
        const auto measured = [&](const char* form) {
          return bench.measure(with({{"scene.mesh", form},
                                     {"scene.turn_deg", "17"},
                                     place,
                                     {"map.resolution", "256"},
                                     {"map.format", "32f"},
                                     {"filter.kind", "box"},
                                     {"filter.size", std::to_string(size)},
                                     {"bias.unit", "texel"},
                                     {"bias.constant", "2"}},
                                    small(scene, 200, 120)),
                               std::nullopt);
        };
        const Measurement built = measured("as_built");
        EXPECT_GT(metric(built, "aliasing"), 1e-4) << "there must be something to compare";
        for (const char* form : forms) {
          SCOPED_TRACE(std::string(scene) + " " + form + " at " + place.second + " size " + std::to_string(size));
          const Measurement m = measured(form);
          uint64_t facing = 0, differ = 0, lost = 0;
          for (size_t i = 0; i < built.ladder.flags.size(); ++i) {
            facing += (built.ladder.flags[i] & flag_facing) != 0;
            lost += (m.ladder.flags[i] & flag_ambiguous) != 0;
            if ((built.ladder.flags[i] | m.ladder.flags[i]) & (flag_ambiguous | flag_undecided)) continue;
            bool same = true;
            for (Cause cause :
                 {Cause::filter, Cause::aliasing_dark, Cause::aliasing_light, Cause::acne, Cause::peter_panning})
              same &= built.ladder[cause][i] == m.ladder[cause][i];
            differ += !same;
          }
          // Each tap may lie at a border, so 25 taps meet borders 25 times as often. Where a float step is wider,
          // borders are wider too: a line of `size` taps meets them within four steps (of corners and of P, in both
          // meshes).
          double largest = 0;
          for (const glm::vec3& p : m.scene.positions)
            largest = std::max({largest, std::abs(double{p.x}), std::abs(double{p.y}), std::abs(double{p.z})});
          const double borders =
              2e-5 * size * size + size * 4 * 0x1p-23 * largest / m.technique.frame.texel_m(glm::dvec3(0));
          EXPECT_LE(static_cast<double>(differ), 4 + borders * static_cast<double>(facing));
          EXPECT_LE(static_cast<double>(lost), 1e-3 * static_cast<double>(facing));
          EXPECT_LE(metric(m, "undecided_taps"), 1e-3);
        }
      }
    }
  }
}

}  // namespace
}  // namespace noonmark::acceptance
