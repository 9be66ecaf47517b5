// Sections through receivers against closed forms, against the ladder, and against the shadow rays.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <regex>
#include <set>

#include "base/error.h"
#include "compare/report/section_picture.h"
#include "compare/report/section_words.h"
#include "tests/support/kind_thrown.h"
#include "tests/support/measured.h"

namespace noonmark::acceptance {
namespace {

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

// The depth of a cut at s, between two of its points.
std::optional<double> depth_at(const SectionLine& line, double s) {
  for (size_t k = 0; k + 1 < line.points.size(); ++k) {
    const glm::dvec2 &a = line.points[k], &b = line.points[k + 1];
    if (a.x <= s && s <= b.x && a.x < b.x) return a.y + (b.y - a.y) * (s - a.x) / (b.x - a.x);
  }
  return std::nullopt;
}

glm::ivec2 middle_of(const Measurement& m) { return {m.receivers.width() / 2, m.receivers.height() / 2}; }

struct Slope {
  double theta_deg, phi_deg;
};

// Scene `plane`: an orthographic map of 10 m, a plane at theta whose slope has the azimuth phi. In the section the plane is
// a line that falls by w tan(theta) for each texel, each step is the plane's depth at its texel's centre, and the middle
// receiver needs the bias -|g| s of its texel's centre.
TEST(SectionOfAPlane, HasItsSlopeItsStepsAndTheBiasThatItNeeds) {
  Workbench bench(gl::DebugMode::fatal);
  for (const Slope& slope : {Slope{30, 0}, {50, 20}, {65, 45}, {75, 110}, {40, 250}}) {
    const Settings settings = with({{"scene.theta_deg", std::to_string(slope.theta_deg)},
                                    {"scene.phi_deg", std::to_string(slope.phi_deg)},
                                    {"map.resolution", "256"},
                                    {"map.format", "32f"}},
                                   small("plane", 96, 54));
    const Measurement m = bench.measure(settings, std::nullopt);
    const ReceiverSection section = bench.sections(m, std::array{middle_of(m)}).front();
    const double w = 10.0 / 256, fall = w * std::tan(radians(slope.theta_deg));
    // Vertices, positions and depths are floats: some roundings of 10 m each, at the slope's steepness.
    const double rounding = 16 * 10 * 0x1p-24 * (1 + std::tan(radians(slope.theta_deg)));
    EXPECT_NEAR(section.texel_m, w, 1e-12);
    EXPECT_NEAR(glm::length(section.gradient_m), fall, rounding);
    EXPECT_NEAR(section.direction.x, std::cos(radians(slope.phi_deg)), 1e-5);
    EXPECT_NEAR(section.direction.y, std::sin(radians(slope.phi_deg)), 1e-5);

    double cut_from = section.reach, cut_to = -section.reach;
    for (const SectionLine& line : section.surfaces) {
      ASSERT_EQ(line.points.size(), 2u) << "an orthographic map cuts triangles in straight lines";
      const glm::dvec2 a = line.points.front(), b = line.points.back();
      if (b.x - a.x > 0.1) {
        EXPECT_NEAR((b.y - a.y) / (b.x - a.x), fall, rounding / (b.x - a.x));
      }
      cut_from = std::min(cut_from, a.x);
      cut_to = std::max(cut_to, b.x);
    }
    EXPECT_NEAR(cut_from, -section.reach, 1e-6) << "the plane is larger than the section";
    EXPECT_NEAR(cut_to, section.reach, 1e-6);

    ASSERT_GE(section.columns.size(), 5u);
    for (size_t k = 0; k < section.columns.size(); ++k) {
      const SectionColumn& column = section.columns[k];
      EXPECT_NEAR(column.stored_m, section.reference_m + fall * column.centre, rounding) << slope.theta_deg << " " << k;
      const glm::dvec2 centre = glm::dvec2(column.texel) + 0.5 - section.place;
      EXPECT_NEAR(glm::length(centre), std::hypot(column.centre, column.beside), 1e-9);
      if (k > 0) {
        EXPECT_EQ(column.from, section.columns[k - 1].to) << "columns without a gap";
      }
    }
    const SectionTap& tap = section.taps.at(0);
    const double needed = std::max(0.0, -fall * tap.along);
    EXPECT_NEAR(tap.threshold_m, needed, rounding);
    EXPECT_EQ(section.cause, needed > rounding ? Cause::acne : section.cause);
  }
}

// The bias that a section says is needed is the one from which the pixel is lit.
TEST(SectionOfAPlane, ThePixelIsLitFromTheBiasThatItNeedsOn) {
  Workbench bench(gl::DebugMode::fatal);
  Settings settings =
      with({{"scene.theta_deg", "55"}, {"scene.phi_deg", "25"}, {"map.resolution", "64"}, {"bias.unit", "m"}},
           small("plane", 96, 54));
  const Measurement m = bench.measure(settings, std::nullopt);
  const PointRecord::Worst worst = m.record.worst;
  const glm::ivec2 pixel(worst.x, worst.y);
  const double needed = bench.sections(m, std::array{pixel}).front().taps.at(0).threshold_m;
  ASSERT_GT(needed, 1e-3);
  for (const double bias : {0.999 * needed, 1.001 * needed}) {
    settings.bias["constant"] = static_cast<float>(bias);
    const Measurement biased = bench.measure(settings, std::nullopt);
    const ReceiverSection section = bench.sections(biased, std::array{pixel}).front();
    EXPECT_NEAR(section.bias_m, bias, 1e-5);
    EXPECT_EQ(section.on_exact_map, bias > needed ? 1.0f : 0.0f);
    EXPECT_EQ(section.cause, bias > needed ? Cause::none : Cause::acne);
  }
}

// What an SVG says of its taps.
struct DrawnTap {
  glm::ivec2 texel{0};
  bool lit = false, shown = false;
  std::string cause;
};
std::map<int, DrawnTap> taps_in(const std::string& svg) {
  static const std::regex tap(
      R"re(<g class="tap" data-tap="(\d+)" data-texel="(-?\d+),(-?\d+)" data-lit="([01])" data-shown="([01])" data-cause="(\w+)">)re");
  std::map<int, DrawnTap> all;
  for (std::sregex_iterator it(svg.begin(), svg.end(), tap), end; it != end; ++it)
    all[std::stoi((*it)[1])] = {{std::stoi((*it)[2]), std::stoi((*it)[3])}, (*it)[4] == "1", (*it)[5] == "1", (*it)[6]};
  return all;
}

class SectionTaps : public testing::TestWithParam<SceneCase> {};

// Every tap's verdict and cause in the SVG add up to the ladder's rungs and steps, at the worst pixel of each cause and on a
// grid over the picture.
TEST_P(SectionTaps, OfTheSvgAreTheLadders) {
  Workbench bench(gl::DebugMode::fatal);
  const Measurement m = bench.measure(with(GetParam().settings, small(GetParam().scene, 160, 96)), std::nullopt);
  std::vector<glm::ivec2> pixels;
  for (const PointRecord::WorstOf& worst : m.record.worst_of) pixels.emplace_back(worst.x, worst.y);
  for (int y = 3; y < 96; y += 13)
    for (int x = 5; x < 160; x += 17) pixels.emplace_back(x, y);
  std::erase_if(pixels, [&](glm::ivec2 p) {
    const size_t i = m.ladder.flags.index(p.x, p.y);
    return !(m.ladder.flags[i] & flag_facing) || !m.map().probe.asks(i);
  });
  ASSERT_GT(pixels.size(), 10u);
  const bool blended = m.map().probe.pattern.bilinear();
  size_t wrong = 0;
  for (const ReceiverSection& section : bench.sections(m, pixels)) {
    const size_t i = m.ladder.flags.index(section.pixel.x, section.pixel.y);
    const std::map<int, DrawnTap> taps = taps_in(report::section_svg(section, report::SectionTheme::automatic));
    ASSERT_EQ(taps.size(), static_cast<size_t>(m.map().probe.taps()));
    double lit = 0, shown = 0;
    std::map<std::string, double> booked;
    for (const auto& [t, tap] : taps) {
      const double weight = blended ? m.map().probe.weight(i, t) : 1.0 / m.map().probe.taps();
      lit += tap.lit ? weight : 0;
      shown += tap.shown ? weight : 0;
      booked[tap.cause] += weight;
      wrong += tap.cause != "none";
    }
    EXPECT_NEAR(lit, m.ladder[Rung::on_exact_map][i], rounding_of_steps);
    // A sampler keeps 8 bits of a weight, and there are at most three pairs of weights along each axis.
    EXPECT_NEAR(shown, m.ladder[Rung::shown][i], blended ? 12.0 / 256 : rounding_of_steps);
    for (int c = static_cast<int>(Cause::aliasing_dark); c <= static_cast<int>(Cause::coverage_light); ++c)
      EXPECT_NEAR(booked[std::string(cause_name(static_cast<Cause>(c)))], std::abs(m.ladder[static_cast<Cause>(c)][i]),
                  rounding_of_steps)
          << cause_name(static_cast<Cause>(c)) << " at " << section.pixel.x << "," << section.pixel.y;
    EXPECT_EQ(section.cause, static_cast<Cause>(m.ladder.cause[i]));
  }
  EXPECT_GT(wrong, 0u) << "the case shows no wrong tap";
}

// The surface that the receiver stands on passes through it. A surface stands on its light ray if and only if the ray is
// blocked: the plane's cuts agree with Embree's rays.
TEST_P(SectionTaps, StandWhereTheSurfacesAndTheShadowRaysAre) {
  Workbench bench(gl::DebugMode::fatal);
  const Measurement m = bench.measure(with(GetParam().settings, small(GetParam().scene, 160, 96)), std::nullopt);
  std::vector<glm::ivec2> pixels;
  for (int y = 2; y < 96; y += 7)
    for (int x = 3; x < 160; x += 11) {
      const size_t i = m.ladder.flags.index(x, y);
      if ((m.ladder.flags[i] & flag_facing) && !(m.ladder.flags[i] & flag_ambiguous) && m.map().probe.asks(i))
        pixels.emplace_back(x, y);
    }
  ASSERT_GT(pixels.size(), 20u);
  size_t blocked = 0;
  for (const ReceiverSection& section : bench.sections(m, pixels)) {
    // The distance of the receiver from the nearest cut, beyond what a chord of that cut may leave the curve: an eighth of
    // the second difference of its points, twice as much for the change of that difference along the curve.
    double nearest = std::numeric_limits<double>::infinity();
    for (const SectionLine& line : section.surfaces)
      if (const auto depth = depth_at(line, section.receiver_s); depth) {
        double bend = 0;
        for (size_t k = 1; k + 1 < line.points.size(); ++k) {
          const glm::dvec2 &a = line.points[k - 1], &b = line.points[k], &c = line.points[k + 1];
          bend = std::max(bend, std::abs(a.y + (c.y - a.y) * (b.x - a.x) / (c.x - a.x) - b.y));
        }
        nearest = std::min(nearest, std::abs(*depth - section.receiver_m) - bend);
      }
    // P is a float, so it lies beside its triangle by a rounding, which the slope enlarges.
    const double rounding =
        (section.receiver_m + glm::length(section.gradient_m) * glm::length(section.place)) * 0x1p-20;
    if (!section.moved) {
      EXPECT_LT(nearest, rounding) << section.pixel.x << "," << section.pixel.y;
      EXPECT_EQ(section.blocker_m.has_value(), section.truth == 0) << section.pixel.x << "," << section.pixel.y;
    }
    blocked += section.blocker_m.has_value();
  }
  EXPECT_GT(blocked, 0u);
}

INSTANTIATE_TEST_SUITE_P(
    Techniques, SectionTaps,
    testing::Values(
        SceneCase{"Unfiltered", "cube-room", {{"map.resolution", "256"}}},
        SceneCase{"Box", "cube-room", {{"map.resolution", "256"}, {"filter.kind", "box"}, {"bias.constant", "0.01"}}},
        SceneCase{"Hardware", "cube-room", {{"map.resolution", "256"}, {"filter.kind", "hardware"}}},
        SceneCase{"Outside", "cube-room", {{"map.extent_m", "6"}, {"map.wrap", "repeat"}, {"map.resolution", "128"}}},
        SceneCase{
            "Moved", "cube-room", {{"map.resolution", "256"}, {"bias.normal_offset", "3"}, {"bias.unit", "texel"}}},
        SceneCase{"Spot", "spot-room", {{"map.resolution", "256"}, {"filter.kind", "box"}}},
        SceneCase{"Point", "point-room", {{"map.resolution", "128"}}},
        SceneCase{"PointGrid", "point-room", {{"map.resolution", "128"}, {"filter.kind", "cube_grid"}}}),
    [](const auto& one) { return std::string(one.param.name); });

// A cut by a perspective map is the same straight surface: at each of its points, 1/depth along the axis is affine in s.
TEST(SectionOfASpotLight, CutsAPlaneWhereOneOverDepthIsAffine) {
  Workbench bench(gl::DebugMode::fatal);
  const Measurement m = bench.measure(with({{"map.resolution", "256"}}, small("spot-room", 160, 96)), std::nullopt);
  const PointRecord::Worst worst = m.record.worst;
  const ReceiverSection section = bench.sections(m, std::array{glm::ivec2(worst.x, worst.y)}).front();
  size_t curves = 0;
  for (const SectionLine& line : section.surfaces) {
    const glm::dvec2 a = line.points.front(), b = line.points.back();
    if (line.points.size() < 3 || b.x - a.x < 0.5) continue;
    for (const glm::dvec2& point : line.points)
      EXPECT_NEAR(1 / point.y, 1 / a.y + (1 / b.y - 1 / a.y) * (point.x - a.x) / (b.x - a.x), 1e-9);
    ++curves;
  }
  EXPECT_GT(curves, 0u);
}

TEST(Sections, OfPixelsWithoutALookupAreRefused) {
  Workbench bench(gl::DebugMode::fatal);
  const Measurement m = bench.measure(small("sphere", 96, 54), std::nullopt);
  const auto message_at = [&](glm::ivec2 pixel) -> std::string {
    return refusal_of(ErrorKind::usage, [&] { bench.sections(m, std::array{pixel}); });
  };
  EXPECT_NE(message_at({96, 5}).find("pixel 96,5 lies outside the picture"), std::string::npos);
  EXPECT_NE(message_at({-1, 5}).find("0,0 (top left) to 95,53"), std::string::npos);
  bool away = false, empty = false;
  for (int y = 0; y < 54; ++y)
    for (int x = 0; x < 96; ++x) {
      const size_t i = m.ladder.flags.index(x, y);
      if (m.receivers.primitive[i] == no_primitive && !empty) {
        EXPECT_NE(message_at({x, y}).find("shows no surface"), std::string::npos);
        empty = true;
      } else if (m.receivers.primitive[i] != no_primitive && !(m.ladder.flags[i] & flag_facing) && !away) {
        EXPECT_NE(message_at({x, y}).find("gets no light from its front"), std::string::npos);
        away = true;
      }
    }
  EXPECT_TRUE(away);
}

// The words say the numbers of the drawing.
TEST(SectionWords, SayTheBiasThatIsMissing) {
  ReceiverSection section;
  SectionTap tap;
  tap.texel = {12, 40};
  tap.centre = {-0.3, 0.4};
  tap.reference_m = 8;
  tap.compared_m = 7.999;
  tap.exact_m = tap.stored_m = 7.9959;
  tap.threshold_m = 0.0041;
  tap.moved_lit = tap.exact_lit = tap.texel_lit = true;
  tap.cause = Cause::acne;
  section.taps = {tap};
  section.cause = Cause::acne;
  section.truth = section.soft_truth = 1;
  section.reference_m = 8;
  section.bias_m = 0.001;
  section.bias_depth = 1e-4;
  section.texel_m = 0.0125;
  const std::vector<std::string> words = report::section_words(section);
  EXPECT_EQ(report::section_title(section), "Acne (too dark)");
  EXPECT_NE(words[0].find("stores in texel (12, 40) a depth 3.1 mm nearer to the light"), std::string::npos)
      << words[0];
  EXPECT_NE(words[0].find("0.5 texels from the receiver"), std::string::npos) << words[0];
  EXPECT_NE(words[0].find("3.1 mm more bias would light the tap"), std::string::npos) << words[0];
  EXPECT_EQ(words[1], "The bias here is 1 mm along the light = 0.08 texels = 0.0001 of the map's depth.");

  section.cause = section.taps[0].cause = Cause::peter_panning;
  section.taps[0].moved_lit = section.taps[0].exact_lit = section.taps[0].texel_lit = false;
  section.taps[0].lit = section.taps[0].shown_lit = true;
  section.taps[0].compared_m = 7.99;
  section.bias_m = 0.01;
  EXPECT_NE(report::section_words(section)[0].find("the bias of 10 mm reaches past it. With less than 4.1 mm"),
            std::string::npos)
      << report::section_words(section)[0];
}

// The sections of the pixels in which Peter Panning is the largest part, and whose texel has no depth before the receiver.
std::vector<ReceiverSection> sections_without_blocker(Workbench& bench, const Settings& settings) {
  const Measurement m = bench.measure(settings, std::nullopt);
  std::vector<glm::ivec2> pixels;
  for (int y = 0; y < m.receivers.height(); ++y)
    for (int x = 0; x < m.receivers.width(); ++x)
      if (m.ladder.cause.at(x, y) == static_cast<uint8_t>(Cause::peter_panning)) pixels.emplace_back(x, y);
  std::vector<ReceiverSection> found = bench.sections(m, pixels);
  std::erase_if(found, [](const ReceiverSection& one) { return !one.missing; });
  return found;
}

std::set<std::string> ways_of(const std::vector<ReceiverSection>& sections) {
  std::set<std::string> ways;
  for (const ReceiverSection& section : sections) {
    const SectionTap& tap = section.taps[section.key_tap];
    EXPECT_GE(tap.exact_m, tap.reference_m);
    EXPECT_FALSE(tap.texel_lit);
    // The map's first depth is that of another face, or of none: it never has a face of the caster that it does not draw.
    if (section.missing->drawn_m && section.missing->culled) {
      EXPECT_LE(tap.exact_m, *section.missing->drawn_m + 1e-4);
    }
    const std::string words = report::section_words(section)[0];
    for (const char* way : {"no other face of it stands there", "the next face of it that is drawn there lies",
                            "does not cover the texel's centre then", "the receiver then"})
      if (words.find(way) != std::string::npos) ways.insert(way);
  }
  return ways;
}

// Peter Panning without a depth before the receiver: the words say what the texel holds, and not what the setting suggests.
TEST(SectionWords, SayWhatTheTexelHolds) {
  Workbench bench(gl::DebugMode::fatal);
  const auto ways = [&](const char* scene, const std::vector<Assignment>& more) {
    const std::vector<ReceiverSection> sections =
        sections_without_blocker(bench, with(more, with({{"map.resolution", "256"}}, small(scene, 200, 120))));
    EXPECT_FALSE(sections.empty()) << scene;
    return ways_of(sections);
  };
  using Ways = std::set<std::string>;
  // Leaves are single faces: without them the map has nothing of a leaf.
  EXPECT_TRUE(ways("foliage", {{"map.cull", "front"}}).contains("no other face of it stands there"));
  // A closed room has walls with two sides.
  EXPECT_TRUE(ways("lab", {{"map.cull", "front"}}).contains("the next face of it that is drawn there lies"));
  // A caster that shrinks leaves its border; one that moves away from the light covers the same texels, farther away.
  EXPECT_EQ(ways("cube-room", {{"bias.caster_normal_offset", "4"}}), Ways{"does not cover the texel's centre then"});
  EXPECT_EQ(ways("cube-room", {{"bias.caster_offset", "60"}}), Ways{"the receiver then"});
}

// Of a cause many pixels have as much: the one that is drawn lies in the middle of them, and without a wish it is one of the largest
// cause.
TEST(TypicalPixel, LiesInTheMiddleOfTheLargestPatch) {
  Workbench bench(gl::DebugMode::fatal);
  const Measurement m = bench.measure(with({{"bias.constant", "0.15"}}, small("cube-room", 200, 120)), std::nullopt);
  const ProbeOf probe_of = [&](size_t) -> const LookupProbe& { return m.map().probe; };
  const auto cause = static_cast<uint8_t>(Cause::peter_panning);
  const std::optional<glm::ivec2> found = typical_pixel(m.ladder, cause, true, probe_of);
  ASSERT_TRUE(found);
  for (int y = -2; y <= 2; ++y)
    for (int x = -2; x <= 2; ++x) EXPECT_EQ(m.ladder.cause.at(found->x + x, found->y + y), cause) << x << " " << y;
  EXPECT_EQ(typical_pixel(m.ladder, cause, false, probe_of), found) << "all of them have all of it";
  EXPECT_FALSE(typical_pixel(m.ladder, static_cast<size_t>(Cause::filter), true, probe_of)) << "one tap has no blur";
}

TEST(SectionTaps, KnowTheFaceThatTheyRead) {
  Workbench bench(gl::DebugMode::fatal);
  const Measurement m = bench.measure(small("point-room", 96, 54), std::nullopt);
  const ReceiverSection section = bench.sections(m, std::array{middle_of(m)}).front();
  const SectionTap& tap = section.taps.at(0);
  EXPECT_EQ(tap.tile, section.tile);
  EXPECT_EQ(tap.tile, tap.texel.y / section.map_size.x);
  // The texel is counted in its face: the faces stand one above the other in the map's image.
  const std::string texel =
      fmt::format("texel ({}, {}) of the cube's face", tap.texel.x, tap.texel.y % section.map_size.x);
  EXPECT_NE(report::section_words(section)[0].find(texel), std::string::npos) << report::section_words(section)[0];
}

// Each ring of the drawing has a line in the legend, also of a cause that is not the pixel's.
TEST(SectionPicture, ExplainsTheRingsOfAllCauses) {
  ReceiverSection section;
  SectionTap tap;
  tap.reference_m = 8;
  tap.compared_m = tap.exact_m = tap.stored_m = 7.99;
  section.taps.assign(4, tap);
  section.taps[1].cause = Cause::acne;
  section.taps[2].cause = Cause::aliasing_light;
  section.taps[3].cause = Cause::acne;
  section.cause = Cause::filter;
  section.reach = 2;
  section.texel_m = 0.01;
  section.reference_m = section.receiver_m = 8;
  const std::string drawn = report::section_svg(section, report::SectionTheme::light);
  const auto times = [&](const std::string& text) {
    size_t count = 0;
    for (size_t at = drawn.find(text); at != std::string::npos; at = drawn.find(text, at + 1)) ++count;
    return count;
  };
  EXPECT_EQ(times("a wrong tap: "), 2u);
  EXPECT_EQ(times("a wrong tap: Acne (too dark)"), 1u);
  EXPECT_EQ(times("a wrong tap: Aliasing, too light"), 1u);
  section.taps.assign(1, tap);
  EXPECT_EQ(report::section_svg(section, report::SectionTheme::light).find("a wrong tap"), std::string::npos);
}

// Who asks for a cause gets that cause explained, also where another makes the larger part of the pixel's error.
TEST(SectionWords, AreAboutTheCauseThatIsAskedFor) {
  Workbench bench(gl::DebugMode::fatal);
  const Measurement m = bench.measure(
      with({{"map.fit", "view"}, {"filter.kind", "box"}, {"bias.constant", "0.001"}}, small("facade", 320, 180)),
      std::nullopt);
  int explained = 0;
  for (int y = 0; y < 180 && explained < 3; ++y)
    for (int x = 0; x < 320 && explained < 3; ++x) {
      const size_t i = m.ladder.truth().index(x, y);
      if (m.ladder.cause[i] != static_cast<uint8_t>(Cause::filter) || !(m.ladder[Cause::peter_panning][i] != 0))
        continue;
      ReceiverSection section = bench.sections(m, std::array{glm::ivec2(x, y)}).front();
      explain(section, Cause::acne);  // no tap has it
      ASSERT_EQ(report::section_title(section), "Filter (blur by design)");
      explain(section, Cause::peter_panning);
      EXPECT_EQ(section.taps[section.key_tap].cause, Cause::peter_panning);
      EXPECT_EQ(report::section_title(section), "Peter Panning (too light)");
      EXPECT_EQ(report::section_words(section).back(),
                "The largest part of this pixel's error is another: Filter (blur by design).");
      ++explained;
    }
  EXPECT_EQ(explained, 3);
}

// For a paper the colours are written out; for a screen the reader's scheme decides.
TEST(SectionPicture, HasTheColoursOfItsTheme) {
  Workbench bench(gl::DebugMode::fatal);
  const Measurement m = bench.measure(small("plane", 96, 54), std::nullopt);
  const ReceiverSection section = bench.sections(m, std::array{middle_of(m)}).front();
  const std::string screen = report::section_svg(section, report::SectionTheme::automatic),
                    light = report::section_svg(section, report::SectionTheme::light),
                    dark = report::section_svg(section, report::SectionTheme::dark);
  EXPECT_NE(screen.find("prefers-color-scheme:dark"), std::string::npos);
  EXPECT_NE(screen.find("var(--ink)"), std::string::npos);
  for (const std::string& fixed : {light, dark}) {
    EXPECT_EQ(fixed.find("var("), std::string::npos);
    EXPECT_EQ(fixed.find("prefers-color-scheme"), std::string::npos);
  }
  EXPECT_NE(light, dark);
  for (const std::string& any : {screen, light, dark}) {
    EXPECT_EQ(any.find("<script"), std::string::npos);
    EXPECT_EQ(any.find("nan"), std::string::npos);
    EXPECT_TRUE(any.starts_with("<svg xmlns=")) << any.substr(0, 40);
  }
}

}  // namespace
}  // namespace noonmark::acceptance
