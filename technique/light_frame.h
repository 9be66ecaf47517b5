// The frame of a light and of its map, in double. The ladder's places and depths are computed in it. The float matrices
// for OpenGL are rounded from it; the error of that rounding is part of the cause `precision`.
//
//   LightFrame frame = make_light_frame(scene, settings);
//   glm::dvec3 p = frame.to_light(P);                     // metres along right, up and forward, from the light
//   double d = frame.window_depth(p);                     // what the map holds of P
//   glm::dvec3 x = frame.texel_place({i, j});             // the place of a texel's centre
//
// A *place* names a light-side ray. It is a homogeneous vector. For a directional light it is (u, v, 1), with u and v
// in metres in the light's plane. For a spot and a point light it is the direction of the ray in the light's axes, of
// any length. So for every light, three places lie on one line of the map if and only if their determinant is 0.
//
// The map of a point light has six faces, in OpenGL's order +X -X +Y -Y +Z -Z. They stand one above the other in an
// image of resolution x 6 resolution texels: texel (i, j) of face f is (i, f * resolution + j). The map of a directional
// light may be a rectangle of square texels (map.aspect).
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "technique/light_kind.h"
#include "technique/settings.h"

namespace noonmark {

// tan(theta) is computed with a cosine of at least this value, so that it is a finite number where N is perpendicular
// to L.
inline constexpr double least_cosine = 1e-6;

struct LightFrame {
  LightKind kind = LightKind::directional;
  // Spot and point: the light's position. It is exactly a float, because every ray starts there. Directional: the point
  // where u, v and z are 0. It is the light's position moved, in its plane, to the middle of the map (map.fit = view) and
  // by map.shift_*_texels and map.snap; of one of several maps the light's position (centre_m).
  glm::dvec3 origin_m{0};
  // Directional with map.snap: the origin of OpenGL's matrix. It does not move with the camera, and its texel grid is
  // that of the map: origin_m is a whole number of texels from it. So the matrix is bit for bit the same in every frame,
  // and the map's place is an exact number that the shaders subtract (drawn_clip_from_world).
  std::optional<glm::dvec3> anchor_m;
  glm::dvec2 anchor_texels{0};  // whole texels from the anchor to the map's middle, along right and up
  // Directional: the map's middle, along right and up from origin_m. It is 0 of a single map: the frames of several
  // have one origin, so that what the light sees of a scene (raytrace/traced_scene.h) is the same for all of them.
  glm::dvec2 centre_m{0};
  // Unit vectors. For a point light they are the axes of the world.
  glm::dvec3 right{1, 0, 0};
  glm::dvec3 up{0, 1, 0};
  glm::dvec3 forward{0, 0, -1};  // directional: the direction in which the light travels; spot: its axis
  // Directional: the direction of every light-side ray, exactly a float. forward is this vector, normalised in double.
  // So rays and frame have the same direction, to the last bit of the float.
  glm::vec3 ray_direction{0, 0, -1};
  double extent_m = 1;         // directional: the map's width
  double tan_half_fov = 1;     // spot: tangent of half the map's angle; point: 1
  double cos_half_cone = -1;   // spot: cosine of half the light's cone
  glm::dvec2 shift_texels{0};  // spot: map.shift_*_texels
  // Point: the turn of the map's cube as a rotation vector, and the cube's axes as columns, in the light's frame. The
  // frame itself does not turn: places and rays stay the same, only the tiles move over them.
  glm::dvec3 turn_deg{0};
  glm::dmat3 cube_axes{1};
  double near_m = 0;
  double far_m = 1;
  double bias_scale = 1;  // of the compared depth's bias in this map (cascades.bias_scales)
  int resolution = 1;     // texels along the width of a tile
  int rows = 1;           // texels along its height
  // Texels along a side of what a lookup reads as one texel (TapPattern::block). So the grid that snapping keeps in place,
  // and over which placements are spread, is that of whole blocks.
  int texel_block = 1;
  int tiles = 1;

  bool operator==(const LightFrame&) const = default;

  const KindOfLight& light() const { return kind_of_light(kind); }
  MapShape map_shape() const { return light().map_shape(); }
  // True if the size of a texel and the step of depth are the same everywhere in the map.
  bool uniform() const { return tiles == 1 && tile(0).orthographic; }
  // True if the map is a cube whose faces are not square to the world's axes.
  bool turned() const { return turn_deg != glm::dvec3(0); }
  // A point or direction of the light's frame along the axes of the cube.
  glm::dvec3 in_cube(glm::dvec3 light) const { return turned() ? light * cube_axes : light; }

  // The map's tiles stand one above the other in its image.
  MapTile tile(int index) const { return light().tile(*this, index); }
  int tile_of(glm::dvec3 point) const { return light().tile_of(*this, point); }
  // True if a tile of the map stores depths by this formula.
  bool has_depth(TileDepth depth) const;
  // The tile that a lookup reads at a point in the light's frame.
  MapTile tile_at(glm::dvec3 point) const { return tile(tile_of(point)); }
  MapTile tile_of_texel(glm::ivec2 texel) const { return tile(tiles > 1 ? texel.y / rows : 0); }
  glm::ivec2 tile_size() const { return {resolution, rows}; }
  int64_t texels() const { return int64_t{1} * resolution * rows * tiles; }  // of the whole map
  glm::ivec2 map_size() const { return {resolution, tiles * rows}; }

  glm::dvec3 to_light(glm::dvec3 world) const {
    const glm::dvec3 d = world - origin_m;
    return {glm::dot(d, right), glm::dot(d, up), glm::dot(d, forward)};
  }
  glm::dvec3 to_world(glm::dvec3 light) const;
  glm::dvec3 direction_to_light(glm::dvec3 world) const { return light().direction_to_light(*this, world); }  // unit
  // The same for a directional light: its direction does not depend on the place.
  glm::dvec3 direction_to_light() const { return -forward; }
  // True if the point can get light. It is false only outside the cone of a spot light.
  bool reaches(glm::dvec3 world) const { return light().reaches(*this, world); }

  // The quantity that the map's depth measures, for a point in the light's frame: metres along the axis, or the
  // distance.
  double depth_m(glm::dvec3 point) const { return tile_at(point).depth_m(point); }
  double window_depth(glm::dvec3 point) const {
    const MapTile tile = tile_at(point);
    return tile.window_depth(tile.depth_m(point));
  }
  // The derivative of window depth at the point, per metre.
  double window_depth_slope(glm::dvec3 point) const {
    const MapTile tile = tile_at(point);
    return tile.window_depth_slope(tile.depth_m(point));
  }
  // The width of one texel in the world at a point in the light's frame.
  double texel_m(glm::dvec3 point) const { return tile_at(point).texel_m(point); }

  glm::dvec3 place(glm::dvec3 point) const { return light().place(point); }  // of a point in the light's frame
  // The place of one tap of a lookup at this point. The offset is in texels for a flat map, in metres of the world for
  // a point light.
  glm::dvec3 tap_place(glm::dvec3 point, glm::dvec3 offset) const { return light().tap_place(*this, point, offset); }
  // The place of a texel's centre. For flat maps the texel may be any integers, also outside the map.
  glm::dvec3 texel_place(glm::ivec2 texel) const { return tile_of_texel(texel).place_of(texel); }
  // The position in the map of a point in the light's frame, in texels; floor() of it is the texel.
  glm::dvec2 map_texels(glm::dvec3 point) const { return tile_at(point).texels(place(point)); }
  // Directional: u and v of a texel's centre.
  glm::dvec2 texel_centre(glm::ivec2 texel) const { return glm::dvec2(texel_place(texel)); }

  glm::dmat4 clip_from_world(const MapTile& tile) const;
  glm::dmat4 clip_from_world(int index) const { return clip_from_world(tile(index)); }
  // OpenGL's matrix is one from the anchor; without an anchor it is clip_from_world(). From the anchor the grid is the same
  // in every frame, and a snapped map is a window of tile_size() texels on it, of which (snapped_corner) is
  // the first. OpenGL takes that from the place in the grid, exactly: a map is drawn cell by cell (snapped_cells), and a
  // lookup rounds its place to snapped_step before the subtraction. So two maps on one grid have bit for bit the same
  // texels, and a receiver has the same place in them.
  glm::dvec3 drawn_origin_m() const { return anchor_m.value_or(origin_m); }
  glm::dmat4 drawn_clip_from_world(const MapTile& tile) const;
  // Texels from the anchor to the map's first corner; a half one if the resolution is odd.
  glm::dvec2 snapped_corner() const { return anchor_texels - glm::dvec2(tile_size()) / 2.0; }
  // In texels: the step of floats as large as 4 maps. So a place is exact after the subtraction if it lies within two
  // maps of the middle.
  float snapped_step() const;
  // The cells of the grid in which the map lies: maps side by side, one of which has the anchor in its middle. `first`
  // and `end` bound the part in texels of the cell; the same texels of the map begin at `to`.
  struct Cell {
    glm::ivec2 cell{0}, first{0}, end{0}, to{0};
  };
  std::vector<Cell> snapped_cells() const;
  // The window depth of one unit of bias (settings.bias.unit) in this map, at a point in the light's frame: bias_scale times
  // what the unit is.
  double depth_per_bias_unit(BiasUnit unit, glm::dvec3 point) const;
};

// The axes of a cube face along the cube's own axes, as OpenGL defines them: s points right, t points up, forward is the
// direction of view.
struct CubeFace {
  glm::dvec3 right, up, forward;
};
const CubeFace& cube_face(int face);  // 0 ... 5
int cube_face_of(glm::dvec3 direction);

// The scene's light, changed by settings.light.
Light effective_light(const Scene& scene, const Settings& settings);

// A part of the view, by the depth along the view's direction, in metres.
struct ViewSlice {
  double begin_m = 0, end_m = 0;
  double wider_m = 0;  // map.fit = corner_*: so much wider is the map than the square of the slice
};

// slice: the part of the view that the map is for, which map.fit = view and sphere read; null: all of it. Throws
// Error(usage) if near >= far, if the extent is not positive, if near is not before a spot or point light, or if the
// position of a directional or spot light is its target.
LightFrame make_light_frame(const Scene& scene, const Settings& settings, const ViewSlice* slice = nullptr);

// What stands in the place of the scene's own map volume, and why, where the settings make its light another one:
// "point-room: near, far of the map are fitted in place of the scene's own 1 m, 25 m, because light.position_m moves the
// light; map.near_m, map.far_m can keep them". Empty if the scene has no volume of its own, if it is used, if the
// settings give all of it, and if map.fit asks for a fit.
std::string map_fit_note(const Scene& scene, const Settings& settings);

// What a user must know of the light and its map volume, one sentence each: first_of_several_note and made_up_light_note
// (technique/chosen_light.h), map_fit_note, that the splits of cascades move with a fitted near plane, and which slices
// hold no part of the scene, so that map.fit = view has nothing to fit their maps to.
std::vector<std::string> light_notes(const Scene& scene, const Settings& settings);

// The smallest map volume around the scene: extent, near and far are such that everything the light can reach is
// inside.
MapVolume fit_map(const Scene& scene, const Light& light);

}  // namespace noonmark
