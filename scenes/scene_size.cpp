#include "scenes/scene_size.h"

#include <string>

#include "scenes/scene.h"

namespace noonmark {

// Measured (measure/memory_estimate.cpp says how). Of 250 bytes for a triangle some 110 are Embree's, 64 its plane, 36 its
// neighbours; of 70 for a vertex 24 are its place in the light's frame and 36 the scene's, OpenGL's and Embree's
// copies.
double scene_bytes(SceneSize size) {
  return 250.0 * static_cast<double>(size.triangles) + 70.0 * static_cast<double>(size.vertices) +
         static_cast<double>(size.part_bytes);
}

uint64_t bytes_of_part(uint64_t name_length) {
  // A short name stands in the part itself. A longer one is allocated: malloc adds a header of 8 bytes and rounds up to
  // a multiple of 16. One byte ends the name.
  static const uint64_t short_name = std::string().capacity();
  return sizeof(Part) + (name_length > short_name ? name_length + 1 + 8 + 15 : 0);
}

SceneSize scene_size(const Scene& scene) {
  SceneSize size{scene.positions.size(), scene.triangles.size(), 0};
  for (const Part& part : scene.parts) size.part_bytes += bytes_of_part(part.name.size());
  return size;
}

}  // namespace noonmark
