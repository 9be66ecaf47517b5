#include "gl/lookup_parts.h"

#include <fmt/format.h>

#include "gl/bias_text.h"

namespace noonmark::gl {

namespace {

std::string uniform(const FilterRead& read) { return fmt::format("filter_{}", read.parameter->name()); }

}  // namespace

ShaderSlots receiver_slots(ProgramCache& programs, const LightFrame& frame, const Bias& bias) {
  const std::string bias_name = bias_text_name(bias);
  programs.define(bias_name, bias_text(bias));
  return {{"light", fmt::format("shaders/light/{}.glsl", frame.light().name())},
          {"cube", frame.turned() ? "shaders/map/cube_turned.glsl" : "shaders/map/cube_along_world.glsl"},
          {"bias", bias_name}};
}

ShaderSlots lookup_slots(ProgramCache& programs, const Technique& technique) {
  const Filter& filter = *technique.filter;
  const std::string name(filter.name);
  std::string text;
  for (const FilterRead& read : filter.reads)
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
  slots["cascade"] = technique.cascade ? "shaders/cascade/by_depth.glsl" : "shaders/cascade/single.glsl";
  programs.define(slots["filter"], text);
  return slots;
}

void set_cascade_uniforms(Program& program, const CascadePlace& cascade) {
  program.set_if_used("this_cascade", cascade.index);
  program.set("cascade_bounds", static_cast<int>(cascade.bounds_m.size()));
  for (size_t k = 0; k < cascade.bounds_m.size(); ++k)
    program.set_if_used(fmt::format("cascade_bound_m[{}]", k).c_str(), cascade.bounds_m[k]);
  program.set_if_used("view_forward", cascade.forward);
}

void set_filter_uniforms(Program& program, const Filter& filter, const FilterSettings& settings) {
  for (const FilterRead& read : filter.reads) {
    const double value = settings[read.parameter->name()];
    if (read.parameter->type == ValueType::real)
      program.set_if_used(uniform(read).c_str(), static_cast<float>(value));
    else
      program.set_if_used(uniform(read).c_str(), static_cast<int>(value));
  }
}

}  // namespace noonmark::gl
