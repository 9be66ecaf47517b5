#include "app/sweep/frame_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "compare/judge/curve_reading.h"
#include "compare/judge/undecided.h"
#include "compare/results/metrics.h"
#include "compare/results/quantities.h"
#include "frames/alignment.h"
#include "frames/map_frame.h"
#include "technique/depth_format.h"
#include "technique/setting_rules.h"

namespace noonmark {
namespace {

// Of a declared lookup that is the frame's, the share of receivers that rounding does not explain is 0 for our own frames.
constexpr double most_beyond_rounding = 0.001;
// three.js's interpolated normals make 0.7% of 6.5% with a normal bias.
constexpr double least_unexplained = 0.002;

// A rasteriser moves vertices by up to 1/16 of a pixel, and SwiftShader what the near plane cuts by up to a quarter. Only given
// positions are where the renderer itself shaded.
constexpr float most_moved_pixels = 0.25f;

Settings settings_of(const GivenMap& map, const Light& light, const Image<float>& picture) {
  Settings settings;
  settings.map.format = DepthFormat::d32f;  // as the depths are handed over, unless the file says what was drawn
  for (const auto& [name, value] : map.technique) find_setting(name).set(settings, value);
  settings.view.width_px = picture.width;
  settings.view.height_px = picture.height;
  settings.map.resolution = map.depth.width;
  settings.map.aspect = static_cast<double>(map.depth.width) / map.depth.height;
  settings.light.kind = light.kind == LightKind::spot ? LightChoice::spot : LightChoice::directional;
  return settings;
}

Image<float> upside_down(const Image<float>& image) {
  Image<float> made(image.width, image.height);
  for (int y = 0; y < image.height; ++y) std::copy_n(&image.at(0, image.height - 1 - y), image.width, &made.at(0, y));
  return made;
}

// Where x, y and w of clip space are 0; of an orthographic camera a point far behind the near plane.
glm::dvec3 eye_of(const ViewMatrix& view, int width, int height) {
  const glm::dmat4& m = view.clip_from_world();
  const glm::dmat3 rows =
      glm::transpose(glm::dmat3(glm::dvec3(m[0][0], m[1][0], m[2][0]), glm::dvec3(m[0][1], m[1][1], m[2][1]),
                                glm::dvec3(m[0][3], m[1][3], m[2][3])));
  const glm::dvec3 eye = glm::inverse(rows) * -glm::dvec3(m[3][0], m[3][1], m[3][3]);
  if (std::isfinite(eye.x) && std::isfinite(eye.y) && std::isfinite(eye.z)) return eye;
  return view.pixel_ray(width / 2, height / 2, width, height).origin;
}

std::string apart_text(const GivenClimb& climbed) {
  return fmt::format("an exact map gives a picture that is {:.4f}% off the handed map's", 100 * climbed.maps_differ);
}

// A bias that the map holds and that is not declared makes two causes that cancel: the exact map lacks it, so R4 is off by it,
// and R5 is off by as much the other way. A large one makes the map look like another one. Empty: no such bias explains how the
// maps differ.
std::string undeclared_text(const GivenClimb& climbed, const Settings& declared, const GivenMap& given,
                            const LightFrame& frame) {
  const MapOffset& offset = climbed.offset;
  if (!offset.in_map() || !(climbed.precision_with_offset < climbed.maps_differ / 2)) return "";
  Settings with = declared;
  with.map.format = offset.format;
  std::string constant = fmt::format("\"bias.polygon_units\": {:.4g}, \"map.format\": \"{}\"",
                                     declared.bias["polygon_units"] + offset.constant / climbed.offset_unit,
                                     find_setting("map.format").get(with));
  // Units have this one size in a format that the depths contradict: the casters are moved along the light.
  if (frame.kind == LightKind::directional && offset.constant > 0 && !are_held_by(offset.format, given.depth.pixels)) {
    const double moved_m = offset.constant * (frame.far_m - frame.near_m),
                 unit_m = declared.bias.offset_unit == OffsetUnit::m ? 1 : frame.texel_m(frame.origin_m);
    constant = fmt::format("\"bias.caster_offset\": {:.4g}", declared.bias["caster_offset"] + moved_m / unit_m);
  }
  return fmt::format(
      "the map holds a bias that is not declared: {}, but {:.4f}% with a polygon offset in it; add to 'technique' "
      "{{\"bias.polygon_factor\": {:.4g}, {}}} (below 0: towards the light), or what the renderer moves its casters by "
      "(bias.caster_*)",
      apart_text(climbed), 100 * climbed.precision_with_offset, declared.bias["polygon_factor"] + offset.factor,
      constant);
}

// So does any other difference of the two maps that is larger than the frame's whole error. Then no cause says anything of the
// frame. Empty: there is none.
std::string cancelling_text(const GivenClimb& climbed, double frame_error) {
  if (!(climbed.maps_differ > frame_error)) return "";
  return fmt::format(
      "{}, which is more than the frame's whole error of {:.4f}%: causes cancel, so they say nothing of the frame; the "
      "casters are drawn otherwise than declared: check map.cull, a bias in the map (bias.polygon_*, bias.caster_*), "
      "near and far of the matrix",
      apart_text(climbed), 100 * frame_error);
}

// "bias.constant is 0.0011 depth; from 0.0019 to 0.0042 acne and Peter Panning are below 0.1% each"
std::string bias_text(const GivenClimb& climbed, const Settings& declared, const PointRecord& frame) {
  if (!climbed.curve) return "";
  const BiasCurve& curve = *climbed.curve;
  const auto in_unit = [&](double depth) { return fmt::format("{:.3g}", depth / climbed.depth_per_unit); };
  std::string says = fmt::format("{} is {} {}; ", curve.parameter, find_setting(curve.parameter).get(declared),
                                 find_setting("bias.unit").get(declared));
  if (hides_bounds(frame)) return says + "what is usable is " + std::string(window_not_known);
  if (!curve.window_min_depth) return says + "no value of it keeps both acne and Peter Panning below 0.1%";
  says += "from " + in_unit(*curve.window_min_depth);
  if (curve.window_max_depth) says += " to " + in_unit(*curve.window_max_depth);
  return says + " acne and Peter Panning are below 0.1% each";
}

// The technique of a file that cannot be is a mistake in the file.
Technique technique_of(const GivenMap& given, const Light& light, const Image<float>& picture,
                       const LightFrame& frame) {
  try {
    return Technique(settings_of(given, light, picture), frame);
  } catch (const SettingConflict& conflict) {
    throw Error(ErrorKind::file, fmt::format("{}: the technique of this map: {}", given.name, conflict.what()));
  }
}

// The share of the counted receivers at which the frame and the declared lookup are on different sides of one half.
double lookup_differs(const Ladder& ladder) {
  const Image<float>& looked_up = ladder[Rung::shown];
  double counted = 0, differ = 0;
  for (size_t i = 0; i < looked_up.size(); ++i)
    if (is_counted(ladder, i)) {
      counted += 1;
      differ += std::abs(ladder.shown()[i] - looked_up[i]) > 0.5f;
    }
  return differ / counted;
}

}  // namespace

FrameMap::FrameMap(const Scene& scene, const raytrace::Tracer& tracer) try : lookup_(scene, tracer) {
} catch (const Error& error) {
  if (error.kind() != ErrorKind::device) throw;
  throw Error(ErrorKind::device,
              fmt::format("the causes of a frame with its own map need OpenGL: {}; or judge it by place alone, with "
                          "--without-map (in a [[frame]]: without_map = true)",
                          error.what()));
}

std::optional<Ladder> FrameMap::climb(const GivenFrame& frame, bool accepted, FrameVerdict& verdict) {
  const GivenMap& given = *frame.map;
  const MapFrame map =
      map_frame(given.name, verdict.light, given.clip_from_world, {given.depth.width, given.depth.height});
  // Where the frame shows nothing there is no receiver.
  ReceiverImage receivers = verdict.receivers;
  ReceiverTruth truth = verdict.truth;
  Image<float> picture = frame.visibility;
  for (size_t i = 0; i < picture.size(); ++i)
    if (std::isnan(picture[i])) {
      receivers.primitive[i] = no_primitive;
      truth.facing[i] = 0;
      picture[i] = 0;
    }
  const int width = picture.width, height = picture.height;
  Image<float> moved_m;
  if (frame.receivers != GivenReceivers::positions) {
    moved_m = pixel_width_m(frame.view, receivers);
    for (float& m : moved_m.pixels) m *= most_moved_pixels;
  }
  Image<uint8_t> missing;
  if (!frame.not_in_map.empty()) {
    missing = Image<uint8_t>(width, height, 0);
    for (size_t i = 0; i < missing.size(); ++i) missing[i] = verdict.classes[i] == FrameClass::missing;
  }
  const Technique technique = technique_of(given, frame.light, frame.visibility, map.frame);
  GivenClimb climbed = lookup_.climb({.receivers = std::move(receivers),
                                      .eye_m = eye_of(frame.view, width, height),
                                      .truth = std::move(truth),
                                      .technique = technique,
                                      .depth = map.mirrored ? upside_down(given.depth) : given.depth,
                                      .frame = {.name = std::string(frame_rung),
                                                .picture = std::move(picture),
                                                .cause = std::string(frame_lookup),
                                                .label = "Lookup (the frame is not the declared lookup of its map)",
                                                .help = std::string(find_metric(frame_lookup).help)},
                                      .missing = std::move(missing),
                                      .moved_m = std::move(moved_m),
                                      .step = frame.step});
  CheckResult check = check_given_map(climbed.map_off_m, climbed.depth_spread_m, climbed.is_scenes_map);
  const std::string undeclared = undeclared_text(climbed, technique.settings, given, map.frame);
  if (check.state == CheckState::failed && !undeclared.empty()) check.says = undeclared;
  if (frame.step > 0)
    check.says +=
        fmt::format("; a value is the declared lookup's own within {:.3g}, the step of the visibility", frame.step);
  check.accepted = accepted;
  // A lookup that is not the frame's has causes of its own, which say nothing of the frame.
  // Where normals are interpolated and the bias reads them, it may be the frame's all the same, if it is nearer to it than the
  // truth is.
  const double unexplained = climbed.metrics.at(std::string(frame_lookup)), error = verdict.metrics.at("frame_error");
  if (check.state == CheckState::passed &&
      (climbed.beyond_rounding > most_beyond_rounding ||
       (climbed.interpolated > 0 && unexplained > least_unexplained && unexplained > error / 2))) {
    check.state = CheckState::failed;
    check.says = fmt::format(
        "the lookup that is declared is {:.4f}% off the frame, whose error is {:.4f}%; at {:.4f}% of the receivers "
        "rounding does not explain it: it is not the frame's own; check bias (its unit, too), filter, map.cull and the "
        "matrix",
        100 * unexplained, 100 * error, 100 * climbed.beyond_rounding);
  }
  if (check.state == CheckState::passed)
    if (const std::string why = undeclared.empty() ? cancelling_text(climbed, error) : undeclared; !why.empty()) {
      check.state = CheckState::failed;
      check.says = why;
    }
  *std::find_if(verdict.checks.begin(), verdict.checks.end(),
                [&](const CheckResult& one) { return one.name == check.name; }) = check;
  if (verdict.refused()) return std::nullopt;
  // Of the ladder only its causes are said: the other metrics are about a technique of ours.
  for (const Ladder::CauseImage& cause : climbed.ladder.causes)
    if (const auto found = climbed.metrics.find(cause.name); found != climbed.metrics.end())
      verdict.metrics.insert(*found);
  PointRecord record;
  record.metrics = verdict.metrics;
  verdict.bias = bias_text(climbed, technique.settings, record);
  verdict.metrics.try_emplace(std::string(frame_map), 0);
  verdict.metrics[std::string(frame_lookup_differs)] = lookup_differs(climbed.ladder);
  return std::move(climbed.ladder);
}

}  // namespace noonmark
