// All sizes are at most 2^53 (properties.cpp), so sums of two cannot overflow; products are tested by division.
#include "scenes/gltf/structure.h"

#include <fmt/format.h>

#include <numbers>

#include "scenes/gltf/element.h"
#include "scenes/gltf/error.h"
#include "scenes/number_ranges.h"

namespace noonmark::gltf {
namespace {

constexpr std::string_view structure_remedy = "export the file again, or correct it";

class StructureChecker {
 public:
  explicit StructureChecker(const Document& document) : d_(document), m_(document.model) {}

  void all() const {
    each(m_.bufferViews, "bufferViews", &StructureChecker::view);
    each(m_.accessors, "accessors", &StructureChecker::accessor);
    each(m_.materials, "materials", &StructureChecker::material);
    each(m_.meshes, "meshes", &StructureChecker::mesh);
    each(m_.skins, "skins", &StructureChecker::skin);
    each(m_.cameras, "cameras", &StructureChecker::camera);
    each(m_.lights, "extensions.KHR_lights_punctual.lights", &StructureChecker::light);
    each(m_.nodes, "nodes", &StructureChecker::node);
    each(m_.scenes, "scenes", &StructureChecker::scene);
    optional(m_.defaultScene, m_.scenes.size(), "scene", "scenes");
  }

 private:
  template <class T>
  void each(const std::vector<T>& items, std::string_view name,
            void (StructureChecker::*check)(const T&, const std::string&) const) const {
    for (size_t i = 0; i < items.size(); ++i) (this->*check)(items[i], fmt::format("{}[{}]", name, i));
  }

  // The accessor that is used. It must exist and have a type that glTF defines.
  const tinygltf::Accessor& used(int index, const std::string& place) const {
    reference(index, m_.accessors.size(), place, "accessors");
    const auto unknown = d_.guarded.unknown_accessors.find(static_cast<size_t>(index));
    if (unknown != d_.guarded.unknown_accessors.end())
      refuse(d_.file, fmt::format("accessors[{}]", index), unknown->second, structure_remedy);
    return m_.accessors[static_cast<size_t>(index)];
  }

  [[noreturn]] void fail(const std::string& place, const std::string& what) const {
    refuse(d_.file, place, what, structure_remedy);
  }

  void reference(int index, size_t size, const std::string& place, std::string_view list) const {
    if (index < 0 || static_cast<size_t>(index) >= size) {
      fail(place, fmt::format("{} refers beyond the {} {}", index, size, list));
    }
  }
  void optional(int index, size_t size, const std::string& place, std::string_view list) const {
    if (index != -1) reference(index, size, place, list);
  }

  void view(const tinygltf::BufferView& v, const std::string& place) const {
    reference(v.buffer, d_.guarded.buffers.size(), place + ".buffer", "buffers");
    const uint64_t length = d_.guarded.buffers[static_cast<size_t>(v.buffer)].byte_length;
    if (v.byteOffset + v.byteLength > length) {
      fail(place,
           fmt::format("ends at byte {} of buffers[{}], which has {}", v.byteOffset + v.byteLength, v.buffer, length));
    }
  }

  // Checks that `count` elements of `bytes` each, `stride` apart, fit into the view from `offset` on.
  void fits(int view_index, size_t offset, size_t count, size_t stride, size_t bytes, size_t alignment,
            const std::string& place) const {
    reference(view_index, m_.bufferViews.size(), place + ".bufferView", "bufferViews");
    const tinygltf::BufferView& v = m_.bufferViews[static_cast<size_t>(view_index)];
    if ((offset % alignment != 0) || ((v.byteOffset + offset) % alignment != 0)) {
      fail(place + ".byteOffset", fmt::format("is not aligned to its components of {} bytes", alignment));
    }
    const size_t room = offset <= v.byteLength ? v.byteLength - offset : 0;
    const size_t most = room < bytes ? 0 : (room - bytes) / stride + 1;
    if (count > most) {
      fail(place + ".count", fmt::format("{} elements, but bufferViews[{}] has room for {}", count, view_index, most));
    }
  }

  void accessor(const tinygltf::Accessor& a, const std::string& place) const {
    switch (a.componentType) {
      case TINYGLTF_COMPONENT_TYPE_BYTE:
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      case TINYGLTF_COMPONENT_TYPE_SHORT:
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        break;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      case TINYGLTF_COMPONENT_TYPE_FLOAT:
        if (a.normalized) fail(place + ".normalized", "is only for integers of 8 and 16 bits");
        break;
      default:
        fail(place + ".componentType", "is not defined by glTF");
    }
    if (a.count == 0) fail(place + ".count", "is 0");
    const size_t component =
        static_cast<size_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(a.componentType)));
    const size_t bytes = element_bytes(a);
    if (a.bufferView != -1) {
      reference(a.bufferView, m_.bufferViews.size(), place + ".bufferView", "bufferViews");
      const size_t stride = m_.bufferViews[static_cast<size_t>(a.bufferView)].byteStride;
      if (stride != 0 && stride < bytes) {
        fail(place, fmt::format("its elements have {} bytes, but the byteStride of bufferViews[{}] is {}", bytes,
                                a.bufferView, stride));
      }
      fits(a.bufferView, a.byteOffset, a.count, element_stride(d_, a), bytes, component, place);
    }
    if (a.sparse.isSparse) sparse(a, component, place + ".sparse");
  }

  void sparse(const tinygltf::Accessor& a, size_t component, const std::string& place) const {
    if (a.sparse.count < 1 || static_cast<size_t>(a.sparse.count) > a.count) {
      fail(place + ".count", fmt::format("{} is not from 1 to the accessor's count, {}", a.sparse.count, a.count));
    }
    const int type = a.sparse.indices.componentType;
    if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
      fail(place + ".indices.componentType", fmt::format("{} is not an unsigned integer type", type));
    }
    const size_t index_bytes = static_cast<size_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(type)));
    const size_t count = static_cast<size_t>(a.sparse.count);
    fits(a.sparse.indices.bufferView, static_cast<size_t>(a.sparse.indices.byteOffset), count, index_bytes, index_bytes,
         index_bytes, place + ".indices");
    fits(a.sparse.values.bufferView, static_cast<size_t>(a.sparse.values.byteOffset), count, packed_stride(a),
         element_bytes(a), component, place + ".values");
    for (int view_index : {a.sparse.indices.bufferView, a.sparse.values.bufferView}) {
      if (m_.bufferViews[static_cast<size_t>(view_index)].byteStride != 0) {
        fail(place, fmt::format("bufferViews[{}] has a byteStride, which is not allowed for sparse data", view_index));
      }
    }
  }

  void material(const tinygltf::Material& m, const std::string& place) const {
    if (m.alphaMode != "OPAQUE" && m.alphaMode != "MASK" && m.alphaMode != "BLEND") {
      fail(place + ".alphaMode", fmt::format("'{}' is not one of OPAQUE, MASK, BLEND", printable(m.alphaMode)));
    }
  }

  void mesh(const tinygltf::Mesh& m, const std::string& place) const {
    for (size_t i = 0; i < m.primitives.size(); ++i) {
      const tinygltf::Primitive& p = m.primitives[i];
      const std::string here = fmt::format("{}.primitives[{}]", place, i);
      optional(p.material, m_.materials.size(), here + ".material", "materials");
      if (const auto found = p.attributes.find("POSITION"); found != p.attributes.end())
        positions(used(found->second, here + ".attributes.POSITION"), fmt::format("accessors[{}]", found->second));
      for (size_t k = 0; k < p.targets.size(); ++k) {
        const auto found = p.targets[k].find("POSITION");
        if (found == p.targets[k].end()) continue;
        positions(used(found->second, fmt::format("{}.targets[{}].POSITION", here, k)),
                  fmt::format("accessors[{}]", found->second));
      }
      if (const int index = indices_of(p); index != -1)
        indices(used(index, here + ".indices"), fmt::format("accessors[{}]", index));
    }
  }

  void skin(const tinygltf::Skin& s, const std::string& place) const {
    if (s.joints.empty()) fail(place + ".joints", "is empty");
    for (size_t i = 0; i < s.joints.size(); ++i) {
      reference(s.joints[i], m_.nodes.size(), fmt::format("{}.joints[{}]", place, i), "nodes");
    }
    if (s.inverseBindMatrices == -1) return;
    const std::string here = place + ".inverseBindMatrices";
    const tinygltf::Accessor& a = used(s.inverseBindMatrices, here);
    if (a.type != TINYGLTF_TYPE_MAT4 || a.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
      fail(here, fmt::format("accessors[{}] is not a MAT4 of FLOAT", s.inverseBindMatrices));
    if (a.count < s.joints.size())
      fail(here, fmt::format("{} {} for {} joints", a.count, a.count == 1 ? "matrix" : "matrices", s.joints.size()));
  }

  void positions(const tinygltf::Accessor& a, const std::string& place) const {
    if (a.type != TINYGLTF_TYPE_VEC3) fail(place + ".type", "positions are VEC3");
    if (a.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT) return;
    if (a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) fail(place + ".componentType", "positions are FLOAT");
    if (!d_.guarded.quantized) {
      refuse(d_.file, place + ".componentType", "integer positions without KHR_mesh_quantization",
             "list that extension in extensionsUsed and extensionsRequired, or export floats");
    }
    if (a.bufferView != -1 && element_stride(d_, a) % 4 != 0) {
      fail(place, "vertices whose distance is not a multiple of 4 bytes; their view needs a byteStride");
    }
  }

  void indices(const tinygltf::Accessor& a, const std::string& place) const {
    const bool type_is_right = a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                               a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                               a.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (a.type != TINYGLTF_TYPE_SCALAR || !type_is_right || a.normalized) {
      fail(place, "indices are unsigned integer SCALARs, not normalized");
    }
    if (a.bufferView != -1 && m_.bufferViews[static_cast<size_t>(a.bufferView)].byteStride != 0) {
      fail(place, fmt::format("indices, but bufferViews[{}] has a byteStride", a.bufferView));
    }
  }

  void camera(const tinygltf::Camera& c, const std::string& place) const {
    if (c.type == "perspective") {
      const tinygltf::PerspectiveCamera& p = c.perspective;
      const std::string here = place + ".perspective";
      if (const NumberRange& angle = ranges::view_angle_rad; !angle.holds(p.yfov))
        fail(here + ".yfov",
             fmt::format("{} is not an angle of view, from {} to {} radians", p.yfov, angle.least, angle.most));
      if (!(p.znear > 0)) fail(here + ".znear", fmt::format("{} is not positive", p.znear));
      distance(p.znear, here + ".znear");
      // 0 means absent, which is an infinite projection.
      if (p.zfar != 0 && !(p.zfar > p.znear))
        fail(here + ".zfar", fmt::format("{} is not beyond znear {}", p.zfar, p.znear));
    } else {
      const tinygltf::OrthographicCamera& o = c.orthographic;
      const std::string here = place + ".orthographic";
      if (!(o.xmag > 0)) fail(here + ".xmag", fmt::format("{} is not positive", o.xmag));
      if (!(o.ymag > 0)) fail(here + ".ymag", fmt::format("{} is not positive", o.ymag));
      if (!(o.znear >= 0)) fail(here + ".znear", fmt::format("{} is negative", o.znear));
      if (!(o.zfar > o.znear)) fail(here + ".zfar", fmt::format("{} is not beyond znear {}", o.zfar, o.znear));
      distance(o.xmag, here + ".xmag");
      distance(o.ymag, here + ".ymag");
      distance(o.znear, here + ".znear");
    }
  }

  void distance(double m, const std::string& place) const {
    if (m > ranges::coordinate_m.most)
      fail(place, fmt::format("{} m is more than the {} m that a scene may have", m, ranges::coordinate_m.most));
  }

  void light(const tinygltf::Light& l, const std::string& place) const {
    if (l.type != "spot") return;
    const double inner = l.spot.innerConeAngle, outer = l.spot.outerConeAngle;
    // Exporters write a right angle as a float, which is 4e-8 more than pi / 2, or with five digits.
    constexpr double right_angle = std::numbers::pi / 2 + 1e-5;
    if (!(outer > 0 && outer <= right_angle))
      fail(place + ".spot.outerConeAngle", fmt::format("{} is not from 0 to pi / 2 radians, without 0", outer));
    if (!(inner >= 0 && inner < outer))
      fail(place + ".spot.innerConeAngle", fmt::format("{} is not from 0 to below outerConeAngle, {}", inner, outer));
  }

  void node(const tinygltf::Node& n, const std::string& place) const {
    optional(n.mesh, m_.meshes.size(), place + ".mesh", "meshes");
    if (n.mesh != -1) optional(n.skin, m_.skins.size(), place + ".skin", "skins");
    optional(n.camera, m_.cameras.size(), place + ".camera", "cameras");
    for (size_t i = 0; i < n.children.size(); ++i) {
      reference(n.children[i], m_.nodes.size(), fmt::format("{}.children[{}]", place, i), "nodes");
    }
    if (const auto found = n.extensions.find("KHR_lights_punctual"); found != n.extensions.end()) {
      reference(found->second.Get("light").GetNumberAsInt(), m_.lights.size(),
                place + ".extensions.KHR_lights_punctual.light", "lights");
    }
  }

  void scene(const tinygltf::Scene& s, const std::string& place) const {
    for (size_t i = 0; i < s.nodes.size(); ++i) {
      reference(s.nodes[i], m_.nodes.size(), fmt::format("{}.nodes[{}]", place, i), "nodes");
    }
  }

  const Document& d_;
  const tinygltf::Model& m_;
};

}  // namespace

void check_structure(const Document& document) { StructureChecker(document).all(); }

}  // namespace noonmark::gltf
