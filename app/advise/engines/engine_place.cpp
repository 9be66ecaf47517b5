// What an engine's rows give at a place of the light: its map, filter and sides.
#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "app/advise/engines/engine.h"
#include "scenes/camera_fit.h"
#include "scenes/camera_frame.h"
#include "technique/lookups.h"

namespace noonmark {
namespace {

// 6 digits are printed, so a texel that is wider by less than half a unit of the last is the recommended one.
constexpr double same_texel = 1 + 5e-6;

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

SeenFrustum seen_frustum(const Settings& settings, const Scene& scene) {
  const Camera camera = effective_camera(scene, settings.view);
  const CameraFrame frame = make_camera_frame(camera, settings.view.width_px, settings.view.height_px);
  return {camera.projection == Projection::perspective, std::hypot(frame.half_width, frame.half_height),
          farthest_in_view_m(settings, scene)};
}

}  // namespace

std::string_view EngineKnob::word() const {
  const size_t last = field.find_last_of(":>");
  if (last != field.npos) return field.substr(field.find_first_not_of(": >", last));
  return field.substr(field.find('.') + 1);
}

std::vector<const BiasPart*> EngineKnob::parts() const {
  constexpr std::string_view group = "bias.", plus = " + bias.";
  const std::string_view names = is.substr(group.size());
  const size_t two = names.find(plus);
  if (two == names.npos) return {&bias_part(names)};
  return {&bias_part(names.substr(0, two)), &bias_part(names.substr(two + plus.size()))};
}

// (1 - c) / c + (1 - c) = s t: the only sum that an engine has.
BiasForm EngineKnob::form() const { return parts().size() > 1 ? BiasForm::sideways : form_of(*parts().front()); }

std::vector<EngineKnob> Engine::biases(LightKind kind) const {
  std::vector<EngineKnob> found;
  for (const EngineKnob& knob : knobs)
    if (knob.is_bias() && (knob.lights & light_bit(kind))) found.push_back(knob);
  return found;
}

const EngineKnob* Engine::knob_of(std::string_view setting) const {
  const auto found =
      std::find_if(knobs.begin(), knobs.end(), [&](const EngineKnob& knob) { return knob.is == setting; });
  return found == knobs.end() ? nullptr : &*found;
}

const EngineKnob* Engine::knob_of_word(std::string_view word, LightKind kind) const {
  for (const EngineKnob& knob : knobs)
    if (knob.word() == word && (knob.lights & light_bit(kind))) return &knob;
  return nullptr;
}

const std::vector<std::string_view>* Engine::choices_of(std::string_view setting) const {
  for (const auto& [name, words] : choices)
    if (name == setting) return &words;
  return nullptr;
}

CulledFaces Engine::culled(const AdvicePlace& place) const {
  const CulledFaces asked = place.settings.map.cull;
  if (!map.sides_of_materials) return asked;
  const std::vector<std::string_view>* words = choices_of("map.cull");
  return words && words->at(static_cast<size_t>(asked)) != words->at(0) ? asked : place.unseen;
}

double AdvicePlace::perspective_slope(double near_m, double far_m) const {
  MapTile tile;
  tile.near_m = near_m;
  tile.far_m = far_m;
  tile.depth = TileDepth::perspective;
  return tile.window_depth_slope(distance_m);
}

double farthest_in_view_m(const Settings& settings, const Scene& scene) {
  const Camera camera = effective_camera(scene, settings.view);
  const Camera fitted = with_fitted_depths(scene, camera, settings.view.width_px, settings.view.height_px);
  return std::min(*camera.far_m, *fitted.far_m);
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

double mean_sphere_m(const SeenFrustum& seen, double far_m) { return 2 * std::hypot(far_m / 2, seen.half_at(far_m)); }

EngineMap engine_map(const Engine& engine, const AdvicePlace& place, std::optional<int> resolution) {
  if (!engine.map.width_m || place.kind() != LightKind::directional)
    return {place.frame.resolution, place.frame.extent_m, place.texel_m};
  const MapSettings& asked = place.settings.map;
  const int most = static_cast<int>(engine.knob_of("map.resolution")->most);
  EngineMap map;
  map.reach_m = asked.fit == MapFit::sphere && asked.reach_m ? *asked.reach_m : place.seen.farthest_m;
  for (int size = static_cast<int>(std::bit_ceil(static_cast<unsigned>(place.frame.resolution)));; size *= 2) {
    map.resolution = resolution ? *resolution : std::min(size, most);
    map.extent_m =
        engine.map.width_m(place.seen, *map.reach_m) * map.resolution / std::max(1, map.resolution - engine.map.border);
    map.texel_m = map.extent_m / map.resolution;
    map.coarser = map.texel_m > same_texel * place.texel_m;
    if (resolution || !map.coarser || map.resolution == most) return map;
  }
}

EngineFilter as_filter(const EngineFilterRow& row, double parameter, const EngineText& of) {
  std::string lines(row.lines);
  const std::string word = "{" + std::string(row.parameter) + "}";
  if (const size_t at = row.parameter.empty() ? lines.npos : lines.find(word); at != lines.npos)
    lines.replace(at, word.size(), number(parameter));
  EngineFilter made;
  made.lines = text_lines(lines, of);
  made.what = row.what;
  made.reach_texels = row.reach + row.reach_of_one * parameter;
  made.same = filter_is(of.place, row.kind, row.size);
  made.scale = row.scale + row.scale_of_one * parameter;
  if (!row.kind.empty() && parameter == 0)
    made.as.emplace(std::string(row.kind), std::initializer_list<std::pair<std::string_view, double>>{});
  if (made.as && row.size > 0) (*made.as)["size"] = row.size;
  return made;
}

std::optional<EngineFilter> as_lookup(const Engine& engine, const AdvicePlace& place) {
  for (const EngineLookupRow& row : engine.lookups) {
    if (row.kind != place.settings.lookup.kind) continue;
    EngineFilter made;
    made.what = row.what;
    made.reach_texels = place.reach_texels;  // no law asks for more bias: nothing is compared
    made.same = true;
    made.as = FilterSettings();
    made.lookup = place.settings.lookup;
    for (const auto& [parameter, value] : row.fixed) (*made.lookup)[parameter] = value;
    made.format = row.format;
    made.cannot = row.cannot;
    if (row.blur) row.blur(place, made);
    made.lines = text_lines(row.lines, {engine, place});
    return made;
  }
  return std::nullopt;
}

bool filter_is(const AdvicePlace& place, std::string_view kind, int size) {
  const FilterSettings& filter = place.settings.filter;
  return filter.kind == kind && (size == 0 || filter.whole("size") == size);
}

}  // namespace noonmark
