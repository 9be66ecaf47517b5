#include "gl/bias_text.h"

#include <fmt/format.h>

namespace noonmark::gl {
namespace {

// The name of the uniform: "bias_slope", "bias_slope_floor" or "bias_slope_cap".
std::string uniform(const ActivePart& active, std::string_view parameter = "") {
  return fmt::format("bias_{}{}", active.part->name, parameter);
}

void declare(std::string& text, const ActivePart& active) {
  text += fmt::format("#include \"technique/bias/{}.glsl\"\nuniform float {};  // {}\n", active.part->name,
                      uniform(active), active.part->unit);
  if (!active.part->floor_help.empty()) text += fmt::format("uniform float {};\n", uniform(active, "_floor"));
  if (!active.part->cap_help.empty()) text += fmt::format("uniform float {};\n", uniform(active, "_cap"));
}

// Each sum is a statement of its own, so that the shader adds in the same order as the host.
std::string looked_up_text(const Bias& bias) {
  if (!bias.moves_lookup()) return "vec3 looked_up(vec3 position, Surface surface) { return position; }\n";
  std::string text = fmt::format("vec3 looked_up(vec3 position, Surface surface) {{\n  float unit_m = {};\n",
                                 bias.offset_unit() == OffsetUnit::m ? "1.0" : "texel_m_at(position)");
  std::string sum = "position";
  for (const ActivePart& active : bias.moving()) {
    const std::string_view name = active.part->name;
    text += fmt::format(
        "  precise float {0}_m = {1} * unit_m;\n"
        "  precise vec3 {0}_offset = {0}_m * {0}_way(surface);\n"
        "  precise vec3 {0}_sum = {2} + {0}_offset;\n",
        name, uniform(active), sum);
    sum = fmt::format("{}_sum", name);
  }
  return text + fmt::format("  return {};\n}}\n", sum);
}

std::string compared_text(const Bias& bias) {
  if (bias.compared().empty()) return "float bias_depth(Receiver receiver) { return 0.0; }\n";
  std::string text = "float bias_depth(Receiver receiver) {\n";
  std::string sum;
  for (const ActivePart& active : bias.compared()) {
    const std::string_view name = active.part->name;
    std::string held = fmt::format("{}_scaled", name);
    text += fmt::format("  precise float {} = {} * {}_factor(receiver.surface);\n", held, uniform(active), name);
    if (!active.part->floor_help.empty()) held = fmt::format("max({}, {})", held, uniform(active, "_floor"));
    if (!active.part->cap_help.empty()) held = fmt::format("min({}, {})", held, uniform(active, "_cap"));
    text += fmt::format("  precise float {}_sum = {}{};\n", name, sum.empty() ? "" : sum + " + ", held);
    sum = fmt::format("{}_sum", name);
  }
  return text + fmt::format("  precise float bias = {} * receiver.bias_unit;\n  return bias;\n}}\n", sum);
}

std::string reference_text(const TapReference& reference) {
  const std::string start = fmt::format("#include \"technique/reference/{}.glsl\"\n", reference.name) +
                            "float tap_depth(Receiver receiver, vec3 offset, MapAddress at) {\n";
  if (!reference.plane)
    return start +
           fmt::format("  return {}(TapPlace(receiver.reference, vec2(0.0), vec2(0.0), 0.0));\n}}\n", reference.name);
  return "uniform float bias_plane_cap;  // bias.unit\n" + start +
         fmt::format(
             "  precise float cap = bias_plane_cap * receiver.bias_unit;\n"
             "  return {}(TapPlace(receiver.reference, receiver.gradient, {}, cap));\n}}\n",
             reference.name, reference.at_texel ? "way_to_centre(at, receiver.map_texels)" : "offset.xy");
}

}  // namespace

std::string bias_text_name(const Bias& bias) {
  std::string name = "bias";
  for (const auto parts : {bias.compared(), bias.moving()})
    for (const ActivePart& active : parts) name += fmt::format(" {}", active.part->name);
  if (bias.moves_lookup() && bias.offset_unit() == OffsetUnit::m) name += " in m";
  return fmt::format("{} over {}", name, bias.reference().name);
}

std::string bias_text(const Bias& bias) {
  std::string text;
  for (const auto parts : {bias.compared(), bias.moving()})
    for (const ActivePart& active : parts) declare(text, active);
  return text + looked_up_text(bias) + compared_text(bias) + reference_text(bias.reference());
}

void set_bias_uniforms(Program& program, const Bias& bias) {
  for (const auto parts : {bias.compared(), bias.moving()})
    for (const ActivePart& active : parts) {
      program.set_if_used(uniform(active).c_str(), active.amount);
      program.set_if_used(uniform(active, "_floor").c_str(), active.floor);
      program.set_if_used(uniform(active, "_cap").c_str(), active.cap);
    }
  program.set_if_used("bias_plane_cap", bias.plane_cap());
}

}  // namespace noonmark::gl
