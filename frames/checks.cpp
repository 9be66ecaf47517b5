#include "frames/checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "base/error.h"
#include "base/suggestion.h"
#include "frames/check_outcome.h"

namespace noonmark {
namespace {

// ---- values

Outcome values(const CheckEvidence& e, const FrameStatistics&) {
  size_t outside = 0;
  int x = 0, y = 0;
  float value = 0;
  const Image<float>& v = e.frame.visibility;
  size_t shown = 0;
  for (size_t i = 0; i < v.size(); ++i) {
    shown += !std::isnan(v[i]);
    if (std::isnan(v[i]) || (v[i] >= 0 && v[i] <= 1)) continue;
    if (outside++ == 0) {
      const auto width = static_cast<size_t>(v.width);
      x = static_cast<int>(i % width), y = static_cast<int>(i / width), value = v[i];
    }
  }
  if (shown == 0)
    return failed(
        "no pixel has a visibility: every one is -1, NaN or has alpha 0; write 1 where light reaches and 0 in shadow",
        "no pixel has a visibility");
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

// ---- the values deep inside lit and shadowed regions, and beside the shadows' edges

// Empty if the picture has enough pixels deep in true light and in true shadow.
std::string too_few(size_t lit, size_t dark) {
  if (lit >= enough && dark >= enough) return "";
  return fmt::format("{} pixels are deep in true {}, and {} are needed", std::min(lit, dark),
                     lit < dark ? "light" : "shadow", enough);
}

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
  if (const std::string why = too_few(s.deep_lit.count, s.deep_dark.count); !why.empty()) return not_checked(why);
  if (is_inverted(s))
    return failed(fmt::format("{}: light and shadow are exchanged; write 1 where the light reaches", deep_text(s)));
  return passed(deep_text(s));
}

Outcome shaded(const CheckEvidence&, const FrameStatistics& s) {
  if (const std::string why = too_few(s.deep_lit.count, enough); !why.empty()) return not_checked(why);
  if (is_inverted(s)) return not_checked(because_inverted);
  if (is_shaded(s))
    return failed(
        fmt::format("deep in true light hardly a pixel reaches 1 (95% are below {:.3f}, the median is {:.3f}): this "
                    "is a shaded frame or one with ambient light, not the visibility of the light",
                    s.deep_lit.high, s.deep_lit.median));
  return passed(fmt::format("deep in true light 5% of the pixels are at {:.3f} or more", s.deep_lit.high));
}

Outcome intensity(const CheckEvidence&, const FrameStatistics& s) {
  if (const std::string why = too_few(enough, s.deep_dark.count); !why.empty()) return not_checked(why);
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
  if (const std::string why = too_few(s.deep_lit.count, s.deep_dark.count); !why.empty()) return not_checked(why);
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
    return not_checked(
        fmt::format("{} pixels are between lit and shadowed beside the shadows' edges, and {} are needed",
                    s.filtered.count, enough));
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
  if (s.filtered.mean > 0.535)
    return not_checked(found +
                       ": linear values have at most 0.532, those of a narrow filter as sRGB at least 0.50, so this "
                       "cannot tell them");
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
  bool reads_places = true;  // of the pixels: one of a picture in another place says nothing
};
constexpr std::array<Row, 11> check_rows{{
    {{"values", "Every value is in [0,1], or says that there is no surface."}, values},
    {{"positions", "Given positions are 32-bit floats, lie on the scene, and project to their own pixels."},
     check_positions,
     false},
    {{"alignment", "The visibility lies on its own receivers: the picture is not flipped, and not shifted by a pixel."},
     check_alignment},
    {{"coverage", "The pixels with a surface are those of the scene through the frame's camera."}, check_coverage},
    {{"inverted", "1 is lit and 0 is shadowed."}, inverted},
    {{"shaded", "The values are the light's visibility, not a shaded frame."}, shaded},
    {{"intensity", "Shadows are 0: their intensity is 1 and no light was added."}, intensity},
    {{"match", "Most of the true shadow is in shadow: scene and light are the frame's."}, match},
    {{"encoding", "The values are linear, not sRGB."}, encoding},
    {{"levels", "How many different values there are; it fails nothing."}, levels, false},
    {{map_check, "A shadow map that is handed over holds the scene's depths, seen from its light."}, map, false},
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
  std::string_view spoilt;
  for (const Row& row : check_rows) {
    Outcome outcome =
        row.reads_places && !spoilt.empty() ? not_checked(std::string(spoilt)) : row.run(evidence, statistics);
    if (spoilt.empty()) spoilt = outcome.spoils;
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
