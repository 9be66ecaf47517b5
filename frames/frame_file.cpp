#include "frames/frame_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "base/error.h"
#include "base/suggestion.h"
#include "frames/frame_keys.h"
#include "scenes/camera_fit.h"
#include "scenes/library.h"
#include "scenes/number_ranges.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

using Json = nlohmann::ordered_json;
using Kind = FrameKeyKind;

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw Error(ErrorKind::file, path + ": " + what);
}

// What the key's numbers have to be; empty if they are. scale: the metres of a length of 1.
std::string wanted_numbers(const FrameKey& key, const Json& value, size_t count, double scale) {
  const FrameRange range = range_of(key);
  const double unit = range.is_length() ? scale : 1;
  const auto holds = [&](const Json& one) { return one.is_number() && range.numbers.holds(unit * one.get<double>()); };
  const bool right = count == 1
                         ? holds(value)
                         : value.is_array() && value.size() == count && std::all_of(value.begin(), value.end(), holds);
  if (right) return "";
  return fmt::format("{}{}{}", count == 1 ? "a number, " : fmt::format("{} numbers, each ", count), range.text(),
                     unit == 1 ? "" : fmt::format(" (times metres_per_unit = {})", scale));
}

bool is_axis(const Json& value) {
  if (!value.is_string()) return false;
  std::string name = value.get<std::string>();
  if (name.starts_with('-') || name.starts_with('+')) name.erase(0, 1);
  return name == "x" || name == "y" || name == "z";
}

// What the value has to be; empty if it is.
std::string wanted(const FrameKey& key, const Json& value, double scale) {
  switch (key.kind) {
    case Kind::object:
      return value.is_object() ? "" : "an object";
    case Kind::text:
      return value.is_string() && !value.get<std::string>().empty() ? "" : "a text";
    case Kind::choice: {
      const std::vector<std::string_view> choices = choices_of(key);
      const bool known =
          value.is_string() && std::find(choices.begin(), choices.end(), value.get<std::string>()) != choices.end();
      return known ? "" : fmt::format("one of \"{}\"", fmt::join(choices, "\", \""));
    }
    case Kind::number:
      return wanted_numbers(key, value, 1, scale);
    case Kind::flag:
      return value.is_boolean() ? "" : "true or false";
    case Kind::vector3:
      return wanted_numbers(key, value, 3, scale);
    case Kind::axes:
      return value.is_array() && value.size() == 3 && std::all_of(value.begin(), value.end(), is_axis)
                 ? ""
                 : "three of \"x\", \"y\", \"z\", each with or without a minus";
    case Kind::matrix:
      return wanted_numbers(key, value, 16, scale);
    case Kind::settings:
      return value.is_object() ? "" : "an object with names of settings and their values";
    case Kind::version:
      return value == 1 ? "" : "1, the version that this program reads";
    case Kind::texts: {
      const auto is_text = [](const Json& one) { return one.is_string() && !one.get<std::string>().empty(); };
      return value.is_array() && std::all_of(value.begin(), value.end(), is_text) ? "" : "a list of texts";
    }
  }
  return "";
}

void check_object(const std::string& path, const Json& object, std::string_view name, double scale) {
  for (const auto& [member, value] : object.items()) {
    std::vector<std::string_view> names;
    const FrameKey* found = nullptr;
    for (const FrameKey& key : frame_keys()) {
      if (key.object != name) continue;
      names.push_back(key.name);
      if (key.name == member) found = &key;
    }
    if (!found)
      refuse(path, fmt::format("there is no key '{}'{}{}", member, name.empty() ? "" : fmt::format(" in '{}'", name),
                               did_you_mean(member, names)));
    if (const std::string want = wanted(*found, value, scale); !want.empty())
      refuse(path, fmt::format("'{}' must be {}", found->full_name(), want));
    if (found->kind == Kind::object) check_object(path, value, member, scale);
  }
}

// The members of a checked file.
class Object {
 public:
  Object(const std::string& path, std::string name, const Json* json)
      : path_(path), name_(std::move(name)), json_(json) {}

  explicit operator bool() const { return json_ != nullptr; }
  bool has(const char* key) const { return json_ && json_->contains(key); }
  Object object(const char* key) const { return {path_, key, has(key) ? &json_->at(key) : nullptr}; }
  std::vector<std::string> texts(const char* key) const {
    return get<std::vector<std::string>>(key).value_or(std::vector<std::string>());
  }
  std::optional<std::string> text(const char* key) const { return get<std::string>(key); }
  std::optional<double> number(const char* key) const { return get<double>(key); }
  bool flag(const char* key) const { return get<bool>(key).value_or(false); }
  bool is(const char* key, std::string_view choice) const { return text(key).value_or("") == choice; }
  std::optional<glm::dvec3> vector(const char* key) const {
    if (!has(key)) return std::nullopt;
    const Json& v = json_->at(key);
    return glm::dvec3(v[0].get<double>(), v[1].get<double>(), v[2].get<double>());
  }
  glm::dmat4 matrix(const char* key, bool by_rows) const {
    glm::dmat4 m;
    for (int i = 0; i < 16; ++i)
      m[by_rows ? i % 4 : i / 4][by_rows ? i / 4 : i % 4] = json_->at(key)[static_cast<size_t>(i)];
    return m;
  }
  void require(const char* key, const char* why) const {
    if (!has(key)) refuse(path_, fmt::format("'{}' is missing: {}", name_.empty() ? key : name_ + "." + key, why));
  }
  [[noreturn]] void refuse_together(const char* what) const { refuse(path_, fmt::format("'{}': {}", name_, what)); }

 private:
  template <class T>
  std::optional<T> get(const char* key) const {
    return has(key) ? std::optional(json_->at(key).get<T>()) : std::nullopt;
  }
  const std::string& path_;
  std::string name_;
  const Json* json_;
};

glm::dmat4 world_from_frame(const std::string& path, const Object& file, const Json& json) {
  const double scale = file.number("metres_per_unit").value_or(1);
  glm::dmat4 m(0);
  m[3][3] = 1;
  std::array<bool, 3> used{};
  for (int scene_axis = 0; scene_axis < 3; ++scene_axis) {
    std::string name = file.has("axes") ? json.at("axes")[static_cast<size_t>(scene_axis)].get<std::string>()
                                        : std::string(1, static_cast<char>('x' + scene_axis));
    const double sign = name.starts_with('-') ? -1 : 1;
    const int of_frame = name.back() - 'x';
    used[static_cast<size_t>(of_frame)] = true;
    m[of_frame][scene_axis] = sign * scale;
  }
  if (!(used[0] && used[1] && used[2])) refuse(path, "'axes' must name each of x, y and z once");
  return m;
}

// The matrix of an object that has one; empty if it has none. Sets its convention.
std::optional<glm::dmat4> read_matrices(const Object& owner, ClipConvention& convention) {
  if (!owner.has("clip_from_world") && !owner.has("view") && !owner.has("projection")) return std::nullopt;
  for (const char* key : {"order", "depth_range", "reversed"}) owner.require(key, "a matrix alone does not say it");
  const bool by_rows = owner.is("order", "row");
  convention = {owner.is("depth_range", "0..1"), owner.flag("reversed"), owner.is("y", "down")};
  if (owner.has("clip_from_world")) {
    if (owner.has("view") || owner.has("projection"))
      owner.refuse_together("give clip_from_world, or view and projection, not both");
    return owner.matrix("clip_from_world", by_rows);
  }
  owner.require("view", "with a projection there is a view");
  owner.require("projection", "with a view there is a projection");
  return owner.matrix("projection", by_rows) * owner.matrix("view", by_rows);
}

// A value of JSON as the text that a setting reads.
std::string setting_text(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return value.dump();
  std::string text;
  for (const Json& one : value) text += (text.empty() ? "" : ",") + one.dump();
  return text;
}

// What the map's matrix and its file do not say. The format is the one that the renderer drew, which gives the size of a
// unit of its polygon offset.
bool is_of_lookup(std::string_view name) {
  constexpr std::string_view of_map[] = {"map.format",         "map.cull",        "map.wrap",
                                         "map.lit_beyond_far", "map.depth_clamp", "map.pancake"};
  return name.starts_with("bias.") || name.starts_with("filter.") ||
         std::find(std::begin(of_map), std::end(of_map), name) != std::end(of_map);
}

void read_map(const std::string& path, const Object& map, const Json& json, FrameFile& file) {
  if (!map) return;
  map.require("file", "the picture of the map's depths");
  map.require("first_row", "the file alone does not say it");
  MapFile& made = file.map.emplace();
  made.file = *map.text("file");
  made.top_row_first = map.is("first_row", "top");
  const std::optional<glm::dmat4> matrix = read_matrices(map, made.convention);
  if (!matrix) map.require("clip_from_world", "the matrix of the light, or its view and projection");
  made.clip_from_frame = *matrix;
  if (!map.has("technique")) return;
  Settings settings;
  for (const auto& [name, value] : json.at("map").at("technique").items()) {
    const std::string text = setting_text(value);
    try {
      const Setting& setting = find_setting(name);
      if (!is_of_lookup(name))
        throw Error(ErrorKind::usage,
                    "a technique here has bias.*, filter.*, map.format, map.cull, map.wrap, map.lit_beyond_far, "
                    "map.depth_clamp and map.pancake; the rest follows from matrix and file");
      setting.set(settings, text);
    } catch (const Error& error) {
      refuse(path, fmt::format("'map.technique.{}': {}", name, error.what()));
    }
    made.technique.emplace_back(name, text);
  }
}

void read_camera(const Object& camera, FrameFile& file) {
  if (!camera) return;
  file.clip_from_frame = read_matrices(camera, file.convention);
  file.camera_name = camera.text("name");
  if (file.camera_name) {
    if (file.clip_from_frame || camera.has("eye") || camera.has("target"))
      camera.refuse_together("give a name, or matrices, or eye and target");
    return;
  }
  if (file.clip_from_frame) {
    if (camera.has("eye") || camera.has("target")) camera.refuse_together("give matrices, or eye and target, not both");
    return;
  }
  camera.require("eye", "give eye and target, or matrices");
  camera.require("target", "give eye and target, or matrices");
  if (!has_direction(*camera.vector("target") - *camera.vector("eye")))
    camera.refuse_together("eye and target are the same place");
  if (camera.has("up") && !has_direction(*camera.vector("up"))) camera.refuse_together("up has no length");
  if (camera.has("fov_y_deg") == camera.has("height"))
    camera.refuse_together("give fov_y_deg of a perspective camera, or height of an orthographic one");
  const auto place = [&](const char* key) {
    return glm::dvec3(file.world_from_frame * glm::dvec4(*camera.vector(key), 1));
  };
  const double scale = glm::length(glm::dvec3(file.world_from_frame[0]));
  const auto length = [&](const char* key) {
    const std::optional<double> given = camera.number(key);
    return given ? std::optional(*given * scale) : std::nullopt;
  };
  Camera& c = file.camera.emplace();
  c.eye_m = place("eye");
  c.target_m = place("target");
  if (camera.has("up")) c.up = glm::dmat3(file.world_from_frame) * *camera.vector("up");
  c.projection = camera.has("height") ? Projection::orthographic : Projection::perspective;
  c.fov_y_deg = camera.number("fov_y_deg").value_or(c.fov_y_deg);
  c.height_m = length("height").value_or(c.height_m);
  c.near_m = length("near");
  c.far_m = length("far");
  if (c.near_m && c.far_m && !(*c.near_m < *c.far_m)) camera.refuse_together("near must be below far");
}

void read_light(const Object& light, FrameFile& file) {
  if (!light) return;
  const auto read_size = [&](Light& l, double scale) {
    l.angular_diameter_deg = light.number("angular_diameter_deg").value_or(0);
    l.radius_m = light.number("radius").value_or(0) * scale;
    l.shape = light.is("shape", "disc") ? LightShape::disc : LightShape::sphere;
  };
  file.light_name = light.text("name");
  Light& l = file.light.emplace();
  if (file.light_name) {
    for (const char* key : {"kind", "direction", "position", "target", "cone_deg"})
      if (light.has(key)) light.refuse_together("give a name, or the light itself");
    read_size(l, glm::length(glm::dvec3(file.world_from_frame[0])));
    return;
  }
  light.require("kind", "it is directional, spot or point");
  l.kind = light.is("kind", "directional") ? LightKind::directional
           : light.is("kind", "spot")      ? LightKind::spot
                                           : LightKind::point;
  const double scale = glm::length(glm::dvec3(file.world_from_frame[0]));
  const auto place = [&](const char* key) {
    return glm::dvec3(file.world_from_frame * glm::dvec4(*light.vector(key), 1));
  };
  if (l.kind != LightKind::directional) light.require("position", "a spot or point light has a place");
  l.position_m = light.has("position") ? place("position") : glm::dvec3(0);
  if (l.kind != LightKind::point) {
    if (light.has("direction") == light.has("target"))
      light.refuse_together("give the direction in which the light travels, or a target, and not both");
    if (light.has("target")) {
      light.require("position", "the light aims from it at its target");
      l.target_m = place("target");
      if (!has_direction(l.target_m - l.position_m)) light.refuse_together("position and target are the same place");
    } else {
      const glm::dvec3 way = glm::dmat3(file.world_from_frame) * *light.vector("direction");
      if (!has_direction(way)) light.refuse_together("the direction has no length");
      l.target_m = l.position_m + glm::normalize(way);
    }
  }
  l.cone_deg = light.number("cone_deg").value_or(l.cone_deg);
  read_size(l, scale);
  if (l.kind == LightKind::spot) light.require("cone_deg", "beyond it nothing is lit");
}

void read_rules(const Object& edge, const Object& contact, double scale, FrameFile& file) {
  if (edge) {
    const int given = edge.has("pixels") + edge.has("texels") + edge.has("distance");
    if (given != 1) edge.refuse_together("give one of pixels, texels and distance");
    if (edge.has("texels")) {
      edge.require("texel", "the width of a texel");
      file.edge_m = *edge.number("texels") * *edge.number("texel") * scale;
      if (const FrameRange most = range_of("edge.distance"); !most.numbers.holds(*file.edge_m))
        edge.refuse_together(fmt::format("texels times texel must be {}", most.text()).c_str());
    }
    if (edge.has("distance")) file.edge_m = *edge.number("distance") * scale;
    file.edge_pixels = edge.number("pixels");
  }
  if (contact) {
    contact.require("distance", "a length along the light's ray");
    file.contact_m = *contact.number("distance") * scale;
  }
}

// Returns what `find` returns. If it throws, the error names this file and the key.
auto named(const std::string& path, const char* key, const auto& find) {
  try {
    return find();
  } catch (const Error& error) {
    refuse(path, fmt::format("'{}': {}", key, error.what()));
  }
}

}  // namespace

FrameFile parse_frame_file(const std::string& path, std::string_view text) {
  const Json json = [&] {
    try {
      return Json::parse(
          text, [&, keys = std::vector<std::set<std::string>>()](int, Json::parse_event_t event, Json& parsed) mutable {
            if (event == Json::parse_event_t::object_start) keys.emplace_back();
            if (event == Json::parse_event_t::object_end) keys.pop_back();
            if (event == Json::parse_event_t::key && !keys.back().insert(parsed.get<std::string>()).second)
              refuse(path, fmt::format("has the key '{}' twice in one object; keep one", parsed.get<std::string>()));
            return true;
          });
    } catch (const Json::exception& fault) {
      const std::string why = fault.what();  // "[json.exception.parse_error.101] parse error at line 1, column 2: ..."
      refuse(path, "is not JSON: " + why.substr(why.find(']') + 2));
    }
  }();
  if (!json.is_object()) refuse(path, "must be a JSON object");
  // Lengths are checked in metres, so their unit is read before them. One that cannot be is refused with the rest.
  constexpr const char* unit_key = "metres_per_unit";
  const double unit = json.contains(unit_key) && json[unit_key].is_number() ? json[unit_key].get<double>() : 1;
  check_object(path, json, "", range_of(unit_key).numbers.holds(unit) ? unit : 1);
  FrameFile file;
  file.path = path;
  const Object all(file.path, "", &json);
  all.require("noonmark_frame", "it is 1");
  all.require("visibility", "the picture that is judged");
  file.scene = all.text("scene");
  file.not_in_map = all.texts("not_in_map");
  file.notes = all.texts("notes");
  const Object visibility = all.object("visibility");
  visibility.require("file", "the picture that is judged");
  file.visibility = *visibility.text("file");
  file.normalised = visibility.flag("normalised");
  file.step = visibility.number("step");
  file.encoding = visibility.is("encoding", "srgb") ? ValueEncoding::srgb : ValueEncoding::linear;
  file.world_from_frame = world_from_frame(path, all, json);
  read_camera(all.object("camera"), file);
  read_light(all.object("light"), file);
  if (const Object positions = all.object("positions")) {
    positions.require("file", "the picture of world positions");
    file.positions = positions.text("file");
  }
  if (const Object depth = all.object("depth")) {
    depth.require("file", "the picture of depths");
    if (file.positions) refuse(path, "give positions or depth, not both");
    file.depth = depth.text("file");
    file.depth_measure = depth.is("measure", "view_z") ? DepthMeasure::view_z : DepthMeasure::window;
  }
  read_map(path, all.object("map"), json, file);
  read_rules(all.object("edge"), all.object("contact"), all.number("metres_per_unit").value_or(1), file);
  return file;
}

Light FrameFile::light_in(const Scene& scene) const {
  if (!light_name) return light.value_or(scene.light);
  Light found = named(path, "light.name", [&] { return light_named(scene, *light_name); });
  found.angular_diameter_deg = light->angular_diameter_deg;
  found.radius_m = light->radius_m;
  found.shape = light->shape;
  return found;
}

glm::dmat4 FrameFile::map_from_world() const {
  return from_convention(map->clip_from_frame, map->convention) * glm::inverse(world_from_frame);
}

ViewMatrix FrameFile::view(const Scene& scene, int width, int height) const {
  if (clip_from_frame)
    return named(path, "camera", [&] {
      return ViewMatrix(from_convention(*clip_from_frame, convention) * glm::inverse(world_from_frame));
    });
  Camera c = camera        ? *camera
             : camera_name ? named(path, "camera.name", [&] { return camera_named(scene, *camera_name); })
                           : scene.camera;
  return named(path, "camera", [&] {
    if (!c.near_m || !c.far_m) {
      const Camera fitted = with_fitted_depths(scene, c, width, height);
      c.near_m = c.near_m ? c.near_m : fitted.near_m;
      c.far_m = c.far_m ? c.far_m : fitted.far_m;
    }
    return ViewMatrix(make_camera_frame(c, width, height).clip_from_world());
  });
}

}  // namespace noonmark
