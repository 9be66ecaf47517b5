// Plain OpenGL. Its only bias is glPolygonOffset; everything else is the application's shader. So the lines are the
// formulas of the parts, with the amounts in window depth or in metres.
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "app/advise/engines/engine.h"
#include "app/advise/engines/unexpressed.h"
#include "technique/filters.h"

namespace noonmark {
namespace opengl_engine {
namespace {

struct PartText {
  std::string_view part, text;  // {}: the amount
};
constexpr PartText texts[] = {
    {"constant", "depth -= {};"},
    {"slope", "{} * (1.0 - dot(N, L))"},
    {"tan", "{} * length(cross(N, L)) / dot(N, L)"},
    {"normal_offset", "position += {} * N;"},
    {"normal_offset_sin", "position += {} * length(cross(N, L)) * N;"},
    {"normal_offset_turned", "position += {} * (1.0 - dot(N, L)) * N;"},
    {"normal_offset_lateral", "position += {} * (1.0 - dot(N, L)) * (N - dot(N, L) * L);"},
    {"normal_offset_axes", "position += {} * (abs(dot(N, u)) + abs(dot(N, v))) * N;"},
    {"caster_offset", "position -= {} * L;"},
    {"caster_normal_offset", "position -= {} * N;"},
    {"caster_normal_offset_sin", "position -= {} * length(cross(N, L)) * N;"},
    {"caster_normal_offset_turned", "position -= {} * (1.0 - dot(N, L)) * N;"},
};

constexpr std::string_view names_line =
    "// N, L: unit vectors from the receiver, N outward, L to the light, dot(N, L) > 0; depth: the receiver's window "
    "depth; position: in the world, of the receiver or of the map's vertex; u, v: axes of a texel in the world";

// The factor of a polygon offset, times a texel's metres, that gives at least this part on every plane. It gives
// max(|cos phi|, |sin phi|) of its factor, which is at least 1 / sqrt(2), and half of A at every azimuth or more.
double least_polygon_factor(const AdvisedPart& part) {
  return (part.form == BiasForm::axes ? 2 : std::numbers::sqrt2) * part.amount;
}

std::string part_line(const AdvisedPart& part, const AdvicePlace& place) {
  const bool compared = part.part->acts_on == BiasTarget::compared_depth;
  const double unit = compared ? place.depth_slope : 1;
  for (const PartText& row : texts) {
    if (row.part != part.part->name) continue;
    std::string text = fmt::format(fmt::runtime(row.text), number(part.amount * unit));
    if (row.part == "slope" || row.part == "tan") {
      if (part.floor > 0) text = fmt::format("max({}, {})", text, number(part.floor * unit));
      if (std::isfinite(part.cap)) text = fmt::format("min({}, {})", text, number(part.cap * unit));
      text = fmt::format("depth -= {};", text);
    }
    text += fmt::format("  // {}: bias.{}", place_name(part.part->acts_on), row.part);
    if (part.floor > 0) text += fmt::format(" bias.{}_floor", row.part);
    if (std::isfinite(part.cap)) text += fmt::format(" bias.{}_cap", row.part);
    return text + (compared ? ", window depth" : ", m");
  }
  throw std::logic_error("a part of a bias without its line of GLSL");
}

std::string polygon_line(const AdvicePlace& place) {
  const BiasSettings& bias = place.settings.bias;
  return fmt::format(
      "glEnable(GL_POLYGON_OFFSET_FILL); glPolygonOffset({}, {});  // while the map is drawn: bias.polygon_factor, "
      "bias.polygon_units",
      number(bias["polygon_factor"]), number(bias["polygon_units"]));
}

std::string format_name(DepthFormat format) {
  return format == DepthFormat::d16   ? "GL_DEPTH_COMPONENT16"
         : format == DepthFormat::d24 ? "GL_DEPTH_COMPONENT24"
                                      : "GL_DEPTH_COMPONENT32F";
}

std::vector<std::string> map_lines(const AdvicePlace& place) {
  const LightFrame& frame = place.frame;
  const bool cube = place.kind() == LightKind::point;
  std::vector<std::string> lines = {
      fmt::format("glTexStorage2D({}, 1, {}, {}, {});", cube ? "GL_TEXTURE_CUBE_MAP" : "GL_TEXTURE_2D",
                  format_name(place.settings.map.format), frame.resolution, frame.resolution)};
  const std::string near_far = fmt::format("{}, {}", number(frame.near_m), number(frame.far_m));
  const std::string half = number(frame.extent_m / 2);
  if (place.kind() == LightKind::directional)
    lines.push_back(fmt::format("clip_from_light = ortho(-{0}, {0}, -{0}, {0}, {1});", half, near_far));
  else
    lines.push_back(fmt::format("clip_from_light = perspective({}, 1, {});  // radians",
                                number(2 * std::atan(frame.tan_half_fov)), near_far));
  const CulledFaces cull = place.settings.map.cull;
  if (cull == CulledFaces::none)
    lines.emplace_back("glDisable(GL_CULL_FACE);");
  else
    lines.push_back(
        fmt::format("glEnable(GL_CULL_FACE); glCullFace(GL_{});", cull == CulledFaces::back ? "BACK" : "FRONT"));
  return lines;
}

bool is_polygon_offset(const AdvisedPart& part) {
  return part.form == BiasForm::polygon_factor || part.form == BiasForm::polygon_resolution;
}

std::string sampler_line(const FilterSettings& filter) {
  const bool blended = find_filter(filter.kind).blended;
  return fmt::format(
      "glTexParameteri(target, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE); "
      "glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_{0}); "
      "glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_{0});  // filter.kind = {1}",
      blended ? "LINEAR" : "NEAREST", filter.kind);
}

std::vector<std::string> shader_limits(const AdvicePlace& place, const std::vector<AdvisedPart>& parts) {
  std::vector<std::string> said;
  for (const AdvisedPart& part : parts) {
    if (is_polygon_offset(part)) continue;
    std::string text = fmt::format("OpenGL has no state for bias.{}: the shader must compute it.", part.part->name);
    if (part.form == BiasForm::tangent || part.form == BiasForm::axes)
      text +=
          fmt::format(" glPolygonOffset({}, 0) gives at least as much on every plane, but acts on the caster (law 35).",
                      number(least_polygon_factor(part) / place.texel_m));
    said.push_back(text);
  }
  return said;
}

std::vector<std::string> reference_limits(const AdvicePlace& place) {
  const BiasSettings& bias = place.settings.bias;
  if (!tap_reference(bias.reference).plane) return {};
  std::string text = fmt::format(
      "OpenGL has no state for bias.reference = {}: the shader must add the slope of the receiver's plane, in depth "
      "for "
      "each texel, times the way to the tap to the depth of each tap.",
      bias.reference);
  if (bias.plane_cap)
    text += fmt::format(" bias.plane_cap = {} {} limits what it adds.", number(*bias.plane_cap),
                        find_setting("bias.unit").get(place.settings));
  return {text};
}

std::vector<std::string> filter_limits(const AdvicePlace& place) {
  std::vector<std::string> said;
  if (!filter_is(place, "none") && !filter_is(place, "hardware"))
    said.push_back(fmt::format(
        "OpenGL has no state for filter.kind = {}: the shader must place its taps, which reach k = {} texels. The "
        "sampler alone gives one fetch, of k = 1 if it is linear.",
        place.settings.filter.kind, number(place.reach_texels)));
  if (place.kind() == LightKind::point)
    said.emplace_back(
        "For a point light the map's fragment shader must write the distance divided by far to gl_FragDepth, and the "
        "lookup must compare the same. A polygon offset has no effect on such a map.");
  return said;
}

}  // namespace
}  // namespace opengl_engine

EngineAdvice opengl_cascades() {
  return {
      .engine = "OpenGL",
      .version = "3.3 and later",
      .lines = {},
      .cannot =
          {"There are no lines for cascades. The application lays them itself: point.json of noonmark render has the "
           "slice, the matrix and the texel of each, and the bias that it needs."},
      .source = "The OpenGL Graphics System, a Specification, version 4.6, section 14.6.5 (depth offset)",
      .comment = "//",
      .why_not_emulated = "there are no lines"};
}

EngineAdvice opengl_advice(const AdvicePlace& place, const std::vector<AdvisedPart>& parts) {
  using namespace opengl_engine;
  EngineAdvice advice{"OpenGL",
                      "3.3 and later",
                      map_lines(place),
                      {},
                      "The OpenGL Graphics System, a Specification, version 4.6, section 14.6.5 (depth offset)",
                      "//"};
  if (!compares(place.settings)) {
    advice.lines.clear();
    advice.cannot.push_back(no_lines_for_lookup(
        place.settings.lookup.kind,
        fmt::format(
            "The passes and the lookup are the application's own shaders; technique/lookups/{}.glsl of Noonmark "
            "has the formulas.",
            place.settings.lookup.kind)));
    advice.why_not_emulated = "there are no lines";
    return advice;
  }
  advice.emulated = place.settings;  // the application's shader does exactly this
  advice.lines.push_back(sampler_line(place.settings.filter));
  bool polygon_offset = false, shader = false;
  for (const AdvisedPart& part : parts) {
    const bool polygon = is_polygon_offset(part);
    if (!polygon && !shader) advice.lines.emplace_back(names_line);
    if (!polygon) advice.lines.push_back(part_line(part, place));
    (polygon ? polygon_offset : shader) = true;
  }
  advice.lines.push_back(polygon_offset ? polygon_line(place) : "glDisable(GL_POLYGON_OFFSET_FILL);");
  for (const std::vector<std::string>& said :
       {shader_limits(place, parts), reference_limits(place), filter_limits(place),
        unexpressed_map(place, {"map.cull", "map.fov_deg"}), unexpressed_distance(place)})
    advice.cannot.insert(advice.cannot.end(), said.begin(), said.end());
  return advice;
}

std::vector<EngineField> opengl_fields() {
  using namespace opengl_engine;
  std::vector<EngineField> rows;
  for (LightKind kind : {LightKind::directional, LightKind::spot})
    for (const auto& [field, unit] : {std::pair<std::string, std::string>{"glPolygonOffset factor",
                                                                          "largest depth slope "
                                                                          "of the triangle"},
                                      {"glPolygonOffset units", "least depth difference of the format"}})
      rows.push_back({"OpenGL", "3.3 and later", std::string(kind_of_light(kind).name()), field, unit,
                      place_name(BiasTarget::caster)});
  return rows;
}

}  // namespace noonmark
