#include "scenes/gltf_precheck.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "scenes/gltf_error.h"

namespace noonmark::gltf {
namespace {

using nlohmann::json;

constexpr std::string_view remedy = "export the file again, or correct it";

// The list of that name; empty where the document has none.
const json& list(const json& document, const char* name) {
  static const json none = json::array();
  const auto found = document.find(name);
  return found == document.end() ? none : *found;
}

void check_node(const std::string& file, const json& node, const std::string& place) {
  // tinygltf drops what stands beside a matrix.
  if (node.contains("matrix") &&
      (node.contains("translation") || node.contains("rotation") || node.contains("scale"))) {
    refuse(file, place, "has both a matrix and a translation, rotation or scale", remedy);
  }
}

void check_camera(const std::string& file, const json& camera, const std::string& place) {
  const std::string type = camera["type"].get<std::string>();
  if (type != "perspective" && type != "orthographic") {
    refuse(file, place + ".type", fmt::format("'{}' is neither perspective nor orthographic", printable(type)), remedy);
  }
  if (!camera.contains(type)) refuse(file, place + "." + type, "is missing", remedy);
  if (camera.contains("perspective") && camera.contains("orthographic")) {
    refuse(file, place, "has both perspective and orthographic", remedy);
  }
  // tinygltf takes 0 for an absent zfar.
  if (type == "perspective" && camera[type].value("zfar", 1.0) == 0)
    refuse(file, place + ".perspective.zfar", "is 0", remedy);
}

void check_light(const std::string& file, const json& light, const std::string& place) {
  if (light["type"] == "spot" && !light.contains("spot")) refuse(file, place + ".spot", "is missing", remedy);
}

void check_view(const std::string& file, const json& view, const std::string& place) {
  if (!view.contains("byteStride")) return;
  const uint64_t stride = view["byteStride"].get<uint64_t>();
  // tinygltf takes 0 for an absent byteStride.
  if (stride < 4 || stride % 4 != 0) {
    refuse(file, place + ".byteStride", fmt::format("{} is not a multiple of 4 from 4 to 252", stride), remedy);
  }
}

void check_accessor(const std::string& file, const json& accessor, const std::string& place) {
  constexpr std::array<std::string_view, 7> types = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
  const std::string type = accessor["type"].get<std::string>();
  if (std::find(types.begin(), types.end(), type) == types.end()) {
    refuse(file, place + ".type", fmt::format("'{}' is none of glTF's", printable(type)), remedy);
  }
}

void check_mesh(const std::string& file, const json& document, const json& mesh, const std::string& place) {
  const json& accessors = list(document, "accessors");
  const json& views = list(document, "bufferViews");
  const json& primitives = mesh["primitives"];
  for (size_t i = 0; i < primitives.size(); ++i) {
    if (!primitives[i].contains("indices")) continue;
    const std::string here = fmt::format("{}.primitives[{}].indices", place, i);
    const size_t index = primitives[i]["indices"].get<size_t>();
    if (index >= accessors.size()) {
      refuse(file, here, fmt::format("{} refers beyond the {} accessors", index, accessors.size()), remedy);
    }
    // Allowed where the indices are sparse, but nobody writes that, and tinygltf refuses it.
    const json& accessor = accessors[index];
    if (!accessor.contains("bufferView") || accessor["bufferView"].get<size_t>() >= views.size()) {
      refuse(file, fmt::format("accessors[{}].bufferView", index), "indices without a bufferView that exists", remedy);
    }
  }
}

}  // namespace

void check_before_tinygltf(const std::string& file, const json& document) {
  const auto each = [&](const char* name, const auto& check) {
    const json& items = list(document, name);
    for (size_t i = 0; i < items.size(); ++i) check(items[i], fmt::format("{}[{}]", name, i));
  };
  each("nodes", [&](const json& one, const std::string& place) { check_node(file, one, place); });
  each("cameras", [&](const json& one, const std::string& place) { check_camera(file, one, place); });
  each("bufferViews", [&](const json& one, const std::string& place) { check_view(file, one, place); });
  each("accessors", [&](const json& one, const std::string& place) { check_accessor(file, one, place); });
  each("meshes", [&](const json& one, const std::string& place) { check_mesh(file, document, one, place); });
  const json::json_pointer lights("/extensions/KHR_lights_punctual/lights");
  if (!document.contains(lights)) return;
  for (size_t i = 0; i < document[lights].size(); ++i) {
    check_light(file, document[lights][i], fmt::format("extensions.KHR_lights_punctual.lights[{}]", i));
  }
}

}  // namespace noonmark::gltf
