// What another lookup.reduction would give, without another lookup: light-bleed reduction is arithmetic on the lit fraction
// of each receiver. All numbers are those of R4, on the exact map, but for what OpenGL would show (Shown).
//
//   ReductionWindow window;
//   window.add({.pixel = 7, .truth = 0, .chain = {.from = 0, .texels = 0, .bare = 0.1, .bound = 0.1}},  // each receiver once
//              {.truth = 0, .soft = 0.2f, .bound = 0.1f});
//   window.sort();
//   std::optional<ReductionWindow::Window> usable = window.usable(0.001, 0.01);
//   double r = window.best().reduction;
#pragma once
#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/results/records.h"

namespace noonmark {

// How the change from the taps of one receiver to its filtered result is parted into causes (compare/ladder/moment_climb.h). All in
// [0, 1].
struct LookupChain {
  double from = 0, texels = 0;  // the taps at the places looked up, and at the centres of their texels: D and R3
  double bare = 0, bound = 0;   // the bound without and with bias and floors
  // The weight of the taps that no texel covers, and of those whose truth float error can change.
  double uncovered = 0, unsure = 0;
};

// Their sum is the change. A part is negative if it darkens. No two parts have opposite signs.
struct LookupParts {
  double coverage = 0, undecided = 0, aliasing = 0, to_bare = 0, to_floors = 0, reduction = 0;

  double leak() const { return std::max(0.0, to_bare); }
  double peter_panning() const { return std::max(0.0, to_floors); }
  double over_darkening() const { return std::min(0.0, to_bare) + std::min(0.0, to_floors); }
};

// shown: the bound after light-bleed reduction.
LookupParts parts_of(const LookupChain& chain, double shown);

class ReductionWindow {
 public:
  // Bytes of a receiver in a list of up to twice its size, and in a copy of it; and of what is shown of one.
  static constexpr double receiver_bytes() { return 4.0 * sizeof(Receiver); }
  static constexpr double shown_bytes() { return 2.0 * sizeof(Shown); }

  // A counted receiver: its pixel, by which the sums are ordered; R1; and the way from D to the bound.
  struct Receiver {
    size_t pixel = 0;
    double truth = 0;
    LookupChain chain;
  };
  void add(const Receiver& receiver) { receivers_.push_back(receiver); }
  // What OpenGL shows of a receiver: R1, R0, and its own bound before light-bleed reduction (bound_of_shown).
  struct Shown {
    uint32_t pixel = 0;
    float truth = 0, soft = 0, bound = 0;
  };
  void add(const Receiver& receiver, Shown shown) {
    shown.pixel = static_cast<uint32_t>(receiver.pixel);
    receivers_.push_back(receiver), shown_.push_back(shown);
  }
  void add(const ReductionWindow& more) {
    receivers_.insert(receivers_.end(), more.receivers_.begin(), more.receivers_.end());
    shown_.insert(shown_.end(), more.shown_.begin(), more.shown_.end());
  }
  const std::vector<Receiver>& all() const { return receivers_; }
  // To be called once, when all are added. Puts the receivers in the order of their pixels: threads add them in any order, and
  // the last bit of a sum depends on it. Receivers whose bound is 0 or 1 are the same at every reduction; they are summed up.
  void sort();

  // Means over the receivers, at this reduction (0 ... 0.99): |R4 - R1|, and the causes as the ladder books them.
  struct At {
    double error = 0, leak = 0, over_darkening = 0, peter_panning = 0, reduction = 0;
    double aliasing_dark = 0, aliasing_light = 0, coverage = 0;
    void add(const At& other);
  };
  At at(double reduction) const;

  // Means over the receivers of what OpenGL would show at this reduction: |R5 - R1| and |R5 - R0|.
  struct ShownErrors {
    double error = 0, error_soft = 0;
  };
  ShownErrors shown(double reduction) const;

  struct Best {
    double reduction = 0, error = 0;
  };
  // The reduction of least error, exactly: between the values at which a receiver's result meets its truth or 0, the error has
  // no minimum. The smallest of equal ones.
  Best best() const;

  // The reductions at which the mean leak is at most leak_bound, and over-darkening and what the reduction darkens are each at
  // most darkening_bound: from `low` to `high`, to within 2^-30. The leak never grows with the reduction, the
  // other two never fall. Empty if there are none.
  struct Window {
    double low = 0, high = 0;
  };
  std::optional<Window> usable(double leak_bound, double darkening_bound) const;

 private:
  static At of(const Receiver& receiver, double reduction);
  size_t count() const { return receivers_.size() + fixed_receivers_; }

  std::vector<Receiver> receivers_;
  std::vector<Shown> shown_;
  At fixed_;  // sums over those that are the same at every reduction
  size_t fixed_receivers_ = 0;
};

// The bound before light-bleed reduction of what OpenGL shows with it, and of the exact bound of the same receiver. Exact for
// results above 0. A result of 0 hides how far its bound is below the reduction: there the exact bound stands for it.
double bound_of_shown(double shown, double exact_bound, double reduction);

// The largest reduction that a setting can have.
inline constexpr double most_reduction = 0.99;

// Of a window that is sorted: best_reduction, best_reduction_error, reduction_min, reduction_max: fractions. Of no receiver
// NaN; the ends of the window are left out if there is none.
std::map<std::string, double> reduction_metrics(const ReductionWindow& window, double leak_bound,
                                                double darkening_bound);

// Of a window that is sorted: its numbers at reductions of 0, 0.01 ... 0.99. Empty of no receiver.
std::vector<LookupCurvePoint> reduction_curve(const ReductionWindow& window);

}  // namespace noonmark
