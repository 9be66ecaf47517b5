// The bytes of the input choose a mesh of few long and many thin triangles and a light. What the cells of the light's
// plane answer (raytrace/light_cells.h) must be what rays answer.
#include <algorithm>
#include <cmath>

#include "tests/fuzz/choices.h"
#include "tests/fuzz/targets.h"
#include "tests/raytrace/cells_support.h"
#include "tests/raytrace/thin_shapes.h"

namespace noonmark::fuzz {
namespace {

Scene any_mesh(Choices& choices) {
  Scene scene;
  scene.name = "fuzzed";
  for (int shapes = choices.below(3); shapes >= 0; --shapes) {
    const test::ThinShapeRow& shape =
        test::thin_shapes[static_cast<size_t>(choices.below(static_cast<int>(test::thin_shapes.size())))];
    const size_t first = scene.positions.size();
    // Thousands of triangles that share no vertices take rays too long.
    const double most = shape.joined && choices.below(2) == 1 ? 11.5 : 8.5;
    shape.add(scene, 3 + static_cast<int>(std::exp2(choices.between(0, most))));
    const glm::dvec3 by = any_point(choices, 2), squeeze(1, choices.between(0, 1), 1);
    for (size_t i = first; i < scene.positions.size(); ++i)
      scene.positions[i] = glm::vec3(by + squeeze * glm::dvec3(scene.positions[i]));
  }
  for (int few = choices.below(5); few > 0; --few) {
    const uint32_t a = test::add_vertex(scene, any_point(choices, 20));
    test::add_vertex(scene, any_point(choices, 20));
    // Often hardly wider than a line.
    const double wide = choices.below(2) == 0 ? 1 : 1e-4;
    test::add_vertex(scene, glm::dvec3(scene.positions[a]) + wide * any_point(choices, 20));
    scene.triangles.emplace_back(a, a + 1, a + 2);
  }
  static constexpr double sizes[] = {1, 1, 1e-3, 1e3}, places[] = {0, 0, 30, 1e4};
  const double size = sizes[choices.below(4)], place = places[choices.below(4)];
  for (glm::vec3& p : scene.positions) p = glm::vec3(size * (glm::dvec3(p) + place));
  const double height = choices.below(4) == 0 ? 0.2 : 10;
  const glm::dvec3 aside(choices.between(-10, 10), 0, choices.between(-10, 10));
  scene.light.target_m = glm::dvec3(size * place);
  scene.light.position_m = scene.light.target_m + size * (glm::dvec3(0, height, 0) + aside);
  return scene;
}

// Whether the light sees a triangle, on which there can be receivers.
bool has_area(const Scene& scene) {
  const glm::dvec3 to_light = test::frame_of(scene).direction_to_light();
  return std::any_of(scene.triangles.begin(), scene.triangles.end(), [&](glm::uvec3 t) {
    const glm::dvec3 a = scene.positions[t.x], b = scene.positions[t.y], c = scene.positions[t.z];
    return glm::dot(glm::cross(b - a, c - a), to_light) != 0;
  });
}

void run(const std::string& bytes) {
  Choices choices(bytes);
  const Scene scene = any_mesh(choices);
  if (!has_area(scene)) return;
  const test::CellsAndRays found =
      test::compare_cells(scene, 60, static_cast<uint32_t>(choices.byte()), choices.between(0, 20), test::box(3));
  require(found.receivers == 0, std::to_string(found.receivers) + " receivers have another truth than by rays");
  require(!found.taps, "a tap's verdict differs from that by rays");
  require(!found.edges, "a distance to an edge differs from that by rays");
  require(!found.depths, "a depth of the exact map differs from that by rays");
}

// Every shape alone, with few triangles and with many.
std::vector<std::string> seeds() {
  std::vector<std::string> all;
  for (char shape = 0; shape < static_cast<char>(test::thin_shapes.size()); ++shape)
    for (char many : {'\x40', '\xff'}) {
      std::string seed = {0, shape};  // one shape
      if (test::thin_shapes[static_cast<size_t>(shape)].joined) seed += '\1';
      seed += {many, 0};
      for (int axis = 0; axis < 3; ++axis) seed += {'\x80', 0};  // about the origin
      seed += {'\xff', '\xff', 0, 0, 0, 1};                      // not squeezed; nothing besides; a high light
      all.push_back(seed);
    }
  return all;
}

std::vector<std::string> words() { return {}; }

}  // namespace

const Target cells_target = {"cells", run, seeds, words, nullptr};

}  // namespace noonmark::fuzz
