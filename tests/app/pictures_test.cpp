// The pictures, images and point.json of a measurement that is written by hand.
#include "app/pictures/pictures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "app/pictures/point_files.h"
#include "app/pictures/point_pictures.h"
#include "app/pictures/view_colors.h"
#include "compare/report/cause_colors.h"
#include "compare/results/metrics.h"
#include "measure/workbench.h"
#include "tests/app/read_image.h"
#include "tests/support/sample_results.h"

namespace noonmark {
namespace {

// A point of 3 x 2 pixels over a map of 2 x 2 texels, in which all numbers are different.
class Pictures : public testing::Test {
 protected:
  Pictures() {
    const auto fill = [](auto& image, int width, int height, const auto& value) {
      image = std::remove_reference_t<decltype(image)>(width, height);
      for (size_t i = 0; i < image.size(); ++i) image[i] = value(i);
    };
    const auto numbered = [](float first) { return [=](size_t i) { return first + static_cast<float>(i) / 8; }; };
    fill(receivers.position, 3, 2, [](size_t i) {
      const float f = static_cast<float>(i);
      return glm::vec3(f, f + 0.25f, -f);
    });
    fill(receivers.normal, 3, 2, [](size_t i) {
      const float f = static_cast<float>(i);
      return glm::vec3(-f, 1, f * 2);
    });
    fill(receivers.primitive, 3, 2, [](size_t i) { return i == 5 ? no_primitive : static_cast<uint32_t>(1000 + i); });
    fill(probe.reference, 3, 2, numbered(0.125f));
    fill(probe.n_dot_l, 3, 2, [](size_t) { return 0.5f; });
    // In order: inside the map, on the repetition of (1, 1), at two corners, outside, and no receiver.
    probe.map_texels = Image<glm::vec2>(3, 2);
    probe.map_texels.pixels = {{0.5f, 0}, {-1, 3.5f}, {1, 0.9f}, {0, 1}, {2, 0}, {0, 0}};
    probe.pattern = tap_pattern(FilterSettings());
    fill(stored, 2, 2, numbered(0.1f));
    fill(exact, 2, 2, numbered(0.2f));
    for (size_t n = 0; n < 6; ++n)
      fill(ladder.rungs[n].lit, 3, 2, [n](size_t i) { return static_cast<float>((n + i) % 2); });
    for (size_t c = 0; c < compared_cause_count; ++c)
      fill(ladder.causes[c].step, 3, 2, numbered(static_cast<float>(c)));
    ladder.cause = ladder.flags = Image<uint8_t>(3, 2);
    ladder.cause.pixels = {0, 5, 6, 9, 3, 0};
    ladder.flags.pixels = {1, 3, 5, 7, 1, 0};
    scene.light.angular_diameter_deg = 0;
    settings.map.wrap = Wrap::repeat;
    frame.resolution = frame.rows = 2;
  }
  Measurement measurement() const {
    const Camera camera{.near_m = 0.1, .far_m = 100};
    exact_map = MapDepths(exact);
    // The whole map, from its lowest row on.
    const auto rows = [this](int first, int count) {
      Image<float> band(stored.width, count);
      for (int y = 0; y < count; ++y)
        for (int x = 0; x < stored.width; ++x) band.at(x, y) = stored.at(x, first + y);
      return band;
    };
    return {{},
            {settings, frame},
            ladder,
            camera,
            scene,
            receivers,
            {{{settings, frame}, probe, MapDepths(stored), exact_map, rows}},
            {},
            std::nullopt};
  }

  TemporaryFolder folder;
  Settings settings;
  Ladder ladder = empty_ladder(3, 2);
  LightFrame frame;
  Scene scene;
  ReceiverImage receivers;
  LookupProbe probe;
  Image<float> stored, exact;
  mutable MapDepths exact_map;
};

TEST_F(Pictures, LadderHoldsEveryRungAndWhatItWasMadeOf) {
  write_images(measurement(), folder.path().string(), "images", "p-");
  EXPECT_EQ(files_in(folder.path()), (std::set<std::string>{"p-ladder.exr", "p-map.exr"}));
  const ReadImage image = read_exr(folder.file("p-ladder.exr"));
  const auto expect = [&](const std::string& name, const std::vector<float>& values) {
    ASSERT_TRUE(image.channels.contains(name)) << name;
    EXPECT_EQ(bits(image.channels.at(name)), bits(values)) << name;
  };
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> p, n;
    for (size_t i = 0; i < 6; ++i) {
      p.push_back(receivers.position[i][axis]);
      n.push_back(receivers.normal[i][axis]);
    }
    expect(std::string("P.") + "XYZ"[axis], p);
    expect(std::string("N.") + "XYZ"[axis], n);
  }
  expect("primitive", {1000, 1001, 1002, 1003, 1004, -1});
  for (size_t n = 0; n < 6; ++n) expect("R" + std::to_string(n), ladder.rungs[n].lit.pixels);
  expect("depth.reference", probe.reference.pixels);
  expect("cause", {0, 5, 6, 9, 3, 0});
  expect("flags", {1, 3, 5, 7, 1, 0});
  for (int c = 1; c < compared_cause_count; ++c)
    expect("step." + std::string(cause_name(static_cast<Cause>(c))), ladder.causes[static_cast<size_t>(c)].step.pixels);
  EXPECT_EQ(image.channels.size(), 6 + 1 + 6 + 3 + 2 + compared_cause_count - 1);
  EXPECT_EQ(image.spec.format, OIIO::TypeDesc::FLOAT);

  // The depths that the wrap mode gives for the texels above. The last pixel has no receiver.
  const auto expect_depths = [&](std::vector<int> texels) {
    write_images(measurement(), folder.path().string(), "images", "q-");
    const ReadImage read = read_exr(folder.file("q-ladder.exr"));
    for (const auto& [name, map] : {std::pair("depth.stored", &stored), std::pair("depth.exact", &exact)}) {
      for (size_t i = 0; i < 5; ++i)
        EXPECT_EQ(read.channels.at(name)[i], texels[i] < 0 ? 1.0f : (*map)[static_cast<size_t>(texels[i])])
            << name << " of pixel " << i;
      EXPECT_TRUE(std::isnan(read.channels.at(name)[5]));
    }
  };
  expect_depths({0, 3, 1, 2, 0});
  settings.map.wrap = Wrap::clamp_to_edge;
  expect_depths({0, 2, 1, 2, 1});
  settings.map.wrap = Wrap::clamp_to_border;
  expect_depths({0, -1, 1, 2, -1});
}

TEST_F(Pictures, MapHasItsHighestRowOnTop) {
  write_images(measurement(), folder.path().string(), ".", "");
  const ReadImage map = read_exr(folder.file("map.exr"));
  EXPECT_EQ(map.channels.size(), 2);
  EXPECT_EQ(map.channels.at("depth.stored"), (std::vector<float>{stored[2], stored[3], stored[0], stored[1]}));
  EXPECT_EQ(map.channels.at("depth.exact"), (std::vector<float>{exact[2], exact[3], exact[0], exact[1]}));
}

// Two cascades: the maps of the fixture, and others that have twice as many rows.
class PicturesOfCascades : public Pictures {
 protected:
  PicturesOfCascades() {
    far_frame = frame;
    far_frame.rows = 4;
    far_stored = Image<float>(2, 4);
    far_exact = Image<float>(2, 4);
    for (size_t i = 0; i < far_stored.size(); ++i) {
      far_stored[i] = 0.5f + static_cast<float>(i) / 32;
      far_exact[i] = 0.75f + static_cast<float>(i) / 64;
    }
    far_map = MapDepths(far_exact);
    cascades = Image<uint8_t>(3, 2);
    cascades.pixels = {0, 0, 1, 1, 0, no_map};
  }
  Measurement measurement() const {
    Measurement m = Pictures::measurement();
    const auto rows = [this](int first, int count) {
      asked.emplace_back(first, count);
      Image<float> band(2, count);
      for (int y = 0; y < count; ++y)
        for (int x = 0; x < 2; ++x) band.at(x, y) = far_stored.at(x, first + y);
      return band;
    };
    m.maps.push_back({{settings, far_frame}, probe, MapDepths(far_stored), far_map, rows});
    m.choice.of = cascades;
    m.record.cascades = {{0.25, 4, {{"error", 0.125}}, 0.5}, {4, 32, {{"error", nan_value}}, std::nullopt}};
    return m;
  }
  LightFrame far_frame;
  Image<float> far_stored, far_exact;
  mutable MapDepths far_map;
  Image<uint8_t> cascades;
  mutable std::vector<std::pair<int, int>> asked;
};

TEST_F(PicturesOfCascades, MapsStandOneAboveTheOther) {
  write_images(measurement(), folder.path().string(), ".", "");
  const ReadImage map = read_exr(folder.file("map.exr"));
  EXPECT_EQ(map.spec.width, 2);
  EXPECT_EQ(map.spec.height, 6);
  // From the top: the rows of the far map from its highest one down, then those of the near one.
  const auto stacked = [](const Image<float>& far, const Image<float>& near) {
    std::vector<float> all;
    for (const Image<float>* image : {&far, &near})
      for (int y = image->height - 1; y >= 0; --y)
        for (int x = 0; x < 2; ++x) all.push_back(image->at(x, y));
    return all;
  };
  EXPECT_EQ(map.channels.at("depth.stored"), stacked(far_stored, stored));
  EXPECT_EQ(map.channels.at("depth.exact"), stacked(far_exact, exact));
  for (const auto& [first, count] : asked) EXPECT_TRUE(first >= 0 && count > 0 && first + count <= 4);
  EXPECT_EQ(read_exr(folder.file("ladder.exr")).channels.at("cascade"), (std::vector<float>{0, 0, 1, 1, 0, -1}));
}

// Cascades may have a resolution each: the image is as wide as the widest map.
TEST(PicturesOfWideCascades, FitMapsOfAnyWidth) {
  Settings settings;
  settings.scene.name = "street";
  settings.view.width_px = 32, settings.view.height_px = 18;
  settings.map.fit = MapFit::sphere;
  settings.cascades.count = 3;
  settings.cascades.resolutions = {16, 32, 8};
  Workbench bench(gl::DebugMode::fatal);
  const Measurement m = bench.measure(settings, std::nullopt);
  const TemporaryFolder folder;
  write_images(m, folder.path().string(), ".", "");
  const ReadImage map = read_exr(folder.file("map.exr"));
  ASSERT_EQ(map.spec.width, 32);
  ASSERT_EQ(map.spec.height, 16 + 32 + 8);
  const std::vector<float>&read = map.channels.at("depth.stored"), &exact = map.channels.at("depth.exact");
  int bottom = 0, known = 0, unknown = 0;
  for (const MeasuredMap& one : m.maps) {
    const int side = one.technique.frame.resolution;
    const Image<float> stored = one.stored_rows(0, side);
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < 32; ++x) {
        const auto at = static_cast<size_t>((map.spec.height - 1 - bottom - y) * 32 + x);
        SCOPED_TRACE(testing::Message() << side << " " << x << " " << y);
        if (x < side) {
          ASSERT_EQ(read[at], stored.at(x, y));
        } else {
          ASSERT_TRUE(std::isnan(read[at])) << "no texel is there";
        }
        // Of the exact map only the depths are known that a receiver's tap reads.
        const bool is_known = x < side && one.exact.texels->has({x, y});
        (is_known ? known : unknown)++;
        if (is_known) {
          ASSERT_EQ(exact[at], one.exact.at({x, y}));
        } else {
          ASSERT_TRUE(std::isnan(exact[at]));
        }
      }
    bottom += side;
  }
  EXPECT_GT(known, 0);
  EXPECT_GT(unknown, 0);
}

TEST_F(PicturesOfCascades, PointJsonListsEach) {
  far_frame.extent_m = 40;
  far_frame.centre_m = {3, -2};
  const nlohmann::json json = nlohmann::json::parse(point_json(measurement(), ""));
  EXPECT_FALSE(json.contains("light")) << "there is no one map";
  ASSERT_EQ(json.at("cascades").size(), 2u);
  const nlohmann::json &near = json["cascades"][0], &far = json["cascades"][1];
  EXPECT_EQ(near.at("begin_m"), 0.25);
  EXPECT_EQ(near.at("end_m"), 4);
  EXPECT_EQ(near.at("bias_needed"), 0.5);
  EXPECT_EQ(near.at("metrics"), nlohmann::json({{"error", 0.125}}));
  EXPECT_TRUE(far.at("bias_needed").is_null());
  EXPECT_EQ(far.at("metrics").at("error"), "nan");
  EXPECT_EQ(far.at("light").at("extent_m"), 40);
  EXPECT_EQ(far.at("light").at("texel_m"), 20);
  EXPECT_EQ(far.at("light").at("map").at("height"), 4);
  const glm::dvec3 middle = far_frame.to_world({3, -2, 0});
  EXPECT_EQ(far.at("light").at("origin_m"), nlohmann::json({middle.x, middle.y, middle.z}));
  EXPECT_TRUE(
      near.at("light").at("map").at("rows").get<std::string>().starts_with("map.exr has the maps of all cascades"));
  // The matrix takes the middle of the map to the middle of the clip space.
  const nlohmann::json& matrix = far.at("light").at("clip_from_world_rows");
  for (size_t row : {0, 1}) {
    double at = matrix[row][3].get<double>();
    for (int axis = 0; axis < 3; ++axis) at += matrix[row][static_cast<size_t>(axis)].get<double>() * middle[axis];
    EXPECT_NEAR(at, 0, 1e-12);
  }
}

TEST_F(Pictures, AreNamedInTheirRecords) {
  const auto names_of = [&] {
    std::set<std::string> names;
    for (const PictureRecord& record : write_pictures(measurement(), folder.path().string(), "images", "p0003")) {
      EXPECT_EQ(record.path, "images/p0003-" + record.name + ".png");
      EXPECT_TRUE(record.caption.ends_with('.'));
      const Image<Color> picture = read_png(folder.file("p0003-" + record.name + ".png"));
      EXPECT_EQ(picture.width, record.name == "depth" ? 2 : 3) << record.name;
      EXPECT_EQ(picture.height, 2) << record.name;
      names.insert(record.name);
    }
    return names;
  };
  std::set<std::string> names = {"truth",   "map",          "classes",    "difference",       "depth",
                                 "frustum", "shaded-truth", "shaded-map", "shaded-difference"};
  EXPECT_EQ(names_of(), names);
  settings.light.angular_diameter_deg = 0.5;
  names.insert({"soft-truth", "shaded-soft-truth"});
  EXPECT_EQ(names_of(), names);
}

// A page that shows a value between 0 and 1 as it is shows round(255 value).
TEST_F(Pictures, DebugViewsShowTheDepthsAsTheyAreStored) {
  std::set<std::string> names;
  for (const PictureRecord& record : write_debug_pictures(measurement(), folder.path().string(), ".", "point"))
    names.insert(record.name);
  EXPECT_EQ(names, (std::set<std::string>{"debug-unshadowed", "debug-stored", "debug-painted", "debug-corner",
                                          "debug-texels"}));
  const auto grey_of = [](float depth) { return Color(static_cast<uint8_t>(std::lround(255 * depth))); };
  const Image<Color> map = read_png(folder.file("point-debug-stored.png"));
  ASSERT_EQ(map.width, 2);
  EXPECT_EQ(map.pixels,
            (std::vector<Color>{grey_of(stored[2]), grey_of(stored[3]), grey_of(stored[0]), grey_of(stored[1])}))
      << "the highest v on top";
  const Image<Color> painted = read_png(folder.file("point-debug-painted.png"));
  ASSERT_EQ(painted.width, 3);
  EXPECT_EQ(painted[0], grey_of(stored.at(0, 0)));
  EXPECT_EQ(painted[1], grey_of(stored.at(1, 1))) << "the map repeats";
  EXPECT_EQ(painted[2], grey_of(stored.at(1, 0)));
  EXPECT_EQ(painted[5], named_color("background"));
  const Image<Color> unshadowed = read_png(folder.file("point-debug-unshadowed.png")),
                     corner = read_png(folder.file("point-debug-corner.png"));
  EXPECT_EQ(unshadowed[5], named_color("background"));
  EXPECT_EQ(corner.at(0, 1), Color(255)) << "a rectangle of one pixel is all frame";
  EXPECT_EQ(corner.at(2, 1), named_color("background"));
}

Color named(std::string_view name) {
  const CauseColor* color = find_color(name);
  if (!color) throw std::logic_error(std::string(name));
  return {color->r, color->g, color->b};
}

TEST_F(Pictures, ClassesShowTheColoursOfTheLegend) {
  for (float& cosine : probe.n_dot_l.pixels)
    cosine = 1;  // full light, so that shading does not change the colours of the legend
  // In order: completely wrong (full colour), right and lit, right and dark, ambiguous, facing away, no surface.
  ladder.flags.pixels = {1, 1, 1, 5, 0, 0};
  ladder.cause.pixels = {static_cast<uint8_t>(Cause::acne), 0, 0, 0, 0, 0};
  ladder[Rung::truth].pixels = {1, 1, 0, 1, 0, 0};
  ladder[Rung::shown].pixels = {0, 1, 0, 0, 0, 0};
  write_pictures(measurement(), folder.path().string(), "images", "p");
  EXPECT_EQ(read_png(folder.file("p-classes.png")).pixels,
            (std::vector<Color>{named("acne"), named("lit"), named("shadowed"), named("ambiguous"), named("attached"),
                                named("background")}));
  const Image<Color> difference = read_png(folder.file("p-difference.png"));
  EXPECT_EQ(difference[0], named("acne"));
  EXPECT_EQ(difference[1], named("lit"));
  EXPECT_EQ(difference[5], named("background"));
  const Image<Color> truth = read_png(folder.file("p-truth.png")), map = read_png(folder.file("p-map.png"));
  EXPECT_GT(truth[0].r, map[0].r);  // lit, and falsely dark in the map
  EXPECT_EQ(truth[1], map[1]);
}

// Both are unlit: what is in shadow, and what faces away from the light.
TEST_F(Pictures, TheLitPictureTellsFacingAwayFromShadow) {
  ladder.flags.pixels = {1, 1, 1, 1, 0, 0};
  ladder[Rung::truth].pixels = {1, 1, 0, 1, 0, 0};
  const Image<Color> picture = lit_picture(measurement());
  const auto is_grey = [](const Color& c) { return c.r == c.g && c.g == c.b; };
  EXPECT_TRUE(is_grey(picture[2])) << "in shadow";
  EXPECT_EQ(picture[4], facing_away);
  EXPECT_FALSE(is_grey(facing_away));
  EXPECT_EQ(picture[5], named("background"));
}

// An ambiguous truth is neither lit nor in shadow, whichever of the two the ray's verdict says.
TEST_F(Pictures, TheLitPictureTellsAmbiguousFromShadow) {
  ladder.flags.pixels = {1, 1 | flag_ambiguous, 1 | flag_ambiguous, 1, flag_ambiguous, 0};
  ladder[Rung::truth].pixels = {1, 1, 0, 0, 0, 0};
  const Image<Color> picture = lit_picture(measurement());
  EXPECT_EQ(picture[1], named("ambiguous"));
  EXPECT_EQ(picture[2], named("ambiguous"));
  EXPECT_NE(picture[3], named("ambiguous"));
  EXPECT_EQ(picture[4], facing_away) << "what faces away is unlit with certainty";
}

// A rung on top of R5 brings its cause: its colour in the picture of the classes, its numbers and its description in
// point.json, its name in the captions.
TEST_F(Pictures, ShowARungOnTopAndItsCause) {
  for (float& cosine : probe.n_dot_l.pixels) cosine = 1;
  ladder.flags.pixels = {1, 1, 1, 5, 0, 0};
  ladder[Rung::truth].pixels = ladder[Rung::shown].pixels = {1, 1, 0, 1, 0, 0};
  for (Ladder::CauseImage& cause : ladder.causes) cause.step = Image<float>(3, 2, 0);
  Image<float> picture = ladder.shown();
  picture[0] = 0;
  const std::array<uint8_t, 3> leak{1, 2, 3};
  add_rung(ladder, {"R6", picture, "seep", "Seep", "Light that leaks."});
  picture[2] = 1;
  add_rung(ladder, {"R7", picture, "penumbra", "Penumbra", "Its width.", leak});
  std::map<std::string, std::string> captions;
  for (const PictureRecord& record : write_pictures(measurement(), folder.path().string(), "images", "p"))
    captions[record.name] = record.caption;
  const Image<Color> classes = read_png(folder.file("p-classes.png"));
  EXPECT_EQ(classes[0], Color(spare_colors[0][0], spare_colors[0][1], spare_colors[0][2]));
  EXPECT_EQ(classes[1], named("lit"));
  EXPECT_EQ(classes[2], Color(1, 2, 3));
  EXPECT_EQ(captions.at("map"), "What the given picture showed (R7).");
  EXPECT_EQ(captions.at("truth"), "The truth: one exact shadow ray for each pixel (R1).");
  EXPECT_TRUE(captions.at("difference").starts_with("Given picture minus truth")) << captions.at("difference");
  EXPECT_NE(captions.at("shaded-map").find("given picture's shadow (R7)"), std::string::npos);

  Measurement m = measurement();
  m.record.causes = ladder.brought;
  m.record.metrics = {{"error", 0.5}, {"seep", 0.25}, {"penumbra", nan_value}};
  const nlohmann::json json = nlohmann::json::parse(point_json(m, ""));
  EXPECT_EQ(json.at("metrics"), nlohmann::json({{"error", 0.5}, {"seep", 0.25}, {"penumbra", "nan"}}));
  EXPECT_EQ(json.at("rungs"), nlohmann::json({"R0", "R1", "R2", "R3", "R4", "R5", "R6", "R7"}));
  EXPECT_EQ(json.at("rungs_on_top").at(1), nlohmann::json({{"name", "R7"},
                                                           {"cause", "penumbra"},
                                                           {"label", "Penumbra"},
                                                           {"help", "Its width."},
                                                           {"color", {1, 2, 3}}}));
  write_images(m, folder.path().string(), ".", "");
  const ReadImage file = read_exr(folder.file("ladder.exr"));
  EXPECT_EQ(file.channels.at("R7"), picture.pixels);
  EXPECT_EQ(file.channels.at("step.penumbra"), (std::vector<float>{0, 0, 1, 0, 0, 0}));
}

TEST_F(Pictures, ShowWhatIsNoNumberAsWrong) {
  ladder.flags.pixels[0] = flag_facing;
  ladder.cause.pixels[0] = static_cast<uint8_t>(Cause::precision);
  ladder[Rung::truth].pixels[0] = 1;
  ladder[Rung::shown].pixels[0] = std::numeric_limits<float>::quiet_NaN();
  write_pictures(measurement(), folder.path().string(), "images", "p");
  EXPECT_EQ(read_png(folder.file("p-classes.png"))[0], named("precision"));
  EXPECT_EQ(read_png(folder.file("p-difference.png"))[0], named("peter_panning"));
  EXPECT_EQ(read_png(folder.file("p-map.png"))[0], Color(0, 0, 0));
}

TEST_F(Pictures, PointHoldsEverySettingAndWhatIsNotFinite) {
  Measurement m = measurement();
  for (const Metric& metric : metrics_table()) m.record.metrics[std::string(metric.name)] = 0.25;
  m.record.metrics["error"] = nan_value;
  m.record.metrics["acne"] = inf_value;
  m.record.times["map_ms"] = -inf_value;
  m.record.worst = {3, 4, inf_value, "acne"};
  const nlohmann::json json = nlohmann::json::parse(point_json(m, "noonmark render 'x'"));
  for (const Setting& row : settings_table())
    EXPECT_TRUE(json.at("settings").contains(std::string(row.name))) << row.name;
  for (const Metric& metric : metrics_table())
    EXPECT_TRUE(json.at("metrics").contains(std::string(metric.name))) << metric.name;
  EXPECT_EQ(json.at("metrics").at("error"), "nan");
  EXPECT_EQ(json.at("metrics").at("acne"), "inf");
  EXPECT_EQ(json.at("metrics").at("wrong"), 0.25);
  EXPECT_EQ(json.at("times").at("map_ms"), "-inf");
  EXPECT_EQ(json.at("settings").at("map.resolution"), 1024);
  EXPECT_EQ(json.at("settings").at("map.extent_m"), "auto");
  EXPECT_EQ(json.at("settings").at("bias.constant"), 0);
  EXPECT_EQ(json.at("settings").at("map.lit_beyond_far"), true);
  ASSERT_EQ(json.at("causes").size(), compared_cause_count);
  for (int c = 0; c < compared_cause_count; ++c)
    EXPECT_EQ(json.at("causes")[static_cast<size_t>(c)], std::string(cause_name(static_cast<Cause>(c))));
  EXPECT_EQ(json.at("worst"), nlohmann::json({{"x", 3}, {"y", 4}, {"error", "inf"}, {"cause", "acne"}}));
  EXPECT_FALSE(json.contains("part"));
  EXPECT_EQ(json.at("flags").at("outside"), flag_outside);
  EXPECT_EQ(json.at("command"), "noonmark render 'x'");
}

// Least, balanced and best of four settings: the cheapest; half of the error for twice the cost; a little less for four times.
// The last one is above four times the cheapest.
TEST(PointsWithPictures, AnswersAreThreePointsAndTheBrokenOne) {
  Results results;
  results.info.accuracy = "error";
  results.info.swept = {"map.resolution"};
  for (const auto& [cost, error] : {std::pair(1.0, 0.8), {2.0, 0.2}, {4.0, 0.19}, {8.0, 0.1}}) {
    PointRecord point;
    point.id = static_cast<int64_t>(results.points.size());
    point.settings = {{"map.resolution", std::to_string(64 << point.id)}};
    point.metrics = {{"texel_work", cost}, {"error", error}};
    results.points.push_back(point);
  }
  EXPECT_EQ(points_with_pictures("answers", results), (std::vector<int64_t>{0, 1, 2}));
  results.bounds.push_back({.metric = "acne", .max = 0, .join = "worst", .held = false, .point = 3, .points = 4});
  EXPECT_EQ(points_with_pictures("answers", results), (std::vector<int64_t>{0, 1, 2, 3}));
}

}  // namespace
}  // namespace noonmark
