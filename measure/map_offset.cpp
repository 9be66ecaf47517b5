#include "measure/map_offset.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace noonmark {
namespace {

// Rasterisers move vertices to a grid of 1/16 of a texel or finer along each axis. The slope along each is at most m.
constexpr double most_moved_by_grid = 2.0 / 16;
// The rows of a renderer's matrix are right to some 1e-6 (frames/map_frame.cpp).
constexpr double matrix_error = 1e-6;
// As of the other checks of a delivery: with fewer there is too little to go on.
constexpr size_t enough = 100;

double step_of(DepthFormat format) { return format == DepthFormat::d16 ? 1.0 / 65535 : 0x1p-24; }

// The steepest slope of the plane that the map shows about a texel, in depth per texel. Empty at the map's border, where the
// map is empty, and where the slopes on both sides of the texel are those of two surfaces: they differ by more than `rounding`,
// and by more than the grid's share of them.
std::optional<double> slope_at(const Image<float>& map, glm::ivec2 t, double rounding) {
  if (t.x < 1 || t.y < 1 || t.x + 1 >= map.width || t.y + 1 >= map.height) return std::nullopt;
  const double here = map.at(t.x, t.y);
  const auto along = [&](double before, double after) -> std::optional<double> {
    if (before >= 1 || after >= 1) return std::nullopt;
    const double middle = std::abs(after - before) / 2;
    if (std::abs(before + after - 2 * here) > 4 * rounding + most_moved_by_grid * middle) return std::nullopt;
    return middle;
  };
  if (here >= 1) return std::nullopt;
  const auto x = along(map.at(t.x - 1, t.y), map.at(t.x + 1, t.y)),
             y = along(map.at(t.x, t.y - 1), map.at(t.x, t.y + 1));
  if (!x || !y) return std::nullopt;
  return std::max(*x, *y);
}

struct Texel {
  double slope, off, least;  // least: what moves it without an offset
};

// A rasteriser's grid moves each triangle by itself, by a share of its own slope. Texels of one slope are mostly those of one
// surface, which has a difference from the line of its own. The line turns about the slope that has most texels, to
// meet these: how far its height at m = 0 moves then. With two slopes every line meets both, so the grid's most is taken.
double unsure_constant(std::vector<Texel> texels, const MapOffset& line) {
  constexpr size_t enough_of_slope = 20;
  constexpr double apart = 0.25;  // of the larger slope; nearer ones tell little of how the line turns
  std::sort(texels.begin(), texels.end(), [](const Texel& a, const Texel& b) { return a.slope < b.slope; });
  struct Surface {
    double slope, off;  // medians; off: from the line
    size_t texels;
  };
  std::vector<Surface> surfaces;
  for (size_t first = 0, end = 0; first < texels.size(); first = end) {
    while (end < texels.size() && texels[end].slope <= (1 + apart / 2) * texels[first].slope + step_of(line.format))
      ++end;
    if (end - first < enough_of_slope) continue;
    std::vector<double> off;
    for (size_t i = first; i < end; ++i)
      off.push_back(std::abs(texels[i].off - line.factor * texels[i].slope - line.constant));
    const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
    std::nth_element(off.begin(), middle, off.end());
    surfaces.push_back({texels[(first + end) / 2].slope, *middle, end - first});
  }
  const auto most = std::max_element(surfaces.begin(), surfaces.end(),
                                     [](const Surface& a, const Surface& b) { return a.texels < b.texels; });
  if (most == surfaces.end()) return 0;
  size_t others = 0;
  double unsure = 0;
  for (const Surface& one : surfaces) {
    const double between = std::abs(one.slope - most->slope);
    if (between < apart * std::max(one.slope, most->slope)) continue;
    ++others;
    unsure = std::max(unsure, one.off * most->slope / between);
  }
  return others < 2 ? most_moved_by_grid * most->slope : unsure;
}

}  // namespace

bool MapOffset::in_map() const {
  return texels >= enough &&
         (std::abs(factor) > most_moved_by_grid || std::abs(constant) > step_of(format) + matrix_error + unsure);
}

MapOffset map_offset(const Image<float>& given, const MapDepths& exact, DepthFormat format) {
  MapOffset found{.format = format};
  std::vector<Texel> texels;
  const double step = step_of(found.format);
  for (int y = 0; y < given.height; ++y)
    exact.texels->each_in_row(y, [&](int x, size_t index) {
      const auto slope = slope_at(given, {x, y}, step);
      if (slope && exact[index] < 1)
        texels.push_back(
            {*slope, static_cast<double>(given.at(x, y)) - exact[index], step + most_moved_by_grid * *slope});
    });
  found.texels = texels.size();
  if (found.texels < enough) return found;
  // Iteratively reweighted least squares. A difference below what moves a texel anyway has no more weight than one of that size.
  for (int round = 0; round < 50; ++round) {
    double n = 0, sm = 0, smm = 0, sd = 0, smd = 0;
    for (const Texel& t : texels) {
      const double off = std::abs(t.off - found.factor * t.slope - found.constant) / t.least;
      const double weight = 1 / (std::max(off, 1.0) * t.least * t.least);
      n += weight, sm += weight * t.slope, smm += weight * t.slope * t.slope;
      sd += weight * t.off, smd += weight * t.slope * t.off;
    }
    const double apart = n * smm - sm * sm;
    // Where all slopes are within a step of each other, factor and constant cannot be told, and the constant is all of the
    // offset.
    const bool told = apart > n * n * step * step;
    const double factor = told ? (n * smd - sm * sd) / apart : 0, constant = (sd - factor * sm) / n;
    const bool settled = std::abs(factor - found.factor) < 1e-6 && std::abs(constant - found.constant) < step * 1e-3;
    found.factor = factor, found.constant = constant;
    if (settled) break;
  }
  found.unsure = unsure_constant(std::move(texels), found);
  return found;
}

}  // namespace noonmark
