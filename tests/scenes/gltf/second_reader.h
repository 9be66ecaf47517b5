// Reads the same file with Assimp, a reader of glTF that shares no code with ours: its triangles in the world, with
// morph targets and skins applied at rest.
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
