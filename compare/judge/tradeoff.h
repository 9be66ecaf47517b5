// Cost against error: every choice at its best bias, so that none looks good by a lucky one.
//
//   for (const ComparedGroup& group : compared_groups(results))
//     for (const ComparedChoice& one : group.choices) print(value_of(one, "map_bytes").worst, value_of(one, "error").worst);
#pragma once
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "base/interval.h"
#include "compare/judge/choices.h"
#include "compare/judge/recommendation.h"
#include "compare/results/records.h"

namespace noonmark {

struct ComparedChoice {
  enum class Window {
    usable,
    empty,     // no bias is usable under every condition
    unknown,   // hides_window() under a condition, or without a curve as many receivers are ambiguous
    no_curve,  // some point has no curve, so the choice stands as it was rendered
  };
  Choice choice;
  Window window = Window::no_curve;
  // In bias.unit. Window usable: that of good_choice(); if no bias of the window meets the bounds, that of choose_bias()
  // without bounds. Window empty: that of the least error (RunInfo::accuracy), of several the least bias. No curve: none.
  std::optional<double> bias;
  std::optional<Interval> usable;      // the joined window
  bool rendered_in_window = false;     // every point was rendered with a bias of its own window
  std::optional<Recommendation> good;  // the choice is good enough
  bool judged = true;                  // has_criterion()
  // Where its numbers are read at its bias: as rendered if that is the bias that was set (BiasChoice::as_set).
  std::optional<double> read_at() const { return good && good->bias ? good->bias->read_at() : bias; }
};
ComparedChoice at_best_bias(const Choice& choice, const Results& results);

// Choices that can be compared (comparable_choices), and the index of one of them. It is empty if no choice is
// good enough, or if the sweep is incomplete (is_incomplete).
struct ComparedGroup {
  std::vector<ComparedChoice> choices;
  std::optional<size_t> recommended;  // the cheapest choice that is good enough
};
std::vector<ComparedGroup> compared_groups(const Results& results);

// good_choices() of the results, from their groups, where RunInfo::over has all conditions_of().
std::vector<Recommendation> good_choices(const std::vector<ComparedGroup>& groups);

// Where a choice is looked at: at its own bias (ComparedChoice::bias), or with the bias that its points were rendered with.
enum class AtBias { best, as_set };

// A metric at the bias, joined over the conditions of the choice. If it does not follow the bias: as rendered.
Joined value_of(const ComparedChoice& one, const std::string& metric, AtBias at = AtBias::best);

// A cost of the choice: joined_interval().
inline MedianInterval cost_of(const ComparedChoice& one, const std::string& metric) {
  return joined_interval(one.choice, metric);
}

// Whether the curve of every point gives the metric at any bias.
bool follows_bias(const ComparedChoice& one, const std::string& metric);

// Whether the metric's value says something about a usable bias, so that the choice can be better than others by it. It
// does not if the window is empty, nor if the value is as rendered and a point was rendered with a bias outside its
// window; as set, no metric follows the bias. A choice without curves has no window that could deny it.
bool counts_by(const ComparedChoice& one, const std::string& metric, AtBias at = AtBias::best);

// The least and the largest value over the usable window, of the largest over the conditions. Of one condition both are
// exact for the stored curve, because it is linear between its entries; of several the least is that over all entries.
// Empty without a window, if the metric does not follow the bias, or if a value is not finite.
std::optional<Interval> span_over_window(const ComparedChoice& one, const std::string& metric);

// The causes of the error, dark and light aliasing joined, and dark and light coverage; also those that rungs brought.
std::vector<std::string> joined_causes(std::initializer_list<const ComparedChoice*> choices);

// The cause with the largest mean over the conditions, at the bias; causes that do not follow the bias as
// rendered. Of joined_causes(). Empty if no cause is above 0.
std::string dominating_cause(const ComparedChoice& one, AtBias at = AtBias::best);

}  // namespace noonmark
