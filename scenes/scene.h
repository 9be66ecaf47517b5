// scenes/: what is looked at: triangles, camera and light, built in or read from glTF, and the receivers of a picture.
// May include base. Knows no shadow map and no setting of one. Begin here, then scenes/library.h (a scene by its name)
// and scenes/receivers.h.
//
// The types of a scene. The project's conventions are defined here and nowhere else.
//
//   Scene scene = make_scene(settings.scene);        // a built-in name or a .gltf/.glb path (scenes/library.h)
//   for (glm::uvec3 t : scene.triangles) use(scene.positions[t.x]);
//
// Conventions
// - Right-handed world, metres, Y up (glTF). Matrices are named to_from: `clip_from_world`.
// - Visibility: 1 = lit, 0 = shadowed; fractions for filtered lookups and for lights with a size.
// - Depth in the map is OpenGL's window depth in [0,1]. A bias is given in a unit that is always named: `depth` (that
//   [0,1]), `m` (metres along the light's axis) or `texel` (of the map at the receiver).
// - Row 0 of a picture is its top row; a pixel's sample is at its centre. Shadow maps keep OpenGL's order: row 0 has
//   the lowest v.
// - Receiver: the visible surface point at a pixel's centre (scenes/receivers.h).
// - theta: the angle between the receiver's geometric normal N and the direction to the light L. Facing receivers have
//   N.L > 0; the others are dark by shading, whatever the map says, and are left out of the errors.
// - w: the world size of one texel at the receiver; directional light: extent / resolution; spot: 2 z tan(fov / 2) /
//   resolution, z along the light's axis; point: 2 z / resolution, z along the axis of the cube's face.
// - Depth that the map measures: along the light's axis (directional, spot), or the distance from the light (point).
// - Geometry is float because OpenGL and Embree take float. The float positions are the scene: every truth is the truth
//   for these positions. What is derived from them (light frame, depths, plane equations) is double.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

namespace noonmark {

// Consecutive triangles that were one mesh primitive of one node. The ladder does not use parts; they are for people.
struct Part {
  std::string name;
  uint32_t first_triangle = 0;
  uint32_t triangle_count = 0;
};

enum class Projection { perspective, orthographic };

struct Camera {
  Projection projection = Projection::perspective;
  glm::dvec3 eye_m{0, 0, 5};
  glm::dvec3 target_m{0, 0, 0};
  glm::dvec3 up{0, 1, 0};  // need not be perpendicular to the view direction, only not parallel to it
  double fov_y_deg = 45;   // perspective: the whole vertical angle
  double height_m = 10;    // orthographic: the world height that the picture shows
  std::optional<double> near_m = {}, far_m = {};  // along the view; empty: fitted (scenes/camera_fit.h)
};

enum class LightKind { directional, spot, point };
enum class LightShape { sphere, disc };

// How strong a light is, as glTF's extension KHR_lights_punctual defines it. A shadow does not depend on it. In a frame with
// several lights, it gives each light its weight (measure/lights_frame.h).
struct LightPower {
  double intensity = 1;                // directional: lux; spot and point: candela
  glm::dvec3 color{1};                 // linear RGB, each 0 or more
  std::optional<double> range_m = {};  // spot, point: beyond it there is no light; empty: without end
  double inner_cone_deg = 0;  // spot: the whole angle in which it has its full intensity; it falls to 0 at cone_deg
};

// - Directional: position_m and target_m give the light's direction, and the point from which its map's depth and
//   centre are measured, as lookAt(position, target, up) does.
// - Spot: the light is at position_m and points at target_m.
// - Point: the light is at position_m; target_m is not used.
struct Light {
  LightKind kind = LightKind::directional;
  glm::dvec3 position_m{0, 10, 0};
  glm::dvec3 target_m{0, 0, 0};
  double angular_diameter_deg = 0;  // directional: of a sun with a size (0.53 for the real one); 0: a point at infinity
  double radius_m = 0;              // spot, point: of a light with a size; 0: a point
  LightShape shape = LightShape::sphere;  // disc: across a spot light's axis; of a point light, facing each receiver
  double cone_deg = 60;                   // spot: the whole angle of the cone; beyond it nothing is lit
  LightPower power = {};
};

// The part of the world that a light's map covers. Near and far are measured from position_m along the light's axis. A
// point light's far is a distance: depth 1 of its map.
struct MapVolume {
  double extent_m = 20;  // directional: whole width of the map, centred on the axis
  double near_m = 1;
  double far_m = 10;
  std::optional<double> height_m = {};  // directional: whole height; empty: as the width
};

// A camera or a light of a scene that has several. Either name finds it (camera_named(), light_named() of scenes/library.h).
template <class T>
struct Named {
  std::string node, name;  // of its node, and its own; "": it has none
  std::optional<T> value;  // empty: it cannot be used
  std::string why_not;     // then the reason
};

struct Scene {
  std::string name;
  std::vector<glm::vec3> positions;  // world, metres, all finite
  // Of the first positions, the unit normals that the scene's file gives its vertices; 0: it gives none. Shorter than positions, or
  // empty, where the rest has none. Receivers have the normals of their triangles; these move casters (technique/casters.h).
  std::vector<glm::vec3> vertex_normals;
  std::vector<glm::uvec3> triangles;  // indices into positions; counter-clockwise seen from outside
  // For each triangle, whether cameras see its front only (glTF's doubleSided = false). Empty: cameras see both sides
  // of all triangles. Light rays and shadow rays always meet both sides. The setting map.cull says what the map's pass
  // culls.
  std::vector<bool> single_sided;
  std::vector<Part> parts;
  // How far, in metres, the border of a cut alpha mask may lie from the border in its texture (scenes/alpha_mask.h). A
  // truth that such a distance can change is ambiguous. 0: no mask, or all of them cut exactly.
  double mask_error_m = 0;
  Camera camera;
  Light light;
  // All that the scene's file has, in its order. The first of them are `camera` and `light`. Of a built-in scene: its lights
  // if it has several, else empty.
  std::vector<Named<Camera>> cameras;
  std::vector<Named<Light>> lights;
  std::optional<MapVolume> map;  // the scene's own choice; without one the map is fitted tightly to the scene
  // For people: one phrase for each thing that the scene's file holds and Noonmark does not model, and for each choice
  // that the file leaves open.
  std::vector<std::string> notes;
};

}  // namespace noonmark
