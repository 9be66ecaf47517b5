#include "frames/checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "base/error.h"
#include "base/suggestion.h"
#include "frames/check_statistics.h"

namespace noonmark {
namespace {

struct Outcome {
  CheckState state = CheckState::passed;
  std::string says;
};
Outcome passed(std::string says) { return {CheckState::passed, std::move(says)}; }
Outcome failed(std::string says) { return {CheckState::failed, std::move(says)}; }
Outcome not_checked(std::string why) { return {CheckState::not_checked, std::move(why)}; }

// ---- values

Outcome values(const CheckEvidence& e, const FrameStatistics&) {
  size_t outside = 0;
  int x = 0, y = 0;
  float value = 0;
  const Image<float>& v = e.frame.visibility;
  for (size_t i = 0; i < v.size(); ++i) {
    if (std::isnan(v[i]) || (v[i] >= 0 && v[i] <= 1)) continue;
    if (outside++ == 0) {
      const auto width = static_cast<size_t>(v.width);
      x = static_cast<int>(i % width), y = static_cast<int>(i / width), value = v[i];
    }
  }
  if (outside == 0) return passed("every value is in [0,1] or says that there is no surface");
  if (value < 0 && value > -1)
    return failed(
        fmt::format("{} values are outside [0,1]; the first is {:g} at x = {}, y = {}: -1 (no surface) was mixed with "
                    "a visibility, as "
                    "by multisampling that was resolved, or by scaling; write one sample at each pixel's centre",
                    outside, value, x, y));
  return failed(
      fmt::format("{} values are outside [0,1]; the first is {:g} at x = {}, y = {}; write visibility, from 0 "
                  "(shadowed) to 1 (lit), and -1 or NaN where there is no surface",
                  outside, value, x, y));
}

// ---- positions

// The largest share of receivers of given positions that may project outside their own pixel, or lie off the scene.
constexpr double most_stray = 0.01;

Outcome positions(const CheckEvidence& e, const FrameStatistics&) {
  if (e.frame.receivers == GivenReceivers::none)
    return not_checked(
        "no positions or depths were given: the receivers are those of rays through the pixels' centres");
  const int width = e.frame.visibility.width, height = e.frame.visibility.height;
  std::vector<double> off_x, off_y, off, moved, size;
  size_t half = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const size_t i = e.moved_m.index(x, y);
      const glm::dvec3 p = e.frame.positions[i];
      if (!std::isfinite(p.x)) continue;
      const glm::dvec3 at = e.frame.view.pixel_of(p, width, height);
      off_x.push_back(at.x - (x + 0.5));
      off_y.push_back(at.y - (y + 0.5));
      off.push_back(std::hypot(off_x.back(), off_y.back()));
      moved.push_back(e.moved_m[i]);
      size.push_back(glm::length(p));
      half += is_half(p.x) && is_half(p.y) && is_half(p.z);
    }
  if (moved.empty()) return failed("no pixel has a position; write the world position of every pixel with a surface");
  const auto count = static_cast<double>(moved.size());
  const double median_size = quantile(size, 0.5), median_moved = quantile(moved, 0.5);
  // A half float has 11 bits. Positions that are halves by chance, as on a grid of powers of two, have no rounding that moves
  // them in the picture.
  if (e.frame.receivers == GivenReceivers::positions && static_cast<double>(half) == count &&
      quantile(off, 0.95) > 0.01)
    return failed(
        fmt::format("every position is a half float, which puts one of twenty more than {:.2g} pixels beside its "
                    "place: write the positions as 32-bit floats",
                    quantile(off, 0.95)));
  const double dx = quantile(off_x, 0.5), dy = quantile(off_y, 0.5);
  if (std::hypot(dx, dy) > 0.1)
    return failed(
        fmt::format("half of the positions lie more than ({:+.2f}, {:+.2f}) pixels (x to the right, y down) from "
                    "the centre of their pixel: the camera is another one, or the picture is shifted, flipped or "
                    "jittered",
                    dx, dy));
  const double stray = static_cast<double>(std::count_if(moved.begin(), moved.end(),
                                                         [&](double m) { return m > 0x1p-12 * median_size; })) /
                       count;
  if (stray > most_stray)
    return failed(
        fmt::format("{:.1f}% of the positions lie off the scene, half of all by more than {:.2g} m: the scene, its "
                    "pose, its unit or its axes are others",
                    100 * stray, median_moved));
  return passed(
      fmt::format("positions lie on the scene (half of them within {:.1g} m) and in their own pixels (off by "
                  "({:+.3f}, {:+.3f}) in the median)",
                  median_moved, dx, dy));
}

// ---- coverage

// Good frames of five renderers differ by 0.3% to 1% of the pixels on the scene's outline, frames that are half a pixel
// off by 16% and more.
constexpr double most_of_outline = 0.05;

Outcome coverage(const CheckEvidence& e, const FrameStatistics&) {
  if (!e.frame.marks_no_surface)
    return not_checked(
        "no pixel says that it has no surface (-1, NaN, or alpha 0): a wrong camera or a shift of the picture "
        "cannot be seen here");
  const Coverage of_frame = coverage_of_frame(e.frame), of_scene = coverage_of(e.seen);
  const size_t outline = outline_pixels(of_scene);
  const size_t differ = differing(of_frame, of_scene);
  if (static_cast<double>(differ) <= most_of_outline * static_cast<double>(outline) + 8)
    return passed(
        fmt::format("{} of {} pixels have a surface in the frame or in the scene alone; its outline has {} pixels",
                    differ, of_scene.size(), outline));
  const std::string found = fmt::format(
      "{} of {} pixels have a surface in the frame or in the scene alone, and the scene's outline has {} pixels",
      differ, of_scene.size(), outline);
  // The flip that explains most must explain nine tenths. A shift must explain three tenths: the row that it brings in at
  // the border of the picture stays.
  size_t least = differ;
  const char* flip = "";
  for (const auto& [flip_x, flip_y, says] : {std::tuple{true, false, "flipped left to right"},
                                             {false, true, "flipped upside down"},
                                             {true, true, "turned by 180 degrees"}})
    if (const size_t left = differing(flipped(of_frame, flip_x, flip_y), of_scene); left < least) {
      least = left;
      flip = says;
    }
  if (least * 10 < differ) return failed(fmt::format("{}: the picture is {}", found, flip));
  const Shift shift = best_shift(e.tracer, e.frame.view, of_frame, of_scene);
  if (shift.differing * 10 < differ * 7 && shift.pixels != glm::dvec2(0)) {
    const bool halves = shift.pixels.x != std::round(shift.pixels.x) || shift.pixels.y != std::round(shift.pixels.y);
    return failed(fmt::format(
        "{}: a shift of ({:+g}, {:+g}) pixels (x to the right, y down) leaves {} of them, so {}", found, shift.pixels.x,
        shift.pixels.y, shift.differing,
        halves ? "it is one of these two: samples are not at the pixels' centres, or multisampling was resolved"
               : "rows or columns are missing or doubled"));
  }
  const size_t lost = lost_surfaces(of_frame, of_scene);
  if (lost * 10 > differ * 9)
    return failed(
        fmt::format("{}, nearly all of them where only the scene has one: multisampling was resolved, or surfaces "
                    "of the scene are not in the frame",
                    found));
  return failed(fmt::format(
      "{}, and no flip or shift of up to a pixel explains them: the camera or the scene is another one", found));
}

// ---- the values deep inside lit and shadowed regions, and beside the shadows' edges

// A region is judged by at least so many pixels.
constexpr size_t enough = 100;

std::string deep_text(const FrameStatistics& s) {
  return fmt::format("deep in true shadow the median is {:.3f}, deep in true light {:.3f}", s.deep_dark.median,
                     s.deep_lit.median);
}

// What one mistake makes of the values is one failure: the checks below it are not made.
bool is_inverted(const FrameStatistics& s) {
  return s.deep_dark.count >= enough && s.deep_lit.count >= enough && s.deep_dark.median > 0.5 &&
         s.deep_lit.median < 0.5;
}
// Measured deep in true light: frames of five engines, with acne or without, 0.065 to 0.87; such a frame times N.L, 0.005 to
// 0.09. Acne makes every surface darker too, but it changes from pixel to pixel.
constexpr double most_smooth = 0.6;
bool is_shaded(const FrameStatistics& s) {
  return s.deep_lit.count >= enough && s.deep_lit.high < 0.995 && s.deep_lit.median < 0.95 &&
         s.deep_lit_roughness < most_smooth;
}
constexpr const char* because_inverted = "light and shadow are exchanged";

Outcome inverted(const CheckEvidence&, const FrameStatistics& s) {
  if (s.deep_dark.count < enough || s.deep_lit.count < enough)
    return not_checked("the picture has too few pixels deep in true light, or deep in true shadow");
  if (is_inverted(s))
    return failed(fmt::format("{}: light and shadow are exchanged; write 1 where the light reaches", deep_text(s)));
  return passed(deep_text(s));
}

Outcome shaded(const CheckEvidence&, const FrameStatistics& s) {
  if (s.deep_lit.count < enough) return not_checked("the picture has too few pixels deep in true light");
  if (is_inverted(s)) return not_checked(because_inverted);
  if (is_shaded(s))
    return failed(
        fmt::format("deep in true light hardly a pixel reaches 1 (95% are below {:.3f}, the median is {:.3f}): this "
                    "is a shaded frame or one with ambient light, not the visibility of the light",
                    s.deep_lit.high, s.deep_lit.median));
  return passed(fmt::format("deep in true light 5% of the pixels are at {:.3f} or more", s.deep_lit.high));
}

Outcome intensity(const CheckEvidence&, const FrameStatistics& s) {
  if (s.deep_dark.count < enough) return not_checked("the picture has too few pixels deep in true shadow");
  if (is_inverted(s)) return not_checked(because_inverted);
  if (is_shaded(s)) return not_checked("the frame is shaded");
  if (s.deep_dark.low > 0.02 && s.deep_dark.median < 0.95)
    return failed(
        fmt::format("deep in true shadow hardly a pixel is 0 (95% are above {:.3f}, the median is {:.3f}): the "
                    "shadow's intensity is below 1, or light was added; write the visibility alone",
                    s.deep_dark.low, s.deep_dark.median));
  return passed(fmt::format("deep in true shadow 5% of the pixels are at {:.3f} or less", s.deep_dark.low));
}

// What faces away from the declared light cannot be lit by it. If most of the picture does and is lit, the light's direction or
// the side that the camera looks at is turned round.
Outcome match(const CheckEvidence& e, const FrameStatistics& s) {
  size_t surfaces = 0, away = 0, away_lit = 0;
  for (size_t i = 0; i < e.seen.size(); ++i) {
    const float value = e.frame.visibility[i];
    if (e.seen[i] == no_primitive || std::isnan(value)) continue;
    ++surfaces;
    away += !e.truth.facing[i];
    away_lit += !e.truth.facing[i] && value > 0.98f;
  }
  if (2 * away > surfaces && 10 * away_lit > 9 * away)
    return failed(
        fmt::format("{} of {} surfaces face away from the declared light, and the frame lights {} of them: the light's "
                    "direction is "
                    "turned round, or the camera's 'reversed' is wrong",
                    away, surfaces, away_lit));
  if (s.deep_dark.count < enough) return not_checked("the picture has too few pixels deep in true shadow");
  if (is_inverted(s)) return not_checked(because_inverted);
  if (s.deep_dark.median >= 0.95 && s.deep_lit.median > 0.5)
    return failed(
        fmt::format("{}: most of the true shadow is lit, so the light, the scene or the camera is another one, or "
                    "the frame has no shadows",
                    deep_text(s)));
  return passed(deep_text(s));
}

Outcome encoding(const CheckEvidence&, const FrameStatistics& s) {
  if (s.filtered.count < enough)
    return not_checked("the picture has too few pixels between lit and shadowed beside the shadows' edges");
  // Acne has values of its own between 0 and 1.
  if (s.deep_lit_between > 0.01)
    return not_checked(
        fmt::format("{:.1f}% of the pixels deep in true light are between lit and shadowed, so what is beside "
                    "the edges is not the filter's alone",
                    100 * s.deep_lit_between));
  // A filter goes over an edge as long below one half as above it, wherever the bias moved the edge. sRGB's transfer function
  // lifts all values. Measured: linear frames of five engines 0.457 to 0.532; the same as sRGB 0.50 to 0.70, above 0.57
  // where the filter is wider than two pixels.
  const std::string found =
      fmt::format("beside the shadows' edges the values between {:g} and {:g} have the mean {:.3f}",
                  FrameStatistics::between_low, FrameStatistics::between_high, s.filtered.mean);
  if (s.filtered.mean > 0.57)
    return failed(found +
                  ", and a filter's are symmetric about one half: the values are encoded as sRGB; write them "
                  "linear, or declare the encoding");
  return passed(found);
}

Outcome levels(const CheckEvidence& e, const FrameStatistics&) {
  std::set<float> different;
  for (const float value : e.frame.visibility.pixels)
    if (!std::isnan(value)) {
      different.insert(value);
      if (different.size() > 256) return passed("more than 256 different values");
    }
  return passed(fmt::format("{} different values{}", different.size(),
                            different.size() > 16 ? ": with 8 bits a value is known to 0.002" : ""));
}

// ---- map

// The largest median distance of a map's depths from the scene's, as a share of the depths' spread. Half floats are off by
// 0.0005 at most; a map that is turned over, or another frame's, is off by a tenth and more.
constexpr double most_map_off = 0.02;

Outcome map(const CheckEvidence& e, const FrameStatistics&) {
  return not_checked(e.frame.map ? "the map is not looked at before the other checks have passed"
                                 : "no shadow map was handed over");
}

struct Row : FrameCheck {
  Outcome (*run)(const CheckEvidence&, const FrameStatistics&);
};
constexpr std::array<Row, 10> check_rows{{
    {{"values", "Every value is in [0,1], or says that there is no surface."}, values},
    {{"positions", "Given positions are 32-bit floats, lie on the scene, and project to their own pixels."}, positions},
    {{"coverage", "The pixels with a surface are those of the scene through the frame's camera."}, coverage},
    {{"inverted", "1 is lit and 0 is shadowed."}, inverted},
    {{"shaded", "The values are the light's visibility, not a shaded frame."}, shaded},
    {{"intensity", "Shadows are 0: their intensity is 1 and no light was added."}, intensity},
    {{"match", "Most of the true shadow is in shadow: scene and light are the frame's."}, match},
    {{"encoding", "The values are linear, not sRGB."}, encoding},
    {{"levels", "How many different values there are; it fails nothing."}, levels},
    {{map_check, "A shadow map that is handed over holds the scene's depths, seen from its light."}, map},
}};

}  // namespace

std::span<const FrameCheck> frame_checks() {
  static const std::vector<FrameCheck> checks(check_rows.begin(), check_rows.end());
  return checks;
}

void require_check(std::string_view name) {
  std::vector<std::string_view> names;
  for (const Row& row : check_rows) names.push_back(row.name);
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  throw Error(ErrorKind::usage, fmt::format("there is no check '{}'{}; there are {}", name, did_you_mean(name, names),
                                            fmt::join(names, ", ")));
}

std::vector<CheckResult> check_frame(const CheckEvidence& evidence) {
  const FrameStatistics statistics = frame_statistics(evidence.frame, evidence.truth, evidence.counted);
  std::vector<CheckResult> results;
  for (const Row& row : check_rows) {
    Outcome outcome = row.run(evidence, statistics);
    results.push_back({row.name, outcome.state, std::move(outcome.says), false});
  }
  return results;
}

CheckResult check_given_map(double off_m, double spread_m) {
  const std::string found = fmt::format(
      "half of the texels that are read are within {:.3g} m of the scene, of depths that spread over {:.3g} m", off_m,
      spread_m);
  if (off_m <= most_map_off * spread_m) return {map_check, CheckState::passed, found};
  return {map_check, CheckState::failed,
          found + ": the map is another one, or it is turned over; check 'first_row', 'y', 'reversed' and the matrix"};
}

}  // namespace noonmark
