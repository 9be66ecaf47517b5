#include "scenes/gltf/draco.h"

#include <draco/compression/decode.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "scenes/gltf/element.h"
#include "scenes/gltf/error.h"

namespace noonmark::gltf {
namespace {

constexpr const char* extension = "KHR_draco_mesh_compression";
constexpr std::string_view draco_remedy = "export the file again, or without the compression";

// The number of triangles that the head of the data gives (Draco's bitstream 2.2, the version that glTF names). No
// value if it is malformed. It is read before decoding, because the decoder allocates memory for that many.
std::optional<uint64_t> promised_triangles(std::span<const uint8_t> data) {
  draco::DecoderBuffer in;
  in.Init(reinterpret_cast<const char*>(data.data()), data.size());
  char magic[5];
  uint8_t version[2], encoder_type, method, traversal;
  uint16_t flags;
  uint32_t vertices, faces;
  if (!in.Decode(magic, 5) || std::memcmp(magic, "DRACO", 5) != 0) return std::nullopt;
  if (!in.Decode(&version) || version[0] != 2 || version[1] != 2) return std::nullopt;
  in.set_bitstream_version(DRACO_BITSTREAM_VERSION(2, 2));
  if (!in.Decode(&encoder_type) || encoder_type != draco::TRIANGULAR_MESH) return std::nullopt;
  if (!in.Decode(&method) || !in.Decode(&flags)) return std::nullopt;
  if ((flags & METADATA_FLAG_MASK) != 0) {
    draco::GeometryMetadata skipped;
    if (!draco::MetadataDecoder().DecodeGeometryMetadata(&in, &skipped)) return std::nullopt;
  }
  if (method == draco::MESH_EDGEBREAKER_ENCODING &&
      (!in.Decode(&traversal) || !draco::DecodeVarint(&vertices, &in) || vertices > max_vertices))
    return std::nullopt;
  if (!draco::DecodeVarint(&faces, &in)) return std::nullopt;
  return faces;
}

template <class T>
bool pack(const draco::PointAttribute& from, uint32_t points, uint8_t* to) {
  const auto components = static_cast<int8_t>(from.num_components());
  std::vector<T> row(static_cast<size_t>(components));
  for (draco::PointIndex p(0); p < points; ++p, to += row.size() * sizeof(T)) {
    const draco::AttributeValueIndex value = from.mapped_index(p);
    if (value.value() >= from.size() || !from.ConvertValue(value, components, row.data())) return false;
    std::memcpy(to, row.data(), row.size() * sizeof(T));
  }
  return true;
}

bool pack(const draco::PointAttribute& from, uint32_t points, int component_type, uint8_t* to) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return pack<int8_t>(from, points, to);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return pack<uint8_t>(from, points, to);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return pack<int16_t>(from, points, to);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return pack<uint16_t>(from, points, to);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return pack<uint32_t>(from, points, to);
    default:
      return pack<float>(from, points, to);
  }
}

// Damaged data can be decoded too. min and max are those of the values before or after quantization.
std::string note_of_bounds(const Document& document, int accessor, std::span<const uint8_t> packed,
                           const std::string& place) {
  const tinygltf::Accessor& a = document.model.accessors[static_cast<size_t>(accessor)];
  const auto declared = document.guarded.declared_bounds.find(static_cast<size_t>(accessor));
  if (declared == document.guarded.declared_bounds.end() || a.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT) return "";
  const auto& [low, high] = declared->second;
  const AccessorReader reader(a, packed);
  glm::dvec3 least(std::numeric_limits<double>::infinity()), most = -least;
  for (size_t i = 0; i < reader.count(); ++i) {
    least = glm::min(least, reader.vec3(i));
    most = glm::max(most, reader.vec3(i));
  }
  double extent = 0, off = 0;
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<size_t>(k);
    extent = std::max(extent, high[axis] - low[axis]);
    off = std::max({off, std::abs(least[k] - low[axis]), std::abs(most[k] - high[axis])});
  }
  // One step of 8 bits over the longest axis; exporters use 10 to 16 bits. The second term is the rounding to float.
  const double step = extent / 255 + 0x1p-22 * std::max(glm::length(least), glm::length(most));
  if (off <= step) return "";
  return fmt::format(
      "{}: the data reach {:.3g} beyond or short of the min and max of accessors[{}], more than "
      "quantization can cause; they are drawn as decoded and may be damaged",
      place, off, accessor);
}

}  // namespace

bool is_draco(const tinygltf::Primitive& primitive) { return primitive.extensions.contains(extension); }

std::string draco_key(const tinygltf::Primitive& primitive) {
  const tinygltf::Value& from = primitive.extensions.at(extension);
  std::string key = fmt::format("{}", from.Get("bufferView").GetNumberAsInt());
  const tinygltf::Value& attributes = from.Get("attributes");
  for (const std::string& name : attributes.Keys())
    key += fmt::format(" {}:{}{}", name.size(), name, attributes.Get(name).GetNumberAsInt());
  return key + ";";
}

DracoMesh decode_draco(const Document& document, Buffers& buffers, int mesh, size_t primitive_index) {
  const tinygltf::Model& model = document.model;
  const tinygltf::Primitive& primitive = model.meshes[static_cast<size_t>(mesh)].primitives[primitive_index];
  const tinygltf::Value& from = primitive.extensions.at(extension);
  const std::string place = fmt::format("meshes[{}].primitives[{}].extensions.{}", mesh, primitive_index, extension);
  const auto fail = [&](const std::string& what) { refuse(document.file, place, what, draco_remedy); };

  if (primitive.mode != TINYGLTF_MODE_TRIANGLES && primitive.mode != TINYGLTF_MODE_TRIANGLE_STRIP)
    fail("only triangles and strips can be compressed");
  const int view = from.Get("bufferView").GetNumberAsInt();
  if (view < 0 || static_cast<size_t>(view) >= model.bufferViews.size())
    fail(fmt::format("bufferView {} is beyond the {} bufferViews", view, model.bufferViews.size()));
  const std::span<const uint8_t> data = buffers.view(view);
  const std::optional<uint64_t> promised = promised_triangles(data);
  if (!promised) fail(fmt::format("bufferViews[{}] does not hold a mesh of Draco's version 2.2", view));
  if (*promised > max_triangles)
    fail(fmt::format("{} triangles are more than the {} allowed", *promised, max_triangles));
  const int indices = indices_of(primitive);
  if (primitive.mode == TINYGLTF_MODE_TRIANGLES && indices != -1 &&
      model.accessors[static_cast<size_t>(indices)].count != 3 * *promised)
    fail(fmt::format("{} triangles, but accessors[{}] has {} indices", *promised, indices,
                     model.accessors[static_cast<size_t>(indices)].count));

  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(data.data()), data.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) fail("cannot be decoded: " + printable(decoded.status().error_msg_string()));
  const draco::Mesh& made = *decoded.value();

  DracoMesh out;
  for (draco::FaceIndex f(0); f < made.num_faces(); ++f) {
    for (size_t k = 0; k < 3; ++k) {
      // The decoder does not check this: in damaged data a corner can be beyond the points.
      const uint32_t corner = made.face(f)[k].value();
      if (corner >= made.num_points()) fail(fmt::format("corner {} of {} points", corner, made.num_points()));
      out.corners.push_back(corner);
    }
  }
  const tinygltf::Value& attributes = from.Get("attributes");
  for (const auto& [name, accessor_index] : primitive.attributes) {
    if (!attributes.Has(name)) continue;
    const auto unique_id = static_cast<uint32_t>(attributes.Get(name).GetNumberAsInt());
    const draco::PointAttribute* attribute = made.GetAttributeByUniqueId(unique_id);
    if (attribute == nullptr) fail(fmt::format("{} is attribute {}, which is not in the data", name, unique_id));
    if (accessor_index < 0 || static_cast<size_t>(accessor_index) >= model.accessors.size())
      fail(fmt::format("{}: accessor {} is beyond the {} accessors", name, accessor_index, model.accessors.size()));
    const tinygltf::Accessor& a = model.accessors[static_cast<size_t>(accessor_index)];
    const int components = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(a.type));
    if (a.count != made.num_points() || components != attribute->num_components())
      fail(fmt::format("{}: accessors[{}] has {} elements of {} components, the data {} of {}", name, accessor_index,
                       a.count, components, made.num_points(), attribute->num_components()));
    std::vector<uint8_t>& bytes = out.elements[accessor_index];
    bytes.resize(a.count * packed_stride(a));
    if (!pack(*attribute, made.num_points(), a.componentType, bytes.data()))
      fail(fmt::format("{} cannot be converted to the type of accessors[{}]", name, accessor_index));
  }
  const int positions = primitive.attributes.at("POSITION");
  if (!out.elements.contains(positions)) fail("POSITION is not among the compressed attributes");
  out.note = note_of_bounds(document, positions, out.elements.at(positions), place);
  return out;
}

}  // namespace noonmark::gltf
