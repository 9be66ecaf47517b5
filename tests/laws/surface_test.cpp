// The laws of surfaces: an error of the grid needs a true shadow edge near it, and how a surface is cut into triangles
// and meshes changes nothing.
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
  // These laws speak of the light's plane: scenes of parallel light.
  for (const BuiltinScene& scene : builtin_scenes())
    if (scene.make({}).light.kind == LightKind::directional) names.emplace_back(scene.name);
  for (const std::string& name : models()) names.push_back(name);
  return names;
}

// Law 4. A tap and the texel's centre that it snaps to differ by at most half a texel in each axis, so a tap that the
// grid answers wrongly lies within w / sqrt(2) of an edge of V, in the light's plane. Shown twice: by the tracer's own
// search along the way to the centre; and, unfiltered, from nothing but the picture's positions, the light's axes and
// the float matrix's texel, by a double-precision search of all triangles at both ends: the receiver's verdict there
// must be R1, and the verdict of its plane at the centre must be the other one.
TEST(Law4, EveryAliasedTapHasATrueEdgeNear) {
  Workbench bench(gl::DebugMode::fatal);
  uint64_t all = 0;
  for (const std::string& name : every_scene()) {
    const Measurement m = bench.measure(
        with({{"map.resolution", "200"}, {"map.shift_u_texels", "0.3"}, {"map.format", "32f"}}, small(name)),
        std::nullopt);
    SCOPED_TRACE(name);
    // The shader's float matrix may put a receiver into the texel beside its own where it lies within 2^-22 of the
    // map's size of the border: 200 * 2^-22 texels.
    EXPECT_LE(metric(m, "edge_displacement_texels"), std::numbers::sqrt2 / 2 + 200 * 0x1p-22);
    const test::LightBins bins(m.scene, m.frame);
    const double w = m.frame.texel_m();
    uint64_t checked = 0, other = 0;
    for (size_t i = 0; i < m.ladder.flags.size(); ++i) {
      const bool light = m.ladder[Cause::aliasing_light][i] != 0;
      if (!light && m.ladder[Cause::aliasing_dark][i] == 0) continue;
      if (m.ladder.flags[i] & flag_ambiguous) continue;
      const glm::dvec3 world(m.receivers.position[i]);
      // The texel's centre from first principles: the light's axes, the map's corner, a step of w.
      const glm::dvec3 from = world - m.frame.origin_m;
      const glm::dvec2 p(glm::dot(from, m.frame.right), glm::dot(from, m.frame.up));
      const glm::dvec2 c = (glm::dvec2(m.probe.texel(i, 0)) + 0.5) * w - 100 * w;
      EXPECT_LE(std::abs(c.x - p.x), w * (0.5 + 200 * 0x1p-22));
      EXPECT_LE(std::abs(c.y - p.y), w * (0.5 + 200 * 0x1p-22));
      const uint32_t own = m.receivers.primitive[i];
      ++checked;
      EXPECT_EQ(bins.occluded(world, own), light) << "aliasing that lights is of a dark receiver";
      bool dark = false;
      const double plane = bins.plane(own, c);
      bins.each_at(
          c, [&](uint32_t t, double z) { dark |= t != own && z < plane - bins.rounding(t) - bins.rounding(own); });
      other += dark == light;
    }
    all += checked;
    // Built-in shadows fall on planes. On a model's curved surface its triangle's plane is not the surface at c.
    if (name.ends_with(".gltf")) {
      EXPECT_LE(static_cast<double>(other), 0.2 * static_cast<double>(checked));
    } else {
      EXPECT_EQ(other, 0u);
    }
  }
  EXPECT_GT(all, 1000u);
}

// Law 11. Welded into one mesh, or there twice, the surface has the same triangles in the same order, and every pixel
// the same verdicts and causes. In reverse order a pixel on an edge sees the other triangle, whose plane gives a
// position that differs in its last place; cut in four, the new vertices are rounded to float by 2^-25 of their
// coordinates. Then what lies so near to the border of a shadow or a texel may change: one or two pixels of fifty
// thousand. A texel of the GPU's map whose centre lies on an edge may also change sides, and with it all the pixels
// that look there: that is precision, and up to 9 x as many where a kernel looks. Pixel by pixel; the totals of the other
// scenes: experiments/laws.toml.
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
          // What the truth is not sure of may be said either way.
          if ((built.flags[i] | m.ladder.flags[i]) & flag_ambiguous) continue;
          for (int c = 0; c < cause_count - 1; ++c) same &= built.causes[c].step[i] == m.ladder.causes[c].step[i];
          differ += !same;
          raster += built.causes[cause_count - 1].step[i] != m.ladder.causes[cause_count - 1].step[i];
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
