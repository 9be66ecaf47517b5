#include "scenes/gltf/properties.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace noonmark::gltf {
namespace {

constexpr uint64_t max_size = uint64_t{1} << 53;  // integers that JSON carries exactly
constexpr bool required = true;

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
                              {"min", Kind::unchecked},
                              {"max", Kind::unchecked},
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
constexpr Field texture_transform[] = {{"offset", Kind::numbers, false, 2},
                                       {"rotation", Kind::number},
                                       {"scale", Kind::numbers, false, 2},
                                       {"texCoord", Kind::integer}};
constexpr Field texture_info_extensions[] = {{"KHR_texture_transform", Kind::object, false, 0, texture_transform}};
constexpr Field texture_info[] = {{"index", Kind::integer, required},
                                  {"texCoord", Kind::integer},
                                  {"extensions", Kind::object, false, 0, texture_info_extensions}};
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
    {"name", Kind::text},        {"type", Kind::text, required}, {"spot", Kind::object, false, 0, spot},
    {"intensity", Kind::number}, {"range", Kind::number},        {"color", Kind::numbers, false, 3}};
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
// Read only if a material masks by a texture. So a file whose textures are broken or absent can still be loaded without
// them.
constexpr Field image[] = {{"uri", Kind::text}, {"bufferView", Kind::integer}};
constexpr Field texture_sampler[] = {{"magFilter", Kind::integer}, {"wrapS", Kind::integer}, {"wrapT", Kind::integer}};
constexpr Field texture[] = {{"source", Kind::integer}, {"sampler", Kind::integer}};
constexpr Field masking[] = {{"images", Kind::objects, false, 0, image},
                             {"samplers", Kind::objects, false, 0, texture_sampler},
                             {"textures", Kind::objects, false, 0, texture}};
constexpr Field asset[] = {{"version", Kind::text, required}, {"minVersion", Kind::text}};

// in_animations: what is read of each animation. All other properties of the file are the same.
constexpr auto root(std::span<const Field> in_animations) {
  return std::to_array<Field>({{"asset", Kind::object, required, 0, asset},
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
                               {"buffers", Kind::objects, false, 0, buffer},
                               {"images", Kind::unchecked, false, 0, image},
                               {"samplers", Kind::unchecked, false, 0, texture_sampler},
                               {"textures", Kind::unchecked, false, 0, texture},
                               {"animations", Kind::unchecked, false, 0, in_animations}});
}
constexpr auto root_at_rest = root({});
constexpr auto root_posed = root(animation);

}  // namespace

std::span<const Field> root_properties(bool posed) { return posed ? root_posed : root_at_rest; }

std::span<const Field> asset_properties() { return std::span<const Field>(root_at_rest).first(1); }

std::span<const Field> animation_properties() { return animation; }

std::span<const Field> masking_properties() { return masking; }

bool is_read_reference(std::string_view name) {
  for (std::string_view set : {"JOINTS_", "WEIGHTS_", "TEXCOORD_"}) {
    if (name.starts_with(set) && name.size() > set.size() && name.size() <= set.size() + 3 &&
        std::all_of(name.begin() + static_cast<std::ptrdiff_t>(set.size()), name.end(),
                    [](unsigned char c) { return std::isdigit(c) != 0; }))
      return true;
  }
  return name == "POSITION" || name == "NORMAL" || name == "TRANSLATION" || name == "ROTATION" || name == "SCALE";
}

}  // namespace noonmark::gltf
