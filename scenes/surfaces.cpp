#include "scenes/surfaces.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace noonmark {
namespace {

// Disjoint sets of numbers. The first of a set is its least number.
class DisjointSets {
 public:
  explicit DisjointSets(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
  uint32_t first(uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];  // halves the path
    return i;
  }
  void join(uint32_t a, uint32_t b) {
    a = first(a), b = first(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<uint32_t> parent_;
};

}  // namespace

std::vector<uint32_t> surfaces_of(const Scene& scene) {
  struct Corner {
    glm::vec3 position;
    uint32_t triangle;
  };
  std::vector<Corner> corners;
  corners.reserve(3 * scene.triangles.size());
  for (uint32_t t = 0; t < scene.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) corners.push_back({scene.positions[scene.triangles[t][i]], t});
  const auto place = [](const Corner& c) { return std::tuple(c.position.x, c.position.y, c.position.z); };
  std::sort(corners.begin(), corners.end(), [&](const Corner& a, const Corner& b) { return place(a) < place(b); });
  DisjointSets sets(scene.triangles.size());
  for (size_t i = 1; i < corners.size(); ++i)
    if (place(corners[i]) == place(corners[i - 1])) sets.join(corners[i - 1].triangle, corners[i].triangle);
  std::vector<uint32_t> surface(scene.triangles.size());
  for (uint32_t t = 0; t < surface.size(); ++t) surface[t] = sets.first(t);
  return surface;
}

}  // namespace noonmark
