#include "technique/bias_parts.h"

#include "base/find_row.h"

#define precise
namespace noonmark::in_float {
#include "bias_formulas.inc"
#include "reference_formulas.inc"
}  // namespace noonmark::in_float
namespace noonmark::in_double {
#include "bias_formulas.inc"
}
namespace noonmark::in_bounds {
#include "bias_formulas.inc"
}
#undef precise

namespace noonmark {
namespace {

constexpr std::string_view moves_the_lookup = "moves the lookup, so each of its values needs a lookup pass of its own";
constexpr std::string_view is_in_the_map =
    "changes the map that is drawn, so each of its values needs a map of its own";

constexpr std::string_view law_35 =
    "law 35: what the parts give along the light adds up, and the sum must reach k·A·tan θ texels";

constexpr double most_units = 1e6;

#define FACTOR(name) .factor = in_float::name##_factor
#define WAY(name) .way = in_double::name##_way, .bounded_way = in_bounds::name##_way

constexpr BiasPart parts[] = {
    {.name = "constant",
     .acts_on = BiasTarget::compared_depth,
     .unit = "bias.unit",
     .most = most_units,
     .help = "The same bias at every receiver, against acne (shadow acne: a surface shadows itself).",
     .law = "law 1: free of acne from k·w·A·tan θ; law 2: a gap of b·sin θ − t / cos ψ at the foot of a wall",
     .formula = {FACTOR(constant), .operations = 0}},
    {.name = "slope",
     .acts_on = BiasTarget::compared_depth,
     .unit = "bias.unit",
     .most = most_units,
     .help = "Slope-scaled bias: max(bias.slope * (1 - N.L), bias.slope_floor).",
     .law = "law 1 at each receiver",
     .floor_help = "Smallest value of the slope-scaled bias.",
     .formula = {FACTOR(slope), .operations = 1}},
    {.name = "tan",
     .acts_on = BiasTarget::compared_depth,
     .unit = "bias.unit",
     .most = most_units,
     .help = "Bias proportional to the slope: bias.tan * tan(theta), at least bias.tan_floor and at most bias.tan_cap.",
     .law = "law 1: free of acne at every slope from tan = k·w·A",
     .floor_help = "Smallest value of the bias by tan(theta).",
     .cap_help = "Largest value of the bias by tan(theta); auto: no limit.",
     .formula = {FACTOR(tan), .operations = 0}},
    {.name = "normal_offset",
     .acts_on = BiasTarget::place_looked_up,
     .unit = "bias.offset_unit",
     .most = 1e6,
     .help = "Normal offset: the receiver is looked up at a place moved along its normal by this much (a texel "
             "is texel_m metres wide).",
     .law = "law 3: free of acne from k·w·A·sin θ; shadows move by d·tan θ",
     .no_curve = moves_the_lookup,
     .formula = {WAY(normal_offset), .operations = 0}},
    {.name = "normal_offset_sin",
     .acts_on = BiasTarget::place_looked_up,
     .unit = "bias.offset_unit",
     .most = 1e6,
     .help = "Like bias.normal_offset, multiplied by sin(theta).",
     .law = law_35,
     .no_curve = moves_the_lookup,
     .formula = {WAY(normal_offset_sin), .operations = 8}},
    {.name = "normal_offset_turned",
     .acts_on = BiasTarget::place_looked_up,
     .unit = "bias.offset_unit",
     .most = 1e6,
     .help = "Like bias.normal_offset, multiplied by (1 - N.L).",
     .law = law_35,
     .no_curve = moves_the_lookup,
     .formula = {WAY(normal_offset_turned), .operations = 4}},
    {.name = "normal_offset_lateral",
     .acts_on = BiasTarget::place_looked_up,
     .unit = "bias.offset_unit",
     .most = 1e6,
     .help = "Like bias.normal_offset_turned, but without the component along the light.",
     .law = law_35,
     .no_curve = moves_the_lookup,
     .formula = {WAY(normal_offset_lateral), .operations = 10}},
    {.name = "normal_offset_axes",
     .acts_on = BiasTarget::place_looked_up,
     .unit = "bias.offset_unit",
     .most = 1e6,
     .help = "Like bias.normal_offset, multiplied by |N.u| + |N.v|, where u and v are the texel's two axes.",
     .law = law_35,
     .no_curve = moves_the_lookup,
     .formula = {WAY(normal_offset_axes), .operations = 14}},
    {.name = "caster_offset",
     .acts_on = BiasTarget::caster,
     .unit = "bias.offset_unit",
     .most = 1e4,
     .help =
         "While the map is drawn, each vertex is moved away from the light by this much; in texels, as wide as texels "
         "are at the vertex.",
     .law = law_35,
     .no_curve = is_in_the_map,
     .formula = {WAY(caster_offset)}},
    {.name = "caster_normal_offset",
     .acts_on = BiasTarget::caster,
     .unit = "bias.offset_unit",
     .most = 1e4,
     .help =
         "Like bias.caster_offset, but each vertex is moved against its normal: that of its file, or without one the "
         "mean of its faces' normals, weighted by their areas.",
     .law = law_35,
     .no_curve = is_in_the_map,
     .formula = {WAY(caster_normal_offset)}},
    {.name = "caster_normal_offset_sin",
     .acts_on = BiasTarget::caster,
     .unit = "bias.offset_unit",
     .most = 1e4,
     .help = "Like bias.caster_normal_offset, multiplied by sin(theta) at the vertex.",
     .law = law_35,
     .no_curve = is_in_the_map,
     .formula = {WAY(caster_normal_offset_sin)}},
    {.name = "caster_normal_offset_turned",
     .acts_on = BiasTarget::caster,
     .unit = "bias.offset_unit",
     .most = 1e4,
     .help = "Like bias.caster_normal_offset, multiplied by (1 - N.L) at the vertex.",
     .law = law_35,
     .no_curve = is_in_the_map,
     .formula = {WAY(caster_normal_offset_turned)}},
    {.name = "polygon_factor",
     .acts_on = BiasTarget::caster,
     .unit = "",
     .most = 1e4,
     .help =
         "Polygon offset: glPolygonOffset(bias.polygon_factor, bias.polygon_units) while the map is drawn. The "
         "factor multiplies the largest depth slope of each triangle, in depth per texel. A negative one moves the map "
         "towards the light.",
     .law = "adds factor·max(|∂d/∂i|, |∂d/∂j|) to the depth in the map",
     .no_curve = is_in_the_map,
     .either_sign = true},
    {.name = "polygon_units",
     .acts_on = BiasTarget::caster,
     .unit = "",
     .most = 1e8,
     .help =
         "Polygon offset: the units multiply the smallest depth difference that the map's format resolves. Negative "
         "ones move the map towards the light.",
     .law = "adds units·r to the depth in the map; r: the least difference of the format",
     .no_curve = is_in_the_map,
     .either_sign = true},
};

constexpr TapReference references[] = {
    {.name = "own_depth",
     .help = "the receiver's own depth",
     .law = "law 1: needs k·w·A·tan θ",
     .depth = in_float::own_depth},
    {.name = "receiver_plane",
     .help = "the depth of the receiver's plane at the tap",
     .law = "needs w/2·A·tan θ with any filter; over creases the plane is carried too far, up to bias.plane_cap",
     .depth = in_float::receiver_plane,
     .operations = 6,
     .plane = true,
     .reads_cap = true},
    {.name = "texel_plane",
     .help = "the depth of the receiver's plane at the centre of the tap's texel",
     .law = "needs the rounding alone on planes, with any filter; over creases as receiver_plane",
     .depth = in_float::texel_plane,
     .operations = 4,
     .plane = true,
     .at_texel = true},
};

#undef FACTOR
#undef WAY

std::vector<BiasParameter> make_bias_parameters() {
  using Role = BiasParameter::Role;
  std::vector<BiasParameter> all;
  for (const BiasPart& part : parts) {
    const auto add = [&](Role role, const char* ending, std::string_view help) {
      const std::string name = std::string(part.name) + ending;
      if (!help.empty()) all.push_back({&part, role, name, "bias." + name, help});
    };
    add(Role::amount, "", part.help);
    add(Role::floor, "_floor", part.floor_help);
    add(Role::cap, "_cap", part.cap_help);
  }
  return all;
}

}  // namespace

std::span<const BiasPart> bias_parts() { return parts; }
const BiasPart& bias_part(std::string_view name) { return find_row(parts, name, "part of a bias"); }

std::span<const BiasParameter> bias_parameters() {
  static const std::vector<BiasParameter> all = make_bias_parameters();
  return all;
}

size_t bias_parameter_index(std::string_view name) {
  const std::span<const BiasParameter> all = bias_parameters();
  return static_cast<size_t>(&find_row(all, name, "parameter of a bias") - all.data());
}

std::span<const TapReference> tap_references() { return references; }
const TapReference& tap_reference(std::string_view name) { return find_row(references, name, "reference of a tap"); }

}  // namespace noonmark
