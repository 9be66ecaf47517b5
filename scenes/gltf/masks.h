// The alpha masks of a file's materials (alphaMode MASK with a base colour texture): which part of a primitive's
// triangles they hide (scenes/alpha_mask.h).
#pragma once
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>

#include "scenes/alpha_mask.h"
#include "scenes/gltf/accessor.h"
#include "scenes/gltf/buffers.h"
#include "scenes/gltf/document.h"
#include "scenes/scene.h"

namespace noonmark::gltf {

class Masks {
 public:
  // notes: of the scene; gets a phrase for each mask that cannot be read as it is meant.
  Masks(const Document& document, Buffers& buffers, std::vector<std::string>& notes)
      : document_(document), buffers_(buffers), notes_(notes) {}

  // How a material masks.
  struct Mask {
    MaskCutter cutter;
    int coordinates;         // the set TEXCOORD_n
    glm::dmat3 uv_from_set;  // KHR_texture_transform
    std::string image;       // "images[2]", for messages
  };

  // Null: the material masks by no texture, or by an image in a format other than PNG and JPEG, which is noted and taken
  // as opaque. Made when it is first asked for. Of the texture the base level is sampled with its magnification filter;
  // a JPEG has alpha 1 everywhere; 16 bits of alpha are rounded to 8. Throws Error(file) for an image that is missing,
  // damaged or too large, and for references out of range.
  const Mask* of(int material);

 private:
  std::optional<Mask> load(const tinygltf::Material& material, const std::string& place);

  const Document& document_;
  Buffers& buffers_;
  std::vector<std::string>& notes_;
  std::map<int, std::optional<Mask>> masks_;
};

// The accessor of the texture coordinates by which a primitive is masked. Throws Error(file) if there is none.
int coordinates_of(const Document& document, int mesh, size_t primitive, const Masks::Mask& mask);

// Cuts the triangles of a primitive by its mask. What it is given must outlive it.
class MaskedPrimitive {
 public:
  // coordinates: of the accessor with that index; vertices: how many the primitive's positions are. Throws Error(file)
  // if they do not fit together.
  MaskedPrimitive(const Document& document, const Masks::Mask& mask, int accessor, const AccessorReader& coordinates,
                  size_t vertices);

  // A triangle of the primitive that cut() will get: all of them decide how fine its mask is cut, which is as fine as
  // MaskCutter::finest_error_texels, but not finer than floats at these corners. Throws as cut() does.
  void prepare(const glm::uvec3& vertices, const glm::vec3 (&corners)[3]);

  // The shown part of the triangle of these vertices, which stand at these corners. scene: what there is already.
  // Throws Error(file) for texture coordinates that are not finite, and for a mask that makes more triangles than a
  // scene may have or than fit into memory.
  void cut(const glm::uvec3& vertices, const glm::vec3 (&corners)[3], const Scene& scene, MaskCutter::Pieces& pieces);

 private:
  const Document& document_;
  const Masks::Mask& mask_;
  const int accessor_;
  const AccessorReader& coordinates_;
  double largest_m_ = 0, metres_per_texel_ = 0;  // of the corners' coordinates; of a texel
  uint64_t room_asked_at_ = 0;                   // triangles

  std::array<glm::dvec2, 3> uv_of(const glm::uvec3& vertices) const;
  double error_texels() const;
};

// Whether a texture decides what of the material is seen.
bool masks_by_texture(const tinygltf::Material& material);
// Whether the material hides its primitives completely: it is masked, has no base colour texture, and its alpha is
// below alphaCutoff.
bool masked_out(const tinygltf::Material& material);

}  // namespace noonmark::gltf
