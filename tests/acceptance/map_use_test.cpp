// How much of a map is used and seen, how large its texels are in the picture, and what a rotation of the map does.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "measure/texel_footprint.h"
#include "scenes/camera_fit.h"
#include "tests/support/measured.h"

namespace noonmark::acceptance {
namespace {

Workbench& bench() {
  static Workbench made(gl::DebugMode::fatal);
  return made;
}

Measurement measured(const Settings& settings) { return bench().measure(settings, std::nullopt); }

// What OpenGL counts is what is read back.
TEST(MapUse, CountsTheTexelsThatHoldADepthBelowOne) {
  for (const char* scene : {"cube-room", "spot-room", "point-room", "fence"})
    for (const char* format : {"16", "24", "32f"})
      for (const char* resolution : {"61", "128"}) {
        const Measurement m =
            measured(with({{"map.format", format}, {"map.resolution", resolution}}, small(scene, 64, 36)));
        const glm::ivec2 size = m.technique.frame.map_size();
        const Image<float> rows = m.map().stored_rows(0, size.y);
        const auto used = std::count_if(rows.pixels.begin(), rows.pixels.end(), [](float depth) { return depth < 1; });
        EXPECT_EQ(metric(m, "map_used"), static_cast<double>(used) / static_cast<double>(rows.size()))
            << scene << format;
        EXPECT_GT(used, 0);
        EXPECT_EQ(metric(m, "map_seen"),
                  static_cast<double>(m.map().exact.texels->count()) / static_cast<double>(rows.size()));
      }
}

// A plane of 6 x 6 m, tilted against a light straight above, covers 36 cos(theta) of the map's 100 square metres; a wall of a
// closed room covers all.
TEST(MapUse, IsTheAreaOfWhatIsDrawn) {
  for (const char* theta : {"0", "30", "60"}) {
    const Measurement m =
        measured(with({{"scene.theta_deg", theta}, {"map.resolution", "512"}}, small("plane", 64, 36)));
    const double cosine = std::cos(std::stod(theta) * std::numbers::pi / 180);
    const double border = (6 + 6 * cosine) * 2 * 10 / 512.0 / 100;  // a texel along its outline
    EXPECT_NEAR(metric(m, "map_used"), 0.36 * cosine, border) << theta;
    EXPECT_LE(metric(m, "map_seen"), metric(m, "map_used") + border) << theta;
  }
  EXPECT_EQ(metric(measured(small("point-room", 64, 36)), "map_used"), 1);
}

// The plane's camera stands 7 m off, square to it. A texel is w across the light, and on the plane longer by 1 / cos(theta).
TEST(MapUse, TexelsAreComparedWithPixels) {
  for (const double theta : {0.0, 40.0, 70.0})
    for (const int resolution : {256, 4096}) {
      const Measurement m =
          measured(with({{"scene.theta_deg", std::to_string(theta)}, {"map.resolution", std::to_string(resolution)}},
                        small("plane", 160, 90)));
      const CameraFrame camera = make_camera_frame(m.camera, 160, 90);
      const TexelFootprint footprint =
          texel_footprint(m.receivers, camera, m.technique.frame, Image<uint8_t>(160, 90, 1));
      const double w = 10.0 / resolution, pixel = 2 * 7 * std::tan(35 * std::numbers::pi / 360) / 90,
                   cosine = std::cos(theta * std::numbers::pi / 180);
      const size_t middle = footprint.pixels.index(80, 45);
      // The middle pixel is beside the picture's middle, where a pixel is wider by less than its own size over the distance.
      EXPECT_NEAR(footprint.perspective[middle], w / pixel, 0.01 * w / pixel) << theta;
      EXPECT_NEAR(footprint.pixels[middle], w / pixel / cosine, 0.02 * w / pixel / cosine)
          << theta << " " << resolution;
      EXPECT_NEAR(metric(m, "perspective_aliasing"), w / pixel, 0.03 * w / pixel);
      EXPECT_LE(metric(m, "perspective_aliasing"), metric(m, "perspective_aliasing_p95"));
      EXPECT_EQ(metric(m, "undersampled"), w / pixel > 1              ? 1
                                           : w / pixel / cosine < 0.9 ? 0
                                                                      : metric(m, "undersampled"));
    }
}

// Law 1: a slope across the texels needs A = |cos phi| + |sin phi| times the bias of one along them.
TEST(MapRoll, ChangesTheAzimuthOfASlope) {
  const auto needed = [&](const char* phi, const char* roll) {
    return metric(measured(with({{"scene.phi_deg", phi}, {"map.roll_deg", roll}}, small("plane", 160, 90))),
                  "acne_free_bias_law_m");
  };
  const double along = needed("0", "0");
  EXPECT_NEAR(needed("0", "45"), std::numbers::sqrt2 * along, 1e-4 * along);
  EXPECT_NEAR(needed("0", "90"), along, 1e-4 * along);
  EXPECT_NEAR(needed("30", "30"), along, 1e-4 * along) << "a roll has the sense in which the azimuth is measured";
  EXPECT_NEAR(needed("0", "-30"), needed("30", "0"), 1e-4 * along);
}

// A turned map shows the same scene: what is true does not change, and the ladder stays sound.
TEST(MapRoll, ChangesNoTruth) {
  for (const char* scene : {"cube-room", "spot-room"}) {
    const Measurement still = measured(small(scene));
    const Image<float> truth = still.ladder.truth();
    const Measurement rolled = measured(with({{"map.roll_deg", "33"}}, small(scene)));
    size_t differ = 0;
    for (size_t i = 0; i < truth.size(); ++i) differ += truth[i] != rolled.ladder.truth()[i];
    EXPECT_EQ(differ, 0u) << scene;
    EXPECT_EQ(metric(rolled, "contract"), 0) << scene;
    EXPECT_LE(metric(rolled, "rounding_excess"), 1) << scene;
    EXPECT_LE(rolled.ladder.residual, rounding_of_steps) << scene;
  }
}

TEST(MapRoll, AutoFindsTheSmallestExtent) {
  for (const char* name : {"cube-room", "facade", "pillars", "wall"})
    for (const char* fit : {"tight", "view", "casters"}) {
      const Settings settings = with({{"map.fit", fit}}, small(name));
      const Scene scene = make_scene(settings.scene);
      const double found = make_light_frame(scene, with({{"map.roll_deg", "auto"}}, settings)).extent_m;
      double least = make_light_frame(scene, settings).extent_m;
      for (int roll = -179; roll < 180; roll += 7)
        least =
            std::min(least, make_light_frame(scene, with({{"map.roll_deg", std::to_string(roll)}}, settings)).extent_m);
      EXPECT_LE(found, least * 1.01) << name << " " << fit;
    }
  // What a tight fit of the room uses, with and without (by hand 87% were found).
  const auto used = [&](const char* roll) {
    return metric(measured(with({{"map.fit", "tight"}, {"map.roll_deg", roll}}, small("cube-room"))), "map_used");
  };
  EXPECT_NEAR(used("0"), 0.484, 0.005);
  EXPECT_GT(used("auto"), 0.87);
}

// A map with fewer rows is the middle of the square one, texel for texel, if both have an even number of them: so a scene
// that lies within has the same errors. Only the matrix is rounded elsewhere.
TEST(RectangularMap, IsTheMiddleOfTheSquareOne) {
  for (const char* filter : {"none", "box", "hardware", "castano"})
    for (const char* extra : {"", "map.snap", "bias.normal_offset"}) {
      std::vector<Assignment> given = {{"bias.constant", "0.002"},
                                       {"filter.kind", filter},
                                       {"map.resolution", "1024"},
                                       {"map.extent_m", "80"},
                                       {"map.wrap", "clamp_to_border"}};
      if (*extra) given.emplace_back(extra, *extra == 'm' ? "true" : "1");
      const Measurement square = measured(with(given, small("cube-room")));
      given.emplace_back("map.aspect", "2");
      const Measurement wide = measured(with(given, small("cube-room")));
      ASSERT_EQ(wide.technique.frame.map_size(), glm::ivec2(1024, 512));
      EXPECT_EQ(metric(wide, "map_texels"), 1024 * 512);
      EXPECT_GE(metric(wide, "map_used"), metric(square, "map_used"));
      const double pixel = 1 / metric(square, "facing");
      for (const char* name : {"error", "acne", "peter_panning", "aliasing", "filter", "coverage", "precision"})
        EXPECT_NEAR(metric(wide, name), metric(square, name), 2 * pixel) << name << " " << filter << " " << extra;
      EXPECT_GT(metric(wide, "acne") + metric(wide, "filter") + metric(wide, "aliasing"), 0);
      EXPECT_EQ(metric(wide, "contract"), 0);
      EXPECT_LE(metric(wide, "rounding_excess"), 1);
      EXPECT_LE(wide.ladder.residual, rounding_of_steps);
    }
}

// Every place of the truth and of the shader agrees in a rectangle as in a square, in all scenes under the sun.
TEST(RectangularMap, IsSoundWithEveryFit) {
  for (const char* scene : {"cube-room", "facade", "wall", "fence"})
    for (const char* fit : {"tight", "view", "sphere", "casters"})
      for (const char* aspect : {"auto", "2", "0.4"}) {
        const Measurement m = measured(with({{"map.fit", fit},
                                             {"map.aspect", aspect},
                                             {"map.resolution", "192"},
                                             {"map.placements", "2"},
                                             {"filter.kind", "box"}},
                                            small(scene, 160, 90)));
        EXPECT_EQ(metric(m, "contract"), 0) << scene << fit << aspect;
        EXPECT_LE(metric(m, "rounding_excess"), 1) << scene << fit << aspect;
        EXPECT_LE(m.ladder.residual, rounding_of_steps) << scene << fit << aspect;
        EXPECT_EQ(metric(m, "placement_disagreements"), 0) << scene << fit << aspect;
        const glm::ivec2 size = m.technique.frame.map_size();
        EXPECT_EQ(size.x, 192);
        if (*aspect == 'a') {
          EXPECT_LE(size.y, 192);
        } else {
          EXPECT_EQ(size.y, std::lround(192 / std::stod(aspect)));
        }
      }
}

// A fit of a given shape holds what the square one holds, with texels that are no smaller than they must be.
TEST(RectangularMap, HoldsTheWholeFit) {
  for (const char* name : {"cube-room", "facade", "pillars", "wall"})
    for (const char* aspect : {"auto", "1", "3", "0.5"}) {
      const Settings settings = with({{"map.fit", "tight"}, {"map.aspect", aspect}}, small(name));
      const Scene scene = make_scene(settings.scene);
      const LightFrame frame = make_light_frame(scene, settings);
      const glm::dvec2 size = frame.map_size();
      double nearest = frame.resolution;  // texels from a side of the map
      for (const glm::vec3& p : scene.positions) {
        const glm::dvec2 at = frame.map_texels(frame.to_light(glm::dvec3(p)));
        const glm::dvec2 beside = glm::min(at, size - at);
        nearest = std::min({nearest, beside.x, beside.y});
      }
      EXPECT_GT(nearest, 0) << name << " " << aspect;
      // The margin, and in an automatic map less than a row.
      EXPECT_LT(nearest, 1e-3 * std::max(size.x, size.y) + 1) << name << " " << aspect;
    }
}

// The wider side along the map's width: no shape takes more texels than a square.
TEST(RectangularMap, OfTheFittedShapeUsesMore) {
  for (const char* name : {"cube-room", "facade", "pillars"}) {
    const auto of = [&](const char* roll, const char* aspect) {
      return measured(with({{"map.fit", "tight"}, {"map.roll_deg", roll}, {"map.aspect", aspect}}, small(name)));
    };
    const Measurement square = of("auto", "1"), shaped = of("auto", "auto");
    EXPECT_LE(metric(shaped, "map_texels"), metric(square, "map_texels")) << name;
    EXPECT_GE(metric(shaped, "map_used"), metric(square, "map_used") - 0.01) << name;
    const LightFrame &a = square.technique.frame, &b = shaped.technique.frame;
    EXPECT_LE(b.extent_m * b.extent_m * b.rows / b.resolution, a.extent_m * a.extent_m * 1.001) << name;
  }
}

TEST(RectangularMap, IsRefusedWhereItHasNoMeaning) {
  EXPECT_THROW(measured(with({{"map.aspect", "2"}}, small("spot-room"))), Error);
  EXPECT_THROW(measured(with({{"map.aspect", "2"}}, small("point-room"))), Error);
  EXPECT_THROW(measured(with({{"map.aspect", "auto"}, {"map.extent_m", "10"}}, small("cube-room"))), Error);
  EXPECT_THROW(measured(with({{"map.aspect", "auto"}}, small("cube-room"))), Error) << "the scene's own volume";
}

TEST(MapRoll, AutoNeedsAFit) {
  EXPECT_THROW(measured(with({{"map.roll_deg", "auto"}}, small("spot-room"))), Error);
  EXPECT_THROW(measured(with({{"map.roll_deg", "auto"}, {"map.extent_m", "10"}}, small("cube-room"))), Error);
}

TEST(OrthographicView, ShowsAsMuchAsThePerspectiveOneAtItsTarget) {
  const Scene scene = make_scene({.name = "cube-room"});
  const auto camera = [&](const std::vector<Assignment>& assignments) {
    return effective_camera(scene, with(assignments, small("cube-room")).view);
  };
  const Camera own = camera({}), parallel = camera({{"view.projection", "orthographic"}});
  EXPECT_EQ(parallel.projection, Projection::orthographic);
  EXPECT_NEAR(parallel.height_m, 2 * glm::distance(own.eye_m, own.target_m) * std::tan(glm::radians(own.fov_y_deg) / 2),
              1e-12);
  EXPECT_EQ(camera({{"view.projection", "orthographic"}, {"view.height_m", "3"}}).height_m, 3);
  EXPECT_EQ(camera({{"view.height_m", "3"}}).projection, Projection::perspective);
  const Measurement m = measured(with({{"view.projection", "orthographic"}}, small("cube-room")));
  EXPECT_GT(metric(m, "facing"), 1000);
  EXPECT_EQ(metric(m, "contract"), 0);
  // Parallel rays: a pixel has one width everywhere, and with a directional light one perspective aliasing.
  EXPECT_NEAR(metric(m, "perspective_aliasing"), metric(m, "perspective_aliasing_p95"),
              1e-6 * metric(m, "perspective_aliasing"));
}

}  // namespace
}  // namespace noonmark::acceptance
