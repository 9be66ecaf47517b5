#include "scenes/gltf/meshopt.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include "scenes/gltf/error.h"

namespace noonmark::gltf {
namespace {

constexpr std::string_view meshopt_remedy = "export the file again, or without the compression";

size_t integer(const tinygltf::Value& object, const char* name) {
  return object.Has(name) ? static_cast<size_t>(object.Get(name).GetNumberAsDouble()) : 0;
}
std::string text(const tinygltf::Value& object, const char* name, const char* by_default) {
  return object.Has(name) ? object.Get(name).Get<std::string>() : by_default;
}

bool layout_is_right(const MeshoptView& v) {
  if (v.mode == "ATTRIBUTES") {
    if (v.stride < 4 || v.stride > 256 || v.stride % 4 != 0) return false;
    if (v.filter == "OCTAHEDRAL") return v.stride == 4 || v.stride == 8;
    if (v.filter == "QUATERNION") return v.stride == 8;
    return v.filter == "NONE" || v.filter == "EXPONENTIAL";
  }
  if (v.mode != "TRIANGLES" && v.mode != "INDICES") return false;
  return (v.stride == 2 || v.stride == 4) && v.filter == "NONE";
}

// The shortest data of the codecs per element: 4 bytes for a block of at most 256 rows and a byte of a row; 1 byte for
// a triangle; 1 byte for an index. A view that has more elements than its data can hold is refused before memory is
// allocated for it.
constexpr size_t largest_ratio = 64;

}  // namespace

std::optional<MeshoptView> meshopt_view(const Document& document, int view) {
  const tinygltf::BufferView& parent = document.model.bufferViews[static_cast<size_t>(view)];
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    const auto found = parent.extensions.find(name);
    if (found == parent.extensions.end()) continue;
    const tinygltf::Value& from = found->second;
    MeshoptView out;
    out.place = fmt::format("bufferViews[{}].extensions.{}", view, name);
    out.buffer = integer(from, "buffer");
    out.offset = integer(from, "byteOffset");
    out.length = integer(from, "byteLength");
    out.count = integer(from, "count");
    out.stride = integer(from, "byteStride");
    out.mode = text(from, "mode", "");
    out.filter = text(from, "filter", "NONE");
    const auto fail = [&](const std::string& what) { refuse(document.file, out.place, what, meshopt_remedy); };
    const auto& buffers = document.guarded.buffers;
    if (out.buffer >= buffers.size())
      fail(fmt::format("buffer {} is beyond the {} buffers", out.buffer, buffers.size()));
    if (out.offset + out.length > buffers[out.buffer].byte_length)
      fail(fmt::format("ends at byte {} of buffers[{}], which has {}", out.offset + out.length, out.buffer,
                       buffers[out.buffer].byte_length));
    if (!layout_is_right(out))
      fail(fmt::format("mode '{}', filter '{}' and byteStride {} cannot be combined", printable(out.mode),
                       printable(out.filter), out.stride));
    if (out.mode == "TRIANGLES" && out.count % 3 != 0)
      fail(fmt::format("count {} is not a multiple of 3, as mode TRIANGLES requires", out.count));
    if (out.count > parent.byteLength || out.count * out.stride != parent.byteLength)
      fail(fmt::format("{} elements of {} bytes do not fill the view's {}", out.count, out.stride, parent.byteLength));
    if (parent.byteLength / largest_ratio > out.length)
      fail(fmt::format("{} bytes cannot be decoded from {}", parent.byteLength, out.length));
    return out;
  }
  return std::nullopt;
}

std::vector<uint8_t> decompress(const Document& document, const MeshoptView& view, std::span<const uint8_t> from) {
  std::vector<uint8_t> out(view.count * view.stride);
  const int result = view.mode == "ATTRIBUTES"
                         ? meshopt_decodeVertexBuffer(out.data(), view.count, view.stride, from.data(), from.size())
                     : view.mode == "TRIANGLES"
                         ? meshopt_decodeIndexBuffer(out.data(), view.count, view.stride, from.data(), from.size())
                         : meshopt_decodeIndexSequence(out.data(), view.count, view.stride, from.data(), from.size());
  if (result != 0) {
    // The first byte has the codec in the high four bits and its version in the low four.
    const bool later = !from.empty() && (from[0] & 0x0f) > (view.mode == "ATTRIBUTES" ? 0 : 1);
    refuse(document.file, view.place,
           later ? fmt::format("its data are of version {} of the codec, which is not supported", from[0] & 0x0f)
                 : "its data cannot be decoded",
           meshopt_remedy);
  }
  if (view.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out.data(), view.count, view.stride);
  if (view.filter == "QUATERNION") meshopt_decodeFilterQuat(out.data(), view.count, view.stride);
  if (view.filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), view.count, view.stride);
  return out;
}

}  // namespace noonmark::gltf
