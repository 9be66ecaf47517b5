#include "scenes/gltf/extensions.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "scenes/gltf/error.h"

namespace noonmark::gltf {
namespace {

using nlohmann::json;

constexpr std::string_view read_extensions[] = {
    "EXT_mesh_gpu_instancing",    "EXT_meshopt_compression", "KHR_animation_pointer",
    "KHR_draco_mesh_compression", "KHR_lights_punctual",     "KHR_mesh_quantization",
    "KHR_meshopt_compression",    "KHR_node_visibility",     "KHR_texture_transform",
};

// The other extensions of the Khronos registry (ratified, vendor and archived ones) that change only shading, textures,
// sound, physics or metadata. Shadows are right without them. With MSFT_lod the node itself shows the finest level.
constexpr std::string_view harmless_extensions[] = {
    "ADOBE_materials_clearcoat_specular",
    "ADOBE_materials_clearcoat_tint",
    "ADOBE_materials_thin_transparency",
    "AGI_articulations",
    "AGI_stk_metadata",
    "CESIUM_primitive_outline",
    "EXT_feature_metadata",
    "EXT_instance_features",
    "EXT_lights_ies",
    "EXT_lights_image_based",
    "EXT_mesh_features",
    "EXT_mesh_manifold",
    "EXT_mesh_primitive_edge_visibility",
    "EXT_structural_metadata",
    "EXT_texture_astc",
    "EXT_texture_avif",
    "EXT_texture_webp",
    "FB_geometry_metadata",
    "GODOT_single_root",
    "GRIFFEL_bim_data",
    "KHR_audio_emitter",
    "KHR_interactivity",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "KHR_technique_webgl",
    "KHR_techniques_webgl",
    "KHR_texture_basisu",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "MPEG_audio_spatial",
    "MPEG_texture_video",
    "MSFT_lod",
    "MSFT_packing_normalRoughnessMetallic",
    "MSFT_packing_occlusionRoughnessMetallic",
    "MSFT_texture_dds",
    "NV_materials_mdl",
};

bool known(std::string_view name) {
  const auto in = [&](const auto& list) { return std::find(std::begin(list), std::end(list), name) != std::end(list); };
  // Names of extensions of materials begin like this, also those of future extensions.
  return in(read_extensions) || in(harmless_extensions) || name.starts_with("KHR_materials_") ||
         name.starts_with("EXT_materials_");
}

const json& list(const json& document, const char* name) {
  static const json none = json::array();
  const auto found = document.find(name);
  return found == document.end() ? none : *found;
}

}  // namespace

void check_extensions(const std::string& file, const json& document, std::vector<std::string>& notes) {
  const json& needed = list(document, "extensionsRequired");
  for (size_t i = 0; i < needed.size(); ++i) {
    const std::string name = needed[i].get<std::string>();
    if (known(name)) continue;
    refuse(file, fmt::format("extensionsRequired[{}]", i),
           fmt::format("'{}' is not supported, and without it the scene may look different", printable(name)),
           "export without it");
  }
  std::set<std::string> unknown;
  for (const json& one : list(document, "extensionsUsed")) {
    if (!known(one.get<std::string>())) unknown.insert(printable(one.get<std::string>()));
  }
  for (const std::string& name : unknown) notes.push_back(fmt::format("extension {} is not read", name));
}

bool uses_extension(const json& document, std::string_view name) {
  const auto named_in = [&](const char* which) {
    const json& names = list(document, which);
    return std::any_of(names.begin(), names.end(), [&](const json& one) { return one == name; });
  };
  return named_in("extensionsUsed") || named_in("extensionsRequired");
}

}  // namespace noonmark::gltf
