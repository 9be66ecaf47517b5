#include "gl/lookup_parts.h"

#include <fmt/format.h>

#include "gl/bias_text.h"
#include "technique/light_kind.h"

namespace noonmark::gl {

ShaderSlots receiver_slots(ProgramCache& programs, LightKind light, const Bias& bias) {
  const std::string bias_name = bias_text_name(bias);
  programs.define(bias_name, bias_text(bias));
  return {{"light", fmt::format("shaders/light/{}.glsl", kind_of_light(light).name())}, {"bias", bias_name}};
}

ShaderSlots lookup_slots(ProgramCache& programs, LightKind light, const Bias& bias, const Filter& filter) {
  const std::string name(filter.name);
  ShaderSlots slots = receiver_slots(programs, light, bias);
  slots["filter"] = fmt::format("shaders/filter/{}.glsl", filter.shader);
  if (filter.own_weights) {
    slots["weights"] = "weights of " + name;
    programs.define(slots["weights"], fmt::format("#include \"technique/filters/{0}.glsl\"\nuniform int filter_size;\n"
                                                  "float filter_weight(int texel, float s) {{ return {0}_weight(texel, "
                                                  "s, filter_size); }}\n",
                                                  name));
  }
  return slots;
}

}  // namespace noonmark::gl
