// Plain OpenGL. Its only bias is glPolygonOffset; everything else is the application's shader. So the lines are the
// formulas of the parts, with the amounts in window depth or in metres.
//
// Names in the lines: N and L are unit vectors of the world from the receiver, N.L is clamped to 0 ... 1; `depth` is the
// receiver's window depth, `position` the place in the world that is looked up or, in the map's vertex shader, the
// vertex; `u` and `v` are the texel's axes in the world.
#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "app/engines/engine.h"
#include "app/engines/unexpressed.h"

namespace noonmark {
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
  return fmt::format("glEnable(GL_POLYGON_OFFSET_FILL); glPolygonOffset({}, {});  // while the map is drawn",
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

std::vector<std::string> shader_limits(const AdvicePlace& place, const std::vector<AdvisedPart>& parts) {
  std::vector<std::string> said;
  for (const AdvisedPart& part : parts) {
    if (part.form == BiasForm::polygon_factor || part.form == BiasForm::polygon_resolution) continue;
    std::string text = fmt::format("OpenGL has no state for bias.{}: the shader must compute it.", part.part->name);
    if (part.form == BiasForm::tangent || part.form == BiasForm::axes)
      text +=
          fmt::format(" glPolygonOffset({}, 0) gives at least as much on every plane, but acts on the caster (law 35).",
                      number(std::sqrt(2.0) * part.amount / place.texel_m));
    said.push_back(text);
  }
  if (tap_reference(place.settings.bias.reference).plane)
    said.push_back(fmt::format(
        "OpenGL has no state for bias.reference = {0}: the shader must add {1} to the depth of each tap.{2}",
        place.settings.bias.reference, "dot(gradient of the receiver's plane, way to the tap)",
        place.settings.bias.plane_cap
            ? fmt::format(" bias.plane_cap = {} {} limits what it adds.", number(*place.settings.bias.plane_cap),
                          find_setting("bias.unit").get(place.settings))
            : ""));
  return said;
}

}  // namespace

EngineAdvice opengl_advice(const AdvicePlace& given, const std::vector<AdvisedPart>& parts) {
  AdvicePlace place = given;
  EngineAdvice advice{"OpenGL",
                      "3.3 and later",
                      map_lines(place),
                      {},
                      "The OpenGL Graphics System, a Specification, version 4.6, section 14.6.5 (depth offset)"};
  const bool hardware = filter_is(place, "hardware"), none = filter_is(place, "none");
  place.filter = {{}, "one linear fetch of a comparison sampler", 1, hardware || none};
  advice.lines.push_back(fmt::format(
      "glTexParameteri(target, GL_TEXTURE_COMPARE_MODE, {}); glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_{}); "
      "// filter.kind = {}",
      none ? "GL_NONE" : "GL_COMPARE_REF_TO_TEXTURE", none ? "NEAREST" : "LINEAR", place.settings.filter.kind));
  bool polygon_offset = false;
  for (const AdvisedPart& part : parts) {
    const bool polygon = part.form == BiasForm::polygon_factor || part.form == BiasForm::polygon_resolution;
    if (!polygon) advice.lines.push_back(part_line(part, place));
    polygon_offset |= polygon;
  }
  advice.lines.push_back(polygon_offset ? polygon_line(place) + " bias.polygon_factor, bias.polygon_units"
                                        : "glDisable(GL_POLYGON_OFFSET_FILL);");
  std::vector<std::string> cube;
  if (place.kind() == LightKind::point)
    cube = {
        "OpenGL has no sampler for a kernel of a cube map: the shader must place each tap and compare the distance "
        "divided by far, which the map's fragment shader writes to gl_FragDepth. A polygon offset has no effect "
        "on such a map."};
  for (const std::vector<std::string>& said : {shader_limits(place, parts), unexpressed_filter(place),
                                               unexpressed_map(place, {"map.cull"}), unexpressed_distance(place), cube})
    advice.cannot.insert(advice.cannot.end(), said.begin(), said.end());
  return advice;
}

std::vector<EngineField> opengl_fields() {
  std::vector<EngineField> rows;
  for (LightKind kind : {LightKind::directional, LightKind::spot})
    for (const auto& [field, unit] : {std::pair<std::string, std::string>{"glPolygonOffset factor",
                                                                          "largest depth slope "
                                                                          "of the triangle"},
                                      {"glPolygonOffset units", "least depth difference of the format"}})
      rows.push_back({"OpenGL", "3.3 and later", std::string(kind_of_light(kind).name()), field, unit,
                      place_name(BiasTarget::caster), "OpenGL 4.6, section 14.6.5"});
  return rows;
}

}  // namespace noonmark
