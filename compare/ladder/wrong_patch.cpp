#include "compare/ladder/wrong_patch.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "compare/ladder/numbers.h"

namespace noonmark {

std::vector<glm::ivec2> largest_patch(Image<uint8_t> left) {  // in no patch yet
  std::vector<glm::ivec2> largest, patch;
  for (int y = 0; y < left.height; ++y) {
    for (int x = 0; x < left.width; ++x) {
      if (!left.at(x, y)) continue;
      left.at(x, y) = 0;
      patch.assign(1, {x, y});
      for (size_t next = 0; next < patch.size(); ++next) {
        const glm::ivec2 p = patch[next];
        for (int ny = std::max(0, p.y - 1); ny <= std::min(left.height - 1, p.y + 1); ++ny)
          for (int nx = std::max(0, p.x - 1); nx <= std::min(left.width - 1, p.x + 1); ++nx)
            if (left.at(nx, ny)) {
              left.at(nx, ny) = 0;
              patch.emplace_back(nx, ny);
            }
      }
      if (patch.size() > largest.size()) largest = patch;
    }
  }
  return largest;
}

glm::ivec2 deepest_in(const std::vector<glm::ivec2>& patch) {
  glm::ivec2 low = patch.front(), high = low;
  for (const glm::ivec2& p : patch) low = glm::min(low, p), high = glm::max(high, p);
  // Steps to what is not of the patch, with a border of such pixels: first over the neighbours before, then over those behind.
  Image<int> steps(high.x - low.x + 3, high.y - low.y + 3, 0);
  for (const glm::ivec2& p : patch) steps.at(p.x - low.x + 1, p.y - low.y + 1) = static_cast<int>(patch.size());
  const auto pass = [&](int first_y, int last_y, int by) {
    for (int y = first_y; y != last_y + by; y += by)
      for (int k = 1; k + 1 < steps.width; ++k) {
        const int x = by > 0 ? k : steps.width - 1 - k;
        for (const glm::ivec2 to : {glm::ivec2(-by, 0), {-1, -by}, {0, -by}, {1, -by}})
          steps.at(x, y) = std::min(steps.at(x, y), steps.at(x + to.x, y + to.y) + 1);
      }
  };
  pass(1, steps.height - 2, 1);
  pass(steps.height - 2, 1, -1);
  const auto depth = [&](const glm::ivec2& p) { return steps.at(p.x - low.x + 1, p.y - low.y + 1); };
  std::vector<glm::ivec2> deepest;
  glm::dvec2 middle(0);
  for (const glm::ivec2& p : patch) {
    if (deepest.empty() || depth(p) > depth(deepest.front())) deepest.clear(), middle = glm::dvec2(0);
    if (deepest.empty() || depth(p) == depth(deepest.front())) deepest.push_back(p), middle += glm::dvec2(p);
  }
  middle /= static_cast<double>(deepest.size());
  const auto away = [&](const glm::ivec2& p) { return glm::length(glm::dvec2(p) - middle); };
  return *std::min_element(deepest.begin(), deepest.end(),
                           [&](const glm::ivec2& a, const glm::ivec2& b) { return away(a) < away(b); });
}

double largest_wrong_patch(const Ladder& ladder) {
  const Image<float>&shown = ladder.shown(), &truth = ladder.truth();
  Image<uint8_t> wrong(shown.width, shown.height);
  for (size_t i = 0; i < wrong.size(); ++i) {
    if (!is_counted(ladder, i)) continue;
    if (std::isnan(shown[i]) || std::isnan(truth[i])) return not_a_number;
    wrong[i] = (shown[i] >= 0.5f) != (truth[i] >= 0.5f);
  }
  return static_cast<double>(largest_patch(std::move(wrong)).size());
}

}  // namespace noonmark
