#include "compare/judge/answers.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace noonmark {
namespace {

bool counts(const CostAndError& one) { return std::isfinite(one.cost) && std::isfinite(one.error); }

// The index of the least by the order, of those that are taken; the first of equal ones.
template <typename Taken, typename Key>
std::optional<size_t> least_by(std::span<const CostAndError> settings, const Taken& taken, const Key& key) {
  std::optional<size_t> found;
  for (size_t i = 0; i < settings.size(); ++i)
    if (counts(settings[i]) && taken(settings[i]) && (!found || key(settings[i]) < key(settings[*found]))) found = i;
  return found;
}

}  // namespace

std::optional<ThreeAnswers> three_answers(std::span<const CostAndError> settings, std::optional<double> budget) {
  const auto by_cost = [](const CostAndError& one) { return std::pair(one.cost, one.error); };
  const auto by_error = [](const CostAndError& one) { return std::pair(one.error, one.cost); };
  const std::optional<size_t> least = least_by(
      settings, [&](const CostAndError& one) { return !budget || one.cost <= *budget; }, by_cost);
  if (!least) return std::nullopt;
  ThreeAnswers answers;
  answers.least = *least;
  // At least the least cost. A multiple of a negative cost would be less.
  const double cost = settings[*least].cost;
  answers.budget = budget.value_or(std::max(cost, budget_of_least * cost));
  const auto within = [&](const CostAndError& one) { return one.cost <= answers.budget; };
  const auto no_cheaper_does = [&](const CostAndError& one) {
    return within(one) && !least_by(
                              settings,
                              [&](const CostAndError& other) {
                                return other.cost < one.cost && other.error <= error_that_pays * one.error;
                              },
                              by_cost);
  };
  answers.balanced = least_by(settings, no_cheaper_does, by_error).value();  // `least` is one, because none is cheaper
  answers.best = least_by(settings, within, by_error).value();
  return answers;
}

}  // namespace noonmark
