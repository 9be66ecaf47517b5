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

void ReductionWindow::sort() {
  std::sort(receivers_.begin(), receivers_.end(),
            [](const Receiver& a, const Receiver& b) { return a.pixel < b.pixel; });
}

ReductionWindow::At ReductionWindow::at(double reduction) const {
  // The same partition on any machine, so that the sums are too.
  const At sum = tbb::parallel_deterministic_reduce(
      tbb::blocked_range<size_t>(0, receivers_.size(), 8192), At{},
      [&](const tbb::blocked_range<size_t>& range, At so_far) {
        for (size_t i = range.begin(); i != range.end(); ++i) {
          const Receiver& r = receivers_[i];
          const double shown = reduced(r.bound, reduction);
          so_far.error += std::abs(shown - r.truth);
          std::array<double, 4> parts{};
          lasting_steps(std::array{r.from, r.texels, r.bare, r.bound, shown}, parts);
          so_far.leak += std::max(0.0, parts[1]);
          so_far.reduction += std::max(0.0, -parts[3]);
        }
        return so_far;
      },
      [](At a, const At& b) {
        a.error += b.error, a.leak += b.leak, a.reduction += b.reduction;
        return a;
      });
  const auto count = static_cast<double>(receivers_.size());
  if (receivers_.empty()) return {not_a_number, not_a_number, not_a_number};
  return {sum.error / count, sum.leak / count, sum.reduction / count};
}

// With u = 1 / (1 - r) a receiver's result is 1 - (1 - L) u until it is 0 at r = L. So its error is linear in u between the
// values of r at which its result meets its truth or 0, and the sum is least at one of them, or at an end.
ReductionWindow::Best ReductionWindow::best() const {
  struct Bend {
    double r, constant, slope;  // what is added to the sum of errors, constant + slope u, from r on
  };
  std::vector<Bend> bends;
  double constant = 0, slope = 0;
  for (const Receiver& r : receivers_) {
    const double loss = 1 - r.bound;
    if (r.bound > r.truth) {
      constant += 1 - r.truth, slope -= loss;
      // Where the result meets the truth; a truth of 0 is met where the result becomes 0 and stays.
      const double meets = r.truth < 1 ? (r.bound - r.truth) / (1 - r.truth) : 1;
      bends.push_back({meets, -2 * (1 - r.truth), 2 * loss});
    } else {
      constant += r.truth - 1, slope += loss;
    }
    bends.push_back({r.bound, 1, -loss});  // from here on the error is the truth itself
  }
  if (receivers_.empty()) return {not_a_number, not_a_number};
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
  if (receivers_.empty() || at(most_reduction).leak > leak_bound || at(0).reduction > darkening_bound)
    return std::nullopt;
  const double low = first_that(0, most_reduction, [&](double r) { return at(r).leak <= leak_bound; });
  const double beyond = first_that(0, most_reduction, [&](double r) { return at(r).reduction > darkening_bound; });
  const double high = at(most_reduction).reduction <= darkening_bound ? most_reduction : beyond - 0x1p-30;
  return low <= high ? std::optional(Window{low, high}) : std::nullopt;
}

std::map<std::string, double> reduction_metrics(ReductionWindow window, double leak_bound, double darkening_bound) {
  window.sort();
  const ReductionWindow::Best best = window.best();
  std::map<std::string, double> metrics = {{"best_reduction", best.reduction}, {"best_reduction_error", best.error}};
  if (const auto usable = window.usable(leak_bound, darkening_bound))
    metrics.insert({{"reduction_min", usable->low}, {"reduction_max", usable->high}});
  return metrics;
}

}  // namespace noonmark
