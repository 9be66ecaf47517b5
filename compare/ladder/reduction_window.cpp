#include "compare/ladder/reduction_window.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "compare/ladder/lasting_steps.h"
#include "compare/ladder/numbers.h"

namespace noonmark {
namespace {

double reduced(double lit, double reduction) { return std::max(0.0, (lit - reduction) / (1 - reduction)); }

constexpr double ReductionWindow::At::*means_of_reduction[] = {
    &ReductionWindow::At::error,          &ReductionWindow::At::leak,      &ReductionWindow::At::over_darkening,
    &ReductionWindow::At::peter_panning,  &ReductionWindow::At::reduction, &ReductionWindow::At::aliasing_dark,
    &ReductionWindow::At::aliasing_light, &ReductionWindow::At::coverage};

// The least x in [low, high] for which `holds`, which is false and then true; high if it is nowhere.
template <class Holds>
double first_that(double low, double high, const Holds& holds) {
  if (holds(low)) return low;
  while (high - low > 0x1p-30) {
    const double middle = (low + high) / 2;
    (holds(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace

LookupParts parts_of(const LookupChain& chain, double shown) {
  std::array<double, 4> parts{};
  lasting_steps(std::array{chain.from, chain.texels, chain.bare, chain.bound, shown}, parts);
  const double change = shown - chain.from;
  double uncovered = std::min(chain.uncovered, std::abs(change));
  double unsure = std::min(chain.unsure, std::abs(change) - uncovered);
  LookupParts all;
  all.coverage = 0 + std::copysign(uncovered, change);  // 0 + x: no negative zero
  all.undecided = 0 + std::copysign(unsure, change);
  for (double& part : parts) {
    const auto take = [&](double& left) {
      const double taken = std::min(left, std::abs(part));
      left -= taken;
      part -= std::copysign(taken, change);
    };
    take(uncovered);
    take(unsure);
  }
  all.aliasing = 0 + parts[0], all.to_bare = 0 + parts[1], all.to_floors = 0 + parts[2], all.reduction = 0 + parts[3];
  return all;
}

void ReductionWindow::At::add(const At& other) {
  error += other.error, leak += other.leak, reduction += other.reduction;
  over_darkening += other.over_darkening, peter_panning += other.peter_panning;
  aliasing_dark += other.aliasing_dark, aliasing_light += other.aliasing_light, coverage += other.coverage;
}

ReductionWindow::At ReductionWindow::of(const Receiver& r, double reduction) {
  const double shown = reduced(r.chain.bound, reduction);
  const LookupParts parts = parts_of(r.chain, shown);
  return {std::abs(shown - r.truth),       parts.leak(),
          -parts.over_darkening(),         parts.peter_panning(),
          std::max(0.0, -parts.reduction), std::max(0.0, -parts.aliasing),
          std::max(0.0, parts.aliasing),   std::abs(parts.coverage)};
}

void ReductionWindow::sort() {
  std::sort(receivers_.begin(), receivers_.end(),
            [](const Receiver& a, const Receiver& b) { return a.pixel < b.pixel; });
  std::vector<Receiver> others;
  for (const Receiver& receiver : receivers_) {
    if (receiver.chain.bound == 0 || receiver.chain.bound == 1)
      fixed_.add(of(receiver, 0)), ++fixed_receivers_;
    else
      others.push_back(receiver);
  }
  receivers_ = std::move(others);
  std::sort(shown_.begin(), shown_.end(), [](const Shown& a, const Shown& b) { return a.pixel < b.pixel; });
}

ReductionWindow::At ReductionWindow::at(double reduction) const {
  if (count() == 0) {
    At none;
    for (double At::*mean : means_of_reduction) none.*mean = not_a_number;
    return none;
  }
  // The same partition on any machine, so that the sums are too.
  At sum = tbb::parallel_deterministic_reduce(
      tbb::blocked_range<size_t>(0, receivers_.size(), 8192), At{},
      [&](const tbb::blocked_range<size_t>& range, At so_far) {
        for (size_t i = range.begin(); i != range.end(); ++i) so_far.add(of(receivers_[i], reduction));
        return so_far;
      },
      [](At a, const At& b) {
        a.add(b);
        return a;
      });
  sum.add(fixed_);
  for (double At::*mean : means_of_reduction) sum.*mean /= static_cast<double>(count());
  return sum;
}

ReductionWindow::ShownErrors ReductionWindow::shown(double reduction) const {
  if (shown_.empty()) return {not_a_number, not_a_number};
  ShownErrors sum = tbb::parallel_deterministic_reduce(
      tbb::blocked_range<size_t>(0, shown_.size(), 8192), ShownErrors{},
      [&](const tbb::blocked_range<size_t>& range, ShownErrors so_far) {
        for (size_t i = range.begin(); i != range.end(); ++i) {
          const Shown& one = shown_[i];
          const double lit = reduced(static_cast<double>(one.bound), reduction);
          so_far.error += std::abs(lit - static_cast<double>(one.truth));
          so_far.error_soft += std::abs(lit - static_cast<double>(one.soft));
        }
        return so_far;
      },
      [](ShownErrors a, const ShownErrors& b) {
        a.error += b.error, a.error_soft += b.error_soft;
        return a;
      });
  for (double ShownErrors::*mean : {&ShownErrors::error, &ShownErrors::error_soft})
    sum.*mean /= static_cast<double>(shown_.size());
  return sum;
}

// With u = 1 / (1 - r) a receiver's result is 1 - (1 - L) u until it is 0 at r = L. So its error is linear in u between the
// values of r at which its result meets its truth or 0, and the sum is least at one of them, or at an end.
ReductionWindow::Best ReductionWindow::best() const {
  struct Bend {
    double r, constant, slope;  // what is added to the sum of errors, constant + slope u, from r on
  };
  std::vector<Bend> bends;
  double constant = fixed_.error, slope = 0;
  for (const Receiver& r : receivers_) {
    const double loss = 1 - r.chain.bound;
    if (r.chain.bound > r.truth) {
      constant += 1 - r.truth, slope -= loss;
      // Where the result meets the truth; a truth of 0 is met where the result becomes 0 and stays.
      const double meets = r.truth < 1 ? (r.chain.bound - r.truth) / (1 - r.truth) : 1;
      bends.push_back({meets, -2 * (1 - r.truth), 2 * loss});
    } else {
      constant += r.truth - 1, slope += loss;
    }
    bends.push_back({r.chain.bound, 1, -loss});  // from here on the error is the truth itself
  }
  if (count() == 0) return {not_a_number, not_a_number};
  std::sort(bends.begin(), bends.end(), [](const Bend& a, const Bend& b) {
    return std::tie(a.r, a.constant, a.slope) < std::tie(b.r, b.constant, b.slope);  // one order on any machine
  });
  Best best{0, constant + slope};
  for (const Bend& bend : bends) {
    if (bend.r > most_reduction) break;
    const double u = 1 / (1 - bend.r);
    constant += bend.constant, slope += bend.slope;
    if (const double error = constant + slope * u; error < best.error) best = {bend.r, error};
  }
  const double last = constant + slope / (1 - most_reduction);
  if (last < best.error) best = {most_reduction, last};
  best.error = at(best.reduction).error;  // the sums above lose digits where u is large
  return best;
}

std::optional<ReductionWindow::Window> ReductionWindow::usable(double leak_bound, double darkening_bound) const {
  const auto leaks = [&](double r) { return !(at(r).leak <= leak_bound); };
  const auto darkens = [&](double r) {
    const At there = at(r);
    return !(there.reduction <= darkening_bound && there.over_darkening <= darkening_bound);
  };
  if (count() == 0 || leaks(most_reduction) || darkens(0)) return std::nullopt;
  const double low = first_that(0, most_reduction, [&](double r) { return !leaks(r); });
  const double high = darkens(most_reduction) ? first_that(0, most_reduction, darkens) - 0x1p-30 : most_reduction;
  return low <= high ? std::optional(Window{low, high}) : std::nullopt;
}

double bound_of_shown(double shown, double exact_bound, double reduction) {
  // 1 stays 1, to the last bit.
  return shown > 0 ? 1 - (1 - shown) * (1 - reduction) : std::min(exact_bound, reduction);
}

std::map<std::string, double> reduction_metrics(const ReductionWindow& window, double leak_bound,
                                                double darkening_bound) {
  const ReductionWindow::Best best = window.best();
  std::map<std::string, double> metrics = {{"best_reduction", best.reduction}, {"best_reduction_error", best.error}};
  if (const auto usable = window.usable(leak_bound, darkening_bound))
    metrics.insert({{"reduction_min", usable->low}, {"reduction_max", usable->high}});
  return metrics;
}

std::vector<LookupCurvePoint> reduction_curve(const ReductionWindow& window) {
  std::vector<LookupCurvePoint> curve;
  for (int percent = 0; percent <= std::lround(100 * most_reduction); ++percent) {
    const double r = percent / 100.0;
    const ReductionWindow::At at = window.at(r);
    if (std::isnan(at.error)) return {};
    const ReductionWindow::ShownErrors shown = window.shown(r);
    curve.push_back({"lookup.reduction", r, at.error, at.leak, at.over_darkening, at.peter_panning, at.reduction,
                     at.aliasing_dark, at.aliasing_light, at.coverage, shown.error, shown.error_soft});
  }
  return curve;
}

}  // namespace noonmark
