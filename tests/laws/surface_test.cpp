// The laws of surfaces. Aliasing needs a true shadow edge near it. How a surface is cut into triangles and meshes
// changes nothing.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/builtin.h"
#include "tests/laws/support.h"
#include "tests/raytrace/fixture.h"

namespace noonmark::acceptance {
namespace {

std::vector<std::string> models() {
  std::vector<std::string> names;
  for (const char* name : {"FlightHelmet", "Lantern"})
    if (std::filesystem::exists(model(name))) names.push_back(model(name));
  return names;
}

std::vector<std::string> every_scene() {
  std::vector<std::string> names;
  // These laws are about the light's plane, so they need a directional light.
  for (const BuiltinScene& scene : builtin_scenes())
    if (scene.make({}).light.kind == LightKind::directional) names.emplace_back(scene.name);
  for (const std::string& name : models()) names.push_back(name);
  return names;
}

// Law 4. A tap and the centre of the texel that it snaps to differ by at most half a texel on each axis. So a tap with
// aliasing lies within w / sqrt(2) of an edge of V, in the light's plane. The test shows this in two ways. First, the
// tracer itself searches along the way to the centre. Second, for the unfiltered lookup, a search of all triangles in
// double uses only the picture's positions, the light's axes and the float matrix's texel. At the receiver it must find
// the verdict of R1, and for the receiver's plane at the centre it must find the opposite verdict.
TEST(Law4, EveryAliasedTapHasATrueEdgeNear) {
  Workbench bench(gl::DebugMode::fatal);
  uint64_t all = 0, all_on_plane = 0;
  for (const std::string& name : every_scene()) {
    const Measurement m = bench.measure(
        with({{"map.resolution", "200"}, {"map.shift_u_texels", "0.3"}, {"map.format", "32f"}}, small(name)),
        std::nullopt);
    SCOPED_TRACE(name);
    // The shader's float matrix may put a receiver into the neighbouring texel if it lies within 2^-22 of the map's
    // size of the border, which is 200 * 2^-22 texels.
    EXPECT_LE(metric(m, "edge_displacement_texels"), std::numbers::sqrt2 / 2 + 200 * 0x1p-22);
    const test::LightBins bins(m.scene, m.technique.frame);
    const double w = m.technique.frame.texel_m(glm::dvec3(0));
    uint64_t checked = 0, other = 0, other_on_plane = 0;
    for (size_t i = 0; i < m.ladder.flags.size(); ++i) {
      const bool light = m.ladder[Cause::aliasing_light][i] != 0;
      if (!light && m.ladder[Cause::aliasing_dark][i] == 0) continue;
      if (m.ladder.flags[i] & flag_ambiguous) continue;
      const glm::dvec3 world(m.receivers.position[i]);
      // The texel's centre from first principles: the light's axes, the map's corner, a step of w.
      const glm::dvec3 from = world - m.technique.frame.origin_m;
      const glm::dvec2 p(glm::dot(from, m.technique.frame.right), glm::dot(from, m.technique.frame.up));
      const glm::dvec2 c = (glm::dvec2(m.map().probe.texel(i, 0)) + 0.5) * w - 100 * w;
      EXPECT_LE(std::abs(c.x - p.x), w * (0.5 + 200 * 0x1p-22));
      EXPECT_LE(std::abs(c.y - p.y), w * (0.5 + 200 * 0x1p-22));
      const uint32_t own = m.receivers.primitive[i];
      ++checked;
      EXPECT_EQ(bins.occluded(world, own), light) << "aliasing that lights a receiver needs a dark receiver";
      bool dark = false, on_plane = false;
      const double plane = bins.plane(own, c);
      bins.each_at(c, [&](uint32_t t, double z) {
        const double rounding = bins.rounding(t) + bins.rounding(own);
        dark |= t != own && z < plane - rounding;
        on_plane |= std::abs(z - plane) <= rounding;
      });
      other += dark == light;
      other_on_plane += on_plane && dark == light;
      all_on_plane += on_plane;
    }
    all += checked;
    // Where the surface ends or bends between the receiver and c, the plane of the receiver's triangle is not the surface
    // at c. A model also has layers that nearly touch.
    EXPECT_LE(static_cast<double>(other), 0.2 * static_cast<double>(checked));
    if (!name.ends_with(".gltf")) {
      EXPECT_EQ(other_on_plane, 0u);
    }
  }
  EXPECT_GT(all, 1000u);
  EXPECT_GT(all_on_plane, all / 2);
}

// Law 11. If the meshes are welded into one, or if the surface is present twice, the surface has the same triangles in
// the same order, and every pixel has the same verdicts and causes. In reverse order a pixel on an edge sees the other
// triangle, whose plane gives a position that differs in its last place. If each triangle is cut in four, the new
// vertices are rounded to float, by 2^-25 of their coordinates. Then a pixel that lies very near the border of a shadow
// or of a texel may change: one or two pixels of fifty thousand. A texel of the GPU's map whose centre lies on an edge
// may also change sides, and all pixels that look there change with it. This is precision, and with a kernel it is up
// to 9 times as many pixels. This test compares pixel by pixel. experiments/laws.toml compares the totals of the other
// scenes.
TEST(Law11, CausesDoNotDependOnHowASurfaceIsCut) {
  Workbench bench(gl::DebugMode::fatal);
  std::vector<std::string> scenes = models();
  scenes.insert(scenes.end(), {"pillars", "fence"});
  for (const std::string& name : scenes) {
    {
      const char* filter = "box";  // its middle tap is the unfiltered one
      Ladder built;
      double built_ambiguous = 0;
      for (const char* mesh : {"as_built", "one_mesh", "reversed", "doubled", "split"}) {
        const Measurement m = bench.measure(with({{"scene.mesh", mesh},
                                                  {"filter.kind", filter},
                                                  {"map.resolution", "256"},
                                                  {"map.format", "32f"},
                                                  {"bias.constant", "0.002"}},
                                                 small(name, 320, 200)),
                                            std::nullopt);
        if (std::string(mesh) == "as_built") {
          built = m.ladder;
          built_ambiguous = metric(m, "ambiguous_receivers");
          continue;
        }
        uint64_t differ = 0, raster = 0, facing = 0;
        for (size_t i = 0; i < built.flags.size(); ++i) {
          facing += (built.flags[i] & flag_facing) != 0;
          bool same = true;
          // At an ambiguous receiver either verdict may be found.
          if ((built.flags[i] | m.ladder.flags[i]) & flag_ambiguous) continue;
          for (int c = 0; c < compared_cause_count - 1; ++c)
            same &= built.causes[c].step[i] == m.ladder.causes[c].step[i];
          differ += !same;
          raster += built.causes[compared_cause_count - 1].step[i] != m.ladder.causes[compared_cause_count - 1].step[i];
        }
        SCOPED_TRACE(testing::Message() << name << " " << filter << " " << mesh);
        const double limit = 1e-4 * static_cast<double>(facing);
        if (std::string(mesh) == "one_mesh" || std::string(mesh) == "doubled") {
          EXPECT_EQ(differ, 0u);
          EXPECT_EQ(raster, 0u);
        } else {
          EXPECT_LE(static_cast<double>(differ), 2 + limit);
          EXPECT_LE(static_cast<double>(raster), 9 * (2 + 5 * limit));
        }
        EXPECT_NEAR(metric(m, "ambiguous_receivers"), built_ambiguous, 1e-3 * static_cast<double>(facing));
      }
    }
  }
}

}  // namespace
}  // namespace noonmark::acceptance
