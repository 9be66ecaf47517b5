#include "gl/lookup_parts.h"

#include <fmt/format.h>

#include <stdexcept>

#include "gl/bias_text.h"

namespace noonmark::gl {
namespace {

struct LightRow {
  LightKind kind;
  const char* file;
};
constexpr LightRow light_rows[] = {
    {LightKind::directional, "shaders/light/directional.glsl"},
    {LightKind::spot, "shaders/light/spot.glsl"},
    {LightKind::point, "shaders/light/point.glsl"},
};

}  // namespace

const char* light_file(LightKind kind) {
  for (const LightRow& row : light_rows)
    if (row.kind == kind) return row.file;
  throw std::logic_error("a kind of light without a row in gl/lookup_parts.cpp");
}

ShaderSlots receiver_slots(ProgramCache& programs, LightKind light, const Bias& bias) {
  const std::string bias_name = bias_text_name(bias);
  programs.define(bias_name, bias_text(bias));
  return {{"light", light_file(light)}, {"bias", bias_name}};
}

ShaderSlots lookup_slots(ProgramCache& programs, LightKind light, const Bias& bias, const Filter& filter) {
  const std::string name(filter.name);
  ShaderSlots slots = receiver_slots(programs, light, bias);
  slots["filter"] = fmt::format("shaders/filter/{}.glsl", filter.shader);
  if (!filter.sizes.empty()) {
    slots["weights"] = "weights of " + name;
    programs.define(slots["weights"], fmt::format("#include \"technique/filters/{0}.glsl\"\nuniform int filter_size;\n"
                                                  "float filter_weight(int texel, float s) {{ return {0}_weight(texel, "
                                                  "s, filter_size); }}\n",
                                                  name));
  }
  return slots;
}

}  // namespace noonmark::gl
