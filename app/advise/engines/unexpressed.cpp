#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "app/advise/engines/engine.h"
#include "technique/lookups.h"

namespace noonmark {
std::string unexpressed_bias(const std::vector<AdvisedPart>& parts, const AdvicePlace& place) {
  std::vector<std::string> what;
  for (const AdvisedPart& part : parts) what.push_back(fmt::format("bias.{} = {}", part.part->name, number(part.set)));
  if (tap_reference(place.settings.bias.reference).plane)
    what.push_back("bias.reference = " + place.settings.bias.reference);
  return fmt::format(
      "There are no lines: no fields of the engine give as much depth as {} at every slope and azimuth. Take another "
      "technique.",
      fmt::join(what, " and "));
}

std::vector<std::string> unexpressed_part(const AdvisedPart& part, const EngineKnob* knob, bool replaced) {
  const std::string_view name = part.part->name;
  std::vector<std::string> said;
  if (!knob && replaced)
    said.push_back(fmt::format(
        "bias.{} = {} has no field of its form. The lines hold the least of other fields that gives at least as much "
        "depth at every slope and azimuth (law 35).",
        name, number(part.set)));
  else if (!knob)
    said.push_back(fmt::format("bias.{} = {} has no field of its form.", name, number(part.set)));
  else if (!replaced)
    said.push_back(fmt::format("bias.{} has a field, {}, but alone it is not enough.", name, knob->field));
  else if (knob->target() != part.part->acts_on)
    said.push_back(
        fmt::format("bias.{} acts on {}, {} on {}. On planes both give the same depth along the light. Near edges they "
                    "differ: an offset along the normal moves a shadow's outline, and a moved caster can let light "
                    "pass at the foot of a thin wall.",
                    name, place_name(part.part->acts_on), knob->field, place_name(knob->target())));
  if (part.floor > 0)
    said.push_back(
        fmt::format("bias.{}_floor: the engine has no least value of a part. A constant bias of {} m along the light "
                    "gives at least as much where the floor acts, on surfaces that are nearly square to the light.",
                    name, number(part.floor)));
  if (std::isfinite(part.cap))
    said.push_back(fmt::format(
        "bias.{}_cap: the engine has no greatest value of a part. Where the bias would exceed {} m, shadows begin "
        "further from their occluders than recommended.",
        name, number(part.cap)));
  return said;
}

std::string unexpressed_reference(const AdvicePlace& place, bool replaced) {
  const std::string& reference = place.settings.bias.reference;
  if (!tap_reference(reference).plane) return "";
  std::string said = fmt::format(
      "bias.reference = {}: every tap is compared with one depth, the receiver's own. So the bias must cover the whole "
      "kernel (law 1: k w A tan(theta), k = {} texels), which the recommended bias need not.",
      reference, number(std::max(place.reach_texels, place.filter.reach_texels)));
  if (replaced) said += " The lines hold the least that does.";
  if (place.settings.bias.plane_cap) said += " bias.plane_cap has no meaning then.";
  return said;
}

std::string unexpressed_filter(const AdvicePlace& place) {
  if (place.filter.lookup || place.filter.same) return "";
  std::string said = fmt::format(
      "filter.kind = {} reaches k = {} texels. The nearest filter here is {}, which reaches {} texels.",
      place.settings.filter.kind, number(place.reach_texels), place.filter.what, number(place.filter.reach_texels));
  if (place.filter.reach_texels > place.reach_texels)
    said += fmt::format(" Law 1 needs a bias in proportion to k: the lines hold {} times the recommended one.",
                        number(place.filter.reach_texels / place.reach_texels));
  return said;
}

std::vector<std::string> unexpressed_lookup(const AdvicePlace& place) {
  if (!place.filter.lookup) return {};
  const LookupSettings &asked = place.settings.lookup, &as = *place.filter.lookup;
  std::vector<std::string> said;
  for (const auto& read : find_lookup(asked.kind).reads) {
    const std::string name(read.parameter->name());
    if (asked[name] != as[name])
      said.push_back(fmt::format("{} = {}: the engine computes with {}.", read.parameter->setting, number(asked[name]),
                                 number(as[name])));
  }
  if (!place.filter.same)
    said.push_back(
        fmt::format("filter.kind = {}: the nearest blur here is {}.", place.settings.filter.kind, place.filter.what));
  if (!place.filter.cannot.empty()) said.emplace_back(place.filter.cannot);
  return said;
}

std::vector<std::string> unexpressed_map(const AdvicePlace& place, const std::vector<std::string_view>& expressed) {
  constexpr std::string_view rows[] = {"map.snap",        "map.shift_u_texels", "map.shift_v_texels",
                                       "map.wrap",        "map.cull",           "map.lit_beyond_far",
                                       "map.depth_clamp", "map.pancake",        "map.turn_deg",
                                       "map.fov_deg",     "light.radius_m",     "light.angular_diameter_deg",
                                       "map.roll_deg",    "map.aspect",         "map.fit_fov_deg"};
  const Settings defaults;
  std::vector<std::string> said;
  for (std::string_view name : rows) {
    const Setting& row = find_setting(name);
    if (row.get(place.settings) == row.get(defaults)) continue;
    if (row.why_idle && !row.why_idle(place.settings, place.kind()).empty()) continue;
    if (std::find(expressed.begin(), expressed.end(), name) != expressed.end()) continue;
    said.push_back(
        fmt::format("{} = {} is not set by the lines above; the engine decides it.", name, row.get(place.settings)));
  }
  return said;
}

std::string unexpressed_distance(const AdvicePlace& place) {
  if (place.frame.uniform()) return "";
  return fmt::format(
      "On a {} light a texel is wider and a step of depth is longer at a greater distance. The numbers hold at {} m "
      "from the light along the axis{}, where a texel is {} m wide.",
      kind_of_light(place.kind()).name(), number(place.distance_m),
      place.kind() == LightKind::point ? " of a face of the cube" : "", number(place.texel_m));
}

}  // namespace noonmark
