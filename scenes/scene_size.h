// How large a scene is, and how much memory it takes at the least. Asked before anything is made of a scene
// (base/memory.h).
//
//   if (scene_bytes(scene_size(scene)) > available_memory().bytes) throw Error(ErrorKind::usage, "it does not fit");
#pragma once
#include <cstdint>

namespace noonmark {

struct Scene;

// Of any scene, instances counted and cut as scene.mesh says; more are refused before anything is made of them (12
// bytes each, and as much again for their vertices, in every stage that follows).
inline constexpr uint64_t max_scene_triangles = uint64_t{1} << 26;

struct SceneSize {
  uint64_t vertices = 0;
  uint64_t triangles = 0;
  uint64_t part_bytes = 0;  // of the list of parts, with their names
};

SceneSize scene_size(const Scene& scene);
// What a part takes whose name has so many characters.
uint64_t bytes_of_part(uint64_t name_length);

// What a scene of this size takes at the least in all that is made of it: OpenGL's buffers, Embree's tree, which
// triangle is beside which, their planes as the light sees them. Edges that lie open cost more (raytrace/silhouettes.h).
double scene_bytes(SceneSize size);

}  // namespace noonmark
