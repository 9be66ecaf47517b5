#include "scenes/gltf_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "scenes/gltf_accessor.h"
#include "scenes/gltf_error.h"
#include "scenes/memory.h"

namespace noonmark::gltf {
namespace {

constexpr uint32_t unused = std::numeric_limits<uint32_t>::max();

struct Drawable {
  size_t primitive = 0;
  int positions = -1;
  int indices = -1;
  int mode = TINYGLTF_MODE_TRIANGLES;
  uint64_t corners = 0;
  uint64_t triangles = 0;
};

bool masked_out(const tinygltf::Model& model, const tinygltf::Primitive& primitive) {
  if (primitive.material == -1) return false;
  const tinygltf::Material& material = model.materials[static_cast<size_t>(primitive.material)];
  const tinygltf::PbrMetallicRoughness& base = material.pbrMetallicRoughness;
  return material.alphaMode == "MASK" && base.baseColorTexture.index == -1 && base.baseColorFactor.size() == 4 &&
         base.baseColorFactor[3] < material.alphaCutoff;
}

std::vector<Drawable> drawables(const tinygltf::Model& model, const tinygltf::Mesh& mesh) {
  std::vector<Drawable> out;
  for (size_t i = 0; i < mesh.primitives.size(); ++i) {
    const tinygltf::Primitive& primitive = mesh.primitives[i];
    const auto position = primitive.attributes.find("POSITION");
    if (primitive.mode < TINYGLTF_MODE_TRIANGLES || position == primitive.attributes.end()) continue;
    if (masked_out(model, primitive)) continue;
    Drawable d{i, position->second, primitive.indices, primitive.mode};
    d.corners = model.accessors[static_cast<size_t>(d.indices == -1 ? d.positions : d.indices)].count;
    // What is left over of an incomplete triangle is ignored (glTF 2.0, section 3.7.2.1).
    d.triangles = d.corners < 3 ? 0 : d.mode == TINYGLTF_MODE_TRIANGLES ? d.corners / 3 : d.corners - 2;
    if (d.triangles > 0) out.push_back(d);
  }
  return out;
}

// The corners of triangle t of a primitive, as places in its list of vertices (glTF 2.0, section 3.7.2.1).
glm::uvec3 corners_of(int mode, uint32_t t) {
  if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) return {t, t + 1 + t % 2, t + 2 - t % 2};
  if (mode == TINYGLTF_MODE_TRIANGLE_FAN) return {t + 1, t + 2, 0};
  return {3 * t, 3 * t + 1, 3 * t + 2};
}

bool degenerate(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  return glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a)) == glm::dvec3(0);
}

// Where the file's vertices went in the scene. The range of indices that a primitive uses is often a small part of its
// accessor; where it is far larger than their number, a list of the used ones takes less memory.
class VertexMap {
 public:
  explicit VertexMap(const std::vector<uint32_t>& used) {
    const auto [low, high] = std::minmax_element(used.begin(), used.end());
    low_ = *low;
    const uint64_t range = uint64_t{*high} - low_ + 1;
    constexpr uint64_t worthwhile = 8;
    if (range > worthwhile * used.size()) {
      sorted_ = used;
      std::sort(sorted_.begin(), sorted_.end());
      sorted_.erase(std::unique(sorted_.begin(), sorted_.end()), sorted_.end());
      places_.assign(sorted_.size(), unused);
    } else {
      places_.assign(range, unused);
    }
  }
  uint32_t& place_of(uint32_t vertex) {
    if (sorted_.empty()) return places_[vertex - low_];
    return places_[static_cast<size_t>(std::lower_bound(sorted_.begin(), sorted_.end(), vertex) - sorted_.begin())];
  }

 private:
  uint32_t low_ = 0;
  std::vector<uint32_t> sorted_;
  std::vector<uint32_t> places_;
};

class Appender {
 public:
  Appender(const Document& document, Buffers& buffers, Scene& scene) : d_(document), buffers_(buffers), scene_(scene) {}

  void append(const PlacedNode& placed, size_t mesh, const Drawable& drawable) {
    const AccessorReader& positions = reader(drawable.positions);
    const std::vector<uint32_t> vertices = vertex_list(mesh, drawable, positions.count());
    VertexMap map(vertices);
    const bool mirrored = glm::determinant(glm::dmat3(placed.world_from_node)) < 0;
    Part part;
    part.first_triangle = static_cast<uint32_t>(scene_.triangles.size());
    for (uint32_t t = 0; t < drawable.triangles; ++t) {
      glm::uvec3 triangle = corners_of(drawable.mode, t);
      if (mirrored) std::swap(triangle.y, triangle.z);
      glm::vec3 corner[3];
      for (int k = 0; k < 3; ++k) {
        triangle[k] = vertices[triangle[k]];
        const uint32_t known = map.place_of(triangle[k]);
        corner[k] =
            known != unused ? scene_.positions[known] : world_position(placed, drawable, positions, triangle[k]);
      }
      if (degenerate(corner[0], corner[1], corner[2])) continue;
      for (int k = 0; k < 3; ++k) {
        uint32_t& place = map.place_of(triangle[k]);
        if (place == unused) {
          place = static_cast<uint32_t>(scene_.positions.size());
          scene_.positions.push_back(corner[k]);
        }
        triangle[k] = place;
      }
      scene_.triangles.push_back(triangle);
    }
    part.triangle_count = static_cast<uint32_t>(scene_.triangles.size()) - part.first_triangle;
    if (part.triangle_count == 0) return;
    part.name = part_name(placed, mesh, drawable);
    scene_.parts.push_back(std::move(part));
  }

 private:
  const AccessorReader& reader(int accessor) {
    if (const auto known = readers_.find(accessor); known != readers_.end()) return known->second;
    // Many accessors may share one long list of sparse indices, and each reader goes through the whole list.
    const tinygltf::Accessor& a = d_.model.accessors[static_cast<size_t>(accessor)];
    if (a.sparse.isSparse) sparse_elements_ += static_cast<uint64_t>(a.sparse.count);
    if (sparse_elements_ > 3 * max_triangles) {
      refuse(d_.file, fmt::format("accessors[{}].sparse.count", accessor),
             fmt::format("the scene has more than {} sparse elements", 3 * max_triangles),
             "export without sparse accessors");
    }
    return readers_.try_emplace(accessor, d_, buffers_, accessor).first->second;
  }

  // The vertices in drawing order, each below count.
  std::vector<uint32_t> vertex_list(size_t mesh, const Drawable& drawable, size_t count) {
    std::vector<uint32_t> list(drawable.corners);
    if (drawable.indices == -1) {
      for (size_t i = 0; i < list.size(); ++i) list[i] = static_cast<uint32_t>(i);
      return list;
    }
    const AccessorReader& indices = reader(drawable.indices);
    for (size_t i = 0; i < list.size(); ++i) {
      list[i] = indices.index(i);
      if (list[i] < count && list[i] != indices.restart_index()) continue;
      refuse(d_.file, fmt::format("accessors[{}]", drawable.indices),
             fmt::format("element {} is {}, {} (meshes[{}].primitives[{}])", i, list[i],
                         list[i] < count ? "which means restart and not a vertex"
                                         : fmt::format("beyond the {} vertices", count),
                         mesh, drawable.primitive),
             "export the file again");
    }
    return list;
  }

  glm::vec3 world_position(const PlacedNode& placed, const Drawable& drawable, const AccessorReader& positions,
                           uint32_t vertex) const {
    const glm::dvec3 local = positions.vec3(vertex);
    const glm::dvec3 world = glm::dvec3(placed.world_from_node * glm::dvec4(local, 1));
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(world[axis]) <= max_coordinate_m) continue;  // false for NaN
      const std::string place = fmt::format("accessors[{}]", drawable.positions);
      const bool finite = std::isfinite(local.x) && std::isfinite(local.y) && std::isfinite(local.z);
      if (!finite)
        refuse(d_.file, place, fmt::format("vertex {} is not finite", vertex), "repair the mesh and export again");
      refuse(d_.file, place,
             fmt::format("vertex {} is {} m from the origin as nodes[{}] places it; at most {} m is allowed", vertex,
                         std::abs(world[axis]), placed.node, max_coordinate_m),
             "scale the scene to metres");
    }
    return glm::vec3(world);
  }

  std::string part_name(const PlacedNode& placed, size_t mesh, const Drawable& drawable) const {
    const std::string& node_name = d_.model.nodes[placed.node].name;
    const std::string& mesh_name = d_.model.meshes[mesh].name;
    const std::string name = !node_name.empty()   ? node_name
                             : !mesh_name.empty() ? mesh_name
                                                  : fmt::format("node {}", placed.node);
    return d_.model.meshes[mesh].primitives.size() == 1 ? name : fmt::format("{}/{}", name, drawable.primitive);
  }

  const Document& d_;
  Buffers& buffers_;
  Scene& scene_;
  std::map<int, AccessorReader> readers_;  // by accessor: instances share them
  uint64_t sparse_elements_ = 0;
};

}  // namespace

void append_geometry(const Document& document, Buffers& buffers, const std::vector<PlacedNode>& nodes, Scene& scene) {
  const tinygltf::Model& model = document.model;
  std::vector<std::vector<Drawable>> meshes;
  for (const tinygltf::Mesh& mesh : model.meshes) meshes.push_back(drawables(model, mesh));

  // Counted before anything is made: instances turn a small file into a large scene.
  uint64_t triangles = 0, vertices = 0;
  for (const PlacedNode& placed : nodes) {
    const int mesh = model.nodes[placed.node].mesh;
    if (mesh == -1) continue;
    for (const Drawable& drawable : meshes[static_cast<size_t>(mesh)]) {
      // Each count is below 2^53 and the sum stays below 2^26 before it is added: no overflow.
      triangles += drawable.triangles;
      vertices += std::min<uint64_t>(drawable.corners, model.accessors[static_cast<size_t>(drawable.positions)].count);
      if (triangles > max_triangles || drawable.corners > 3 * max_triangles) {
        refuse(document.file, fmt::format("nodes[{}].mesh", placed.node),
               fmt::format("the scene has more than the {} triangles allowed", max_triangles),
               "simplify it or split it");
      }
    }
  }
  const double needed = scene_bytes({vertices, triangles});
  if (const AvailableMemory available = available_memory(); needed > static_cast<double>(available.bytes)) {
    refuse(document.file, "",
           fmt::format("its {} triangles, instances counted, take at least {} of memory and {}", triangles,
                       bytes_text(needed), available.text()),
           "simplify it, draw fewer instances, or use a machine with more memory");
  }
  Appender appender(document, buffers, scene);
  for (const PlacedNode& placed : nodes) {
    const int mesh = model.nodes[placed.node].mesh;
    if (mesh == -1) continue;
    for (const Drawable& drawable : meshes[static_cast<size_t>(mesh)]) {
      appender.append(placed, static_cast<size_t>(mesh), drawable);
    }
  }
}

}  // namespace noonmark::gltf
