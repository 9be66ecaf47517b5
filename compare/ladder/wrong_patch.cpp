#include "compare/ladder/wrong_patch.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "compare/ladder/numbers.h"

namespace noonmark {

double largest_wrong_patch(const Ladder& ladder) {
  const Image<float>&shown = ladder.shown(), &truth = ladder.truth();
  Image<uint8_t> left(shown.width, shown.height);  // wrong, and in no patch yet
  for (size_t i = 0; i < left.size(); ++i) {
    if (!is_counted(ladder, i)) continue;
    if (std::isnan(shown[i]) || std::isnan(truth[i])) return not_a_number;
    left[i] = (shown[i] >= 0.5f) != (truth[i] >= 0.5f);
  }
  size_t largest = 0;
  std::vector<std::pair<int, int>> patch;
  for (int y = 0; y < left.height; ++y) {
    for (int x = 0; x < left.width; ++x) {
      if (!left.at(x, y)) continue;
      left.at(x, y) = 0;
      patch.assign(1, {x, y});
      for (size_t next = 0; next < patch.size(); ++next) {
        const auto [px, py] = patch[next];
        for (int ny = std::max(0, py - 1); ny <= std::min(left.height - 1, py + 1); ++ny)
          for (int nx = std::max(0, px - 1); nx <= std::min(left.width - 1, px + 1); ++nx)
            if (left.at(nx, ny)) {
              left.at(nx, ny) = 0;
              patch.emplace_back(nx, ny);
            }
      }
      largest = std::max(largest, patch.size());
    }
  }
  return static_cast<double>(largest);
}

}  // namespace noonmark
