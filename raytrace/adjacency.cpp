#include "raytrace/adjacency.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <numeric>
#include <tuple>

namespace noonmark {
namespace {

constexpr size_t largest_fan = 64;

// One number for each distinct position. -0 and 0 are equal positions and compare so.
std::vector<uint32_t> weld(const std::vector<glm::vec3>& positions) {
  std::vector<uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](uint32_t i) { return std::tuple(positions[i].x, positions[i].y, positions[i].z); };
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
  std::vector<uint32_t> number(positions.size());
  uint32_t next = 0;
  for (size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && key(order[i]) != key(order[i - 1])) ++next;
    number[order[i]] = next;
  }
  return number;
}

// For each triangle, the first triangle with the same corners in the same cyclic order.
std::vector<uint32_t> find_first(const std::vector<std::array<uint32_t, 3>>& corners) {
  struct Key {
    std::array<uint32_t, 3> corners;  // begun so that they are the least
    uint32_t triangle;
    bool operator<(const Key& other) const {
      return std::tie(corners, triangle) < std::tie(other.corners, other.triangle);
    }
  };
  std::vector<Key> keys;
  keys.reserve(corners.size());
  for (uint32_t t = 0; t < corners.size(); ++t) {
    const auto [a, b, c] = corners[t];
    using Corners = std::array<uint32_t, 3>;
    keys.push_back({std::min({Corners{a, b, c}, Corners{b, c, a}, Corners{c, a, b}}), t});
  }
  tbb::parallel_sort(keys);
  std::vector<uint32_t> first(corners.size());
  for (size_t i = 0; i < keys.size(); ++i)
    first[keys[i].triangle] =
        i > 0 && keys[i].corners == keys[i - 1].corners ? first[keys[i - 1].triangle] : keys[i].triangle;
  return first;
}

}  // namespace

Adjacency::Adjacency(const Scene& scene) {
  const std::vector<uint32_t> number = weld(scene.positions);
  const size_t count = scene.triangles.size();
  welded_.resize(count);
  struct Edge {
    uint32_t low, high, triangle;
    uint8_t edge;
  };
  std::vector<Edge> edges;
  edges.reserve(3 * count);
  for (size_t t = 0; t < count; ++t) {
    const glm::uvec3 v = scene.triangles[t];
    welded_[t] = {number[v.x], number[v.y], number[v.z]};
  }
  first_ = find_first(welded_);
  for (uint32_t t = 0; t < count; ++t) {
    if (is_copy(t)) {
      any_copies_ = true;
      continue;
    }
    for (uint8_t e = 0; e < 3; ++e) {
      const uint32_t a = welded_[t][e], b = welded_[t][(e + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), t, e});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high, a.triangle, a.edge) < std::tie(b.low, b.high, b.triangle, b.edge);
  });
  const auto same = [](const Edge& a, const Edge& b) { return a.low == b.low && a.high == b.high; };

  begin_.assign(3 * count + 1, 0);
  const auto each_run = [&](auto&& visit) {
    for (size_t first = 0; first < edges.size();) {
      size_t last = first + 1;
      while (last < edges.size() && same(edges[first], edges[last])) ++last;
      // The cost of a run grows with its square. No real surface has so many triangles at one edge, but a broken file
      // may have. Such an edge counts as a boundary.
      for (size_t i = first; i < last && last - first <= largest_fan; ++i)
        for (size_t j = first; j < last; ++j)
          if (edges[j].triangle != edges[i].triangle) visit(3 * edges[i].triangle + edges[i].edge, edges[j].triangle);
      first = last;
    }
  };
  each_run([&](uint32_t slot, uint32_t) { ++begin_[slot + 1]; });
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  neighbours_.resize(begin_.back());
  std::vector<uint32_t> fill(begin_.begin(), begin_.end() - 1);
  each_run([&](uint32_t slot, uint32_t neighbour) { neighbours_[fill[slot]++] = neighbour; });
}

std::vector<uint32_t> Adjacency::without_copies() const {
  std::vector<uint32_t> kept;
  for (uint32_t t = 0; any_copies_ && t < triangles(); ++t)
    if (!is_copy(t)) kept.push_back(t);
  return kept;
}

std::span<const uint32_t> Adjacency::across(uint32_t triangle, int edge) const {
  const size_t slot = 3 * static_cast<size_t>(triangle) + static_cast<size_t>(edge);
  return {neighbours_.data() + begin_[slot], neighbours_.data() + begin_[slot + 1]};
}

}  // namespace noonmark
