// What another lookup.reduction would give, without another lookup: light-bleed reduction is arithmetic on the lit fraction
// of each receiver. All numbers are those of R4, on the exact map.
//
//   ReductionWindow window;
//   window.add({.pixel = 7, .truth = 0, .from = 0, .texels = 0, .bare = 0.1, .bound = 0.1});  // each counted receiver, once
//   std::optional<Window> usable = window.usable(0.001, 0.01);
//   double r = window.best().reduction;
#pragma once
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace noonmark {

class ReductionWindow {
 public:
  // Of one receiver: its pixel, by which the sums are ordered; R1; the taps at the places looked up, and at the centres of their texels; the bound without and with
  // bias and floors (compare/ladder/moment_climb.h). All in [0, 1].
  struct Receiver {
    size_t pixel = 0;
    double truth = 0, from = 0, texels = 0, bare = 0, bound = 0;
  };
  void add(const Receiver& receiver) { receivers_.push_back(receiver); }
  void add(const ReductionWindow& more) {
    receivers_.insert(receivers_.end(), more.receivers_.begin(), more.receivers_.end());
  }
  const std::vector<Receiver>& all() const { return receivers_; }
  // Puts the receivers in the order of their pixels. Threads add them in any order, and the last bit of a sum depends on it.
  void sort();

  // Means over the receivers, at this reduction (0 ... 0.99): |R4 - R1|; the leak and what the reduction darkens, as the
  // ladder books them.
  struct At {
    double error = 0, leak = 0, reduction = 0;
  };
  At at(double reduction) const;

  struct Best {
    double reduction = 0, error = 0;
  };
  // The reduction of least error, exactly: between the values at which a receiver's result meets its truth or 0, the error has
  // no minimum. The smallest of equal ones.
  Best best() const;

  // The reductions at which the mean leak is at most leak_bound and what the reduction darkens at most darkening_bound: from
  // `low` to `high`, to within 2^-30. The leak never grows with the reduction, and what it darkens never falls. Empty if there
  // are none.
  struct Window {
    double low = 0, high = 0;
  };
  std::optional<Window> usable(double leak_bound, double darkening_bound) const;

 private:
  std::vector<Receiver> receivers_;
};

// The largest reduction that a setting can have.
inline constexpr double most_reduction = 0.99;

// Of the window in the order of its pixels: best_reduction, best_reduction_error, reduction_min, reduction_max: fractions. Of no receiver NaN; the window is left out if
// there is none.
std::map<std::string, double> reduction_metrics(ReductionWindow window, double leak_bound, double darkening_bound);

}  // namespace noonmark
