#include "scenes/gltf/masks.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "base/memory.h"
#include "scenes/gltf/error.h"
#include "scenes/scene_size.h"

namespace noonmark::gltf {
namespace {

constexpr std::string_view mask_remedy = "export the file again, or set scene.masks = false";

struct Alpha {
  int width = 0, height = 0;
  std::vector<uint8_t> values;
};

bool begins(std::span<const uint8_t> bytes, std::string_view with) {
  return bytes.size() >= with.size() && std::equal(with.begin(), with.end(), bytes.begin(),
                                                   [](char a, uint8_t b) { return static_cast<uint8_t>(a) == b; });
}

// libpng's "simplified" interface: it converts every kind of PNG to 8 bits of red, green, blue and alpha.
Alpha alpha_of_png(const std::string& file, std::span<const uint8_t> bytes, const std::string& place) {
  struct PngReader {
    png_image image{};
    ~PngReader() { png_image_free(&image); }
  } reader;
  png_image& image = reader.image;
  image.version = PNG_IMAGE_VERSION;
  const auto damaged = [&] {
    refuse(file, place, fmt::format("is a damaged PNG: {}", printable(image.message)), mask_remedy);
  };
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0) damaged();
  // As many as OpenGL's textures may have on a large GPU.
  constexpr uint32_t most_texels = 32768;
  if (image.width > most_texels || image.height > most_texels)
    refuse(file, place,
           fmt::format("has {} x {} texels; at most {} on a side are allowed", image.width, image.height, most_texels),
           "scale it down, or set scene.masks = false");
  Alpha out{static_cast<int>(image.width), static_cast<int>(image.height), {}};
  const size_t texels = size_t{image.width} * image.height;
  if ((image.format & PNG_FORMAT_FLAG_ALPHA) == 0) {
    out = {1, 1, {255}};
    return out;
  }
  // Of the header, which libpng has checked, the texels may not take more bits than the whole file can be unpacked to.
  constexpr double most_unpacked = 1032;  // bytes from one: 258 bytes take at least two bits (RFC 1951, section 3.2)
  constexpr size_t depth_at = 24, colour_type_at = 25;
  constexpr uint8_t grey_alpha = 4, red_green_blue_alpha = 6;
  const uint8_t type = bytes[colour_type_at];
  const int samples = type == grey_alpha ? 2 : type == red_green_blue_alpha ? 4 : 1;  // at least
  if (static_cast<double>(texels) * samples * bytes[depth_at] / 8 > most_unpacked * static_cast<double>(bytes.size()))
    refuse(file, place,
           fmt::format("is a damaged PNG: it has {} bytes, too few for {} x {} texels", bytes.size(), image.width,
                       image.height),
           mask_remedy);
  image.format = PNG_FORMAT_RGBA;
  const double needed = static_cast<double>(texels) * 5;
  if (const AvailableMemory available = available_memory(); needed > static_cast<double>(available.bytes))
    refuse(file, place, fmt::format("takes {} of memory to decode and {}", bytes_text(needed), available.text()),
           "scale it down, or set scene.masks = false");
  std::vector<uint8_t> colours(texels * 4);
  if (png_image_finish_read(&image, nullptr, colours.data(), 0, nullptr) == 0) damaged();
  out.values.resize(texels);
  for (size_t i = 0; i < texels; ++i) out.values[i] = colours[4 * i + 3];
  return out;
}

MaskWrap wrap_of(const std::string& file, std::optional<int> value, const std::string& place) {
  switch (value.value_or(TINYGLTF_TEXTURE_WRAP_REPEAT)) {
    case TINYGLTF_TEXTURE_WRAP_REPEAT:
      return MaskWrap::repeat;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      return MaskWrap::mirrored;
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return MaskWrap::clamp;
    default:
      refuse(file, place, fmt::format("wraps by {}, which glTF does not define", *value), mask_remedy);
  }
}

MaskFilter filter_of(const std::string& file, std::optional<int> value, const std::string& place) {
  switch (value.value_or(TINYGLTF_TEXTURE_FILTER_LINEAR)) {
    case TINYGLTF_TEXTURE_FILTER_NEAREST:
      return MaskFilter::nearest;
    case TINYGLTF_TEXTURE_FILTER_LINEAR:
      return MaskFilter::linear;
    default:
      refuse(file, place, fmt::format("has the magFilter {}, which glTF does not define", *value), mask_remedy);
  }
}

double number(const tinygltf::Value& object, const char* name, size_t k, double otherwise) {
  if (!object.Has(name)) return otherwise;
  const tinygltf::Value& value = object.Get(name);
  return value.IsArray() ? value.Get(static_cast<int>(k)).GetNumberAsDouble() : value.GetNumberAsDouble();
}

// KHR_texture_transform: translation * rotation * scale, for column vectors (u, v, 1). Counter-clockwise as seen with v
// down, as in all viewers; the listing in the extension's text turns the other way (KhronosGroup/glTF issue 1563).
glm::dmat3 uv_transform(const tinygltf::Value& from) {
  const double angle = number(from, "rotation", 0, 0), c = std::cos(angle), s = std::sin(angle);
  const double su = number(from, "scale", 0, 1), sv = number(from, "scale", 1, 1);
  return {{c * su, -s * su, 0}, {s * sv, c * sv, 0}, {number(from, "offset", 0, 0), number(from, "offset", 1, 0), 1}};
}

}  // namespace

bool masks_by_texture(const tinygltf::Material& material) {
  return material.alphaMode == "MASK" && material.pbrMetallicRoughness.baseColorTexture.index != -1;
}

bool masked_out(const tinygltf::Material& material) {
  const tinygltf::PbrMetallicRoughness& base = material.pbrMetallicRoughness;
  return material.alphaMode == "MASK" && base.baseColorTexture.index == -1 && base.baseColorFactor.size() == 4 &&
         base.baseColorFactor[3] < material.alphaCutoff;
}

const Masks::Mask* Masks::of(int material) {
  if (material == -1) return nullptr;
  const auto [found, fresh] = masks_.try_emplace(material);
  const tinygltf::Material& m = document_.model.materials[static_cast<size_t>(material)];
  if (fresh && masks_by_texture(m)) found->second = load(m, fmt::format("materials[{}]", material));
  return found->second ? &*found->second : nullptr;
}

std::optional<Masks::Mask> Masks::load(const tinygltf::Material& material, const std::string& place) {
  const GuardedDocument& guarded = document_.guarded;
  const tinygltf::TextureInfo& info = material.pbrMetallicRoughness.baseColorTexture;
  const std::string here = place + ".pbrMetallicRoughness.baseColorTexture";
  if (static_cast<size_t>(info.index) >= guarded.textures.size())
    refuse(document_.file, here + ".index",
           fmt::format("{} refers beyond the {} textures", info.index, guarded.textures.size()), mask_remedy);
  const TextureInfo& texture = guarded.textures[static_cast<size_t>(info.index)];
  const std::string texture_place = fmt::format("textures[{}]", info.index);
  if (!texture.image) {
    notes_.push_back(fmt::format("{} masked by an image that only an extension names, taken as opaque", place));
    return std::nullopt;
  }
  if (*texture.image >= guarded.images.size())
    refuse(document_.file, texture_place + ".source",
           fmt::format("{} refers beyond the {} images", *texture.image, guarded.images.size()), mask_remedy);
  const std::string image_place = fmt::format("images[{}]", *texture.image);
  const std::vector<uint8_t> bytes = buffers_.image(*texture.image);
  Alpha alpha{1, 1, {255}};
  if (begins(bytes, "\x89PNG\r\n\x1a\n")) {
    alpha = alpha_of_png(document_.file, bytes, image_place);
  } else if (!begins(bytes, "\xff\xd8\xff")) {  // a JPEG has no alpha
    notes_.push_back(
        fmt::format("{} masked by {}, which is neither PNG nor JPEG, taken as opaque", place, image_place));
    return std::nullopt;
  }
  AlphaMask mask;
  mask.width = alpha.width, mask.height = alpha.height, mask.alpha = std::move(alpha.values);
  mask.wrap_u = wrap_of(document_.file, texture.wrap_s, texture_place);
  mask.wrap_v = wrap_of(document_.file, texture.wrap_t, texture_place);
  mask.filter = filter_of(document_.file, texture.mag_filter, texture_place);
  mask.factor = material.pbrMetallicRoughness.baseColorFactor[3];
  mask.cutoff = material.alphaCutoff;
  int coordinates = info.texCoord;
  glm::dmat3 transform(1);
  if (const auto found = info.extensions.find("KHR_texture_transform"); found != info.extensions.end()) {
    transform = uv_transform(found->second);
    if (found->second.Has("texCoord")) coordinates = found->second.Get("texCoord").GetNumberAsInt();
  }
  return Mask{MaskCutter(std::move(mask)), coordinates, transform, image_place};
}

int coordinates_of(const Document& document, int mesh, size_t primitive, const Masks::Mask& mask) {
  const std::string set = fmt::format("TEXCOORD_{}", mask.coordinates);
  const std::string place = fmt::format("meshes[{}].primitives[{}].attributes.{}", mesh, primitive, set);
  const auto& attributes = document.model.meshes[static_cast<size_t>(mesh)].primitives[primitive].attributes;
  const auto found = attributes.find(set);
  if (found == attributes.end())
    refuse(document.file, place, fmt::format("is missing, and {} masks by it", mask.image), mask_remedy);
  const int accessor = found->second;
  const std::vector<tinygltf::Accessor>& accessors = document.model.accessors;
  if (accessor < 0 || static_cast<size_t>(accessor) >= accessors.size())
    refuse(document.file, place, fmt::format("{} refers beyond the {} accessors", accessor, accessors.size()),
           mask_remedy);
  const std::string at = fmt::format("accessors[{}]", accessor);
  const auto unknown = document.guarded.unknown_accessors.find(static_cast<size_t>(accessor));
  if (unknown != document.guarded.unknown_accessors.end()) refuse(document.file, at, unknown->second, mask_remedy);
  if (accessors[static_cast<size_t>(accessor)].type != TINYGLTF_TYPE_VEC2)
    refuse(document.file, at + ".type", "texture coordinates are VEC2", mask_remedy);
  return accessor;
}

MaskedPrimitive::MaskedPrimitive(const Document& document, const Masks::Mask& mask, int accessor,
                                 const AccessorReader& coordinates, size_t vertices)
    : document_(document), mask_(mask), accessor_(accessor), coordinates_(coordinates) {
  if (coordinates.count() < vertices)
    refuse(document.file, fmt::format("accessors[{}].count", accessor),
           fmt::format("{} texture coordinates for {} vertices", coordinates.count(), vertices), mask_remedy);
}

std::array<glm::dvec2, 3> MaskedPrimitive::uv_of(const glm::uvec3& vertices) const {
  std::array<glm::dvec2, 3> uv;
  for (int k = 0; k < 3; ++k) {
    const uint32_t v = vertices[k];
    const glm::dvec2 at(mask_.uv_from_set * glm::dvec3(coordinates_.value(v, 0), coordinates_.value(v, 1), 1));
    if (!std::isfinite(at.x) || !std::isfinite(at.y))
      refuse(document_.file, fmt::format("accessors[{}]", accessor_),
             fmt::format("the texture coordinates of vertex {} are not finite", v),
             "repair the mesh and export again, or set scene.masks = false");
    uv[static_cast<size_t>(k)] = at;
  }
  return uv;
}

void MaskedPrimitive::prepare(const glm::uvec3& vertices, const glm::vec3 (&corners)[3]) {
  for (const glm::vec3& corner : corners)
    for (int axis = 0; axis < 3; ++axis) largest_m_ = std::max(largest_m_, std::abs(double{corner[axis]}));
  metres_per_texel_ =
      std::max(metres_per_texel_, mask_.cutter.metres_per_texel({corners[0], corners[1], corners[2]}, uv_of(vertices)));
}

// A chord that is nearer to its arc than a step of the corners' floats is lost in their rounding.
double MaskedPrimitive::error_texels() const {
  const double step_m = 0x1p-23 * largest_m_;
  return metres_per_texel_ > 0 ? std::max(MaskCutter::finest_error_texels, step_m / metres_per_texel_)
                               : MaskCutter::finest_error_texels;
}

void MaskedPrimitive::cut(const glm::uvec3& vertices, const glm::vec3 (&corners)[3], const Scene& scene,
                          MaskCutter::Pieces& pieces) {
  const std::array<glm::dvec2, 3> uv = uv_of(vertices);
  const auto too_many = [&](const std::string& what) {
    refuse(document_.file, mask_.image, what, "set scene.masks = false, or use a smaller texture");
  };
  try {
    const uint64_t there = std::min<uint64_t>(max_triangles, scene.triangles.size());
    mask_.cutter.cut({corners[0], corners[1], corners[2]}, uv, pieces, max_triangles - there, error_texels());
  } catch (const MaskCutter::TooManyPieces&) {
    too_many(
        fmt::format("its mask cuts the scene into more than the {} triangles allowed, or repeats more often than "
                    "can be cut",
                    max_triangles));
  }
  // The pieces cannot be counted before they are cut, so the memory is asked for again and again.
  constexpr uint64_t step = 1'000'000;
  const uint64_t count = scene.triangles.size() + pieces.triangles.size();
  if (count < room_asked_at_) return;
  room_asked_at_ = count + step;
  SceneSize size = scene_size(scene);
  size.triangles += pieces.triangles.size(), size.vertices += pieces.positions.size();
  const double needed = scene_bytes(size);
  if (const AvailableMemory available = available_memory(); needed > static_cast<double>(available.bytes))
    too_many(fmt::format("its mask cuts the scene into {} triangles so far, which take at least {} of memory, and {}",
                         count, bytes_text(needed), available.text()));
}

}  // namespace noonmark::gltf
