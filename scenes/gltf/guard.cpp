#include "scenes/gltf/guard.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <set>
#include <span>
#include <string_view>
#include <utility>

#include "scenes/gltf/error.h"
#include "scenes/gltf/extensions.h"
#include "scenes/gltf/precheck.h"
#include "scenes/gltf/properties.h"

namespace noonmark::gltf {
namespace {

using nlohmann::json;

// Where a value stands in the document. The text is made only for a message, because most values are right.
struct Place {
  const Place* outer = nullptr;
  std::string_view name;
  std::optional<size_t> index;  // of an element of outer, which then has no name

  std::string text() const {
    const std::string before = outer == nullptr ? "" : outer->text();
    if (index) return fmt::format("{}[{}]", before, *index);
    return before.empty() ? std::string(name) : fmt::format("{}.{}", before, name);
  }
};

// Checks a document against the table and gives its numbers the types that tinygltf needs.
class GuardChecker {
 public:
  explicit GuardChecker(const std::string& file) : file_(file) {}

  void object(json& object, std::span<const Field> fields, const Place& place) const {
    if (!object.is_object()) wrong(place, "an object", object);
    for (const Field& field : fields) {
      const Place inner{&place, field.name, {}};
      const auto found = object.find(field.name);
      if (found != object.end()) {
        value(*found, field, inner);
      } else if (field.is_required) {
        refuse(file_, inner.text(), "is missing", remedy);
      }
    }
  }

 private:
  static constexpr std::string_view remedy = "export the file again, or correct it (see the glTF 2.0 specification)";

  [[noreturn]] void wrong(const Place& place, std::string_view expected, const json& found) const {
    const bool scalar = found.is_primitive() && !found.is_string();
    refuse(file_, place.text(),
           fmt::format("should be {}, not {}", expected, scalar ? found.dump() : found.type_name()), remedy);
  }

  void value(json& value, const Field& field, const Place& place) const {
    switch (field.kind) {
      case Kind::integer:
        return integer(value, field.limit, place);
      case Kind::number:
        return number(value, place);
      case Kind::flag:
        if (!value.is_boolean()) wrong(place, "true or false", value);
        return;
      case Kind::text:
        if (!value.is_string()) wrong(place, "a string", value);
        return;
      case Kind::object:
        return object(value, field.fields, place);
      case Kind::references:
        return references(value, place);
      case Kind::unchecked:
        return;
      case Kind::integers:
        return elements(value, field, Kind::integer, place);
      case Kind::numbers:
        return elements(value, field, Kind::number, place);
      case Kind::texts:
        return elements(value, field, Kind::text, place);
      case Kind::objects:
        return elements(value, field, Kind::object, place);
      case Kind::reference_lists:
        return elements(value, field, Kind::references, place);
    }
  }

  void elements(json& array, const Field& field, Kind kind, const Place& place) const {
    if (!array.is_array()) wrong(place, "an array", array);
    if (kind == Kind::number && field.limit != any_count && array.size() != field.limit) {
      refuse(file_, place.text(), fmt::format("has {} numbers instead of {}", array.size(), field.limit), remedy);
    }
    Field element = field;
    element.kind = kind;
    for (size_t i = 0; i < array.size(); ++i) value(array[i], element, {&place, "", i});
  }

  void references(json& object, const Place& place) const {
    if (!object.is_object()) wrong(place, "an object", object);
    for (const auto& [name, index] : object.items()) integer(index, max_index, {&place, name, {}});
  }

  // JSON has one kind of number, so 3.0 is an integer too.
  void integer(json& value, uint64_t limit, const Place& place) const {
    const auto expected = [&] { return fmt::format("an integer from 0 to {}", limit); };
    if (value.is_number_unsigned()) {
      if (value.get<uint64_t>() > limit) wrong(place, expected(), value);
      return;
    }
    if (!value.is_number_float()) wrong(place, expected(), value);
    const double x = value.get<double>();
    if (!(x >= 0 && x <= static_cast<double>(limit)) || x != std::floor(x)) wrong(place, expected(), value);
    value = static_cast<uint64_t>(x);
  }

  void number(json& value, const Place& place) const {
    if (!value.is_number() || !std::isfinite(value.get<double>())) wrong(place, "a finite number", value);
    value = value.get<double>();
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
std::optional<DeclaredBounds> declared_bounds(const json& accessor) {
  DeclaredBounds out;
  for (auto [name, to] : {std::pair("min", &out.min), std::pair("max", &out.max)}) {
    const auto found = accessor.find(name);
    if (found == accessor.end() || !found->is_array() || found->size() != 3) return std::nullopt;
    for (size_t k = 0; k < 3; ++k) {
      if (!(*found)[k].is_number()) return std::nullopt;
      (*to)[k] = (*found)[k].get<double>();
    }
  }
  return out;
}

// Takes the animations out of the document, all but the requested one; null if the scene is at rest.
json take_animation(const std::string& file, json& document, std::optional<size_t> index, size_t count) {
  const auto found = document.find("animations");
  if (index && *index >= count) {
    refuse(
        file, "animations",
        count == 0 ? "there are none" : fmt::format("there are {}, counted from 0, and {} is requested", count, *index),
        count == 0 ? "leave scene.time_s at auto" : "choose another scene.animation");
  }
  json chosen = index ? std::move((*found)[*index]) : json();
  if (found != document.end()) document.erase(found);
  if (index)
    GuardChecker(file).object(chosen, animation_properties(), {nullptr, fmt::format("animations[{}]", *index), {}});
  return chosen;
}

// The texture that decides where a material hides its triangles; null: none does.
const json* masking_texture(const json& document, const json& primitive) {
  const auto material = primitive.find("material");
  const auto materials = document.find("materials");
  if (material == primitive.end() || materials == document.end() || material->get<uint64_t>() >= materials->size())
    return nullptr;
  const json& m = (*materials)[material->get<size_t>()];
  if (m.value("alphaMode", "") != "MASK") return nullptr;
  const auto base = m.find("pbrMetallicRoughness");
  if (base == m.end()) return nullptr;
  const auto texture = base->find("baseColorTexture");
  return texture == base->end() ? nullptr : &*texture;
}

// Takes the lists of textures out of the document and keeps what masks need of them. Texture coordinates stay only where
// a mask reads them, so that broken ones elsewhere do not matter.
void take_masks(const std::string& file, json& document, GuardedDocument& out) {
  std::set<size_t> used;
  if (const auto meshes = document.find("meshes"); meshes != document.end()) {
    for (json& mesh : *meshes) {
      for (json& primitive : mesh["primitives"]) {
        if (const json* const texture = masking_texture(document, primitive)) {
          used.insert((*texture)["index"].get<size_t>());
          continue;
        }
        json& attributes = primitive["attributes"];
        for (auto it = attributes.begin(); it != attributes.end();)
          it = it.key().starts_with("TEXCOORD_") ? attributes.erase(it) : std::next(it);
      }
    }
  }
  json lists = json::object();
  for (const Field& list : masking_properties()) {
    const auto found = document.find(list.name);
    if (found == document.end()) continue;
    if (!used.empty()) lists[list.name] = std::move(*found);
    document.erase(found);
  }
  if (used.empty()) return;
  GuardChecker(file).object(lists, masking_properties(), {});
  const json samplers = lists.value("samplers", json::array());
  for (const json& from : lists.value("textures", json::array())) {
    TextureInfo& texture = out.textures.emplace_back();
    if (from.contains("source")) texture.image = from["source"].get<uint64_t>();
    if (!from.contains("sampler")) continue;
    const uint64_t sampler = from["sampler"].get<uint64_t>();
    const std::string place = fmt::format("textures[{}].sampler", out.textures.size() - 1);
    if (sampler >= samplers.size())
      refuse(file, place, fmt::format("{} refers beyond the {} samplers", sampler, samplers.size()),
             "export the file again, or correct it");
    const auto number = [&](const char* name) {
      const auto found = samplers[sampler].find(name);
      return found == samplers[sampler].end() ? std::nullopt : std::optional<int>(found->get<int>());
    };
    texture.mag_filter = number("magFilter"), texture.wrap_s = number("wrapS"), texture.wrap_t = number("wrapT");
  }
  std::set<uint64_t> shown;
  for (size_t texture : used)
    if (texture < out.textures.size() && out.textures[texture].image) shown.insert(*out.textures[texture].image);
  const auto images = lists.find("images");
  for (size_t i = 0; images != lists.end() && i < images->size(); ++i) {
    ImageInfo& image = out.images.emplace_back();
    json& from = (*images)[i];
    if (!shown.contains(i)) continue;
    if (from.contains("uri")) image.uri = std::move(from["uri"].get_ref<std::string&>());
    if (from.contains("bufferView")) image.view = from["bufferView"].get<uint64_t>();
  }
}

}  // namespace

GuardedDocument guard(const std::string& file, json document, std::optional<size_t> animation) {
  GuardedDocument out;
  if (!document.is_object()) refuse(file, "JSON", "not an object", "is this a glTF file?");
  // Checked first, because a file of glTF 1.0 would otherwise fail on its first property, without the reason.
  for (const char* list : {"scenes", "nodes", "meshes", "accessors"}) {
    if (document.contains(list) && document[list].is_object())
      refuse(file, list, "named objects where glTF 2.0 has an array: this is glTF 1.0", "export it as glTF 2.0");
  }
  const GuardChecker checker(file);
  if (document.contains("asset")) {
    checker.object(document, asset_properties(), {});
    check_version(file, document);
  }
  checker.object(document, root_properties(animation.has_value()), {});
  check_extensions(file, document, out.notes);
  out.quantized = uses_extension(document, "KHR_mesh_quantization");
  if (const auto found = document.find("animations"); found != document.end() && found->is_array())
    out.animations = found->size();
  out.animation = take_animation(file, document, animation, out.animations);
  if (const auto accessors = document.find("accessors"); accessors != document.end()) {
    for (size_t i = 0; i < accessors->size(); ++i) {
      json& accessor = (*accessors)[i];
      if (const auto bounds = declared_bounds(accessor)) out.declared_bounds[i] = *bounds;
      accessor.erase("min");
      accessor.erase("max");
    }
  }
  take_masks(file, document, out);
  out.json = std::move(document);
  prepare_for_tinygltf(file, out);
  if (const auto buffers = out.json.find("buffers"); buffers != out.json.end()) {
    for (json& one : *buffers) {
      BufferInfo info;
      if (one.contains("uri")) info.uri = std::move(one["uri"].get_ref<std::string&>());
      info.byte_length = one["byteLength"].get<uint64_t>();
      out.buffers.push_back(std::move(info));
    }
    out.json.erase(buffers);
  }
  return out;
}

}  // namespace noonmark::gltf
