#include "app/advise/engines/engine_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "app/advise/engines/engine.h"
#include "technique/cascades.h"
#include "technique/lookups.h"

namespace noonmark {
namespace {

// "github.com/OWNER/NAME at COMMIT: FILE:LINE, FILE:LINE; ...", or the document.
std::string source_text(const Engine& engine) {
  std::string text, at;
  for (const EngineSource& one : sources_of(engine)) {
    const std::string here = fmt::format("github.com/{} at {}: ", one.repository, one.commit);
    text += here == at ? ", " : (text.empty() ? "" : "; ") + here;
    text += place_of(one);
    at = here;
  }
  return text.empty() ? std::string(engine.sources) : text;
}

// Whether each of the maps has this line of its own.
bool is_of_each(const Engine& engine, std::string_view line, size_t maps) {
  return maps > 1 && !engine.cascades->each.empty() && line.starts_with("light.");
}

std::string in_place_of_braces(std::string_view text, std::string_view put) {
  const size_t at = text.find("{}");
  return std::string(text.substr(0, at)).append(put).append(text.substr(at + 2));
}

// The line to type. typed: the number of each cascade, or of the one map. If the engine has the field once for all cascades, the
// numbers are equal and the first is written.
std::string knob_line(const Engine& engine, const EngineKnob& knob, const std::vector<double>& typed) {
  std::vector<std::string> texts;
  for (const double value : typed) texts.push_back((engine.literal ? engine.literal : number)(value));
  if (!is_of_each(engine, knob.line, typed.size())) return in_place_of_braces(knob.line, texts.front());
  const bool one = std::all_of(texts.begin(), texts.end(), [&](const std::string& text) { return text == texts[0]; });
  return in_place_of_braces(
      engine.cascades->each,
      in_place_of_braces(knob.line, one ? texts.front() : fmt::format("[{}][i]", fmt::join(texts, ", "))));
}

std::string no_lines_for(LightKind kind) {
  return fmt::format(
      "There are no lines: Noonmark does not describe what this engine does with the bias of a {} light.",
      kind_of_light(kind).name());
}

double greatest_of(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
}

EngineAdvice begun(const Engine& engine) {
  EngineAdvice advice{std::string(engine.name), std::string(engine.version), {}, {},
                      source_text(engine),      std::string(engine.comment)};
  advice.why_not_emulated = "there are no lines";
  return advice;
}

EngineAdvice without_lines(const Engine& engine, std::string why) {
  EngineAdvice advice = begun(engine);
  advice.cannot.push_back(std::move(why));
  return advice;
}

// The settings of the map that the lines express, beside resolution, format and volume.
std::vector<std::string_view> expressed(const Engine& engine, const AdvicePlace& place, bool cascades) {
  std::vector<std::string_view> maps;
  if (engine.map.sides_of_materials) maps.push_back("map.cull");
  for (const auto& [setting, words] : engine.choices) maps.push_back(setting);
  if (engine.lines.find("{focus}") != engine.lines.npos) maps.push_back("map.fov_deg");
  if (cascades) maps.insert(maps.end(), {"map.snap", "map.depth_clamp", "map.pancake"});  // part of the engine's fit
  if (!cascades && !place.map.reach_m) maps.push_back("map.fit_fov_deg");  // the lines have the extent as a number
  return maps;
}

// places: of the one map, or of each cascade. parts: of each place.
EngineAdvice advice_of(const Engine& engine, const std::vector<AdvicePlace>& places,
                       const std::vector<std::vector<AdvisedPart>>& parts, const AdvisedCascades* cascades) {
  const AdvicePlace& place = places.front();
  const EngineText of{engine, place, cascades};
  EngineAdvice advice = begun(engine);
  const std::vector<EngineKnob> knobs = engine.biases(place.kind());
  std::vector<Typed> typed;
  for (size_t k = 0; k < places.size(); ++k) typed.push_back(typed_amounts(engine, places[k], knobs, parts[k]));
  const bool suffices = std::all_of(typed.begin(), typed.end(), [](const Typed& one) { return one.suffices; });
  std::vector<std::string> once;  // what is said of fields that all cascades share, and of numbers that are too large
  if (suffices && !knobs.empty()) {
    const std::vector<std::string> all = text_lines(engine.lines, of);
    const auto last = std::find(all.begin(), all.end(), "---");
    advice.lines.assign(all.begin(), last);
    for (const std::string& line : place.filter.lines) {
      const bool each = is_of_each(engine, line, places.size());
      advice.lines.push_back(fmt::format(
          "{}  {} {}{}filter.kind = {}", each ? in_place_of_braces(engine.cascades->each, line) : line, engine.comment,
          place.filter.lookup ? fmt::format("lookup.kind = {}, ", place.settings.lookup.kind) : "",
          place.filter.same ? "" : "in place of ", place.settings.filter.kind));
    }
    ActingMetres acting;
    for (size_t i = 0; i < knobs.size(); ++i) {
      const EngineKnob& knob = knobs[i];
      std::vector<double> numbers, metres;
      for (size_t k = 0; k < places.size(); ++k) {
        metres.push_back(typed[k].metres[i]);
        numbers.push_back(metres[k] / knob.of_one(places[k]));
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
        if (numbers[k] != needed[k]) metres[k] = numbers[k] * knob.of_one(places[k]);
      advice.lines.push_back(knob_line(engine, knob, numbers) + typed.front().from[i]);
      acting.push_back(std::move(metres));
    }
    if (last != all.end()) advice.lines.insert(advice.lines.end(), last + 1, all.end());
    emulate(of, knobs, acting, advice);
  } else {
    advice.cannot.push_back(knobs.empty() ? no_lines_for(place.kind())
                                          : unexpressed_bias(typed.front().replaced, place));
  }
  const auto say = [&](const std::vector<std::string>& said) {
    for (const std::string& one : said)
      if (!one.empty()) advice.cannot.push_back(one);
  };
  for (const AdvisedPart& part : parts.front())
    say(unexpressed_part(part, knob_for(knobs, part), !advice.lines.empty()));
  say({unexpressed_reference(place, !advice.lines.empty())});
  if (knobs.empty())
    advice.cannot.push_back(fmt::format("filter.kind = {} is not written, either.", place.settings.filter.kind));
  else
    say({unexpressed_filter(place)}), say(unexpressed_lookup(place));
  say(unexpressed_map(place, expressed(engine, place, cascades)));
  say({unexpressed_distance(place)});
  say(once);
  if (cascades) say(unexpressed_cascades(engine, *cascades));
  say(text_lines(engine.limits, of));
  return advice;
}

// Of several that are as near, the first.
EngineFilter nearest_filter(const Engine& engine, const AdvicePlace& place) {
  std::optional<EngineFilter> best;
  const auto off = [&](const EngineFilter& one) { return std::abs(one.reach_texels - place.reach_texels); };
  for (const EngineFilterRow& row : engine.filters) {
    if (!(row.lights & light_bit(place.kind()))) continue;
    const double parameter =
        row.reach_of_one > 0 ? std::max(0.0, place.reach_texels - row.reach) / row.reach_of_one : 0;
    EngineFilter offered = as_filter(row, parameter, {engine, place});
    if (row.only_itself && !offered.same) continue;
    if (!best || (offered.same != best->same ? offered.same : off(offered) < off(*best))) best = std::move(offered);
  }
  return *best;
}

EngineAdvice advice_of_map(const Engine& engine, AdvicePlace place, const std::vector<AdvisedPart>& parts) {
  place.map = engine_map(engine, place);
  if (engine.advice) return engine.advice(engine, place, parts, begun(engine));
  if (compares(place.settings)) {
    place.filter = nearest_filter(engine, place);
  } else {
    const std::optional<EngineFilter> made = as_lookup(engine, place);
    if (!made) return without_lines(engine, no_lines_for_lookup(place.settings.lookup.kind, engine.no_lookup));
    place.filter = *made;
  }
  return advice_of(engine, {place}, {parts}, nullptr);
}

std::string no_cascades(const Engine& engine, const Settings& settings) {
  const int count = settings.cascades.count;
  if (!compares(settings) && !engine.advice)
    return fmt::format("There are no lines for cascades with lookup.kind = {}.", settings.lookup.kind);
  if (!engine.cascades) return fmt::format("There are no lines for cascades. {}", engine.no_cascades);
  const std::vector<int>& counts = engine.cascades->counts;
  if (std::find(counts.begin(), counts.end(), count) != counts.end()) return "";
  return fmt::format("There are no lines: the engine lays {} cascades, and cascades.count = {}.",
                     fmt::join(counts, ", "), count);
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
  cascades.laid = laid_by(engine, settings, cascades.near_m, cascades.ends_m);
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
    place.filter = nearest_filter(engine, place);
    place.map = {laid[k].frame.resolution, laid[k].frame.extent_m, laid[k].frame.extent_m / laid[k].frame.resolution};
    cascades.places.push_back(place);
  }
  double first_m = no_limit, last_m = -no_limit;  // of the scene, along the light
  for (const glm::vec3& position : scene.positions) {
    const double depth = glm::dot(glm::dvec3(position), laid.front().frame.forward);
    first_m = std::min(first_m, depth);
    last_m = std::max(last_m, depth);
  }
  cascades.scene_depth_m = last_m - first_m;
  if (engine.cascades->depth_m) {
    const double depth_m = engine.cascades->depth_m(cascades);
    for (AdvicePlace& place : cascades.places) place.depth_slope = 1 / depth_m;
  }
  return advice_of(engine, cascades.places, parts, &cascades);
}

}  // namespace

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

std::string no_lines_for_lookup(const std::string& lookup_kind, std::string_view of_engine) {
  return fmt::format("There are no lines for lookup.kind = {}. {}", lookup_kind,
                     of_engine.empty() ? "Noonmark knows of no field of this engine for it." : of_engine);
}

namespace {
EngineAdvice advice_for_engine(const Engine& engine, const Settings& settings, const LightFrame& frame,
                               const Scene& scene, const SeenDepths& in_views) {
  if (settings.cascades.count > 1) return advice_of_cascades(engine, settings, scene, in_views);
  AdvicePlace place = advice_place(settings, frame, scene);
  place.seen.farthest_m = std::max(place.seen.farthest_m, in_views.farthest_m);
  return advice_of_map(engine, place, advised_parts(place));
}
}  // namespace

EngineAdvice advice_for_engine(std::string_view word, const Settings& settings, const LightFrame& frame,
                               const Scene& scene, const SeenDepths& in_views) {
  return advice_for_engine(engine_of(word), settings, frame, scene, in_views);
}

std::vector<EngineAdvice> engine_advice(const Settings& settings, const LightFrame& frame, const Scene& scene,
                                        const SeenDepths& in_views) {
  std::vector<EngineAdvice> all;
  for (const Engine& engine : engines()) all.push_back(advice_for_engine(engine, settings, frame, scene, in_views));
  return all;
}

}  // namespace noonmark
