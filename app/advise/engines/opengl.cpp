// Plain OpenGL. Its only bias is glPolygonOffset; everything else is the application's shader. So the lines are the
// formulas of the parts, with the amounts in window depth or in metres.
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "app/advise/engines/engine.h"
#include "technique/filters.h"
#include "technique/lookups.h"

namespace noonmark::opengl_engine {
namespace {

double depth_m(const AdvicePlace& place) { return 1 / place.depth_slope; }

double half_of_width(const AdvicePlace&) { return 2; }

constexpr std::string_view names_line =
    "// N, L: unit vectors from the receiver, N outward, L to the light, dot(N, L) > 0; depth: the receiver's window "
    "depth; position: in the world, of the receiver or of the map's vertex; u, v: axes of a texel in the world";

// The factor of a polygon offset, times a texel's metres, that gives at least this part on every plane. It gives
// max(|cos phi|, |sin phi|) of its factor, which is at least 1 / sqrt(2), and half of A at every azimuth or more.
double least_polygon_factor(const AdvisedPart& part) {
  return (part.form == BiasForm::axes ? 2 : std::numbers::sqrt2) * part.amount;
}

bool is_polygon_offset(const AdvisedPart& part) {
  return part.form == BiasForm::polygon_factor || part.form == BiasForm::polygon_resolution;
}

// The row's line, with the part's floor and cap around the depth that it computes: those have a line "depth -= ...;".
std::string part_line(const Engine& engine, const AdvisedPart& part, const AdvicePlace& place) {
  const EngineKnob* found = engine.knob_of(fmt::format("bias.{}", part.part->name));
  if (!found) throw std::logic_error("a part of a bias without its line of GLSL");
  const EngineKnob& knob = *found;
  const auto in_unit = [&](double metres) { return number(metres / knob.of_one(place)); };
  std::string text(knob.line), name(part.part->name), all = "bias." + name;
  text.replace(text.find("{}"), 2, in_unit(part.amount));
  const auto bounded = [&](const char* function, const char* what, double metres) {
    const size_t from = std::string_view("depth -= ").size();
    text = fmt::format("depth -= {}({}, {});", function, text.substr(from, text.size() - 1 - from), in_unit(metres));
    all += " bias." + name + what;
  };
  if (part.floor > 0) bounded("max", "_floor", part.floor);
  if (std::isfinite(part.cap)) bounded("min", "_cap", part.cap);
  return fmt::format("{}  // {}: {}, {}", text, place_name(part.part->acts_on), all, knob.one ? "window depth" : "m");
}

std::vector<std::string> limits(const AdvicePlace& place, const std::vector<AdvisedPart>& parts) {
  std::vector<std::string> said;
  for (const AdvisedPart& part : parts) {
    if (is_polygon_offset(part)) continue;
    said.push_back(fmt::format("OpenGL has no state for bias.{}: the shader must compute it.", part.part->name));
    if (part.form == BiasForm::tangent || part.form == BiasForm::axes)
      said.back() +=
          fmt::format(" glPolygonOffset({}, 0) gives at least as much on every plane, but acts on the caster (law 35).",
                      number(least_polygon_factor(part) / place.texel_m));
  }
  const BiasSettings& bias = place.settings.bias;
  if (tap_reference(bias.reference).plane)
    said.push_back(fmt::format(
        "OpenGL has no state for bias.reference = {}: the shader must add the slope of the receiver's plane, in depth "
        "for each texel, times the way to the tap to the depth of each tap.{}",
        bias.reference,
        bias.plane_cap ? fmt::format(" bias.plane_cap = {} {} limits what it adds.", number(*bias.plane_cap),
                                     find_setting("bias.unit").get(place.settings))
                       : ""));
  if (!filter_is(place, "none") && !filter_is(place, "hardware"))
    said.push_back(fmt::format(
        "OpenGL has no state for filter.kind = {}: the shader must place its taps, which reach k = {} texels. The "
        "sampler alone gives one fetch, of k = 1 if it is linear.",
        place.settings.filter.kind, number(place.reach_texels)));
  return said;
}

EngineAdvice advice(const Engine& engine, const AdvicePlace& place, const std::vector<AdvisedPart>& parts,
                    EngineAdvice advice) {
  const EngineText of{engine, place};
  if (!compares(place.settings)) {
    advice.cannot.push_back(no_lines_for_lookup(
        place.settings.lookup.kind,
        fmt::format(
            "The passes and the lookup are the application's own shaders; technique/lookups/{}.glsl of Noonmark "
            "has the formulas.",
            place.settings.lookup.kind)));
    return advice;
  }
  advice.why_not_emulated.clear();
  advice.emulated = place.settings;  // the application's shader does exactly this
  const std::vector<std::string> all = text_lines(engine.lines, of);
  const auto last = std::find(all.begin(), all.end(), "---");
  advice.lines.assign(all.begin(), last);
  bool polygon_offset = false, shader = false;
  for (const AdvisedPart& part : parts) {
    const bool polygon = is_polygon_offset(part);
    if (!polygon && !shader) advice.lines.emplace_back(names_line);
    if (!polygon) advice.lines.push_back(part_line(engine, part, place));
    (polygon ? polygon_offset : shader) = true;
  }
  advice.lines.push_back(*(last + (polygon_offset ? 1 : 2)));
  for (const std::vector<std::string>& said :
       {limits(place, parts), text_lines(engine.limits, of), unexpressed_map(place, {"map.cull", "map.fov_deg"})})
    advice.cannot.insert(advice.cannot.end(), said.begin(), said.end());
  if (const std::string said = unexpressed_distance(place); !said.empty()) advice.cannot.push_back(said);
  return advice;
}

std::optional<std::string> own(std::string_view word, const EngineText& of) {
  if (word == "glPolygonOffset factor") return number(of.place.settings.bias["polygon_factor"]);
  if (word == "glPolygonOffset units") return number(of.place.settings.bias["polygon_units"]);
  if (word == "shape") return of.place.kind() == LightKind::point ? "GL_TEXTURE_CUBE_MAP" : "GL_TEXTURE_2D";
  if (word == "sampler") return find_filter(of.place.settings.filter.kind).blended ? "LINEAR" : "NEAREST";
  if (word == "filter") return of.place.settings.filter.kind;
  return std::nullopt;
}

// clang-format off
EngineKnob depth(std::string_view is, std::string_view line) { return {.field = is, .is = is, .one = depth_m, .line = line}; }
EngineKnob offset(std::string_view is, std::string_view line) { return {.field = is, .is = is, .line = line}; }

}  // namespace

Engine engine() {
  return {
      .name = "OpenGL",
      .version = "3.3 and later",
      .comment = "//",
      .sources = "The OpenGL Graphics System, a Specification, version 4.6, section 14.6.5 (depth offset)",
      .knobs = {{.field = "glPolygonOffset factor", .is = "bias.polygon_factor", .unit = "largest depth slope of the triangle", .preset = 0, .lights = directional_light | spot_light},
                {.field = "glPolygonOffset units", .is = "bias.polygon_units", .unit = "least depth difference of the format", .preset = 0, .lights = directional_light | spot_light},
                depth("bias.constant", "depth -= {};"),
                depth("bias.slope", "depth -= {} * (1.0 - dot(N, L));"),
                depth("bias.tan", "depth -= {} * length(cross(N, L)) / dot(N, L);"),
                offset("bias.normal_offset", "position += {} * N;"),
                offset("bias.normal_offset_sin", "position += {} * length(cross(N, L)) * N;"),
                offset("bias.normal_offset_turned", "position += {} * (1.0 - dot(N, L)) * N;"),
                offset("bias.normal_offset_lateral", "position += {} * (1.0 - dot(N, L)) * (N - dot(N, L) * L);"),
                offset("bias.normal_offset_axes", "position += {} * (abs(dot(N, u)) + abs(dot(N, v))) * N;"),
                offset("bias.caster_offset", "position -= {} * L;"),
                offset("bias.caster_normal_offset", "position -= {} * N;"),
                offset("bias.caster_normal_offset_sin", "position -= {} * length(cross(N, L)) * N;"),
                offset("bias.caster_normal_offset_turned", "position -= {} * (1.0 - dot(N, L)) * N;"),
                {.field = "size", .is = "map.resolution", .least = 1, .step = 1},
                {.field = "right", .is = "map.extent_m", .one = half_of_width},
                {.field = "near", .is = "map.near_m", .least = -no_limit},
                {.field = "far", .is = "map.far_m", .least = -no_limit},
                {.field = "format", .is = "map.format"},
                {.field = "cull face", .is = "map.cull"}},
      .choices = {{"map.format", {"GL_DEPTH_COMPONENT16", "GL_DEPTH_COMPONENT24", "GL_DEPTH_COMPONENT32F"}},
                  {"map.cull", {"glDisable(GL_CULL_FACE);", "glEnable(GL_CULL_FACE); glCullFace(GL_BACK);", "glEnable(GL_CULL_FACE); glCullFace(GL_FRONT);"}}},
      .lines = R"(
glTexStorage2D({shape}, 1, {format}, {size}, {size});
?directional clip_from_light = ortho(-{right}, {right}, -{right}, {right}, {near}, {far});
?!directional clip_from_light = perspective({fov}, 1, {near}, {far});  // radians
{cull face}
glTexParameteri(target, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE); glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_{sampler}); \
glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_{sampler});  // filter.kind = {filter}
---
glEnable(GL_POLYGON_OFFSET_FILL); glPolygonOffset({glPolygonOffset factor}, {glPolygonOffset units});  // while the map is drawn: bias.polygon_factor, \
bias.polygon_units
glDisable(GL_POLYGON_OFFSET_FILL);)",
      .limits = R"(
?point For a point light the map's fragment shader must write the distance divided by far to gl_FragDepth, and the lookup must compare the same. \
A polygon offset has no effect on such a map.)",
      .no_cascades = "The application lays them itself: point.json of noonmark render has the slice, the matrix and the texel of each, and the bias that it needs.",
      .own = own,
      .advice = advice};
}
// clang-format on

}  // namespace noonmark::opengl_engine
