#include "app/advise/engines/cover.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace noonmark {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double compared_at_rad = std::numbers::pi / 4;
// An amount that gives so many times the needed depth at 45 degrees grows without bound towards an end of the slopes. On this
// grid the ratios of two forms that are bounded stay below 10, and those that are not pass 2000.
constexpr double unbounded = 1000;

class Cover {
 public:
  Cover(const std::vector<BiasForm>& forms, const std::function<double(double, double)>& needed)
      : gains_(forms.size()) {
    constexpr int steps = 1024, azimuths = 9;
    std::vector<double> slopes = {1e-4};
    for (int i = 0; i < steps; ++i) slopes.push_back(0.5 * std::numbers::pi * i / steps);
    for (double rest : {1e-4, 1e-6}) slopes.push_back(0.5 * std::numbers::pi - rest);
    for (double theta : slopes)
      for (int j = 0; j < azimuths; ++j) {
        const double phi = 0.25 * std::numbers::pi * j / (azimuths - 1);
        const double depth = needed(theta, phi);
        if (!(depth > 0)) continue;
        needed_.push_back(depth);
        scale_ = std::max(scale_, depth * std::cos(theta));
        for (size_t i = 0; i < forms.size(); ++i) gains_[i].push_back(gain(forms[i], theta, phi));
      }
    for (BiasForm form : forms) at_45_.push_back(gain(form, compared_at_rad));
  }

  bool nothing() const { return needed_.empty(); }

  // The least amount of form i beside so much of form j; infinite if there is none.
  double beside(size_t i, size_t j, double of_j) const {
    double most = 0;
    for (size_t k = 0; k < needed_.size(); ++k) {
      const double rest = needed_[k] - of_j * gains_[j][k];
      if (rest > 0) most = std::max(most, gains_[i][k] > 0 ? rest / gains_[i][k] : infinity);
    }
    return most * at_45_[i] > unbounded * scale_ ? infinity : most;
  }
  double alone(size_t i) const { return beside(i, i, 0); }
  double depth_at_45(size_t i, double amount) const { return amount * at_45_[i]; }

  // The amount of j beside which i and j together give least at 45 degrees. What i must give is a greatest value of linear
  // functions of j's amount, so the sum is convex, and a search by thirds finds its least value.
  double best_beside(size_t i, size_t j) const {
    double low = 0, high = 0;
    for (size_t k = 0; k < needed_.size(); ++k)
      if (gains_[j][k] >= at_45_[j] / 16) high = std::max(high, needed_[k] / gains_[j][k]);
    const auto sum = [&](double of_j) { return depth_at_45(j, of_j) + depth_at_45(i, unlimited(i, j, of_j)); };
    for (int step = 0; step < 50; ++step) {
      const double a = low + (high - low) / 3, b = high - (high - low) / 3;
      if (sum(a) <= sum(b))
        high = b;
      else
        low = a;
    }
    return high;
  }

 private:
  double unlimited(size_t i, size_t j, double of_j) const {
    double most = 0;
    for (size_t k = 0; k < needed_.size(); ++k)
      most = std::max(most, (needed_[k] - of_j * gains_[j][k]) / std::max(gains_[i][k], 1e-12));
    return most;
  }

  std::vector<std::vector<double>> gains_;  // of each form, at each slope and azimuth
  std::vector<double> needed_, at_45_;
  double scale_ = 0;  // the greatest needed depth across the plane: needed depths may be 0 at any one slope
};

}  // namespace

std::optional<std::vector<double>> least_cover(const std::vector<BiasForm>& forms,
                                               const std::function<double(double, double)>& needed) {
  const Cover cover(forms, needed);
  std::vector<double> amounts(forms.size(), 0);
  if (cover.nothing()) return amounts;
  std::optional<std::vector<double>> best;
  double least = infinity;
  const auto offer = [&](double depth, std::vector<double> offered) {
    if (depth < least) least = depth, best = std::move(offered);
  };
  for (size_t i = 0; i < forms.size(); ++i) {
    std::vector<double> one = amounts;
    one[i] = cover.alone(i);
    offer(cover.depth_at_45(i, one[i]), one);
  }
  if (best) return best;
  for (size_t i = 0; i < forms.size(); ++i)
    for (size_t j = i + 1; j < forms.size(); ++j) {
      std::vector<double> two = amounts;
      two[j] = cover.best_beside(i, j);
      two[i] = cover.beside(i, j, two[j]);
      offer(cover.depth_at_45(i, two[i]) + cover.depth_at_45(j, two[j]), two);
    }
  return best;
}

}  // namespace noonmark
