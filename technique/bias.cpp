#include "technique/bias.h"

#include <cmath>

namespace noonmark {
namespace {

// A value beyond the range of float becomes the greatest float, which has the same effect as no cap.
float rounded(double value) { return static_cast<float>(std::min<double>(value, std::numeric_limits<float>::max())); }

bool acts(const BiasSettings& settings, const BiasPart& part) {
  const std::string name(part.name);
  return settings[name] != 0 || (!part.floor_help.empty() && settings[name + "_floor"] != 0);
}

ActivePart active_part(const BiasSettings& settings, const BiasPart& part) {
  const std::string name(part.name);
  ActivePart active{&part, rounded(settings[name])};
  if (!part.floor_help.empty()) active.floor = rounded(settings[name + "_floor"]);
  if (!part.cap_help.empty()) active.cap = rounded(settings[name + "_cap"]);
  return active;
}

}  // namespace

Bias::Bias(const BiasSettings& settings)
    : unit_(settings.unit),
      offset_unit_(settings.offset_unit),
      reference_(&tap_reference(settings.reference)),
      plane_cap_(rounded(settings.plane_cap.value_or(std::numeric_limits<double>::infinity()))) {
  for (const BiasPart& part : bias_parts()) {
    if (!acts(settings, part)) continue;
    if (part.acts_on == BiasTarget::compared_depth) compared_.push_back(active_part(settings, part));
    if (part.acts_on == BiasTarget::place_looked_up) moving_.push_back(active_part(settings, part));
    if (part.acts_on == BiasTarget::caster && part.formula.way) casting_.push_back(active_part(settings, part));
  }
  const PolygonOffset offset{rounded(settings["polygon_factor"]), rounded(settings["polygon_units"])};
  if (offset.factor != 0 || offset.units != 0) polygon_offset_ = offset;
}

std::string unit_of_amount(std::string_view unit, const BiasSettings& settings) {
  Settings all;
  all.bias = settings;
  if (unit == "bias.unit") return find_setting(unit).get(all);
  if (unit == "bias.offset_unit") return settings.offset_unit == OffsetUnit::m ? "m" : "texels";
  return std::string(unit);
}

float Bias::at(const LookupProbe& probe, size_t i) const {
  if (compared_.empty()) return 0;
  const in_float::Surface surface = surface_of(probe, i);
  float sum = 0;  // exact: 0 plus the first part is that part
  for (const ActivePart& active : compared_) sum += active.held(active.part->formula.factor(surface));
  return sum * probe.bias_unit[i];
}

bool Bias::reads_tan() const {
  in_float::Surface flat{}, steep{};
  flat.n_dot_l = steep.n_dot_l = 0.5f;
  flat.tan_theta = 1;
  steep.tan_theta = 2;
  return compares_otherwise(flat, steep);
}

bool Bias::reads_normal() const {
  in_float::Surface flat{}, steep{};
  flat.n_dot_l = 0.75f;
  flat.tan_theta = 1;
  steep.n_dot_l = 0.5f;
  steep.tan_theta = 2;
  return moves_lookup() || compares_otherwise(flat, steep);
}

bool Bias::compares_otherwise(const in_float::Surface& one, const in_float::Surface& other) const {
  return std::any_of(compared_.begin(), compared_.end(), [&](const ActivePart& active) {
    return active.part->formula.factor(one) != active.part->formula.factor(other);
  });
}

glm::dvec3 Bias::moved_m(const LightFrame& frame, glm::dvec3 position, glm::dvec3 normal) const {
  glm::dvec3 moved(0);
  if (moving_.empty()) return moved;
  const in_double::Surface surface = surface_at(frame, position, normal);
  const double unit_m = offset_m(frame.texel_m(frame.to_light(position)));
  for (const ActivePart& active : moving_) moved += active.amount * unit_m * active.part->formula.way(surface);
  return moved;
}

in_double::Surface surface_at(const LightFrame& frame, glm::dvec3 position, glm::dvec3 normal) {
  in_double::Surface surface{};
  surface.normal = normal;
  surface.to_light = frame.direction_to_light(position);
  glm::dvec3 right, up;
  frame.light().texel_axes(frame, frame.to_light(position), right, up);
  surface.texel_right = right;
  surface.texel_up = up;
  surface.n_dot_l = glm::dot(normal, surface.to_light);
  const double cosine = std::clamp(surface.n_dot_l, least_cosine, 1.0);
  surface.tan_theta = std::sqrt(1 - cosine * cosine) / cosine;
  return surface;
}

const BiasPart* curve_part(const BiasSettings& settings) {
  bool none = true;
  for (const BiasPart& part : bias_parts()) {
    if (!acts(settings, part)) continue;
    none = false;
    if (part.no_curve.empty()) return &part;
  }
  return none ? &bias_part("constant") : nullptr;
}

}  // namespace noonmark
