#include "scenes/gltf_guard.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>

#include "scenes/gltf_error.h"
#include "scenes/gltf_precheck.h"

namespace noonmark::gltf {
namespace {

using nlohmann::json;

enum class Kind { integer, integers, number, numbers, flag, text, texts, object, objects };

constexpr uint64_t max_index = 0x7fffffff;        // tinygltf keeps these in an int
constexpr uint64_t max_size = uint64_t{1} << 53;  // integers that JSON carries exactly
constexpr bool required = true;

struct Field {
  std::string_view name;
  Kind kind;
  bool is_required = false;
  uint64_t limit = max_index;       // integer(s): the largest; numbers: how many
  std::span<const Field> fields{};  // object(s): what is read of it
};

// The properties that are read, from the leaves up (glTF 2.0, section 5).
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
constexpr Field buffer_view[] = {{"buffer", Kind::integer, required},
                                 {"byteOffset", Kind::integer, false, max_size},
                                 {"byteLength", Kind::integer, required, max_size},
                                 {"byteStride", Kind::integer, false, 252}};
constexpr Field buffer[] = {{"uri", Kind::text}, {"byteLength", Kind::integer, required, max_size}};
constexpr Field attributes[] = {{"POSITION", Kind::integer}};
constexpr Field primitive[] = {{"attributes", Kind::object, required, 0, attributes},
                               {"indices", Kind::integer},
                               {"material", Kind::integer},
                               {"mode", Kind::integer, false, 6}};
constexpr Field mesh[] = {{"name", Kind::text}, {"primitives", Kind::objects, required, 0, primitive}};
constexpr Field node_light[] = {{"light", Kind::integer, required}};
constexpr Field node_extensions[] = {{"KHR_lights_punctual", Kind::object, false, 0, node_light}};
constexpr Field node[] = {{"name", Kind::text},
                          {"mesh", Kind::integer},
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
constexpr Field material[] = {{"name", Kind::text},
                              {"alphaMode", Kind::text},
                              {"alphaCutoff", Kind::number},
                              {"doubleSided", Kind::flag},
                              {"pbrMetallicRoughness", Kind::object, false, 0, metallic_roughness}};
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
constexpr Field asset[] = {{"version", Kind::text, required}, {"minVersion", Kind::text}};
constexpr Field root[] = {{"asset", Kind::object, required, 0, asset},
                          {"extensionsUsed", Kind::texts},
                          {"extensionsRequired", Kind::texts},
                          {"extensions", Kind::object, false, 0, root_extensions},
                          {"scene", Kind::integer},
                          {"scenes", Kind::objects, false, 0, scene},
                          {"nodes", Kind::objects, false, 0, node},
                          {"meshes", Kind::objects, false, 0, mesh},
                          {"materials", Kind::objects, false, 0, material},
                          {"cameras", Kind::objects, false, 0, camera},
                          {"accessors", Kind::objects, false, 0, accessor},
                          {"bufferViews", Kind::objects, false, 0, buffer_view},
                          {"buffers", Kind::objects, false, 0, buffer}};

constexpr std::string_view quantization = "KHR_mesh_quantization";
// The first two are read. The others change shading, textures or metadata only, so shadows are right without them.
constexpr std::array<std::string_view, 21> supported_extensions = {
    quantization,
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_texture_basisu",
    "KHR_texture_transform",
    "KHR_xmp_json_ld",
    "EXT_texture_avif",
    "EXT_texture_webp",
    "MSFT_texture_dds",
    "KHR_animation_pointer",
};

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
      case Kind::integers:
      case Kind::numbers:
      case Kind::texts:
      case Kind::objects:
        break;
    }
    if (!from.is_array()) wrong(place, "an array", from);
    if (field.kind == Kind::numbers && from.size() != field.limit) {
      refuse(file_, place, fmt::format("has {} numbers instead of {}", from.size(), field.limit), remedy);
    }
    json to = json::array();
    for (size_t i = 0; i < from.size(); ++i) {
      const std::string inner = fmt::format("{}[{}]", place, i);
      Field element = field;
      element.kind = field.kind == Kind::integers  ? Kind::integer
                     : field.kind == Kind::numbers ? Kind::number
                     : field.kind == Kind::texts   ? Kind::text
                                                   : Kind::object;
      to.push_back(value(from[i], element, inner));
    }
    return to;
  }

  // JSON has one kind of number: 3.0 is an integer too.
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

// "2.1" -> 2. Anything but digits, a point and digits is refused by returning -1.
int major_version(const std::string& version) {
  int major = -1, minor = -1, used = 0;
  if (version.size() > 8 || std::sscanf(version.c_str(), "%d.%d%n", &major, &minor, &used) != 2) return -1;
  return static_cast<size_t>(used) == version.size() && minor >= 0 ? major : -1;
}

void check_version(const std::string& file, const json& document) {
  const json& found = document["asset"];
  const std::string version = found["version"].get<std::string>();
  if (major_version(version) != 2) {
    refuse(file, "asset.version", fmt::format("'{}' is not 2.x", printable(version)), "export it as glTF 2.0");
  }
  if (!found.contains("minVersion")) return;
  const std::string least = found["minVersion"].get<std::string>();
  if (least != "2.0") {
    refuse(file, "asset.minVersion",
           fmt::format("needs a reader of version '{}', this one reads 2.0", printable(least)),
           "export it as glTF 2.0");
  }
}

void check_extensions(const std::string& file, const json& document) {
  const json none = json::array();
  const json& needed = document.contains("extensionsRequired") ? document["extensionsRequired"] : none;
  for (size_t i = 0; i < needed.size(); ++i) {
    const std::string name = needed[i].get<std::string>();
    if (std::find(supported_extensions.begin(), supported_extensions.end(), name) == supported_extensions.end()) {
      refuse(file, fmt::format("extensionsRequired[{}]", i), fmt::format("'{}' is not supported", printable(name)),
             "export without it (compressed meshes: uncompressed)");
    }
  }
}

bool names_extension(const json& document, const char* list, std::string_view name) {
  if (!document.contains(list)) return false;
  return std::any_of(document[list].begin(), document[list].end(), [&](const json& one) { return one == name; });
}

}  // namespace

GuardedDocument guard(const std::string& file, const std::string& text) {
  json whole;
  // The parser of JSON skips a byte order mark; glTF forbids it (section 2.7).
  if (text.starts_with("\xef\xbb\xbf"))
    refuse(file, "byte 0 of the JSON", "a byte order mark", "save it as plain UTF-8");
  try {
    whole = json::parse(text);
  } catch (const json::exception& e) {
    refuse(file, "JSON", printable(e.what()), "export the file again, or correct it");
  }
  GuardedDocument out;
  if (!whole.is_object()) refuse(file, "JSON", "not an object", "is this a glTF file?");
  // Before the rest: a file of glTF 1.0 would fail on its first property and not say why.
  if (whole.contains("asset")) check_version(file, Reducer(file).object(whole, std::span(root).first(1), ""));
  out.json = Reducer(file).object(whole, root, "");
  check_extensions(file, out.json);
  check_before_tinygltf(file, out.json);
  out.quantized = names_extension(out.json, "extensionsUsed", quantization) ||
                  names_extension(out.json, "extensionsRequired", quantization);
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
