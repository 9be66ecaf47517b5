#include "scenes/gltf/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "base/memory.h"
#include "scenes/gltf/accessor.h"
#include "scenes/gltf/draco.h"
#include "scenes/gltf/error.h"
#include "scenes/gltf/instances.h"
#include "scenes/gltf/masks.h"
#include "scenes/gltf/morph.h"
#include "scenes/gltf/notes.h"
#include "scenes/gltf/skin.h"
#include "scenes/number_ranges.h"
#include "scenes/scene_size.h"

namespace noonmark::gltf {
namespace {

constexpr uint32_t unused = std::numeric_limits<uint32_t>::max();

struct Drawable {
  size_t primitive = 0;
  int positions = -1;
  int indices = -1;
  int mode = TINYGLTF_MODE_TRIANGLES;
  bool draco = false;
  uint64_t corners = 0;  // for a Draco mesh without an accessor for its indices, known after it is decoded
  uint64_t triangles = 0;
  bool single_sided = true;
  int material = -1;
};

// A primitive without a material has the default one (glTF 2.0, section 3.9.6).
const tinygltf::Material& material_of(const tinygltf::Model& model, const tinygltf::Primitive& primitive) {
  static const tinygltf::Material by_default;
  return primitive.material == -1 ? by_default : model.materials[static_cast<size_t>(primitive.material)];
}

uint64_t triangles_of(int mode, uint64_t corners) {
  // The rest of an incomplete triangle is ignored (glTF 2.0, section 3.7.2.1).
  return corners < 3 ? 0 : mode == TINYGLTF_MODE_TRIANGLES ? corners / 3 : corners - 2;
}

// All that decides what a primitive draws, as text: equal for primitives that draw the same.
std::string what_is_drawn(const tinygltf::Primitive& primitive) {
  std::string text = fmt::format("{} {}", primitive.mode, primitive.material);
  const auto add = [&](const std::map<std::string, int>& attributes) {
    for (const auto& [name, accessor] : attributes) text += fmt::format(" {}:{}{}", name.size(), name, accessor);
    text += ";";
  };
  add(primitive.attributes);
  if (is_draco(primitive)) text += draco_key(primitive);
  for (const auto& target : primitive.targets) add(target);
  return text;
}

// repeated: counts the primitives that are left out because another of the mesh draws the same.
std::vector<Drawable> drawables(const tinygltf::Model& model, const tinygltf::Mesh& mesh, uint64_t& repeated) {
  std::vector<Drawable> out;
  std::set<std::string> drawn;
  for (size_t i = 0; i < mesh.primitives.size(); ++i) {
    const tinygltf::Primitive& primitive = mesh.primitives[i];
    const auto position = primitive.attributes.find("POSITION");
    if (primitive.mode < TINYGLTF_MODE_TRIANGLES || position == primitive.attributes.end()) continue;
    const tinygltf::Material& material = material_of(model, primitive);
    if (masked_out(material)) continue;
    if (mesh.primitives.size() > 1 && !drawn.insert(what_is_drawn(primitive)).second) {
      ++repeated;
      continue;
    }
    Drawable d{i, position->second, indices_of(primitive), primitive.mode, is_draco(primitive)};
    if (d.indices != -1 || !d.draco)
      d.corners = model.accessors[static_cast<size_t>(d.indices == -1 ? d.positions : d.indices)].count;
    d.triangles = triangles_of(d.mode, d.corners);
    d.single_sided = !material.doubleSided;
    d.material = primitive.material;
    if (d.triangles > 0 || d.draco) out.push_back(d);
  }
  return out;
}

// The corners of triangle t of a primitive, as indices into its list of vertices (glTF 2.0, section 3.7.2.1).
glm::uvec3 corners_of(int mode, uint32_t t) {
  if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) return {t, t + 1 + t % 2, t + 2 - t % 2};
  if (mode == TINYGLTF_MODE_TRIANGLE_FAN) return {t + 1, t + 2, 0};
  return {3 * t, 3 * t + 1, 3 * t + 2};
}

bool degenerate(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  return glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a)) == glm::dvec3(0);
}

// Whether the whole width of a triangle of a flattened mesh can come from rounding its corners to float. Each corner
// may be off by sqrt(3) / 2 of a float step of the largest coordinate. Two corners, on opposite sides, make the width.
bool as_thin_as_rounding(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const glm::dvec3 ab = glm::dvec3(b) - glm::dvec3(a), ac = glm::dvec3(c) - glm::dvec3(a), bc = ac - ab;
  const double longest = std::max({glm::length(ab), glm::length(ac), glm::length(bc)});
  double largest = 0;
  for (const glm::vec3& p : {a, b, c})
    for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(static_cast<double>(p[k])));
  return glm::length(glm::cross(ab, ac)) <= 4 * 0x1p-24 * largest * longest;
}

// Maps the file's vertices to the scene's. A primitive often uses a small range of its accessor's indices. If the range
// is far larger than the number of vertices used, a list of the used ones takes less memory.
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

// The data of a primitive: its vertices in drawing order, and the readers of its attributes. Attributes that were
// compressed are packed in `draco`.
struct Source {
  DracoMesh draco;
  std::map<int, AccessorReader> unpacked;
  std::vector<uint32_t> vertices;
};

class Appender {
 public:
  Appender(const Document& document, Buffers& buffers, const Placement& placement, bool masks, Scene& scene)
      : d_(document),
        buffers_(buffers),
        masks_are_read_(masks),
        masks_(document, buffers, scene.notes),
        readers_(document, buffers),
        skins_(document, readers_, placement.world_from_node),
        scene_(scene) {}

  void append(const PlacedNode& placed, const Drawable& drawable) {
    const tinygltf::Node& node = d_.model.nodes[placed.node];
    Source made;
    const Source& source = drawable.draco ? decoded(node.mesh, drawable) : made;
    if (!drawable.draco)
      made.vertices =
          vertex_list(node.mesh, drawable, d_.model.accessors[static_cast<size_t>(drawable.positions)].count);
    if (source.vertices.empty()) return;
    const auto reader = [&](int accessor) -> const AccessorReader& {
      const auto found = source.unpacked.find(accessor);
      return found != source.unpacked.end() ? found->second : readers_(accessor);
    };
    const MorphedPositions positions(d_, readers_, reader(drawable.positions), node, drawable.primitive);
    std::optional<MaskedPrimitive> masked;
    if (const Masks::Mask* const mask = masks_are_read_ ? masks_.of(drawable.material) : nullptr) {
      const int coordinates = coordinates_of(d_, node.mesh, drawable.primitive, *mask);
      masked.emplace(d_, *mask, coordinates, reader(coordinates), reader(drawable.positions).count());
    }
    const AccessorReader* const normals = normals_of(node.mesh, drawable, positions, reader);
    Part part;
    part.first_triangle = static_cast<uint32_t>(scene_.triangles.size());
    const uint64_t instances = instance_count(d_, placed.node);
    // append_geometry could not count the triangles of a Draco mesh without an accessor for its indices.
    if (scene_.triangles.size() + instances * (source.vertices.size() / 3) > max_triangles)
      refuse(d_.file, fmt::format("nodes[{}].mesh", placed.node),
             fmt::format("the scene has more than the {} triangles allowed", max_triangles), "simplify it or split it");
    if (node.skin != -1) {
      const SkinnedVertices skin =
          skins_.vertices(node.skin, node.mesh, drawable.primitive, reader(drawable.positions).count(), reader);
      count_reads(placed, source, 1 + positions.targets() + 2 * skin.sets());
      if (instances != 1 || d_.model.nodes[placed.node].extensions.contains("EXT_mesh_gpu_instancing"))
        refuse(d_.file, fmt::format("nodes[{}]", placed.node),
               "instances of a mesh under a skin: glTF does not define their places",
               "export without EXT_mesh_gpu_instancing");
      append_triangles(placed, drawable, source, positions, normals, masked, false,
                       [&](uint32_t v) { return skin.world_from_mesh(v); });
    } else {
      count_reads(placed, source, instances * (1 + positions.targets()));
      const Instances places(d_, readers_, placed.node);
      for (uint64_t i = 0; i < instances; ++i) {
        const glm::dmat4 world_from_mesh = placed.world_from_node * places.node_from_mesh(i);
        append_triangles(placed, drawable, source, positions, normals, masked, flattens(world_from_mesh),
                         [&](uint32_t) { return world_from_mesh; });
      }
    }
    part.triangle_count = static_cast<uint32_t>(scene_.triangles.size()) - part.first_triangle;
    if (part.triangle_count == 0) return;
    part.name = part_name(placed, drawable);
    scene_.parts.push_back(std::move(part));
  }

  uint64_t degenerate_triangles() const { return degenerate_; }

 private:
  // Limits the number of values that are read. Morph targets and sets of joints multiply it for each vertex, so a small
  // file could take hours.
  void count_reads(const PlacedNode& placed, const Source& source, uint64_t each) {
    constexpr uint64_t max_reads = uint64_t{1} << 31;
    reads_ += each > max_reads ? max_reads + 1 : each * source.vertices.size();
    if (reads_ > max_reads)
      refuse(d_.file, fmt::format("nodes[{}].mesh", placed.node),
             fmt::format("more than {} values are to be read for vertices, morph targets and joints", max_reads),
             "simplify it or split it");
  }

  // world_from_mesh(v): the transform of vertex v. flat: the mesh has no inside and no outside, so its triangles keep
  // the order of their corners.
  template <class WorldFromMesh>
  void append_triangles(const PlacedNode& placed, const Drawable& drawable, const Source& source,
                        const MorphedPositions& positions, const AccessorReader* normals,
                        std::optional<MaskedPrimitive>& masked, bool flat, const WorldFromMesh& world_from_mesh) {
    const std::vector<uint32_t>& vertices = source.vertices;
    VertexMap map(vertices);
    const int mode = drawable.draco ? TINYGLTF_MODE_TRIANGLES : drawable.mode;
    const auto count = static_cast<uint32_t>(triangles_of(mode, vertices.size()));
    for (uint32_t t = 0; t < count; ++t) {
      glm::uvec3 triangle = corners_of(mode, t);
      glm::vec3 corner[3];
      double orientation = 0;  // below 0: mirrored at most corners; the joints may differ
      for (int k = 0; k < 3; ++k) {
        triangle[k] = vertices[triangle[k]];
        const glm::dmat4 world = world_from_mesh(triangle[k]);
        if (!flat) orientation += glm::determinant(glm::dmat3(world));
        const uint32_t known = map.place_of(triangle[k]);
        corner[k] = known != unused ? scene_.positions[known]
                                    : world_position(placed, drawable, world, positions.at(triangle[k]), triangle[k]);
      }
      if (degenerate(corner[0], corner[1], corner[2]) ||
          (flat && as_thin_as_rounding(corner[0], corner[1], corner[2]))) {
        ++degenerate_;
        continue;
      }
      if (orientation < 0) std::swap(triangle.y, triangle.z), std::swap(corner[1], corner[2]);
      if (masked) {  // all are known before the first is cut
        masked->prepare(triangle, corner);
        uncut_.push_back({triangle, {corner[0], corner[1], corner[2]}});
        continue;
      }
      append_piece(drawable, {0, 1, 2}, triangle, corner, map);
      for (int k = 0; normals && k < 3; ++k)
        keep_normal(map.place_of(triangle[k]), world_from_mesh(triangle[k]), normals->vec3(triangle[k]));
    }
    for (const Uncut& u : uncut_) {
      masked->cut(u.vertices, u.corner, scene_, pieces_);
      cut_places_.assign(pieces_.positions.size(), unused);
      scene_.mask_error_m = std::max(scene_.mask_error_m, pieces_.error_m);
      for (const glm::uvec3& piece : pieces_.triangles) append_piece(drawable, piece, u.vertices, u.corner, map);
    }
    uncut_.clear();
  }

  // piece: three indices. 0, 1 and 2 are the corners of the triangle that was cut, larger ones new vertices in pieces_.
  void append_piece(const Drawable& drawable, const glm::uvec3& piece, const glm::uvec3& triangle,
                    const glm::vec3 (&corner)[3], VertexMap& map) {
    glm::uvec3 made;
    for (int k = 0; k < 3; ++k)
      made[k] = piece[k] < 3 ? vertex(map.place_of(triangle[static_cast<int>(piece[k])]), corner[piece[k]])
                             : vertex(cut_places_[piece[k]], pieces_.positions[piece[k]]);
    scene_.triangles.push_back(made);
    scene_.single_sided.push_back(drawable.single_sided);
  }

  // The primitive's normals; null without any that can be used. Of cut masks, morphed meshes and lists that are too short the
  // normals are computed from the faces.
  template <class Read>
  const AccessorReader* normals_of(int mesh, const Drawable& drawable, const MorphedPositions& positions,
                                   const Read& read) const {
    const auto& attributes = d_.model.meshes[static_cast<size_t>(mesh)].primitives[drawable.primitive].attributes;
    const auto found = attributes.find("NORMAL");
    if (found == attributes.end() || positions.targets() > 0) return nullptr;
    const size_t accessor = static_cast<size_t>(found->second);
    if (found->second < 0 || accessor >= d_.model.accessors.size() || d_.guarded.unknown_accessors.contains(accessor))
      return nullptr;
    const tinygltf::Accessor& a = d_.model.accessors[accessor];
    if (a.type != TINYGLTF_TYPE_VEC3 || a.count < read(drawable.positions).count()) return nullptr;
    return &read(found->second);
  }

  // A normal turns with the inverse transpose of the transform, which the cofactors are but for the determinant.
  void keep_normal(uint32_t place, const glm::dmat4& world_from_mesh, const glm::dvec3& local) {
    const glm::dmat3 m(world_from_mesh);
    const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    const glm::dvec3 normal = (glm::determinant(m) < 0 ? -1.0 : 1.0) * (cofactors * local);
    const double length = glm::length(normal);
    if (!(length > 0) || !std::isfinite(length)) return;
    if (scene_.vertex_normals.size() <= place) scene_.vertex_normals.resize(place + 1, glm::vec3(0));
    scene_.vertex_normals[place] = glm::vec3(normal / length);
  }

  // The scene's vertex at this place of a list, appended if there is none yet.
  uint32_t vertex(uint32_t& place, const glm::vec3& position) {
    if (place == unused) {
      place = static_cast<uint32_t>(scene_.positions.size());
      scene_.positions.push_back(position);
    }
    return place;
  }

  // Decoded once, even if several nodes show it.
  const Source& decoded(int mesh, const Drawable& drawable) {
    const auto [found, fresh] = decoded_.try_emplace({mesh, drawable.primitive});
    Source& source = found->second;
    if (!fresh) return source;
    source.draco = decode_draco(d_, buffers_, mesh, drawable.primitive);
    if (!source.draco.note.empty()) scene_.notes.push_back(source.draco.note);
    for (const auto& [accessor, bytes] : source.draco.elements)
      source.unpacked.try_emplace(accessor, d_.model.accessors[static_cast<size_t>(accessor)], bytes);
    source.vertices = std::move(source.draco.corners);
    return source;
  }

  // The vertices in drawing order, with each index below count.
  std::vector<uint32_t> vertex_list(int mesh, const Drawable& drawable, size_t count) {
    std::vector<uint32_t> list(drawable.corners);
    if (drawable.indices == -1) {
      for (size_t i = 0; i < list.size(); ++i) list[i] = static_cast<uint32_t>(i);
      return list;
    }
    const AccessorReader& indices = readers_(drawable.indices);
    for (size_t i = 0; i < list.size(); ++i) {
      list[i] = indices.index(i);
      if (list[i] < count && list[i] != indices.restart_index()) continue;
      refuse(d_.file, fmt::format("accessors[{}]", drawable.indices),
             fmt::format("element {} is {}, {} (meshes[{}].primitives[{}])", i, list[i],
                         list[i] < count ? "which means restart and is not a vertex"
                                         : fmt::format("beyond the {} vertices", count),
                         mesh, drawable.primitive),
             "export the file again");
    }
    return list;
  }

  glm::vec3 world_position(const PlacedNode& placed, const Drawable& drawable, const glm::dmat4& world_from_mesh,
                           const glm::dvec3& local, uint32_t vertex) const {
    const glm::dvec3 world = glm::dvec3(world_from_mesh * glm::dvec4(local, 1));
    for (int axis = 0; axis < 3; ++axis) {
      if (ranges::coordinate_m.holds(world[axis])) continue;
      const std::string place = fmt::format("accessors[{}]", drawable.positions);
      const bool finite = std::isfinite(local.x) && std::isfinite(local.y) && std::isfinite(local.z);
      if (!finite)
        refuse(d_.file, place, fmt::format("vertex {} is not finite", vertex), "repair the mesh and export again");
      refuse(d_.file, place,
             fmt::format("vertex {} is {} m from the origin in nodes[{}]; at most {} m is allowed", vertex,
                         std::abs(world[axis]), placed.node, ranges::coordinate_m.most),
             "scale the scene to metres");
    }
    return glm::vec3(world);
  }

  std::string part_name(const PlacedNode& placed, const Drawable& drawable) const {
    const tinygltf::Node& node = d_.model.nodes[placed.node];
    const tinygltf::Mesh& mesh = d_.model.meshes[static_cast<size_t>(node.mesh)];
    const std::string name = !node.name.empty()   ? node.name
                             : !mesh.name.empty() ? mesh.name
                                                  : fmt::format("node {}", placed.node);
    return mesh.primitives.size() == 1 ? name : fmt::format("{}/{}", name, drawable.primitive);
  }

  const Document& d_;
  Buffers& buffers_;
  const bool masks_are_read_;
  Masks masks_;
  struct Uncut {
    glm::uvec3 vertices;
    glm::vec3 corner[3];
  };
  std::vector<Uncut> uncut_;          // the triangles of a masked primitive
  MaskCutter::Pieces pieces_;         // of the triangle that is being cut
  std::vector<uint32_t> cut_places_;  // of their positions, in the scene
  Readers readers_;                   // by accessor, because instances share them
  Skins skins_;
  Scene& scene_;
  std::map<std::pair<int, size_t>, Source> decoded_;  // Draco meshes, by mesh and primitive
  uint64_t reads_ = 0, degenerate_ = 0;
};

// Whether the node's mesh is visible. A mesh with a skin depends on its joints only, so its own node may be scaled to
// zero.
bool draws(const tinygltf::Node& node, const PlacedNode& placed) {
  return node.mesh != -1 && placed.visible && (!placed.collapsed || node.skin != -1);
}

// The number of triangles and vertices, counted from the lists alone. No buffer is read. A Draco mesh whose indices
// have no accessor counts as 0 until it is decoded.
SceneSize count_geometry(const Document& document, const Placement& placement) {
  const tinygltf::Model& model = document.model;
  std::map<int, std::vector<Drawable>> meshes;
  SceneSize count;
  uint64_t repeated = 0;
  for (const PlacedNode& placed : placement.nodes) {
    const tinygltf::Node& node = model.nodes[placed.node];
    if (!draws(node, placed)) continue;
    const auto [mesh, fresh] = meshes.try_emplace(node.mesh);
    if (fresh) mesh->second = drawables(model, model.meshes[static_cast<size_t>(node.mesh)], repeated);
    const uint64_t instances = instance_count(document, placed.node);
    for (const Drawable& drawable : mesh->second) {
      // Each count is below 2^53, and the sum is at most 2^26 before one is added, so there is no overflow.
      const bool too_many = drawable.triangles > max_triangles || instances > max_triangles;
      count.triangles += too_many ? max_triangles + 1 : drawable.triangles * instances;
      count.vertices +=
          std::min<uint64_t>(drawable.corners, model.accessors[static_cast<size_t>(drawable.positions)].count) *
          (too_many ? 1 : instances);
      if (count.triangles > max_triangles || drawable.corners > 3 * max_triangles) {
        refuse(document.file, fmt::format("nodes[{}].mesh", placed.node),
               fmt::format("the scene has more than the {} triangles allowed", max_triangles),
               "simplify it or split it");
      }
    }
  }
  return count;
}

}  // namespace

uint64_t append_geometry(const Document& document, Buffers& buffers, const Placement& placement, bool masks,
                         Scene& scene) {
  // Counted before anything is allocated, because instances can turn a small file into a large scene.
  const SceneSize count = count_geometry(document, placement);
  const double needed = scene_bytes(count);
  if (const AvailableMemory available = available_memory(); needed > static_cast<double>(available.bytes)) {
    refuse(document.file, "",
           fmt::format("its {} triangles, instances counted, take at least {} of memory and {}", count.triangles,
                       bytes_text(needed), available.text()),
           "simplify it, draw fewer instances, or use a machine with more memory");
  }
  const tinygltf::Model& model = document.model;
  std::vector<std::vector<Drawable>> meshes;
  uint64_t repeated = 0;
  for (const tinygltf::Mesh& mesh : model.meshes) meshes.push_back(drawables(model, mesh, repeated));
  if (repeated > 0)
    scene.notes.push_back(counted(repeated, "primitive") + " that another of the mesh repeats, drawn once");
  Appender appender(document, buffers, placement, masks, scene);
  for (const PlacedNode& placed : placement.nodes) {
    const tinygltf::Node& node = model.nodes[placed.node];
    if (!draws(node, placed)) continue;
    for (const Drawable& drawable : meshes[static_cast<size_t>(node.mesh)]) appender.append(placed, drawable);
  }
  const uint64_t dropped = appender.degenerate_triangles();
  if (dropped > 0) scene.notes.push_back(counted(dropped, "triangle") + " without an area left out and not numbered");
  return dropped;
}

}  // namespace noonmark::gltf
