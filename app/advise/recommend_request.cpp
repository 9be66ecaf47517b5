#include "app/advise/recommend_request.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <string_view>

#include "app/advise/cascade_places.h"
#include "app/advise/recommend_filtered.h"
#include "app/definition/share_text.h"
#include "base/error.h"
#include "base/shell_words.h"
#include "base/text.h"
#include "compare/judge/choices.h"
#include "compare/results/number_text.h"
#include "scenes/ground.h"
#include "scenes/interior.h"
#include "scenes/library.h"
#include "technique/light_frame.h"
#include "technique/lookups.h"
#include "technique/setting_rules.h"
#include "technique/tap_pattern.h"

namespace noonmark {
namespace {

// What says where a map lies.
constexpr std::string_view settings_of_place[] = {
    "map.fit",          "map.extent_m",    "map.extent_scale", "map.near_m",         "map.far_m",
    "map.snap",         "map.depth_range", "map.reach_m",      "map.shift_u_texels", "map.shift_v_texels",
    "light.position_m", "light.target_m"};

// Whether [answer] choose of the experiment leaves a setting to the recommendation. What the command line gives stays.
bool leaves_open(const Experiment& experiment, const std::string& setting) {
  const auto is_of = [&](const std::string& group) {
    if (group == "map.fit")
      return std::find(std::begin(settings_of_place), std::end(settings_of_place), setting) !=
             std::end(settings_of_place);
    return setting == group || setting.starts_with(group + ".");
  };
  const std::vector<std::string>& given = experiment.overridden;
  return std::any_of(experiment.choose.begin(), experiment.choose.end(), is_of) &&
         std::find(given.begin(), given.end(), setting) == given.end();
}

// Whether the user said what a setting with this beginning is, fixed or swept. The unit of the bias is none of it.
bool gives(const Experiment& experiment, std::string_view begin) {
  return std::any_of(experiment.locations.begin(), experiment.locations.end(), [&](const auto& given) {
    return given.first.starts_with(begin) && given.first != "bias.unit" && !leaves_open(experiment, given.first);
  });
}

// The points of the conditions alone: each choice of the sweep has its first value.
std::vector<Settings> conditions_of(Experiment experiment) {
  std::erase_if(experiment.swept, [](const Swept& swept) { return !swept.condition; });
  const Settings unset;
  for (const auto& [name, location] : experiment.locations)
    if (name.starts_with("map.") && leaves_open(experiment, name)) {
      const Setting& row = find_setting(name);
      row.set(experiment.base, row.get(unset));
    }
  return points(experiment);
}

// What the experiment fixes or sweeps of resolution and filter is what may be recommended.
void take_choices(AdviceRequest& request, const Experiment& experiment) {
  std::map<std::string, FilterSettings> filters;
  std::set<int> resolutions;
  for (const Settings& point : points(experiment)) {
    std::string key;
    for (const Setting& row : settings_table())
      if (row.name.starts_with("filter.")) key += row.get(point) + '\n';
    filters.emplace(key, point.filter);
    resolutions.insert(point.map.resolution);
  }
  if (gives(experiment, "map.resolution")) request.resolutions.assign(resolutions.begin(), resolutions.end());
  if (!gives(experiment, "filter.")) return;
  request.filters.clear();
  for (const auto& [key, filter] : filters) request.filters.push_back(filter);
  const auto reach = [](const FilterSettings& filter) { return tap_pattern(filter).reach_texels(); };
  std::stable_sort(request.filters.begin(), request.filters.end(),
                   [&](const auto& a, const auto& b) { return reach(a) < reach(b); });
}

// The bounds for the eye: those of the experiment, the options' in their place, and the default of what neither gives.
std::vector<Bound> eye_bounds(const Experiment& experiment, const AdviceWishes& wishes) {
  std::vector<Bound> bounds;
  std::copy_if(experiment.bounds.begin(), experiment.bounds.end(), std::back_inserter(bounds), is_eye_bound);
  for (Bound& bound : bounds)  // which choices it is about is known only to an experiment that sweeps them
    std::erase_if(bound.where, [](const auto& one) { return !decides_what_is_seen(one.first); });
  for (const Bound& usual : default_eye_bounds()) {
    const std::optional<double> given = usual.metric == edge_metric ? wishes.edges : wishes.patch;
    const auto same = [&](const Bound& bound) { return bound.metric == usual.metric; };
    if (given) std::erase_if(bounds, same);
    if (std::any_of(bounds.begin(), bounds.end(), same)) continue;
    bounds.push_back(usual);
    if (given) bounds.back().max = *given;
  }
  return bounds;
}

// A setting of the map's place that the user gave; empty: none. How far cascades reach says nothing of one map.
std::string given_place(const Experiment& experiment) {
  for (const std::string_view name : settings_of_place)
    if (name != "map.reach_m" && gives(experiment, name)) return std::string(name);
  return "";
}

// Where the map may lie: if the user says nothing of it, also elsewhere than the settings lay it.
std::vector<MapPlace> places_of(const Experiment& experiment, const AdviceRequest& request, const Scene& scene,
                                std::span<const Settings> views) {
  if (request.conditions.front().cascades.count > 1) return {place_as_given(!gives(experiment, "bias."))};
  return given_place(experiment).empty() ? map_places(scene, request.conditions, views) : std::vector{place_as_given()};
}

// What was given that decides the answer, beside the scene: "scene.floor = true, map.resolution = 512 | 1024". Empty: nothing.
// Another answer for the same scene differs in one of these. What has its default decides nothing, but for what the search would choose.
std::string given_text(const Experiment& experiment, const AdviceRequest& request) {
  const Settings& first = request.conditions.front();
  const Settings unset;
  std::vector<std::string> parts;
  for (const Setting& row : settings_table()) {
    const std::string name(row.name), value = row.get(first);
    if (name == "scene.name" || !experiment.locations.contains(name) || leaves_open(experiment, name)) continue;
    const auto swept = std::find_if(experiment.swept.begin(), experiment.swept.end(),
                                    [&](const Swept& one) { return one.name == name; });
    std::vector<std::string> values;
    if (swept != experiment.swept.end())
      for (const std::string& one : swept->values) values.push_back(setting_text(one));
    else if (value != row.get(unset) || name == "map.resolution" || name == "map.fit" || name == "filter.kind")
      values.push_back(setting_text(value));
    if (!values.empty()) parts.push_back(fmt::format("{} = {}", name, fmt::join(values, " | ")));
  }
  const CurveOptions bounds;
  if (request.curve.acne_bound != bounds.acne_bound)
    parts.push_back("acne within " + percent_text(request.curve.acne_bound));
  if (request.curve.peter_panning_bound != bounds.peter_panning_bound)
    parts.push_back("Peter Panning within " + percent_text(request.curve.peter_panning_bound));
  return fmt::format("{}", fmt::join(parts, ", "));
}

// Where the bounds are from, for a sentence.
std::string source_of_bounds(const Experiment& experiment, const AdviceWishes& wishes) {
  const CurveOptions usual;
  std::vector<std::string> sources;
  if (wishes.acne || wishes.peter_panning || wishes.edges || wishes.patch) sources.emplace_back("the options");
  if (experiment.curve.acne_bound != usual.acne_bound ||
      experiment.curve.peter_panning_bound != usual.peter_panning_bound ||
      std::any_of(experiment.bounds.begin(), experiment.bounds.end(), is_eye_bound))
    sources.push_back(printable(experiment.path));
  return sources.empty() ? "the defaults of recommend" : fmt::format("{}", fmt::join(sources, ", then "));
}

// --cascades: beside one map, several counts of them.
void add_cascades(AdviceRequest& request, const Experiment& experiment, std::span<const std::string> engines,
                  Workbench& bench, const std::function<void(const std::string&)>& say) {
  const std::string given = gives(experiment, "cascades.count") ? "cascades.count" : given_place(experiment);
  if (!given.empty())
    throw Error(ErrorKind::usage,
                fmt::format("--cascades lays the maps itself, and {} is given too; leave one of them out", given));
  if (request.conditions.front().cascades.depths != CascadeDepths::planes)
    throw SettingConflict("cascades.depths",
                          "--cascades searches ends that are numbers, the same in every view; leave "
                          "cascades.depths = visible out, or leave out --cascades and give cascades.count");
  CascadePlaces cascades = cascade_places(bench, request.conditions, cascade_counts, engines, request.width_px, say);
  if (cascades.places.empty())
    throw Error(ErrorKind::usage, fmt::format("--cascades: {}; leave it out", cascades.why_not));
  for (MapPlace& place : cascades.places) request.places.push_back(std::move(place));
}

// --lookups: beside lookups that compare, or in their place, filtered maps.
void add_lookups(AdviceRequest& request, const Experiment& experiment, const std::vector<std::string>& lookups) {
  for (auto one = lookups.begin(); one != lookups.end(); ++one)
    if (std::find(lookups.begin(), one, *one) != one)
      throw Error(ErrorKind::usage, fmt::format("--lookups names '{}' twice; name each lookup once", *one));
  for (const char* group : {"lookup.", "bias.", "map.moments", "filter."})
    if (gives(experiment, group))
      throw Error(
          ErrorKind::usage,
          fmt::format(
              "--lookups chooses the lookup, its blur and its bias itself, and a setting {} is given; leave one of "
              "them out",
              std::string_view(group).ends_with('.') ? std::string(group) + "*" : group));
  if (request.conditions.front().cascades.count > 1)
    throw Error(ErrorKind::usage, "--lookups is of one map; set cascades.count = 1, or leave it out");
  if (std::find(lookups.begin(), lookups.end(), "compare") == lookups.end()) request.levels.clear();
  for (BiasLevel& level : filtered_levels(lookups, searched_bounds(request.curve))) {
    if (kind_of_light(request.light).map_shape() == MapShape::cube)
      throw Error(ErrorKind::usage,
                  fmt::format("--lookups {}: a point light's cube map has lookup.kind = compare alone; leave it out",
                              level.lookup));
    request.levels.push_back(std::move(level));
  }
}

// Of a model by itself: a shadow that would fall on a ground is in none of the pictures, so the map and the lines leave it out.
std::string no_ground_text(const Settings& first, const Scene& scene) {
  if (!names_file(first.scene.name) || first.scene.floor || has_ground(scene) || camera_inside(scene)) return "";
  return "The model has no ground: this answer is for its shadows on itself, and the lines cut the shadow off on a "
         "ground of yours. For a floor under it: --set scene.floor=true, or noonmark init MODEL and then noonmark "
         "recommend FILE.toml.";
}

// Where the direction or the position of the light is from.
std::string source_of_light(const Experiment& experiment, const Settings& first, const Scene& scene) {
  for (const std::string_view name :
       {"light.azimuth_deg", "light.elevation_deg", "light.position_m", "light.target_m", "light.name", "light.index"})
    if (const auto given = experiment.locations.find(std::string(name)); given != experiment.locations.end())
      return "as " + given->second + " gives it";
  if (!names_file(first.scene.name)) return "that of the built-in scene";
  if (!scene.lights.empty()) return "that of the model's file";
  return "fitted, because the model's file has none; yours: --set light.position_m=X,Y,Z --set light.target_m=X,Y,Z, "
         "or light.azimuth_deg and light.elevation_deg";
}

std::string place_of_light(const LightFrame& frame) {
  const glm::dvec3 way = frame.forward, at = frame.origin_m;
  if (frame.kind == LightKind::directional)
    return fmt::format("shines along {:.3g}, {:.3g}, {:.3g}", way.x, way.y, way.z);
  return fmt::format("stands at {:.4g}, {:.4g}, {:.4g} m", at.x, at.y, at.z);
}

std::string light_text(const Experiment& experiment, std::span<const Settings> conditions, const Scene& scene) {
  const Settings& first = conditions.front();
  const LightFrame frame = make_light_frame(scene, first);
  const auto given = settings_map(first);
  const auto has_that_light = [&](const Settings& condition) {
    const auto here = settings_map(condition);
    return std::all_of(here.begin(), here.end(), [&](const auto& setting) {
      const auto& [name, value] = setting;
      return (!name.starts_with("light.") && !name.starts_with("scene.")) || value == given.at(name);
    });
  };
  return fmt::format(
      "The light is {} and {}, {}{}.", kind_of_light(frame.kind).name(), place_of_light(frame),
      source_of_light(experiment, first, scene),
      std::all_of(conditions.begin(), conditions.end(), has_that_light) ? "" : "; other conditions have other ones");
}

// The part "floor" comes last (scenes/floor.h), unless the mesh is made anew.
std::string floor_text(const Settings& first, const Scene& scene) {
  if (!first.scene.floor || scene.parts.empty() || first.scene.mesh != MeshForm::as_built) return "";
  const Part& floor = scene.parts.back();
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (uint32_t t = 0; t < floor.triangle_count; ++t)
    for (int corner = 0; corner < 3; ++corner) {
      const glm::dvec3 p(scene.positions[scene.triangles[floor.first_triangle + t][corner]]);
      low = glm::min(low, p), high = glm::max(high, p);
    }
  const glm::dvec3 middle = 0.5 * (low + high);
  return fmt::format(
      "The floor of scene.floor is a square of {:.4g} m at y = {:.4g} m; its middle is x = {:.4g}, z = {:.4g} m.",
      high.x - low.x, low.y, middle.x, middle.z);
}

// Of an experiment that sweeps choices: says that its own report answers for the swept points alone, so the two answers may differ.
std::string sweep_text(const Experiment& experiment) {
  const int64_t points = point_count(experiment);
  if (experiment.path.empty() || swept_names(experiment) == condition_names(experiment)) return "";
  return fmt::format(
      "The report of noonmark check {} has the cheapest of its {} alone, so its answer can be another one.",
      shell_quoted(experiment.path), counted(static_cast<size_t>(points), "point"));
}

}  // namespace

std::vector<std::string> about_text(const Experiment& experiment, std::span<const Settings> conditions,
                                    const Scene& scene) {
  const Settings& first = conditions.front();
  std::vector<std::string> lines = {sweep_text(experiment), no_ground_text(first, scene),
                                    light_text(experiment, conditions, scene), floor_text(first, scene)};
  std::erase_if(lines, [](const std::string& line) { return line.empty(); });
  return lines;
}

AdviceRequest request_of(const Experiment& experiment, const AdviceWishes& wishes, Workbench& bench,
                         const std::function<void(const std::string&)>& say) {
  AdviceRequest request;
  request.conditions = conditions_of(experiment);
  for (const Settings& condition : request.conditions)
    if (!compares(condition))
      throw SettingConflict(
          "lookup.kind",
          fmt::format("recommend chooses the lookup: leave lookup.kind = {} out, and name it with --lookups",
                      condition.lookup.kind));
  const Settings first = request.conditions.front();
  const Scene& scene = bench.scene(first.scene);
  if (request.conditions.size() == 1 && wishes.views > 1) {
    request.conditions = turned_views(first, scene);
    request.conditions.resize(std::min(request.conditions.size(), static_cast<size_t>(wishes.views)));
  }
  const bool turned = request.conditions.size() > 1 && conditions_of(experiment).size() == 1;
  request.places = places_of(experiment, request, scene, turned ? views_between(first, scene) : request.conditions);
  const LightKind light = make_light_frame(scene, request.conditions.front()).kind;
  if (!gives(experiment, "bias.")) request.levels = bias_levels();
  request.filters = filters_to_try(light);
  for (int resolution = 256; resolution <= 8192; resolution *= 2) request.resolutions.push_back(resolution);
  request.light = light;
  request.between = light == LightKind::directional && !gives(experiment, "map.resolution");
  take_choices(request, experiment);
  request.width_px = searched_width_px(bench, request.conditions.front());
  request.curve = experiment.curve;
  if (wishes.acne) request.curve.acne_bound = *wishes.acne;
  if (wishes.peter_panning) request.curve.peter_panning_bound = *wishes.peter_panning;
  if (!wishes.lookups.empty()) add_lookups(request, experiment, wishes.lookups);
  if (wishes.cascades) add_cascades(request, experiment, wishes.engines, bench, say);
  request.eye = eye_bounds(experiment, wishes);
  request.accuracy = experiment.accuracy;
  request.error = wishes.error;
  request.budget = wishes.budget;
  request.about = about_text(experiment, request.conditions, scene);
  request.given = given_text(experiment, request);
  request.source_of_bounds = source_of_bounds(experiment, wishes);
  request.answer_given = wishes.answer.has_value();
  request.answer = wishes.answer.value_or(wishes.budget ? AnswerKind::best : AnswerKind::least);
  return request;
}

}  // namespace noonmark
