#include "gl/lookup_parts.h"

#include <fmt/format.h>

#include "gl/bias_text.h"
#include "technique/cascade_blends.h"
#include "technique/cascade_selections.h"

namespace noonmark::gl {

namespace {

std::string uniform(const KindRead<FilterSettings>& read) { return fmt::format("filter_{}", read.parameter->name()); }

}  // namespace

ShaderSlots choice_slots(ProgramCache& programs, const Technique& technique) {
  if (!technique.cascade) return {{"choice", "shaders/cascade/single.glsl"}};
  const std::string_view shape = technique.cascade->shape->name;
  const std::string blend = fmt::format("blend {}", shape);
  programs.define(blend, fmt::format("#include \"technique/blends/{0}.glsl\"\n"
                                     "float weight_of_next(float place, float blend) {{\n"
                                     "  precise float way = way_into_band(place, blend);\n"
                                     "  return {0}_blend(way);\n"
                                     "}}\n",
                                     shape));
  return {{"choice", std::string(technique.cascade->selection->shader)}, {"blend", blend}};
}

ShaderSlots receiver_slots(ProgramCache& programs, const LightFrame& frame, const Bias& bias) {
  const std::string bias_name = bias_text_name(bias);
  programs.define(bias_name, bias_text(bias));
  return {{"light", fmt::format("shaders/light/{}.glsl", frame.light().name())},
          {"cube", frame.turned() ? "shaders/map/cube_turned.glsl" : "shaders/map/cube_along_world.glsl"},
          {"bias", bias_name}};
}

ShaderSlots moment_slots(ProgramCache& programs, const Technique& technique) {
  const std::string_view name = technique.moments.value().kind().name;
  const std::string slot = fmt::format("lookup {}", name);
  std::string text = fmt::format(
      "#include \"technique/lookups/shared/words.glsl\"\n"
      "#include \"technique/lookups/{0}.glsl\"\n"
      "uniform LookupParameters lookup;\n"
      "vec4 stored_texel(float depth) {{ return {0}_stored(depth, lookup); }}\n"
      "float lit_fraction(vec4 stored, float depth) {{\n"
      "  return {0}_lit(stored, depth, lookup);\n"
      "}}\n",
      name);
  if (technique.moments->spread())
    text += fmt::format(
        "vec4 added(vec4 sums, vec4 stored) {{ return {0}_add_stored(sums, stored); }}\n"
        "vec4 spread(vec4 sums, float taps) {{ return {0}_spread(sums, taps); }}\n",
        name);
  programs.define(slot, text);
  return {{"lookup", slot}};
}

void set_lookup_uniforms(Program& program, const Technique& technique) {
  const in_float::LookupParameters& p = technique.moments.value().parameters();
  program.set_if_used("lookup.v_min", p.v_min);
  program.set_if_used("lookup.floor", p.floor);
  program.set_if_used("lookup.exponent", p.exponent);
  program.set_if_used("lookup.negative_exponent", p.negative_exponent);
  program.set_if_used("lookup.moment_bias", p.moment_bias);
  program.set_if_used("lookup.moments", p.moments);
}

ShaderSlots lookup_slots(ProgramCache& programs, const Technique& technique) {
  if (technique.moments) {
    ShaderSlots slots = receiver_slots(programs, technique.frame, technique.bias);
    slots.merge(moment_slots(programs, technique));
    slots["filter"] = "moments";
    programs.define("moments", "#include <lookup>\n#include \"shaders/filter/moments.glsl\"\n");
    slots.merge(choice_slots(programs, technique));
    return slots;
  }
  const Filter& filter = *technique.filter;
  const std::string name(filter.name);
  std::string text;
  for (const KindRead<FilterSettings>& read : filter.reads)
    text += fmt::format("uniform {} {};  // {}\n", read.parameter->type == ValueType::real ? "float" : "int",
                        uniform(read), read.parameter->unit);
  if (filter.own_weights)
    text += fmt::format(
        "#include \"technique/filters/{0}.glsl\"\n"
        "float filter_weight(int texel, float s) {{ return {0}_weight(texel, s, filter_size); }}\n",
        name);
  text += fmt::format("#include \"shaders/filter/{}.glsl\"\n", filter.shader);

  ShaderSlots slots = receiver_slots(programs, technique.frame, technique.bias);
  slots["filter"] = "filter " + name;
  slots.merge(choice_slots(programs, technique));
  programs.define(slots["filter"], text);
  return slots;
}

void set_choice_uniforms(Program& program, const Technique& technique) {
  if (!technique.cascade) return;
  const CascadePlace& cascade = *technique.cascade;
  program.set("last_cascade", cascade.last());
  program.set("cascade_blend", cascade.blend);
  program.set("cascade_seam", cascade.seam);
  program.set_if_used("view_forward", cascade.view_forward);
  program.set_if_used("cascade_axes", cascade.light_axes);
  const auto set_each = [&](const char* name, const auto& list) {
    for (size_t k = 0; k < list.size(); ++k) program.set_if_used(fmt::format("{}[{}]", name, k).c_str(), list[k]);
  };
  set_each("cascade_depths", cascade.depths);
  set_each("cascade_middle", cascade.middles);
  set_each("cascade_half", cascade.halves);
}

void set_filter_uniforms(Program& program, const Filter& filter, const FilterSettings& settings) {
  for (const KindRead<FilterSettings>& read : filter.reads) {
    const double value = settings[read.parameter->name()];
    if (read.parameter->type == ValueType::real)
      program.set_if_used(uniform(read).c_str(), static_cast<float>(value));
    else
      program.set_if_used(uniform(read).c_str(), static_cast<int>(value));
  }
}

}  // namespace noonmark::gl
