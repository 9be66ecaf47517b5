#include "app/live/live_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "base/text.h"
#include "compare/judge/undecided.h"
#include "compare/report/cause_colors.h"
#include "compare/report/deflate.h"
#include "compare/report/page_parts.h"
#include "compare/report/text.h"
#include "gl/page_text.h"
#include "live_files.h"
#include "scenes/camera_fit.h"
#include "scenes/camera_frame.h"
#include "scenes/receivers.h"
#include "technique/bias.h"
#include "technique/chosen_light.h"
#include "technique/light_frame.h"
#include "technique/setting_rules.h"

namespace noonmark {
namespace {

using nlohmann::json;

std::string_view file(std::string_view name) {
  const std::string_view text = live_files::embedded(fmt::format("live/page/{}", name));
  if (text.empty()) throw std::logic_error("the live page's file " + std::string(name) + " is not in the program");
  return text;
}

json point_json(glm::dvec3 p) { return {p.x, p.y, p.z}; }
json optional_json(std::optional<double> value) { return value ? json(*value) : json(); }

// Little-endian bytes of 32-bit values, in byte planes, deflated, as base64.
template <class Value>
std::string packed(const std::vector<Value>& values) {
  static_assert(sizeof(Value) == 4);
  const std::string_view bytes(reinterpret_cast<const char*>(values.data()), 4 * values.size());
  return report::base64(report::deflated(report::byte_planes(bytes, 4)));
}

// Each index as the difference to the index before it: neighbours in a mesh have small differences.
std::vector<uint32_t> differences(const std::vector<glm::uvec3>& triangles) {
  std::vector<uint32_t> all;
  uint32_t last = 0;
  for (const glm::uvec3& t : triangles)
    for (int i = 0; i < 3; ++i) {
      const auto step = static_cast<int32_t>(t[i] - last);
      all.push_back((static_cast<uint32_t>(step) << 1) ^ static_cast<uint32_t>(step >> 31));  // small ones unsigned
      last = t[i];
    }
  return all;
}

// What the page subtracts from all places, so that its floats are as fine as the scene is small, wherever it stands: on each axis the
// middle of the scene if all corners stay exact, as they do far from the origin; otherwise 0.
glm::dvec3 page_origin(const Scene& scene) {
  glm::dvec3 origin(0);
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax_element(scene.positions.begin(), scene.positions.end(),
                                                 [&](glm::vec3 a, glm::vec3 b) { return a[axis] < b[axis]; });
    const float middle = low->operator[](axis) / 2 + high->operator[](axis) / 2;
    const bool exact = std::all_of(scene.positions.begin(), scene.positions.end(), [&](glm::vec3 p) {
      const double moved = static_cast<double>(p[axis]) - static_cast<double>(middle);
      return static_cast<double>(static_cast<float>(moved)) == moved;
    });
    if (exact) origin[axis] = static_cast<double>(middle);
  }
  return origin;
}

// OpenGL's usual depth from -1 to 1. Near and far are moved to the scene, which cuts off no part of it.
glm::dmat4 clip_of(const Scene& scene, CameraFrame frame) {
  double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
  for (const glm::vec3& p : scene.positions) {
    const double depth = frame.in_axes(p).z;
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  const double margin = 0x1p-10 * (farthest - nearest);
  if (nearest - margin < *frame.camera.far_m && farthest + margin > *frame.camera.near_m) {
    frame.camera.near_m = std::max(*frame.camera.near_m, nearest - margin);
    frame.camera.far_m = std::min(*frame.camera.far_m, farthest + margin);
  }
  return frame.clip_from_world();
}

json camera_json(const Scene& scene, const Settings& settings, glm::dvec3 origin) {
  const Camera camera = effective_camera(scene, settings.view);
  const CameraFrame frame = make_camera_frame(camera, settings.view.width_px, settings.view.height_px);
  const glm::dmat4 clip = glm::translate(clip_of(scene, frame), origin);
  std::vector<double> columns;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) columns.push_back(clip[c][r]);
  return {{"perspective", camera.projection == Projection::perspective},
          {"eye", point_json(frame.eye_m - origin)},
          {"right", point_json(frame.right)},
          {"up", point_json(frame.up)},
          {"forward", point_json(frame.forward)},
          {"half_width", frame.half_width},
          {"half_height", frame.half_height},
          {"clip", columns}};
}

json light_json(const Scene& scene, const LightSettings& light, glm::dvec3 origin) {
  const Light own = chosen_light(scene, light).light;
  const auto place = [&](const std::optional<glm::dvec3>& p) { return p ? point_json(*p - origin) : json(); };
  return {{"scene_position", place(own.position_m)},
          {"scene_target", place(own.target_m)},
          {"position", place(light.position_m)},
          {"target", place(light.target_m)}};
}

// The scene's own volume is of its first light, as that is (why_not_the_scenes in technique/light_frame.cpp); the script sees
// whether that light is moved.
json map_json(const Scene& scene, const MapSettings& map, const LightSettings& light) {
  json own;
  const ChosenLight chosen = chosen_light(scene, light);
  if (scene.map && map.fit == MapFit::scene && chosen.first && !chosen.made_up)
    own = {{"extent_m", scene.map->extent_m}, {"near_m", scene.map->near_m}, {"far_m", scene.map->far_m}};
  return {{"own", own},
          {"range_of_scene", map.depth_range == DepthRange::scene},
          {"extent_scale", map.extent_scale},
          {"near_m", optional_json(map.near_m)},
          {"far_m", optional_json(map.far_m)},
          {"shift", {map.shift_u_texels, map.shift_v_texels}},
          {"wrap", static_cast<int>(map.wrap)},
          {"lit_beyond_far", map.lit_beyond_far}};
}

// The parts that the page's shader has, each with its limits (technique/bias.h: ActivePart).
json parts_json(const BiasSettings& bias) {
  json parts = json::array();
  for (const BiasPart& part : bias_parts()) {
    if (part.acts_on == BiasTarget::caster) continue;
    const std::string name(part.name);
    json one = {{"name", name}, {"amount", bias[name]}};
    if (!part.floor_help.empty()) one["floor"] = bias[name + "_floor"];
    if (!part.cap_help.empty()) {
      const double cap = bias[name + "_cap"];
      one["cap"] = std::isfinite(cap) ? cap : static_cast<double>(std::numeric_limits<float>::max());
    }
    parts.push_back(one);
  }
  return parts;
}

// All parts of the bias that the page has, so that its shader has a uniform for each.
Bias every_part(BiasSettings settings) {
  for (const BiasPart& part : bias_parts()) settings[part.name] = part.acts_on == BiasTarget::caster ? 0 : 1;
  return Bias(settings);
}

// The scene and the settings that differ from their defaults, for the command that gives the same point.
json changed_settings(const Settings& settings) {
  json changed = json::object();
  const Settings defaults;
  for (const Setting& row : settings_table())
    if (const std::string value = row.get(settings); value != row.get(defaults) || row.name == "scene.name")
      changed[std::string(row.name)] = value;
  return changed;
}

// The settings that the page's controls change (state.js), and the distance of the filter's taps.
json state_json(const Settings& settings) {
  json state;
  for (const char* name :
       {"bias.constant", "bias.slope", "bias.normal_offset", "filter.kind", "filter.size", "filter.step_texels",
        "map.resolution", "map.extent_m", "map.format", "light.azimuth_deg", "light.elevation_deg"})
    state[name] = find_setting(name).get(settings);
  return state;
}

json colours_json() {
  json all = json::array();
  for (const CauseColor& color : cause_colors) all.push_back({{"name", color.name}, {"label", color.label}});
  for (const CauseColor& color : pixel_state_colors)
    all.push_back({{"name", color.name},
                   // The program leaves them out, the page does not.
                   {"label", std::string_view(color.name) == "ambiguous" ? "Ambiguous truth, counted" : color.label}});
  return all;
}

json page_data(const Scene& scene, const Settings& settings, std::string_view version) {
  const glm::dvec3 origin = page_origin(scene);
  std::vector<float> positions;
  float largest = 0;  // coordinate in the world, by which the program's rays err (raytrace/light_view.h)
  for (const glm::vec3& p : scene.positions) {
    const glm::vec3 moved(glm::dvec3(p) - origin);
    positions.insert(positions.end(), {moved.x, moved.y, moved.z});
    for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, std::abs(p[axis]));
  }
  const double cap = settings.bias.plane_cap.value_or(static_cast<double>(std::numeric_limits<float>::max()));
  return {{"version", version},
          {"scene", printable(scene.name)},
          {"settings", changed_settings(settings)},
          {"state", state_json(settings)},
          {"defaults", state_json({})},
          {"width", settings.view.width_px},
          {"height", settings.view.height_px},
          {"camera", camera_json(scene, settings, origin)},
          {"light", light_json(scene, settings.light, origin)},
          {"largest_m", largest},
          {"map", map_json(scene, settings.map, settings.light)},
          {"bias",
           {{"unit", static_cast<int>(settings.bias.unit)}, {"plane_cap", cap}, {"parts", parts_json(settings.bias)}}},
          {"colours", colours_json()},
          {"notes", light_notes(scene, settings)},
          {"much_ambiguous", much_ambiguous},
          {"position_count", scene.positions.size()},
          {"triangle_count", scene.triangles.size()},
          {"positions", packed(positions)},
          {"triangles", packed(differences(scene.triangles))},
          {"unseen", packed(unseen_backs(scene, effective_camera(scene, settings.view)))}};
}

std::string shader(const std::string& root, const Settings& settings) {
  return gl::webgl_text(root, every_part(settings.bias),
                        [](std::string_view name) { return live_files::embedded(fmt::format("live/page/{}", name)); });
}

// The scripts and shaders, packed: start.js unpacks them.
std::string code(const Settings& settings) {
  std::string script = "(function() {\n";
  for (const char* part : {"vectors", "light", "mesh", "tree", "view", "state", "measure", "picture", "live"})
    script += file(fmt::format("{}.js", part));
  const json all = {{"script", script + "})();\n"},
                    {"shaders",
                     {{"judge", shader("judge.frag", settings)},
                      {"map", shader("map.frag", settings)},
                      {"map_boxes", shader("map.vert", settings)},
                      {"mesh", shader("mesh.vert", settings)},
                      {"screen", shader("shaders/screen.vert", settings)}}}};
  return report::base64(report::deflated(all.dump()));
}

}  // namespace

std::string live_page(const Scene& scene, const Settings& settings, std::string_view version) {
  require_one_map(settings, "a live page");
  require_compared(settings, "a live page");
  make_light_frame(scene, settings);  // throws what is wrong with the settings
  return report::fill_template(file("live.html"), [&](std::string_view name) -> std::string {
    if (name == "head")
      return report::page_head(
          {.title = printable(scene.name),
           .style = report::colour_rules({cause_colors.begin(), cause_colors.end()}) + std::string(file("live.css")),
           .version = std::string(version),
           .brand = "Noonmark live",
           .pictures = "data: blob:"});
    if (name == "version") return report::Markup(std::string(version)).html();
    if (name == "data") return report::data_block("live-data", page_data(scene, settings, version)).html();
    if (name == "code") return code(settings);
    if (name == "unpack") return std::string(report::page_file("report/page/data.js"));
    if (name == "start") return std::string(file("start.js"));
    throw std::logic_error("the live page's template asks for " + std::string(name));
  });
}

}  // namespace noonmark
