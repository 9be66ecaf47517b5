#include "app/advise/engines/cover.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace noonmark {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// An amount that gives so many times the needed depth at 45 degrees grows without bound towards an end of the slopes. On this
// grid the ratios of two forms that are bounded stay below 10, and those that are not pass 2000.
constexpr double unbounded = 1000;

// What is needed at each slope and azimuth, and what one metre of each form gives there.
struct Grid {
  std::vector<std::vector<double>> gains;
  std::vector<double> needed, at_45;
  double scale = 0;  // the greatest needed depth across the plane: needed depths may be 0 at any one slope

  Grid(const std::vector<BiasForm>& forms, const std::function<double(double, double)>& needed_m)
      : gains(forms.size()) {
    constexpr int steps = 1024, azimuths = 9;
    std::vector<double> slopes = {1e-4};
    for (int i = 0; i < steps; ++i) slopes.push_back(0.5 * std::numbers::pi * i / steps);
    for (double rest : {1e-4, 1e-6}) slopes.push_back(0.5 * std::numbers::pi - rest);
    for (double theta : slopes)
      for (int j = 0; j < azimuths; ++j) {
        const double phi = 0.25 * std::numbers::pi * j / (azimuths - 1);
        const double depth = needed_m(theta, phi);
        if (!(depth > 0)) continue;
        needed.push_back(depth);
        scale = std::max(scale, depth * std::cos(theta));
        for (size_t i = 0; i < forms.size(); ++i) gains[i].push_back(gain(forms[i], theta, phi));
      }
    for (BiasForm form : forms) at_45.push_back(gain(form, 0.25 * std::numbers::pi));
  }

  // The least amount of form i beside so much of form j; infinite if i gives nothing where j does not suffice. least_gain: i is taken
  // to give at least that, so that a search meets no infinite amount.
  double beside(size_t i, size_t j, double of_j, double least_gain = 0) const {
    double most = 0;
    for (size_t k = 0; k < needed.size(); ++k)
      if (const double rest = needed[k] - of_j * gains[j][k]; rest > 0)
        most = std::max(most, rest / std::max(gains[i][k], least_gain));
    return most;
  }

  // The amount of j beside which i and j together give least at 45 degrees. What i must give is a greatest value of linear
  // functions of j's amount, so the sum is convex, and a search by thirds finds its least value.
  double best_beside(size_t i, size_t j) const {
    double low = 0, high = 0;
    for (size_t k = 0; k < needed.size(); ++k)
      if (gains[j][k] >= at_45[j] / 16) high = std::max(high, needed[k] / gains[j][k]);
    const auto sum = [&](double of_j) { return of_j * at_45[j] + beside(i, j, of_j, 1e-12) * at_45[i]; };
    for (int step = 0; step < 50; ++step) {
      const double a = low + (high - low) / 3, b = high - (high - low) / 3;
      (sum(a) <= sum(b) ? high : low) = sum(a) <= sum(b) ? b : a;
    }
    return high;
  }
};

}  // namespace

std::optional<std::vector<double>> least_cover(const std::vector<BiasForm>& forms,
                                               const std::function<double(double, double)>& needed) {
  const Grid grid(forms, needed);
  if (grid.needed.empty()) return std::vector<double>(forms.size(), 0);
  std::vector<double> best;
  double least = infinity;
  const auto offer = [&](size_t i, size_t j, double of_j) {
    const double of_i = grid.beside(i, j, of_j), depth = of_i * grid.at_45[i] + of_j * grid.at_45[j];
    if (!(of_i * grid.at_45[i] <= unbounded * grid.scale) || !(depth < least)) return;
    least = depth;
    best.assign(forms.size(), 0);
    best[j] = of_j;
    best[i] = of_i;
  };
  for (size_t i = 0; i < forms.size(); ++i) offer(i, i, 0);
  if (!best.empty()) return best;
  for (size_t i = 0; i < forms.size(); ++i)
    for (size_t j = i + 1; j < forms.size(); ++j) offer(i, j, grid.best_beside(i, j));
  if (best.empty()) return std::nullopt;
  return best;
}

}  // namespace noonmark
