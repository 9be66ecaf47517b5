#include "app/advise/engines/engine_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "app/advise/engines/engine.h"
#include "app/advise/engines/unexpressed.h"
#include "technique/filters.h"
#include "technique/tap_pattern.h"

namespace noonmark {
namespace {

// The table. OpenGL stands last; it has no fields of its own (opengl.cpp).
std::vector<Engine> engines() { return {three_js(), babylon_js(), godot(), bevy(), filament(), unity_urp()}; }

// A place of the map at which depths and texels become metres.
glm::dvec3 advised_point(const Settings& settings, const LightFrame& frame, const Scene& scene) {
  const glm::dvec3 seen = frame.to_light(settings.view.target_m.value_or(scene.camera.target_m));
  if (frame.light().rays().have_one_direction()) return {0, 0, frame.near_m};  // every place is alike
  const double distance = frame.kind == LightKind::point ? glm::length(seen) : seen.z;
  return frame.cube_axes * glm::dvec3(0, 0, std::clamp(distance, frame.near_m, frame.far_m));
}

double reach_of(const Settings& settings, double texel_m) {
  const TapPattern pattern = tap_pattern(settings.filter);
  if (!pattern.in_world) return pattern.reach_texels();
  double longest_m = 0;
  for (const glm::vec3& offset : pattern.offsets) longest_m = std::max<double>(longest_m, glm::length(offset));
  return longest_m / texel_m + 0.5;
}

AdvicePlace advice_place(const Settings& settings, const LightFrame& frame, const Scene& scene) {
  const glm::dvec3 point = advised_point(settings, frame, scene);
  AdvicePlace place{settings, frame};
  place.distance_m = glm::length(point);
  place.texel_m = frame.texel_m(point);
  place.depth_slope = frame.window_depth_slope(point);
  place.cone_tan = std::tan(std::acos(std::clamp(frame.cos_half_cone, 0.0, 1.0)));
  place.reach_texels = reach_of(settings, place.texel_m);
  return place;
}

struct FormOfPart {
  std::string_view part;
  BiasForm form;
};
constexpr FormOfPart forms[] = {{"constant", BiasForm::constant},
                                {"slope", BiasForm::slope},
                                {"tan", BiasForm::tangent},
                                {"normal_offset", BiasForm::normal},
                                {"normal_offset_sin", BiasForm::tangent},
                                {"normal_offset_turned", BiasForm::turned},
                                {"normal_offset_lateral", BiasForm::turned_sideways},
                                {"normal_offset_axes", BiasForm::axes},
                                {"caster_offset", BiasForm::constant},
                                {"caster_normal_offset", BiasForm::normal},
                                {"caster_normal_offset_sin", BiasForm::tangent},
                                {"caster_normal_offset_turned", BiasForm::turned},
                                {"polygon_factor", BiasForm::polygon_factor},
                                {"polygon_units", BiasForm::polygon_resolution}};

// The least step of the map's format in window depth. Of 32f it is the step of depths from 1/2 to 1.
double format_step(DepthFormat format) { return format == DepthFormat::d16 ? 0x1p-16 : 0x1p-24; }

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
    if (part.unit == "texels") metres = place.texel_m;
    AdvisedPart advised{&part, form, bias[name] * metres, bias[name], 0, std::numeric_limits<double>::infinity()};
    if (bounded) advised.floor = bias[name + "_floor"] * metres;
    if (!part.cap_help.empty()) advised.cap = bias[name + "_cap"] * metres;
    if (form == BiasForm::polygon_factor) advised.step_m = place.texel_m;
    if (form == BiasForm::polygon_resolution)
      advised.step_m = format_step(place.settings.map.format) / place.depth_slope;
    parts.push_back(advised);
  }
  return parts;
}

// The field that has this form, on the part's own side if there is one on both.
const EngineKnob* knob_for(const std::vector<EngineKnob>& knobs, const AdvisedPart& part) {
  const EngineKnob* found = nullptr;
  for (const EngineKnob& knob : knobs)
    if (knob.form == part.form && (!found || knob.target == part.part->acts_on)) found = &knob;
  return found;
}

EngineAdvice advice_of(const Engine& engine, AdvicePlace place, const std::vector<AdvisedPart>& parts) {
  place.filter = engine.filter(place);
  EngineAdvice advice{engine.name, engine.version, engine.map_lines(place), {}, engine.source};
  for (const std::string& line : place.filter.lines)
    advice.lines.push_back(fmt::format("{}  {} filter.kind = {}", line, engine.comment, place.settings.filter.kind));
  const std::vector<EngineKnob> knobs = engine.knobs(place.kind());
  std::vector<double> metres(knobs.size(), 0);
  std::vector<std::string> from(knobs.size());
  for (const AdvisedPart& part : parts) {
    const EngineKnob* knob = knob_for(knobs, part);
    if (knob) {
      const size_t i = static_cast<size_t>(knob - knobs.data());
      metres[i] += part.amount;
      from[i] += fmt::format("{}bias.{}", from[i].empty() ? "  " + engine.comment + " " : " + ", part.part->name);
    }
    const std::vector<std::string> said = unexpressed_part(part, knob, knobs, place);
    advice.cannot.insert(advice.cannot.end(), said.begin(), said.end());
  }
  for (size_t i = 0; i < knobs.size(); ++i)
    advice.lines.push_back(fmt::format(fmt::runtime(knobs[i].line), number(knobs[i].typed(metres[i], place))) +
                           from[i]);
  for (const std::vector<std::string>& said :
       {unexpressed_reference(knobs, place), unexpressed_filter(place), unexpressed_map(place, engine.maps),
        unexpressed_distance(place), engine.limits(place)})
    advice.cannot.insert(advice.cannot.end(), said.begin(), said.end());
  return advice;
}

}  // namespace

BiasForm form_of(const BiasPart& part) {
  for (const FormOfPart& row : forms)
    if (row.part == part.name) return row.form;
  throw std::logic_error("a part of a bias without its form");
}

double gain(BiasForm form, double theta_rad) {
  const double c = std::cos(theta_rad), s = std::sin(theta_rad), t = std::tan(theta_rad);
  switch (form) {
    case BiasForm::constant:
    case BiasForm::polygon_resolution:
      return 1;
    case BiasForm::slope:
      return 1 - c;
    case BiasForm::normal:
      return 1 / c;
    case BiasForm::tangent:
    case BiasForm::axes:
    case BiasForm::polygon_factor:
      return t;
    case BiasForm::turned:
      return (1 - c) / c;
    case BiasForm::turned_sideways:
      return (1 - c) * s * t;
    case BiasForm::sideways:
      return s * t;
  }
  throw std::logic_error("a form of a bias without its gain");
}

double AdvisedPart::depth_m(double theta_rad) const {
  return step_m * std::min(std::max(amount * gain(form, theta_rad), floor), cap);
}

double AdvicePlace::perspective_slope(double near_m, double far_m) const {
  MapTile tile;
  tile.near_m = near_m;
  tile.far_m = far_m;
  tile.depth = TileDepth::perspective;
  return tile.window_depth_slope(distance_m);
}

std::string number(double value) { return fmt::format("{:.6g}", value == 0 ? 0.0 : value); }  // -0 is written as 0

std::string numbers(glm::dvec3 v) { return fmt::format("{}, {}, {}", number(v.x), number(v.y), number(v.z)); }

std::string place_name(BiasTarget target) {
  switch (target) {
    case BiasTarget::compared_depth:
      return "the receiver's compared depth";
    case BiasTarget::place_looked_up:
      return "the place looked up";
    case BiasTarget::caster:
      return "the caster";
  }
  throw std::logic_error("a bias without a place");
}

EngineFilter nearest_reach(const AdvicePlace& place, std::vector<EngineFilter> offered) {
  return *std::min_element(offered.begin(), offered.end(), [&](const EngineFilter& a, const EngineFilter& b) {
    if (a.same != b.same) return a.same;
    return std::abs(a.reach_texels - place.reach_texels) < std::abs(b.reach_texels - place.reach_texels);
  });
}

bool filter_is(const AdvicePlace& place, std::string_view kind, int size) {
  const FilterSettings& filter = place.settings.filter;
  return filter.kind == kind && (size == 0 || filter.whole("size") == size);
}

std::vector<EngineAdvice> engine_advice(const Settings& settings, const LightFrame& frame, const Scene& scene) {
  const AdvicePlace place = advice_place(settings, frame, scene);
  const std::vector<AdvisedPart> parts = advised_parts(place);
  std::vector<EngineAdvice> all;
  for (const Engine& engine : engines()) all.push_back(advice_of(engine, place, parts));
  all.push_back(opengl_advice(place, parts));
  return all;
}

std::vector<EngineField> engine_fields() {
  std::vector<EngineField> rows;
  const auto add = [&](const EngineField& row) {
    const auto same = std::find_if(rows.begin(), rows.end(), [&](const EngineField& other) {
      return other.engine == row.engine && other.field == row.field && other.unit == row.unit &&
             other.place == row.place;
    });
    if (same == rows.end())
      rows.push_back(row);
    else
      same->light += ", " + row.light;
  };
  for (const Engine& engine : engines())
    for (LightKind kind : {LightKind::directional, LightKind::spot, LightKind::point})
      for (const EngineKnob& knob : engine.knobs(kind))
        add({engine.name, engine.version, std::string(kind_of_light(kind).name()), knob.field, knob.unit,
             place_name(knob.target), engine.source});
  for (const EngineField& row : opengl_fields()) add(row);
  return rows;
}

}  // namespace noonmark
