#include "scenes/gltf/guard.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <span>
#include <string_view>

#include "scenes/gltf/error.h"
#include "scenes/gltf/extensions.h"
#include "scenes/gltf/json.h"
#include "scenes/gltf/precheck.h"

namespace noonmark::gltf {
namespace {

using nlohmann::json;

// references: an object with indices by name, of which the ones in read_attribute() are kept. reference_lists: an array
// of such objects.
enum class Kind { integer, integers, number, numbers, flag, text, texts, object, objects, references, reference_lists };

constexpr uint64_t max_index = 0x7fffffff;        // tinygltf keeps these in an int
constexpr uint64_t max_size = uint64_t{1} << 53;  // integers that JSON carries exactly
constexpr uint64_t any_count = 0;
constexpr bool required = true;

struct Field {
  std::string_view name;
  Kind kind;
  bool is_required = false;
  uint64_t limit = max_index;       // integer(s): the largest; numbers: how many, any_count: any number
  std::span<const Field> fields{};  // object(s): the properties that are read
};

// The properties that are read, from the innermost objects outwards (glTF 2.0, section 5).
constexpr Field sparse_indices[] = {
    {"bufferView", Kind::integer, required}, {"byteOffset", Kind::integer}, {"componentType", Kind::integer, required}};
constexpr Field sparse_values[] = {{"bufferView", Kind::integer, required}, {"byteOffset", Kind::integer}};
constexpr Field sparse[] = {{"count", Kind::integer, required},
                            {"indices", Kind::object, required, 0, sparse_indices},
                            {"values", Kind::object, required, 0, sparse_values}};
constexpr Field accessor[] = {{"bufferView", Kind::integer},
                              {"byteOffset", Kind::integer, false, max_size},
                              {"componentType", Kind::integer, required},
                              {"normalized", Kind::flag},
                              {"count", Kind::integer, required, max_size},
                              {"type", Kind::text, required},
                              {"sparse", Kind::object, false, 0, sparse}};
// EXT_meshopt_compression, KHR_meshopt_compression. tinygltf stores all numbers of an extension in an int.
constexpr Field meshopt[] = {{"buffer", Kind::integer, required},
                             {"byteOffset", Kind::integer},
                             {"byteLength", Kind::integer, required},
                             {"byteStride", Kind::integer, required, 256},
                             {"count", Kind::integer, required},
                             {"mode", Kind::text, required},
                             {"filter", Kind::text}};
constexpr Field buffer_view_extensions[] = {{"EXT_meshopt_compression", Kind::object, false, 0, meshopt},
                                            {"KHR_meshopt_compression", Kind::object, false, 0, meshopt}};
constexpr Field buffer_view[] = {{"buffer", Kind::integer, required},
                                 {"byteOffset", Kind::integer, false, max_size},
                                 {"byteLength", Kind::integer, required, max_size},
                                 {"byteStride", Kind::integer, false, 252},
                                 {"extensions", Kind::object, false, 0, buffer_view_extensions}};
constexpr Field buffer[] = {{"uri", Kind::text}, {"byteLength", Kind::integer, required, max_size}};
constexpr Field draco[] = {{"bufferView", Kind::integer, required}, {"attributes", Kind::references, required}};
constexpr Field primitive_extensions[] = {{"KHR_draco_mesh_compression", Kind::object, false, 0, draco}};
constexpr Field primitive[] = {{"attributes", Kind::references, required},
                               {"indices", Kind::integer},
                               {"material", Kind::integer},
                               {"mode", Kind::integer, false, 6},
                               {"targets", Kind::reference_lists},
                               {"extensions", Kind::object, false, 0, primitive_extensions}};
constexpr Field mesh[] = {{"name", Kind::text},
                          {"primitives", Kind::objects, required, 0, primitive},
                          {"weights", Kind::numbers, false, any_count}};
constexpr Field skin[] = {{"inverseBindMatrices", Kind::integer}, {"joints", Kind::integers, required}};
constexpr Field node_light[] = {{"light", Kind::integer, required}};
constexpr Field visibility[] = {{"visible", Kind::flag}};
constexpr Field instancing[] = {{"attributes", Kind::references, required}};
constexpr Field node_extensions[] = {{"KHR_lights_punctual", Kind::object, false, 0, node_light},
                                     {"KHR_node_visibility", Kind::object, false, 0, visibility},
                                     {"EXT_mesh_gpu_instancing", Kind::object, false, 0, instancing}};
constexpr Field node[] = {{"name", Kind::text},
                          {"mesh", Kind::integer},
                          {"skin", Kind::integer},
                          {"weights", Kind::numbers, false, any_count},
                          {"camera", Kind::integer},
                          {"children", Kind::integers},
                          {"matrix", Kind::numbers, false, 16},
                          {"translation", Kind::numbers, false, 3},
                          {"rotation", Kind::numbers, false, 4},
                          {"scale", Kind::numbers, false, 3},
                          {"extensions", Kind::object, false, 0, node_extensions}};
constexpr Field scene[] = {{"name", Kind::text}, {"nodes", Kind::integers}};
constexpr Field texture_info[] = {{"index", Kind::integer, required}};
constexpr Field metallic_roughness[] = {{"baseColorFactor", Kind::numbers, false, 4},
                                        {"baseColorTexture", Kind::object, false, 0, texture_info}};
constexpr Field material_extensions[] = {{"KHR_materials_transmission", Kind::object}};
constexpr Field material[] = {{"name", Kind::text},
                              {"alphaMode", Kind::text},
                              {"alphaCutoff", Kind::number},
                              {"doubleSided", Kind::flag},
                              {"pbrMetallicRoughness", Kind::object, false, 0, metallic_roughness},
                              {"extensions", Kind::object, false, 0, material_extensions}};
constexpr Field perspective[] = {
    {"yfov", Kind::number, required}, {"znear", Kind::number, required}, {"zfar", Kind::number}};
constexpr Field orthographic[] = {{"xmag", Kind::number, required},
                                  {"ymag", Kind::number, required},
                                  {"znear", Kind::number, required},
                                  {"zfar", Kind::number, required}};
constexpr Field camera[] = {{"type", Kind::text, required},
                            {"perspective", Kind::object, false, 0, perspective},
                            {"orthographic", Kind::object, false, 0, orthographic}};
constexpr Field spot[] = {{"innerConeAngle", Kind::number}, {"outerConeAngle", Kind::number}};
constexpr Field light[] = {
    {"name", Kind::text}, {"type", Kind::text, required}, {"spot", Kind::object, false, 0, spot}};
constexpr Field root_lights[] = {{"lights", Kind::objects, required, 0, light}};
constexpr Field root_extensions[] = {{"KHR_lights_punctual", Kind::object, false, 0, root_lights}};
// Read only for the animation that poses the scene. So a file with broken animations can still be loaded at rest.
constexpr Field pointer[] = {{"pointer", Kind::text, required}};
constexpr Field target_extensions[] = {{"KHR_animation_pointer", Kind::object, false, 0, pointer}};
constexpr Field channel_target[] = {
    {"node", Kind::integer}, {"path", Kind::text, required}, {"extensions", Kind::object, false, 0, target_extensions}};
constexpr Field channel[] = {{"sampler", Kind::integer, required},
                             {"target", Kind::object, required, 0, channel_target}};
constexpr Field animation_sampler[] = {
    {"input", Kind::integer, required}, {"output", Kind::integer, required}, {"interpolation", Kind::text}};
constexpr Field animation[] = {{"channels", Kind::objects, required, 0, channel},
                               {"samplers", Kind::objects, required, 0, animation_sampler}};
constexpr Field asset[] = {{"version", Kind::text, required}, {"minVersion", Kind::text}};
constexpr Field root[] = {{"asset", Kind::object, required, 0, asset},
                          {"extensionsUsed", Kind::texts},
                          {"extensionsRequired", Kind::texts},
                          {"extensions", Kind::object, false, 0, root_extensions},
                          {"scene", Kind::integer},
                          {"scenes", Kind::objects, false, 0, scene},
                          {"nodes", Kind::objects, false, 0, node},
                          {"meshes", Kind::objects, false, 0, mesh},
                          {"skins", Kind::objects, false, 0, skin},
                          {"materials", Kind::objects, false, 0, material},
                          {"cameras", Kind::objects, false, 0, camera},
                          {"accessors", Kind::objects, false, 0, accessor},
                          {"bufferViews", Kind::objects, false, 0, buffer_view},
                          {"buffers", Kind::objects, false, 0, buffer}};

bool read_attribute(std::string_view name) {
  for (std::string_view set : {"JOINTS_", "WEIGHTS_"}) {
    if (name.starts_with(set) && name.size() > set.size() && name.size() <= set.size() + 3 &&
        std::all_of(name.begin() + static_cast<std::ptrdiff_t>(set.size()), name.end(),
                    [](unsigned char c) { return std::isdigit(c) != 0; }))
      return true;
  }
  return name == "POSITION" || name == "TRANSLATION" || name == "ROTATION" || name == "SCALE";
}

class Reducer {
 public:
  explicit Reducer(const std::string& file) : file_(file) {}

  json object(const json& from, std::span<const Field> fields, const std::string& place) const {
    if (!from.is_object()) wrong(place, "an object", from);
    json to = json::object();
    for (const Field& field : fields) {
      const std::string name(field.name);
      const std::string inner = place.empty() ? name : place + "." + name;
      const auto found = from.find(name);
      if (found != from.end()) {
        to[name] = value(*found, field, inner);
      } else if (field.is_required) {
        refuse(file_, inner, "is missing", remedy);
      }
    }
    return to;
  }

 private:
  static constexpr std::string_view remedy = "export the file again, or correct it (see the glTF 2.0 specification)";

  [[noreturn]] void wrong(const std::string& place, std::string_view expected, const json& found) const {
    const bool scalar = found.is_primitive() && !found.is_string();
    refuse(file_, place, fmt::format("should be {}, not {}", expected, scalar ? found.dump() : found.type_name()),
           remedy);
  }

  json value(const json& from, const Field& field, const std::string& place) const {
    switch (field.kind) {
      case Kind::integer:
        return integer(from, field.limit, place);
      case Kind::number:
        return number(from, place);
      case Kind::flag:
        return from.is_boolean() ? from : (wrong(place, "true or false", from), from);
      case Kind::text:
        return from.is_string() ? from : (wrong(place, "a string", from), from);
      case Kind::object:
        return object(from, field.fields, place);
      case Kind::references:
        return references(from, place);
      case Kind::integers:
      case Kind::numbers:
      case Kind::texts:
      case Kind::objects:
      case Kind::reference_lists:
        break;
    }
    if (!from.is_array()) wrong(place, "an array", from);
    if (field.kind == Kind::numbers && field.limit != any_count && from.size() != field.limit) {
      refuse(file_, place, fmt::format("has {} numbers instead of {}", from.size(), field.limit), remedy);
    }
    json to = json::array();
    for (size_t i = 0; i < from.size(); ++i) {
      const std::string inner = fmt::format("{}[{}]", place, i);
      Field element = field;
      element.kind = field.kind == Kind::integers  ? Kind::integer
                     : field.kind == Kind::numbers ? Kind::number
                     : field.kind == Kind::texts   ? Kind::text
                     : field.kind == Kind::objects ? Kind::object
                                                   : Kind::references;
      to.push_back(value(from[i], element, inner));
    }
    return to;
  }

  json references(const json& from, const std::string& place) const {
    if (!from.is_object()) wrong(place, "an object", from);
    json to = json::object();
    for (const auto& [name, index] : from.items()) {
      if (read_attribute(name)) to[name] = integer(index, max_index, place + "." + name);
    }
    return to;
  }

  // JSON has one kind of number, so 3.0 is an integer too.
  json integer(const json& from, uint64_t limit, const std::string& place) const {
    const std::string expected = fmt::format("an integer from 0 to {}", limit);
    if (from.is_number_unsigned()) {
      if (from.get<uint64_t>() > limit) wrong(place, expected, from);
      return from;
    }
    if (!from.is_number_float()) wrong(place, expected, from);
    const double x = from.get<double>();
    if (!(x >= 0 && x <= static_cast<double>(limit)) || x != std::floor(x)) wrong(place, expected, from);
    return static_cast<uint64_t>(x);
  }

  json number(const json& from, const std::string& place) const {
    if (!from.is_number() || !std::isfinite(from.get<double>())) wrong(place, "a finite number", from);
    return from.get<double>();
  }

  const std::string& file_;
};

// "2.1" -> {2, 1}. No value unless the text is digits, a point and digits.
std::optional<std::pair<int, int>> version_of(const std::string& text) {
  int major = -1, minor = -1, used = 0;
  if (text.size() > 8 || std::sscanf(text.c_str(), "%d.%d%n", &major, &minor, &used) != 2) return std::nullopt;
  if (static_cast<size_t>(used) != text.size() || major < 0 || minor < 0) return std::nullopt;
  return std::pair(major, minor);
}

// glTF 2.0, section 3.2: a reader must support minVersion if it is given, otherwise the major version.
void check_version(const std::string& file, const json& document) {
  const json& found = document["asset"];
  const std::string text = found["version"].get<std::string>();
  const auto version = version_of(text);
  constexpr std::string_view remedy = "export it as glTF 2.0";
  if (!found.contains("minVersion")) {
    if (!version || version->first != 2)
      refuse(file, "asset.version", fmt::format("'{}' is not 2.x", printable(text)), remedy);
    return;
  }
  const std::string least_text = found["minVersion"].get<std::string>();
  const auto least = version_of(least_text);
  if (!least || least->first != 2 || least->second != 0) {
    refuse(file, "asset.minVersion",
           fmt::format("needs a reader of version '{}', this one reads 2.0", printable(least_text)), remedy);
  }
  if (!version || *version < *least) {
    refuse(file, "asset.minVersion",
           fmt::format("'{}' is above asset.version '{}'", printable(least_text), printable(text)), remedy);
  }
}

// The min and max of an accessor with three components. No value if they are missing or are not three numbers. That is
// not an error here, because only a note depends on them.
std::optional<DeclaredBounds> declared_bounds(const json& from) {
  DeclaredBounds out;
  for (auto [name, to] : {std::pair("min", &out.min), std::pair("max", &out.max)}) {
    const auto found = from.find(name);
    if (found == from.end() || !found->is_array() || found->size() != 3) return std::nullopt;
    for (size_t k = 0; k < 3; ++k) {
      if (!(*found)[k].is_number()) return std::nullopt;
      (*to)[k] = (*found)[k].get<double>();
    }
  }
  return out;
}

// The requested animation. Null if the scene is at rest.
json chosen_animation(const std::string& file, const json& whole, std::optional<size_t> index) {
  if (!index) return nullptr;
  const auto found = whole.find("animations");
  const size_t count = found != whole.end() && found->is_array() ? found->size() : 0;
  if (*index >= count) {
    refuse(
        file, "animations",
        count == 0 ? "there are none" : fmt::format("there are {}, counted from 0, and {} is requested", count, *index),
        count == 0 ? "leave scene.time_s at auto" : "choose another scene.animation");
  }
  return Reducer(file).object((*found)[*index], animation, fmt::format("animations[{}]", *index));
}

}  // namespace

GuardedDocument guard(const std::string& file, const std::string& text, std::optional<size_t> animation_index) {
  const json whole = parse_json(file, text);
  GuardedDocument out;
  if (!whole.is_object()) refuse(file, "JSON", "not an object", "is this a glTF file?");
  // Checked first, because a file of glTF 1.0 would otherwise fail on its first property, without the reason.
  for (const char* list : {"scenes", "nodes", "meshes", "accessors"}) {
    if (whole.contains(list) && whole[list].is_object())
      refuse(file, list, "named objects where glTF 2.0 has an array: this is glTF 1.0", "export it as glTF 2.0");
  }
  if (whole.contains("asset")) check_version(file, Reducer(file).object(whole, std::span(root).first(1), ""));
  out.json = Reducer(file).object(whole, root, "");
  check_extensions(file, out.json, out.notes);
  out.quantized = uses_extension(out.json, "KHR_mesh_quantization");
  out.animation = chosen_animation(file, whole, animation_index);
  out.animations = whole.contains("animations") && whole["animations"].is_array() ? whole["animations"].size() : 0;
  const auto accessors = whole.find("accessors");
  for (size_t i = 0; accessors != whole.end() && i < accessors->size(); ++i) {
    if (const auto bounds = declared_bounds((*accessors)[i])) out.declared_bounds[i] = *bounds;
  }
  prepare_for_tinygltf(file, out);
  if (out.json.contains("buffers")) {
    for (const json& one : out.json["buffers"]) {
      BufferInfo info;
      if (one.contains("uri")) info.uri = one["uri"].get<std::string>();
      info.byte_length = one["byteLength"].get<uint64_t>();
      out.buffers.push_back(std::move(info));
    }
    out.json.erase("buffers");
  }
  return out;
}

}  // namespace noonmark::gltf
