// What Assimp, a reader of glTF that has nothing in common with ours, makes of the same file: its triangles in the
// world, morph targets and skins applied at rest.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace noonmark::test {

struct SecondReading {
  std::string error;  // not empty: it could not read the file
  std::vector<std::array<glm::dvec3, 3>> triangles;
};

SecondReading read_by_assimp(const std::string& path);

}  // namespace noonmark::test
