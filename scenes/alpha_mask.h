// Alpha masks as geometry: a triangle is cut along the border of its mask, and what the mask hides is left out. So the
// camera, the shadow map and the rays all meet the same surface, and none of them has to read a texture.
//
//   const MaskCutter cutter({.width = 64, .height = 64, .alpha = alpha, .cutoff = 0.5});
//   MaskCutter::Pieces pieces;
//   cutter.cut(corners, texture_coordinates, pieces);
//   for (glm::uvec3 t : pieces.triangles) use(pieces.positions[t.x]);
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace noonmark {

enum class MaskWrap { repeat, mirrored, clamp };
enum class MaskFilter { nearest, linear };

// A picture of alpha, and which of it is opaque: alpha times factor is at least cutoff (glTF 2.0, section 3.9.4). Only
// the finest level of the picture is used: no mipmaps.
struct AlphaMask {
  int width = 0, height = 0;   // texels, at least 1
  std::vector<uint8_t> alpha;  // 255 is 1; width of a row; the first row is where v = 0
  MaskWrap wrap_u = MaskWrap::repeat, wrap_v = MaskWrap::repeat;
  MaskFilter filter = MaskFilter::linear;
  double factor = 1;  // of all alpha
  double cutoff = 0.5;

  // Whether the texture is opaque at (u, v), sampled as OpenGL samples it but in double (OpenGL 4.5, section 8.14).
  bool opaque_at(glm::dvec2 uv) const;
};

class MaskCutter {
 public:
  // How far the border of the pieces may lie from the texture's, in texels, where nothing coarser is asked for.
  static constexpr double finest_error_texels = 0x1p-11;

  // Throws std::invalid_argument for a picture whose size is not that of its alpha.
  explicit MaskCutter(AlphaMask mask);

  struct Pieces {
    std::vector<glm::vec3> positions;  // the corners that were given come first, unchanged
    std::vector<glm::uvec3> triangles;
    double error_m = 0;  // how far their border may lie from the texture's, along the surface
  };

  // The opaque part of the triangle as triangles of the same winding; none: the mask hides all of it. uv: the texture
  // coordinates of the corners. Positions of new vertices are computed in double and rounded to float once.
  // - nearest: the border runs along the sides of the texels, exactly.
  // - linear: between two neighbouring texel centres the border is exactly where the interpolated alpha reaches the
  //   cutoff. Inside a square of four centres it is an arc of a hyperbola, or two of them. The pieces follow it by
  //   chords, none of which is further from its arc than error_texels. Where four alphas are those of a plane, the arc
  //   is straight and the cut exact.
  // - Pieces share their vertices: there is no T-junction inside a triangle, and none between two triangles whose
  //   common corners have equal positions and equal texture coordinates.
  // - A triangle whose texture coordinates span no area has no border that could be cut: it stays whole if the mask is
  //   opaque in the middle of its texture coordinates, otherwise nothing of it stays.
  // most: of the triangles. Throws TooManyPieces for more, and for a triangle that repeats the mask more than a million
  // times or whose texture coordinates are so large that a double cannot tell texels apart. error_texels: triangles
  // beside each other need the same one, or their vertices on the common side differ.
  void cut(const std::array<glm::vec3, 3>& corners, const std::array<glm::dvec2, 3>& uv, Pieces& pieces,
           uint64_t most = UINT64_MAX, double error_texels = finest_error_texels) const;

  // The most metres that a texel measures on the triangle, in any direction; 0 if its texture coordinates span no area.
  double metres_per_texel(const std::array<glm::vec3, 3>& corners, const std::array<glm::dvec2, 3>& uv) const;

  struct TooManyPieces {};

  const AlphaMask& mask() const { return mask_; }

 private:
  struct Axis;
  struct Leaf;
  class Clipper;
  struct Split {
    int32_t low, high;  // a node's number, or one of the codes below
  };
  static constexpr int32_t opaque = -1, hidden = -2, mixed = -3;

  int32_t build(int x0, int x1, int y0, int y1);
  int32_t cell(int i, int j) const;
  double value(int64_t i, int64_t j) const;
  Leaf leaf_at(int64_t i, int64_t j) const;
  glm::dvec2 in_texels(glm::dvec2 uv) const;
  void visit(int32_t code, Leaf leaf, Clipper& clipper) const;
  void add_opaque_leaf(const Leaf& leaf, Clipper& clipper) const;
  void add_mixed_cell(const Leaf& leaf, Clipper& clipper) const;

  AlphaMask mask_;
  std::vector<Split> splits_;
  int32_t root_ = hidden;
};

}  // namespace noonmark
