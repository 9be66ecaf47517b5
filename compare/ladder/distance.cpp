#include "compare/ladder/distance.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <vector>

#include "compare/ladder/numbers.h"

namespace noonmark {
namespace {

// d[i] = min over j of (i - j)^2 + f[j]: the lower envelope of the parabolas rooted at every j with finite f.
void transform(const std::vector<float>& f, std::vector<float>& d, std::vector<int>& root, std::vector<double>& from) {
  const int n = static_cast<int>(f.size());
  int k = -1;
  for (int q = 0; q < n; ++q) {
    if (f[q] == infinity_f) continue;
    double start = -infinity;  // double: beyond 4096 a float cannot separate this place from a neighbouring pixel
    while (k >= 0) {
      const double p = root[k];
      start = ((f[q] + static_cast<double>(q) * q) - (f[root[k]] + p * p)) / (2.0 * (q - p));
      if (start > from[k]) break;
      start = -infinity;
      --k;
    }
    ++k;
    root[k] = q;
    from[k] = start;
  }
  for (int q = 0, i = 0; q < n; ++q) {
    if (k < 0) {
      d[q] = infinity_f;
      continue;
    }
    while (i < k && from[i + 1] < q) ++i;
    const float away = static_cast<float>(q - root[i]);
    d[q] = away * away + f[root[i]];
  }
}

}  // namespace

Image<float> distance_to(const Image<uint8_t>& mask) {
  const int width = mask.width, height = mask.height;
  Image<float> squared(width, height, infinity_f);
  const auto lines = [](int count, int length, const auto& get, const auto& set) {
    tbb::parallel_for(tbb::blocked_range<int>(0, count), [&](const tbb::blocked_range<int>& range) {
      std::vector<float> f(length), d(length);
      std::vector<double> from(length);
      std::vector<int> root(length);
      for (int line = range.begin(); line != range.end(); ++line) {
        for (int i = 0; i < length; ++i) f[i] = get(line, i);
        transform(f, d, root, from);
        for (int i = 0; i < length; ++i) set(line, i, d[i]);
      }
    });
  };
  lines(
      width, height, [&](int x, int y) { return mask.at(x, y) ? 0.0f : infinity_f; },
      [&](int x, int y, float d) { squared.at(x, y) = d; });
  lines(
      height, width, [&](int y, int x) { return squared.at(x, y); },
      [&](int y, int x, float d) { squared.at(x, y) = std::sqrt(d); });
  return squared;
}

}  // namespace noonmark
