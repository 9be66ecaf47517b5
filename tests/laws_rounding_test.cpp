// Law 11 on meshes as they come: tiles that meet to rounding only, and corners on a neighbour's edge, on planes that no
// axis carries, at the origin and far from it. All must give what one quad gives.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/laws_support.h"

namespace noonmark::acceptance {
namespace {

const Assignment places[] = {{"scene.move_m", "0,0,0"},
                             {"scene.move_m", "22,-18,9"},          // 30 m
                             {"scene.move_m", "-220,180,90"},       // 300 m
                             {"scene.move_m", "7300,-6000,3200"}};  // 10 km
const char* const forms[] = {"tiles", "t_junctions"};

// An empty floor is lit everywhere. The only possible error is acne, and the bias of law 1 removes it. So there is no
// error at all, for one quad as for many pieces.
TEST(Law11Rounding, AnEmptyFloorInPiecesIsStillEmpty) {
  Workbench bench(gl::DebugMode::fatal);
  for (const char* form : forms) {
    for (const char* turn : {"0", "17"}) {
      for (const Assignment& place : places) {
        for (int size : {1, 3}) {  // 9 x 9: experiments/laws.toml
          SCOPED_TRACE(std::string(form) + " turned " + turn + " at " + place.second + " size " + std::to_string(size));
          const Measurement m = bench.measure(with({{"scene.theta_deg", "40"},
                                                    {"scene.phi_deg", "25"},
                                                    {"scene.mesh", form},
                                                    {"scene.turn_deg", turn},
                                                    place,
                                                    {"map.resolution", "128"},
                                                    {"map.format", "32f"},
                                                    {"filter.kind", "box"},
                                                    {"filter.size", std::to_string(size)},
                                                    {"bias.unit", "texel"},
                                                    {"bias.constant", text(1.2 * size)}},
                                                   small("plane", 160, 96)),
                                              exact_window());
          EXPECT_EQ(metric(m, "counted"), metric(m, "facing") - metric(m, "ambiguous_receivers"));
          EXPECT_GT(metric(m, "counted"), 8000);
          for (const char* name : {"filter", "aliasing", "peter_panning", "coverage"})
            EXPECT_EQ(metric(m, name), 0) << name;
          // P rounds beside its tile at 10 km, by half a millimetre where tiles are 0.5 m wide.
          EXPECT_LE(metric(m, "ambiguous"), 1e-3);
          EXPECT_LE(metric(m, "undecided_taps"), 1e-3);
          EXPECT_LE(metric(m, "undecided"), 1e-3);
          // k A tan(40 deg) <= 1.1 k texels; acne is what float rounding of P and the map leaves of it.
          EXPECT_LE(metric(m, "acne"), 0);
          ASSERT_TRUE(m.record.curve);
          EXPECT_TRUE(m.record.curve->window_min_depth) << "there is a usable bias, as on one quad";
          EXPECT_EQ(m.record.curve->window_max_depth.value_or(0), 1) << "nothing limits it from above";
        }
      }
    }
  }
}

// With occluders: the same causes at the same pixels as the mesh as built, but for single pixels at the borders of
// shadows and texels, where a receiver's last place decides (tests/laws_surface_test.cpp).
TEST(Law11Rounding, OccludersCastTheSameErrorsOnPieces) {
  Workbench bench(gl::DebugMode::fatal);
  for (const char* scene : {"wall", "facade"}) {
    for (const Assignment& place : {places[0], places[2]}) {
      for (int size : {1, 9}) {
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
          // A tap decides at a border: 81 taps meet 81 times as many. And where a float step is wider, so are borders:
          // a line of `size` taps meets them within four steps (of corners and of P, in both meshes) more often.
          double largest = 0;
          for (const glm::vec3& p : m.scene.positions)
            largest = std::max({largest, std::abs(double{p.x}), std::abs(double{p.y}), std::abs(double{p.z})});
          const double borders = 2e-5 * size * size + size * 4 * 0x1p-23 * largest / m.frame.texel_m();
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
