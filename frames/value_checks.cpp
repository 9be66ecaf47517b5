// The checks of the frame's values: whether they are visibility, and whether they are the pixels' own.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_map>
#include <vector>

#include "frames/check_outcome.h"
#include "frames/value_curve.h"

namespace noonmark {
namespace {

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

// What one mistake makes of the values is one failure: the checks below it are not made. A wide filter over much acne over coarse
// texels leaves light and shadow far from 0 and 1, with either the brighter one.
bool is_inverted(const FrameStatistics& s) {
  constexpr double clearly = 0.6;
  return s.deep_dark.count >= enough && s.deep_lit.count >= enough && s.deep_dark.median > 0.5 &&
         s.deep_lit.median < 0.5 && s.deep_dark.median - s.deep_lit.median > clearly;
}
constexpr const char* because_inverted = "light and shadow are exchanged";

// Hardly a pixel that the light reaches has the value 1.
bool is_darkened(const FrameStatistics& s) {
  return s.deep_lit.count >= enough && s.deep_lit.high < 0.995 && s.deep_lit.median < 0.95;
}
// Lookups make at most a tenth of the pixels as bright as a function of N.L.
bool is_shaded(const FrameStatistics& s) {
  return is_darkened(s) && (s.shading.explained >= 0.4 || s.shading.is_one_value);
}

// Values that are the same at every distance of the occluder: an exponential map would leak by e^(-c d), which differs by 0.01
// and more where one distance is 1.25 times another.
constexpr double one_value = 0.01, distances_apart = 1.25;
struct Evenness {
  size_t told = 0, even = 0;
};
struct Shadowed {
  float value, nearest, first;  // the distances to the nearest occluder, and to the first that the light meets
};

double at_share(const std::vector<Shadowed>& pixels, double share, float Shadowed::*what) {
  std::vector<double> values;
  for (const Shadowed& pixel : pixels) values.push_back(pixel.*what);
  return quantile(std::move(values), share);
}

// Between the 5th and the 95th percentile. A map holds the first occluder, or with front faces culled another one.
bool are_apart(const std::vector<Shadowed>& pixels) {
  for (float Shadowed::*const what : {&Shadowed::nearest, &Shadowed::first})
    if (!(at_share(pixels, 0.95, what) >= distances_apart * at_share(pixels, 0.05, what))) return false;
  return true;
}

// Three quarters have the lowest value. The others are brighter: an edge's filter reaches further there, or a bias loses the
// shadow.
bool is_even(std::vector<Shadowed> pixels) {
  const double low = at_share(pixels, 0.05, &Shadowed::value);
  const size_t all = pixels.size();
  pixels.erase(
      std::remove_if(pixels.begin(), pixels.end(), [&](const Shadowed& p) { return p.value > low + one_value; }),
      pixels.end());
  return pixels.size() * 4 >= all * 3 && are_apart(pixels);
}

// Of the pixels deep in true shadow, those of surfaces on which occluders of several distances cast it, and those of them
// where the surface has one value all the same. Ambient light has a value of its own on each triangle, an intensity one on all.
Evenness evenness_in_shadow(const CheckEvidence& e, const FrameStatistics& s) {
  constexpr size_t least = 32;
  Image<uint8_t> mask(s.deep.width, s.deep.height, 0);
  for (size_t i = 0; i < mask.size(); ++i) mask[i] = s.deep[i] == 1;
  const Image<float> nearest = e.tracer.occluder_distance(e.receivers, e.light, mask);
  const Image<uint32_t> first = e.tracer.first_on_the_way(e.receivers, e.light, mask);
  std::vector<Shadowed> whole;
  std::unordered_map<uint32_t, std::vector<Shadowed>> triangles;
  for (size_t i = 0; i < mask.size(); ++i) {
    if (!mask[i] || !std::isfinite(nearest[i]) || first[i] == no_primitive) continue;
    const glm::dvec3 p = e.receivers.position[i];
    const double distance = way_to_plane(e.scene, first[i], p, e.light.direction_to_light(p));
    if (!std::isfinite(distance)) continue;  // the light grazes it
    whole.push_back({e.frame.visibility[i], nearest[i], static_cast<float>(distance)});
    triangles[e.receivers.primitive[i]].push_back(whole.back());
  }
  if (whole.size() >= enough && is_even(whole)) return {whole.size(), whole.size()};
  Evenness found;
  for (const auto& [primitive, pixels] : triangles) {
    if (pixels.size() < least || !are_apart(pixels)) continue;
    found.told += pixels.size();
    if (is_even(pixels)) found.even += pixels.size();
  }
  return found;
}

// Whether the value is k / n of the n taps that make the frame's levels, which are those of a square: a column of them that reaches
// over a thin occluder lights all of its shadow alike. With an intensity of 1/2 the levels of 9 taps are
// of 18, and with those of cut filters beside them of 36.
bool is_of_square_filter(const CurveEvidence& curve, double value) {
  if (curve.by_levels() != value_curves.data()) return false;
  const int taps = curve.fits[0].taps, side = static_cast<int>(std::lround(std::sqrt(taps)));
  return side <= 7 && side != 6 && side * side == taps && std::abs(value * taps - std::round(value * taps)) < 0.02;
}

}  // namespace

Outcome check_values(const CheckEvidence& e, const FrameStatistics&) {
  size_t outside = 0, not_judged = 0;
  for (const uint8_t mark : e.frame.not_judged.pixels) not_judged += mark;
  int x = 0, y = 0;
  float value = 0;
  const Image<float>& v = e.frame.visibility;
  size_t shown = 0;
  for (size_t i = 0; i < v.size(); ++i) {
    shown += !std::isnan(v[i]);
    if (std::isnan(v[i]) || (v[i] >= -rounding_of_sums && v[i] <= 1 + rounding_of_sums)) continue;
    if (outside++ == 0) {
      const auto width = static_cast<size_t>(v.width);
      x = static_cast<int>(i % width), y = static_cast<int>(i / width), value = v[i];
    }
  }
  if (shown == 0)
    return failed(
        "no pixel has a visibility: every one is -1, -2, NaN or has alpha 0; write 1 where light reaches and 0 in "
        "shadow",
        "no pixel has a visibility");
  if (outside == 0)
    return passed("every value is in [0,1] or says that there is no surface" +
                  (not_judged ? fmt::format("; {} pixels show a surface that is not judged (-2)", not_judged) : ""));
  if (value < 0 && value > -2)
    return failed(
        fmt::format("{} values are outside [0,1]; the first is {} at x = {}, y = {}: -1 (no surface) or -2 (a surface "
                    "that is not judged) was mixed with a visibility, as "
                    "by multisampling that was resolved, or by scaling; write one sample at each pixel's centre",
                    outside, value, x, y));
  return failed(
      fmt::format("{} values are outside [0,1]; the first is {} at x = {}, y = {}; write visibility, from 0 "
                  "(shadowed) to 1 (lit), and -1 or NaN where there is no surface, -2 at a surface that is not judged",
                  outside, value, x, y));
}

// Of all pixels, not only those deep inside: hardly a lit one is lit in the frame, and hardly a shadowed one is dark. Acne
// leaves the shadowed ones dark, and a lost shadow leaves the lit ones lit.
bool is_exchanged(const CheckEvidence& e) {
  double value[2] = {};
  size_t count[2] = {};
  for (size_t i = 0; i < e.counted.size(); ++i) {
    if (!e.counted[i]) continue;
    value[e.truth.lit[i]] += e.frame.visibility[i];
    ++count[e.truth.lit[i]];
  }
  return count[0] >= enough && count[1] >= enough && value[0] > 0.9 * static_cast<double>(count[0]) &&
         value[1] < 0.1 * static_cast<double>(count[1]);
}

Outcome check_inverted(const CheckEvidence& e, const FrameStatistics& s) {
  constexpr const char* mend = "light and shadow are exchanged; write 1 where the light reaches";
  if (is_inverted(s)) return failed(fmt::format("{}: {}", deep_text(s), mend));
  if (const std::string why = too_few(s.deep_lit.count, s.deep_dark.count); !why.empty())
    return is_exchanged(e)
               ? failed(fmt::format("nearly all lit pixels are dark, and nearly all shadowed ones lit: {}", mend))
               : not_checked(why);
  return passed(deep_text(s));
}

Outcome check_shaded(const CheckEvidence&, const FrameStatistics& s) {
  if (const std::string why = too_few(s.deep_lit.count, enough); !why.empty()) return not_checked(why);
  if (is_inverted(s)) return not_checked(because_inverted);
  if (!is_darkened(s))
    return passed(fmt::format("deep in true light 5% of the pixels are at {:.3f} or more", s.deep_lit.high));
  const std::string found =
      fmt::format("deep in true light hardly a pixel reaches 1 (95% are below {:.3f}, the median is {:.3f})",
                  s.deep_lit.high, s.deep_lit.median);
  if (is_shaded(s))
    return failed(fmt::format(
        "{}, and {}: this is a shaded frame or one with ambient light, not the visibility of the light", found,
        s.shading.explained > 0
            ? fmt::format("{:.0f}% of them are as bright as a function of N.L says", 100 * s.shading.explained)
            : "they have one value that no filter's taps make"));
  return not_checked(found +
                     ", but N.L does not explain that: it is acne, or shading with textures, and the values "
                     "alone do not tell which");
}

Outcome check_intensity(const CheckEvidence& e, const FrameStatistics& s) {
  if (const std::string why = too_few(enough, s.deep_dark.count); !why.empty()) return not_checked(why);
  if (is_inverted(s)) return not_checked(because_inverted);
  if (is_shaded(s)) return not_checked("the frame is shaded");
  if (s.deep_dark.low <= 0.02 || s.deep_dark.median >= 0.95)
    return passed(fmt::format("deep in true shadow 5% of the pixels are at {:.3f} or less", s.deep_dark.low));
  const std::string found =
      fmt::format("deep in true shadow hardly a pixel is 0 (95% are above {:.3f}, the median is {:.3f})",
                  s.deep_dark.low, s.deep_dark.median);
  // An intensity, or light that was added, leaves no shadow darker. A filter's tap that leaks does.
  size_t shadowed = 0, darker = 0;
  for (size_t i = 0; i < e.counted.size(); ++i) {
    if (!e.counted[i] || e.truth.lit[i]) continue;
    ++shadowed;
    darker += e.frame.visibility[i] < s.deep_dark.median - one_value;
  }
  const Evenness here = is_of_square_filter(s.curve, s.deep_dark.median) || 100 * darker > shadowed
                            ? Evenness{enough, 0}
                            : evenness_in_shadow(e, s);
  if (here.told >= enough && here.even * 10 >= here.told * 9)
    return failed(
        fmt::format("{}, and it is the same at every distance of the occluder: the shadow's intensity is below "
                    "1, or light was added; write the visibility alone",
                    found));
  if (here.told < enough)
    return not_checked(found +
                       ": the shadow's intensity is below 1, or light was added, or a filtered map leaks; too few "
                       "pixels have occluders at different distances to tell which");
  return not_checked(found + ", and it differs by place: a filtered map leaks so; an intensity below 1 is one value");
}

// What faces away from the declared light cannot be lit by it. If most of the picture faces away and is lit, the light's direction or
// the side that the camera looks at may be turned round. Then the surfaces that the declared light reaches are dark in the frame. If
// they are not, a shader wrote 1 wherever N.L is below 0, which is no fault.
Outcome check_match(const CheckEvidence& e, const FrameStatistics& s) {
  size_t surfaces = 0, away = 0, away_lit = 0, reached = 0, reached_dark = 0;
  for (size_t i = 0; i < e.seen.size(); ++i) {
    const float value = e.frame.visibility[i];
    if (e.seen[i] == no_primitive || std::isnan(value)) continue;
    ++surfaces;
    away += !e.truth.facing[i];
    away_lit += !e.truth.facing[i] && value > 0.98f;
    if (!e.counted[i] || !e.truth.lit[i]) continue;
    ++reached;
    reached_dark += value < 0.5f;
  }
  if (2 * away > surfaces && 10 * away_lit > 9 * away) {
    const std::string found = fmt::format(
        "{} of {} surfaces face away from the declared light, and the frame lights {} of them: the light's direction "
        "is turned round, or the camera's 'reversed' is wrong",
        away, surfaces, away_lit);
    if (reached < enough) return not_checked(found + ", or the shader writes 1 where N.L is below 0");
    if (reached_dark * 10 >= reached * 9) return failed(found);
  }
  if (const std::string why = too_few(s.deep_lit.count, s.deep_dark.count); !why.empty()) return not_checked(why);
  if (is_inverted(s)) return not_checked(because_inverted);
  if (s.deep_dark.median < 0.95 || s.deep_lit.median <= 0.5) return passed(deep_text(s));
  // A bias or a format that loses shadows makes none elsewhere. Acne darkens, but leaves no such region whole.
  if (s.shadow_elsewhere >= enough && 10 * s.shadow_elsewhere >= s.deep_dark.count)
    return failed(
        fmt::format("{}: most of the true shadow is lit, and {} pixels deep in true light lie inside shadows of the "
                    "frame: the light or the scene is another one",
                    deep_text(s), s.shadow_elsewhere));
  return not_checked(
      fmt::format("{}: most of the true shadow is lit, and the frame has no shadow elsewhere ({} pixels): "
                  "the renderer has lost its shadows, or draws none",
                  deep_text(s), s.shadow_elsewhere));
}

Outcome check_encoding(const CheckEvidence&, const FrameStatistics& s) {
  const CurveEvidence& found = s.curve;
  const auto of_curve = [&](const ValueCurve* curve) { return static_cast<size_t>(curve - value_curves.data()); };
  const auto wrong = [](const ValueCurve& curve) {
    return fmt::format("the values are encoded with {}; write them linear, or declare the encoding", curve.name);
  };
  if (const ValueCurve* const curve = found.by_levels()) {
    const int taps = found.fits[of_curve(curve)].taps;
    if (curve == value_curves.data())
      return passed(
          fmt::format("{} values that many pixels share are k / {}, as of a filter's taps", found.levels.size(), taps));
    return failed(fmt::format("{} values that many pixels share are no k / n, and decoded with {} they are k / {}: {}",
                              found.levels.size(), curve->name, taps, wrong(*curve)));
  }
  const auto ramps = [&](size_t curve) {
    return fmt::format("{:.0f}% of {} ramps of a blend are straight as they are, and {:.0f}% decoded with {}",
                       100 * found.straight[0], found.ramps, 100 * found.straight[curve], value_curves[curve].name);
  };
  if (const ValueCurve* const curve = found.by_ramps()) {
    if (curve == value_curves.data()) return passed(ramps(1));
    return failed(fmt::format("{}: {}", ramps(of_curve(curve)), wrong(*curve)));
  }
  return not_checked(
      fmt::format("{} values are shared by many pixels, and {} ramps of a blend were asked: neither tells "
                  "linear values from encoded ones",
                  found.levels.size(), found.ramps));
}

Outcome check_levels(const CheckEvidence& e, const FrameStatistics&) {
  std::set<float> different;
  for (const float value : e.frame.visibility.pixels)
    if (!std::isnan(value)) {
      different.insert(value);
      if (different.size() > 256) return passed("more than 256 different values");
    }
  return passed(fmt::format("{} different values{}", different.size(),
                            different.size() > 16 ? ": with 8 bits a value is known to 0.002" : ""));
}

}  // namespace noonmark
