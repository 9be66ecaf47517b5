// Which of the measured choices to set: the cheapest one that is good enough under all conditions.
//
//   const Recommendation found = recommend(results, {});
//   if (found.outcome == Recommendation::Outcome::found) print(found.choice.first().settings, found.bias->value);
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "compare/judge/choices.h"
#include "compare/judge/interval.h"
#include "compare/results/records.h"

namespace noonmark {

// The bias keeps this factor of distance from either end of the usable window, if the window is wide enough. At its ends
// acne and Peter Panning begin in steps, and a driver that rounds otherwise would break them.
inline constexpr double bias_margin = 1.05;
// Biases whose error is at most this factor of the least count as equally accurate (BiasCurve::flat_min_depth uses the
// same). Of these the one is taken that is furthest from both ends of the window.
inline constexpr double flat_error = 1.1;

// A bias for the parameter that the choice's curves vary, in bias.unit.
struct BiasChoice {
  std::string parameter, unit;
  double value = 0;     // a short decimal
  Interval window;      // usable under every condition
  bool narrow = false;  // the window is too narrow for bias_margin; the value is in its middle half
  // The points were rendered with it, and it is kept because it is good enough (set_bias). narrow: it is closer than
  // bias_margin to an end of the window.
  bool as_set = false;
  // Where numbers of the answer are read: as rendered, or at the value.
  std::optional<double> read_at() const { return as_set ? std::nullopt : std::optional(value); }
};

// How far a bias that is not narrow keeps from the ends of its window: "the bias keeps at least 5% from both ends". A
// window from 0 has no lower end, because no bias is needed there.
std::string margin_text(const BiasChoice& bias);

// How many costs of the good choices are known to be above the least. Costs that are equal for equal work count once.
struct CostNoise {
  size_t costs = 0;  // different costs
  size_t least = 0;  // those of them that are not certainly above the least: 1 if it is known which one is the least
  bool meaningless() const { return costs > 1 && least == costs; }
};

struct Recommendation {
  enum class Outcome {
    found,
    none_holds,    // there are criteria, and no choice meets them
    no_criterion,  // neither a bound nor a curve: no criterion for good enough
    incomplete,    // conditions of some choices are not measured yet
  } outcome = Outcome::no_criterion;
  // The others: only if found.
  Choice choice;
  MedianInterval cost;             // largest over the conditions, in the unit of RunInfo::cost (joined_interval)
  Joined error;                    // RunInfo::accuracy, at `bias`, or as rendered if there is no bias
  std::optional<BiasChoice> bias;  // the choice has curves
  CostNoise noise;                 // of recommend()
};

// The bias for a choice with curves: within its joined window and the margin, as far from the ends as possible without
// losing accuracy (flat_error; the error is RunInfo::accuracy, the largest over the conditions), and rounded to few digits
// inside of it. At that bias every one of `bounds` holds that applies to the choice. Empty if the window is empty, or if
// no bias in it meets the bounds.
std::optional<BiasChoice> choose_bias(const Choice& choice, const Results& results,
                                      const std::vector<BoundResult>& bounds);

// The bias that was set, if the results are of this one choice, a bound speaks of it, every bound holds as rendered, and
// the bias lies in the joined window. Such results compare nothing: they judge what was set. So a report of settings that
// hold their bounds speaks of their own bias, and not of another one that would hold too.
std::optional<BiasChoice> set_bias(const Choice& choice, const Results& results);

// The biases at which a curve of the choice has an entry or its best bias, in bias.unit, within low ... high, and the
// two ends. Every point must have a curve.
std::vector<double> curve_biases(const Choice& choice, double low, double high);

// The choice at its best bias, or nothing if it is not good enough or there is no criterion for it. A choice is good
// enough if it keeps, under every condition, every bound that applies to it, and if it has curves and the joined window is
// not empty. A max on a metric that the experiment asks of other choices alone (its `where` names swept settings of the map,
// the filter or the bias) applies too, if no bound on that metric speaks of this choice: what is too wrong for one map is too wrong for
// another. Bounds on values of the curve are checked at the bias that would be set (set_bias, otherwise choose_bias), other
// bounds as rendered. A value that is not finite, also a cost or an error, is never good enough.
std::optional<Recommendation> good_choice(const Choice& choice, const Results& results);
// Whether a bound or a curve says if the choice is good enough.
bool has_criterion(const Choice& choice, const Results& results);

// Whether the choice was judged by a bound that the experiment asks of other choices alone (good_choice).
bool keeps_bounds_of_others(const Choice& choice, const Results& results);

// All choices that are good enough under conditions_of(), in order.
std::vector<Recommendation> good_choices(const Results& results);

// Whether the points of some choices are not measured yet under every condition, so that nothing can be recommended.
bool is_incomplete(const Results& results);

// Of choices that are good enough the one of least cost (as recommend). Null if there is none.
const Recommendation* cheapest(const std::vector<Recommendation>& good);

// Of the good choices whose cost is not certainly above the least (compare/judge/interval.h; costs that do not depend on
// the machine have no interval and are compared exactly) the one of least error, then of least cost, then the first.
Recommendation recommend(const Results& results);
// The same where good_choices() are known already: of thousands of choices they are most of the work.
Recommendation recommend(const Results& results, const std::vector<Recommendation>& good);

// Whether one point meets a bound's limits, in the way that the bound takes placements. Metrics of the curve are read at
// the bias (window depth), if it is given.
bool meets(const PointRecord& point, const BoundResult& bound, std::optional<double> bias_depth = std::nullopt);

// The number with the fewest significant digits that lies in [low, high] and differs from `value` by at most 5%. `value`
// lies in [low, high]; it is returned itself if nothing shorter does.
double short_decimal(double value, double low, double high);

}  // namespace noonmark
