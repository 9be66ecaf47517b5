#include "gl/lookup_parts.h"

#include <fmt/format.h>

#include "gl/bias_text.h"
#include "technique/cascade_selections.h"

namespace noonmark::gl {

namespace {

std::string uniform(const FilterRead& read) { return fmt::format("filter_{}", read.parameter->name()); }

}  // namespace

std::string cascade_file(const Technique& technique) {
  return technique.cascade ? std::string(technique.cascade->selection->shader) : "shaders/cascade/single.glsl";
}

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
  slots["cascade"] = cascade_file(technique);
  programs.define(slots["filter"], text);
  return slots;
}

void set_cascade_uniforms(Program& program, const CascadePlace& cascade) {
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
  for (const FilterRead& read : filter.reads) {
    const double value = settings[read.parameter->name()];
    if (read.parameter->type == ValueType::real)
      program.set_if_used(uniform(read).c_str(), static_cast<float>(value));
    else
      program.set_if_used(uniform(read).c_str(), static_cast<int>(value));
  }
}

}  // namespace noonmark::gl
