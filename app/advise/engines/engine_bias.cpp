// The bias of a recommendation in the fields of an engine.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "app/advise/engines/cover.h"
#include "app/advise/engines/engine.h"
#include "technique/bias.h"

namespace noonmark {
namespace {

// A plane at a slope: cosine, sine and tangent of theta. A is |cos phi| + |sin phi|.
struct Plane {
  double c, s, t, phi;
};
struct FormRow {
  BiasForm form;
  std::array<std::string_view, 3> parts;  // that gain so
  double (*gain)(const Plane&);
};
constexpr FormRow forms[] = {
    {BiasForm::constant, {"constant", "caster_offset"}, [](const Plane&) { return 1.0; }},
    {BiasForm::slope, {"slope"}, [](const Plane& p) { return 1 - p.c; }},
    {BiasForm::normal, {"normal_offset", "caster_normal_offset"}, [](const Plane& p) { return 1 / p.c; }},
    // Along the normal by the sine, or a depth by the tangent.
    {BiasForm::tangent, {"tan", "normal_offset_sin", "caster_normal_offset_sin"}, [](const Plane& p) { return p.t; }},
    // Along the normal by 1 - N.L; and that without its component along the light.
    {BiasForm::turned,
     {"normal_offset_turned", "caster_normal_offset_turned"},
     [](const Plane& p) { return (1 - p.c) / p.c; }},
    {BiasForm::turned_sideways, {"normal_offset_lateral"}, [](const Plane& p) { return (1 - p.c) * p.s * p.t; }},
    {BiasForm::sideways,
     {},
     [](const Plane& p) { return p.s * p.t; }},  // `normal` without its component along the light
    {BiasForm::axes,
     {"normal_offset_axes"},
     [](const Plane& p) { return p.t * (std::abs(std::cos(p.phi)) + std::abs(std::sin(p.phi))); }},
    {BiasForm::polygon_factor,
     {"polygon_factor"},
     [](const Plane& p) { return p.t * std::max(std::abs(std::cos(p.phi)), std::abs(std::sin(p.phi))); }},
    {BiasForm::polygon_resolution, {"polygon_units"}, [](const Plane&) { return 1.0; }}};

// The least step of the map's format in window depth. Of 32f it is the step of depths from 1/2 to 1.
double format_step(DepthFormat format) { return format == DepthFormat::d16 ? 0x1p-16 : 0x1p-24; }

// Law 1: what a part must cover grows with the reach of the filter and with the texel. A part in metres or in depth, which
// also covers rounding, is never made less.
double factor_of(const AdvisedPart& part, const AdvicePlace& place) {
  const double reach = std::max(1.0, place.filter.reach_texels / place.reach_texels);
  const double texel = place.map.texel_m / place.texel_m;
  return reach * (part.part->unit == "bias.offset_unit" && place.settings.bias.offset_unit == OffsetUnit::texel
                      ? texel
                      : std::max(1.0, texel));
}

// The depth that the engine's other fields must give: of the parts without a field, and of a reference that it does not
// have, less what it always adds.
double needed_m(const Engine& engine, const AdvicePlace& place, const std::vector<AdvisedPart>& without, double theta,
                double phi) {
  double depth = 0;
  for (const AdvisedPart& part : without) depth += factor_of(part, place) * part.depth_m(theta, phi);
  if (tap_reference(place.settings.bias.reference).plane)  // law 1
    depth +=
        std::max(place.reach_texels, place.filter.reach_texels) * place.map.texel_m * gain(BiasForm::axes, theta, phi);
  for (const auto& [name, amount] : engine.always)
    if (const BiasForm form = form_of(bias_part(name)); form == BiasForm::polygon_factor)
      depth -= amount * place.map.texel_m * gain(form, theta, phi);
  return depth;
}

void add_from(std::string& from, std::string_view comment, const std::string& what) {
  from += (from.empty() ? fmt::format("  {} ", comment) : ", ") + what;
}

}  // namespace

BiasForm form_of(const BiasPart& part) {
  for (const FormRow& row : forms)
    if (std::find(row.parts.begin(), row.parts.end(), part.name) != row.parts.end()) return row.form;
  throw std::logic_error("a part of a bias without its form");
}

double gain(BiasForm form, double theta_rad, double phi_rad) {
  return forms[static_cast<size_t>(form)].gain(
      {std::cos(theta_rad), std::sin(theta_rad), std::tan(theta_rad), phi_rad});
}

double AdvisedPart::depth_m(double theta_rad, double phi_rad) const {
  return step_m * std::min(std::max(amount * gain(form, theta_rad, phi_rad), floor), cap);
}

std::vector<AdvisedPart> advised_parts(const AdvicePlace& place) {
  const BiasSettings& bias = place.settings.bias;
  double unit_m = 1;
  if (bias.unit == BiasUnit::texel) unit_m = place.texel_m;
  if (bias.unit == BiasUnit::depth) unit_m = 1 / place.depth_slope;
  std::vector<AdvisedPart> parts;
  for (const BiasPart& part : bias_parts()) {
    const BiasForm form = form_of(part);
    const std::string name(part.name);
    const bool bounded = !part.floor_help.empty();
    if (bias[name] == 0 && !(bounded && bias[name + "_floor"] != 0)) continue;
    double metres = 1;
    if (part.unit == "bias.unit") metres = unit_m;
    if (part.unit == "bias.offset_unit") metres = Bias(bias).offset_m(place.texel_m);
    if (part.acts_on == BiasTarget::compared_depth) metres *= place.frame.bias_scale;
    AdvisedPart advised{&part, form, bias[name] * metres, bias[name], 0, no_limit};
    if (bounded) advised.floor = bias[name + "_floor"] * metres;
    if (!part.cap_help.empty()) advised.cap = bias[name + "_cap"] * metres;
    if (form == BiasForm::polygon_factor) advised.step_m = place.texel_m;
    if (form == BiasForm::polygon_resolution)
      advised.step_m = format_step(place.settings.map.format) / place.depth_slope;
    parts.push_back(advised);
  }
  return parts;
}

const EngineKnob* knob_for(const std::vector<EngineKnob>& knobs, const AdvisedPart& part) {
  const EngineKnob* found = nullptr;
  for (const EngineKnob& knob : knobs)
    if (knob.form() == part.form && (!found || knob.target() == part.part->acts_on)) found = &knob;
  return found;
}

Typed typed_amounts(const Engine& engine, const AdvicePlace& place, const std::vector<EngineKnob>& knobs,
                    const std::vector<AdvisedPart>& parts) {
  Typed typed{std::vector<double>(knobs.size(), 0), std::vector<std::string>(knobs.size()), {}, true};
  for (const AdvisedPart& part : parts) {
    const EngineKnob* knob = knob_for(knobs, part);
    if (!knob) {
      typed.replaced.push_back(part);
      continue;
    }
    const size_t i = static_cast<size_t>(knob - knobs.data());
    typed.metres[i] += factor_of(part, place) * part.amount;
    add_from(typed.from[i], engine.comment, fmt::format("bias.{}", part.part->name));
  }
  const bool plane = tap_reference(place.settings.bias.reference).plane;
  if (typed.replaced.empty() && !plane) return typed;
  std::vector<size_t> offered;
  std::vector<BiasForm> offered_forms;
  for (size_t i = 0; i < knobs.size(); ++i) {
    const BiasForm form = knobs[i].form();
    if (form == BiasForm::polygon_factor || form == BiasForm::polygon_resolution) continue;
    offered.push_back(i);
    offered_forms.push_back(form);
  }
  const auto cover = least_cover(
      offered_forms, [&](double theta, double phi) { return needed_m(engine, place, typed.replaced, theta, phi); });
  typed.suffices = cover.has_value();
  for (size_t k = 0; cover && k < offered.size(); ++k) {
    if ((*cover)[k] == 0) continue;
    typed.metres[offered[k]] += (*cover)[k];
    for (const AdvisedPart& part : typed.replaced)
      add_from(typed.from[offered[k]], engine.comment, fmt::format("in place of bias.{}", part.part->name));
    if (plane) add_from(typed.from[offered[k]], engine.comment, "in place of bias.reference");
  }
  return typed;
}

}  // namespace noonmark
