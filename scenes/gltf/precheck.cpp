#include "scenes/gltf/precheck.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "scenes/gltf/error.h"

namespace noonmark::gltf {
namespace {

using nlohmann::json;

constexpr std::string_view precheck_remedy = "export the file again, or correct it";

void check_node(const std::string& file, const json& node, const std::string& place) {
  // tinygltf drops translation, rotation and scale beside a matrix.
  if (node.contains("matrix") &&
      (node.contains("translation") || node.contains("rotation") || node.contains("scale"))) {
    refuse(file, place, "has both a matrix and a translation, rotation or scale", precheck_remedy);
  }
}

// Empty, or the reason why the camera's type is not defined by glTF.
std::string check_camera(const std::string& file, const json& camera, const std::string& place) {
  const std::string type = camera["type"].get<std::string>();
  if (type != "perspective" && type != "orthographic")
    return fmt::format("type '{}' is neither perspective nor orthographic", printable(type));
  if (!camera.contains(type)) refuse(file, place + "." + type, "is missing", precheck_remedy);
  if (camera.contains("perspective") && camera.contains("orthographic")) {
    refuse(file, place, "has both perspective and orthographic", precheck_remedy);
  }
  // tinygltf uses 0 for an absent zfar, so 0 must be refused here.
  if (type == "perspective" && camera[type].value("zfar", 1.0) == 0)
    refuse(file, place + ".perspective.zfar", "is 0", precheck_remedy);
  return "";
}

// In lux or candela, and of a part of the colour: what both give at a micrometre is a float still.
constexpr double most_intensity = 1e20, most_color = 1e6;

// What the schema of KHR_lights_punctual allows, and no more than a float holds of a pixel's light.
void check_light(const std::string& file, const json& light, const std::string& place) {
  const auto least = [&](const json& value, const std::string& name, bool above) {
    const double number = value.get<double>();
    if (above ? number > 0 : number >= 0) return;
    refuse(file, place + "." + name, fmt::format("{} is not {} 0", number, above ? "above" : "at least"),
           precheck_remedy);
  };
  const auto within = [&](const json& value, const std::string& name, double most) {
    least(value, name, false);
    if (const double number = value.get<double>(); number > most)
      refuse(file, place + "." + name, fmt::format("{} is more than {:g}", number, most), precheck_remedy);
  };
  if (const auto intensity = light.find("intensity"); intensity != light.end())
    within(*intensity, "intensity", most_intensity);
  if (const auto range = light.find("range"); range != light.end()) least(*range, "range", true);
  if (const auto color = light.find("color"); color != light.end())
    for (const json& one : *color) within(one, "color", most_color);
  if (light["type"] == "spot" && !light.contains("spot")) refuse(file, place + ".spot", "is missing", precheck_remedy);
}

void check_view(const std::string& file, const json& view, const std::string& place) {
  if (!view.contains("byteStride")) return;
  const uint64_t stride = view["byteStride"].get<uint64_t>();
  // tinygltf uses 0 for an absent byteStride, so 0 must be refused here.
  if (stride < 4 || stride % 4 != 0) {
    refuse(file, place + ".byteStride", fmt::format("{} is not a multiple of 4 from 4 to 252", stride),
           precheck_remedy);
  }
}

// Empty, or the reason why the accessor's type is not defined by glTF.
std::string unknown_type(const json& accessor) {
  constexpr std::array<std::string_view, 7> types = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
  constexpr std::array<int, 6> component_types = {5120, 5121, 5122, 5123, 5125, 5126};
  const std::string type = accessor["type"].get<std::string>();
  const int component = accessor["componentType"].get<int>();
  if (std::find(types.begin(), types.end(), type) == types.end())
    return fmt::format("type: '{}' is not defined by glTF", printable(type));
  if (std::find(component_types.begin(), component_types.end(), component) == component_types.end())
    return fmt::format("componentType: {} is not defined by glTF", component);
  return "";
}

}  // namespace

void prepare_for_tinygltf(const std::string& file, GuardedDocument& guarded) {
  json& document = guarded.json;
  const auto each = [&](const char* name, const auto& step) {
    const auto found = document.find(name);
    for (size_t i = 0; found != document.end() && i < found->size(); ++i) {
      step(i, (*found)[i], fmt::format("{}[{}]", name, i));
    }
  };
  each("nodes", [&](size_t, const json& one, const std::string& place) { check_node(file, one, place); });
  each("bufferViews", [&](size_t, const json& one, const std::string& place) { check_view(file, one, place); });
  each("cameras", [&](size_t i, json& one, const std::string& place) {
    const std::string unknown = check_camera(file, one, place);
    if (unknown.empty()) return;
    guarded.unknown_cameras[i] = unknown;
    one = {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 1.0}}}};
  });
  each("accessors", [&](size_t i, json& one, const std::string&) {
    const std::string unknown = unknown_type(one);
    if (unknown.empty()) return;
    guarded.unknown_accessors[i] = unknown;
    one = {{"type", "SCALAR"}, {"componentType", 5121}, {"count", 1}};
  });
  each("meshes", [&](size_t, json& one, const std::string&) {
    for (json& primitive : one["primitives"]) {
      const auto indices = primitive.find("indices");
      if (indices == primitive.end()) continue;
      primitive["attributes"][indices_attribute] = *indices;
      primitive.erase("indices");
    }
  });
  const json::json_pointer lights("/extensions/KHR_lights_punctual/lights");
  if (!document.contains(lights)) return;
  for (size_t i = 0; i < document[lights].size(); ++i) {
    check_light(file, document[lights][i], fmt::format("extensions.KHR_lights_punctual.lights[{}]", i));
  }
}

}  // namespace noonmark::gltf
