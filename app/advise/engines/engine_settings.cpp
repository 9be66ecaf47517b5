#include "app/advise/engines/engine_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "app/advise/engines/cover.h"
#include "app/advise/engines/engine.h"
#include "app/advise/engines/engine_cascades.h"
#include "app/advise/engines/engine_emulated.h"
#include "app/advise/engines/unexpressed.h"
#include "technique/cascades.h"
#include "technique/filters.h"
#include "technique/lookups.h"
#include "technique/tap_pattern.h"

namespace noonmark {
namespace {

// The table. OpenGL stands last; it has no fields of its own (opengl.cpp).
std::vector<Engine> engines() {
  return {three_js(), babylon_js(), playcanvas(), godot(), bevy(), filament(), unity_urp()};
}

// "github.com/OWNER/NAME at COMMIT: FILE:LINE, FILE:LINE; ..."
std::string text_of(const std::vector<EngineSource>& sources) {
  std::string text, at;
  for (const EngineSource& one : sources) {
    const std::string here = fmt::format("github.com/{} at {}: ", one.repository, one.commit);
    text += here == at ? ", " : (text.empty() ? "" : "; ") + here;
    text += one.path + (one.line > 0 ? fmt::format(":{}", one.line) : "");
    at = here;
  }
  return text;
}

// A place of the map at which depths and texels become metres.
glm::dvec3 advised_point(const Settings& settings, const LightFrame& frame, const Scene& scene) {
  const glm::dvec3 seen = frame.to_light(settings.view.target_m.value_or(scene.camera.target_m));
  if (frame.light().rays().have_one_direction()) return {0, 0, frame.near_m};  // every place is alike
  const double distance = frame.kind == LightKind::point ? glm::length(seen) : seen.z;
  return frame.cube_axes * glm::dvec3(0, 0, std::clamp(distance, frame.near_m, frame.far_m));
}

double reach_of(const Settings& settings, double texel_m) {
  const TapPattern pattern = tap_pattern(settings);
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
  place.seen = seen_frustum(settings, scene);
  place.unseen = std::find(scene.single_sided.begin(), scene.single_sided.end(), true) == scene.single_sided.end()
                     ? CulledFaces::none
                     : CulledFaces::back;
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
    if (part.unit == "bias.offset_unit") metres = Bias(bias).offset_m(place.texel_m);
    if (part.acts_on == BiasTarget::compared_depth) metres *= place.frame.bias_scale;
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

// The metres of each knob, and what of the settings each holds.
struct Typed {
  std::vector<double> metres;
  std::vector<std::string> from;
  std::vector<AdvisedPart> replaced;  // parts without a field of their form
  bool suffices = true;
};

void add_from(std::string& from, const std::string& comment, const std::string& what) {
  from += (from.empty() ? "  " + comment + " " : ", ") + what;
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
    if (knobs[i].form == BiasForm::polygon_factor || knobs[i].form == BiasForm::polygon_resolution) continue;
    offered.push_back(i);
    offered_forms.push_back(knobs[i].form);
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

// Whether each of the maps has this line of its own.
bool is_of_each(const Engine& engine, const std::string& line, size_t maps) {
  return maps > 1 && !engine.cascades->each.empty() && line.starts_with(engine.cascades->each_begins);
}

// The line to type. typed: the number of each cascade, or of the one map. If the engine has the field once for all cascades, the
// numbers are equal and the first is written.
std::string knob_line(const Engine& engine, const EngineKnob& knob, const std::vector<double>& typed) {
  const auto literal = engine.literal ? engine.literal : number;
  if (!is_of_each(engine, knob.line, typed.size())) return fmt::format(fmt::runtime(knob.line), literal(typed.front()));
  std::vector<std::string> texts;
  for (const double value : typed) texts.push_back(literal(value));
  const bool one = std::all_of(texts.begin(), texts.end(), [&](const std::string& text) { return text == texts[0]; });
  return fmt::format(
      fmt::runtime(engine.cascades->each),
      fmt::format(fmt::runtime(knob.line), one ? texts.front() : fmt::format("[{}][i]", fmt::join(texts, ", "))));
}

std::string no_lines_for(LightKind kind) {
  return fmt::format(
      "There are no lines: Noonmark does not describe what this engine does with the bias of a {} light.",
      kind_of_light(kind).name());
}

double greatest_of(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
}

// places: of the one map, or of each cascade. parts: of each place.
EngineAdvice advice_of(const Engine& engine, const std::vector<AdvicePlace>& places,
                       const std::vector<std::vector<AdvisedPart>>& parts, const AdvisedCascades* cascades) {
  const AdvicePlace& place = places.front();
  EngineAdvice advice{engine.name, engine.version, {}, {}, text_of(engine.sources), engine.comment};
  const std::vector<EngineKnob> knobs = engine.knobs(place.kind());
  std::vector<Typed> typed;
  for (size_t k = 0; k < places.size(); ++k) typed.push_back(typed_amounts(engine, places[k], knobs, parts[k]));
  const bool suffices = std::all_of(typed.begin(), typed.end(), [](const Typed& one) { return one.suffices; });
  std::vector<std::string> once;  // what is said of fields that all cascades share, and of numbers that are too large
  if (suffices && !knobs.empty()) {
    advice.lines = cascades ? engine.cascades->lines(*cascades) : engine.map_lines(place);
    for (const std::string& line : place.filter.lines) {
      const bool each = is_of_each(engine, line, places.size());
      advice.lines.push_back(fmt::format(
          "{}  {} {}{}filter.kind = {}", each ? fmt::format(fmt::runtime(engine.cascades->each), line) : line,
          engine.comment, place.filter.lookup ? fmt::format("lookup.kind = {}, ", place.settings.lookup.kind) : "",
          place.filter.same ? "" : "in place of ", place.settings.filter.kind));
    }
    ActingMetres acting;
    for (size_t i = 0; i < knobs.size(); ++i) {
      const EngineKnob& knob = knobs[i];
      std::vector<double> numbers, metres;
      for (size_t k = 0; k < places.size(); ++k) {
        metres.push_back(typed[k].metres[i]);
        numbers.push_back(knob.typed(metres[k], places[k]));
      }
      const std::vector<double> needed = numbers;
      if (cascades && !is_of_each(engine, knob.line, places.size())) {
        once.push_back(one_for_all(knob.field, numbers));
        numbers.assign(places.size(), greatest_of(numbers));
      }
      for (double& value : numbers) value = std::clamp(value, -knob.most, knob.most);
      if (const double greatest = greatest_of(needed); std::abs(greatest) > knob.most)
        once.push_back(fmt::format("{} is at most {}, and {} is needed: the lines hold less.", knob.field,
                                   number(knob.most), number(greatest)));
      for (size_t k = 0; k < places.size(); ++k)
        if (numbers[k] != needed[k]) metres[k] = numbers[k] / knob.typed(1, places[k]);
      advice.lines.push_back(knob_line(engine, knob, numbers) + typed.front().from[i]);
      acting.push_back(std::move(metres));
    }
    advice.lines.insert(advice.lines.end(), engine.last.begin(), engine.last.end());
    if (cascades)
      emulate_cascades(engine, *cascades, knobs, acting, advice);
    else
      emulate(engine, place, knobs, acting, advice);
  } else {
    advice.cannot.push_back(knobs.empty() ? no_lines_for(place.kind())
                                          : unexpressed_bias(typed.front().replaced, place));
    advice.why_not_emulated = "there are no lines";
  }
  const auto say = [&](const std::vector<std::string>& said) {
    for (const std::string& one : said)
      if (!one.empty()) advice.cannot.push_back(one);
  };
  for (const AdvisedPart& part : parts.front())
    say(unexpressed_part(part, knob_for(knobs, part), !advice.lines.empty()));
  say(unexpressed_reference(place, !advice.lines.empty()));
  if (knobs.empty())
    advice.cannot.push_back(fmt::format("filter.kind = {} is not written, either.", place.settings.filter.kind));
  else
    say(unexpressed_filter(place));
  std::vector<std::string_view> maps = engine.maps;
  if (cascades) maps.insert(maps.end(), {"map.snap", "map.depth_clamp", "map.pancake"});  // part of the engine's fit
  if (!cascades && !place.map.reach_m) maps.push_back("map.fit_fov_deg");  // the lines have the extent as a number
  say(unexpressed_map(place, maps));
  say(unexpressed_distance(place));
  say(once);
  if (cascades) say(unexpressed_choice(*engine.cascades, *cascades));
  if (cascades) say({fitted_cascades(*engine.cascades, *cascades)});
  say(cascades ? engine.cascades->limits(*cascades) : engine.limits(place));
  return advice;
}

EngineAdvice without_lines(const Engine& engine, std::string why) {
  EngineAdvice advice{engine.name, engine.version, {}, {std::move(why)}, text_of(engine.sources), engine.comment};
  advice.why_not_emulated = "there are no lines";
  return advice;
}

EngineAdvice advice_of_map(const Engine& engine, AdvicePlace place, const std::vector<AdvisedPart>& parts) {
  if (compares(place.settings)) {
    place.filter = engine.filter(place);
  } else {
    const std::optional<EngineFilter> made = engine.filtered ? engine.filtered(place) : std::nullopt;
    if (!made) return without_lines(engine, no_lines_for_lookup(place.settings.lookup.kind, engine.no_filtered));
    place.filter = *made;
  }
  place.map = engine.fit && place.kind() == LightKind::directional
                  ? engine.fit(place)
                  : EngineMap{place.frame.resolution, place.frame.extent_m, place.texel_m};
  return advice_of(engine, {place}, {parts}, nullptr);
}

std::string no_cascades(const Engine& engine, const Settings& settings) {
  const int count = settings.cascades.count;
  if (!compares(settings))
    return fmt::format("There are no lines for cascades with lookup.kind = {}.", settings.lookup.kind);
  if (!engine.cascades) return "There are no lines for cascades. " + engine.no_cascades;
  const std::vector<int>& counts = engine.cascades->counts;
  if (std::find(counts.begin(), counts.end(), count) != counts.end()) return "";
  return fmt::format("There are no lines: the engine lays {} cascades, and cascades.count = {}.",
                     fmt::join(counts, ", "), count);
}

double depth_along(const Scene& scene, glm::dvec3 way) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const glm::vec3& position : scene.positions) {
    const double depth = glm::dot(glm::dvec3(position), way);
    least = std::min(least, depth);
    most = std::max(most, depth);
  }
  return most - least;
}

EngineAdvice advice_of_cascades(const Engine& engine, const Settings& settings, const Scene& scene,
                                const SeenDepths& in_views) {
  if (std::string none = no_cascades(engine, settings); !none.empty()) return without_lines(engine, std::move(none));
  const std::vector<Technique> recommended = techniques_of(scene, settings);
  AdvisedCascades cascades;
  for (const ViewSlice& slice : recommended.front().cascade->slices) cascades.ends_m.push_back(slice.end_m);
  cascades.blend = blend_in(*engine.cascades, settings.cascades);
  // The lines set one near plane for all views. One beyond that of another view would cut open what stands close to its camera.
  cascades.near_m = std::min(recommended.front().cascade->slices.front().begin_m, in_views.nearest_m);
  cascades.laid = laid_by(*engine.cascades, settings, cascades.near_m, cascades.ends_m);
  const std::vector<Technique> laid = techniques_of(scene, cascades.laid);
  std::vector<std::vector<AdvisedPart>> parts;
  for (size_t k = 0; k < laid.size(); ++k) {
    const AdvicePlace asked = advice_place(settings, recommended[k].frame, scene);
    parts.push_back(advised_parts(asked));
    AdvicePlace place{settings, laid[k].frame};
    place.texel_m = asked.texel_m;
    place.depth_slope = 1 / place.range_m();
    place.reach_texels = asked.reach_texels;
    place.unseen = asked.unseen;
    place.seen = asked.seen;
    place.filter = engine.filter(place);
    place.map = {laid[k].frame.resolution, laid[k].frame.extent_m, laid[k].frame.extent_m / laid[k].frame.resolution};
    cascades.places.push_back(place);
  }
  cascades.scene_depth_m = depth_along(scene, laid.front().frame.forward);
  if (engine.cascades->depth_m) {
    const double depth_m = engine.cascades->depth_m(cascades);
    for (AdvicePlace& place : cascades.places) place.depth_slope = 1 / depth_m;
  }
  return advice_of(engine, cascades.places, parts, &cascades);
}

}  // namespace

BiasForm form_of(const BiasPart& part) {
  for (const FormOfPart& row : forms)
    if (row.part == part.name) return row.form;
  throw std::logic_error("a part of a bias without its form");
}

double gain(BiasForm form, double theta_rad, double phi_rad) {
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
      return t;
    case BiasForm::axes:
      return t * (std::abs(std::cos(phi_rad)) + std::abs(std::sin(phi_rad)));
    case BiasForm::polygon_factor:
      return t * std::max(std::abs(std::cos(phi_rad)), std::abs(std::sin(phi_rad)));
    case BiasForm::turned:
      return (1 - c) / c;
    case BiasForm::turned_sideways:
      return (1 - c) * s * t;
    case BiasForm::sideways:
      return s * t;
  }
  throw std::logic_error("a form of a bias without its gain");
}

double AdvisedPart::depth_m(double theta_rad, double phi_rad) const {
  return step_m * std::min(std::max(amount * gain(form, theta_rad, phi_rad), floor), cap);
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

std::string placed_comment(std::string_view of_light) {
  return fmt::format("// These lines set the light's {}. The model stands where its file puts it, in the file's size.",
                     of_light);
}

std::string_view placed_of_light(const AdvicePlace& place) {
  return place.kind() == LightKind::point ? "position" : "position and direction";
}

std::string no_lines_for_lookup(const std::string& lookup_kind, const std::string& of_engine) {
  return fmt::format("There are no lines for lookup.kind = {}. {}", lookup_kind,
                     of_engine.empty() ? "Noonmark knows of no field of this engine for it." : of_engine);
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

std::vector<EngineAdvice> engine_advice(const Settings& settings, const LightFrame& frame, const Scene& scene,
                                        const SeenDepths& in_views) {
  std::vector<EngineAdvice> all;
  if (settings.cascades.count > 1) {
    for (const Engine& engine : engines()) all.push_back(advice_of_cascades(engine, settings, scene, in_views));
    all.push_back(opengl_cascades());
    return all;
  }
  AdvicePlace place = advice_place(settings, frame, scene);
  place.seen.farthest_m = std::max(place.seen.farthest_m, in_views.farthest_m);
  const std::vector<AdvisedPart> parts = advised_parts(place);
  for (const Engine& engine : engines()) all.push_back(advice_of_map(engine, place, parts));
  all.push_back(opengl_advice(place, parts));
  return all;
}

std::string engine_word(std::string_view engine) {
  std::string word;
  for (const char c : engine) {
    const bool upper = c >= 'A' && c <= 'Z';
    if (!upper && !(c >= 'a' && c <= 'z')) break;  // three.js, Unity URP
    word += static_cast<char>(upper ? c - 'A' + 'a' : c);
  }
  return word;
}

namespace {
std::vector<std::string> engine_names() {
  std::vector<std::string> names;
  for (const Engine& engine : engines()) names.push_back(engine.name);
  names.push_back(opengl_fields().front().engine);
  return names;
}
}  // namespace

std::vector<std::string> engine_words() {
  std::vector<std::string> words;
  for (const std::string& name : engine_names()) words.push_back(engine_word(name));
  return words;
}

std::string engine_of_word(std::string_view word) {
  for (const std::string& name : engine_names())
    if (engine_word(name) == word) return name;
  throw std::logic_error("no engine has this word");
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
             place_name(knob.target)});
  for (const EngineField& row : opengl_fields()) add(row);
  return rows;
}

std::vector<std::pair<std::string, std::vector<EngineSource>>> engine_sources() {
  std::vector<std::pair<std::string, std::vector<EngineSource>>> all;
  for (Engine& engine : engines()) all.emplace_back(engine.name, std::move(engine.sources));
  return all;
}

}  // namespace noonmark
